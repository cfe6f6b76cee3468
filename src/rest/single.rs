//! `GET /v1/points/{id}` and `GET /v1/nearest`: single points.

use std::sync::Arc;

use axum::{
    extract::{Path, State},
    response::Response,
    routing,
};
use http::{HeaderMap, Method, Uri};
use serde::Serialize;
use serde_json::{Value, json};
use strew_core::server::Stop;

use super::{
    api::{self, Endpoint, Operation, schemas},
    document,
    freshness::Freshness,
};
use crate::access::Caller;
use crate::service::{
    Error, Found, Kind, Neighbors, Placed, Service,
    query::{Parameter, Parameters, ResolvedSet, SET_NAMES, Shape, parse_pairs},
};

/// The parameters that say what points there are: without a region there is nothing to count.
fn set_names() -> Vec<&'static str> {
    let names = SET_NAMES.into_iter();
    names.filter(|name| *name != "count").collect()
}

const ID: &[Parameter] = &[Parameter {
    name: "id",
    about: "The stable id of a point: its lattice address.",
    allowed: "two integers joined by a colon, such as -31:52",
    shape: Shape::Pattern("^-?[0-9]+:-?[0-9]+$"),
    default: None,
    example: "0:0",
}];

/// The path of points by id.
pub(super) fn by_id(service: Arc<Service>) -> Endpoint {
    let operation = Operation {
        method: Method::GET,
        id: "getPoint",
        summary: "A point by its id",
        about: "The same parameters that gave the id find the point again.",
        path_parameters: ID,
        parameters: api::given(&[], &set_names()),
        body: None,
        answers: vec![
            told(
                "The point.",
                json!({ "point": schemas::reference("Found"), "query": set() }),
            ),
            api::Answer::unchanged(),
        ],
        problems: vec![Kind::Invalid, Kind::OtherTable, Kind::NoSuchPoint],
        example: "'/v1/points/0:0?spacing=1&attributes=angle'".into(),
    };
    let handler = routing::get(point);
    Endpoint::new("/v1/points/{id}", service, vec![(operation, handler)])
}

/// The path of the points near a place.
pub(super) fn nearest(service: Arc<Service>) -> Endpoint {
    let neighbors = json!({ "type": "array", "items": schemas::reference("Found") });
    let operation = Operation {
        method: Method::GET,
        id: "getNearest",
        summary: "The points nearest to a place",
        about: "Exact, nearest first; of equally near ones the smaller id first. With k and radius \
                both must hold; at most 10000 points.",
        path_parameters: &[],
        parameters: api::given(&["at"], &[&["k", "radius"], &set_names()[..]].concat()),
        body: None,
        answers: vec![
            told(
                "The points.",
                json!({ "neighbors": neighbors, "query": set() }),
            ),
            api::Answer::unchanged(),
        ],
        problems: vec![Kind::Invalid, Kind::OtherTable],
        example: "'/v1/nearest?at=100.5,-3&k=2&spacing=1'".into(),
    };
    let handler = routing::get(around);
    Endpoint::new("/v1/nearest", service, vec![(operation, handler)])
}

fn told(about: &'static str, members: Value) -> api::Answer {
    api::Answer {
        status: 200,
        about,
        headers: vec![],
        contents: vec![(document::JSON.into(), schemas::object(members))],
    }
}

fn set() -> Value {
    schemas::reference("Set")
}

#[derive(Serialize)]
struct One {
    point: Found,
    query: ResolvedSet,
}

#[derive(Serialize)]
struct Several {
    neighbors: Vec<Found>,
    query: ResolvedSet,
}

async fn point(
    State(service): State<Arc<Service>>,
    Path(id): Path<String>,
    uri: Uri,
    headers: HeaderMap,
) -> Result<Response, Error> {
    let (parameters, faults) = parse_pairs(uri.query().unwrap_or_default());
    let set = parameters.check_set(&service.catalog(), &[], faults)?;
    let placed = service.place(set).await?;
    let one = One {
        point: placed.point(&id)?,
        query: placed.resolved.clone(),
    };
    finished(&uri, &headers, &parameters, &placed, &one)
}

async fn around(
    State(service): State<Arc<Service>>,
    caller: Caller,
    uri: Uri,
    headers: HeaderMap,
) -> Result<Response, Error> {
    let (parameters, mut faults) = parse_pairs(uri.query().unwrap_or_default());
    let around = parameters.around().map_err(|more| faults.extend(more));
    let set = parameters.check_set(&service.catalog(), &["at", "k", "radius"], faults)?;
    let around = around.map_err(|()| Error::Internal("a fault is lost"))?;
    let placed = service.place(set).await?;
    let effort = Neighbors::of(&placed, &around);
    let budget = service.own_budget();
    // Thousands of points are written where they are found, not where sockets are served.
    let answer = move |_: &Stop| {
        let _held = budget.hold(effort.bytes)?;
        let neighbors = placed.nearest(around)?;
        caller.charge(neighbors.len() as u128)?;
        let several = Several {
            neighbors,
            query: placed.resolved.clone(),
        };
        finished(&uri, &headers, &parameters, &placed, &several)
    };
    service.workers().take_turn(effort.lane, answer).await?
}

/// A document that changes with the table only.
fn finished(
    uri: &Uri,
    headers: &HeaderMap,
    parameters: &Parameters,
    placed: &Placed,
    document: &impl Serialize,
) -> Result<Response, Error> {
    let made_of = (&placed.resolved, &placed.set.entry.digest);
    let freshness = Freshness::of(uri, headers, document::JSON, &made_of)
        .pinned(parameters.get("table").is_some());
    let unchanged = freshness.unchanged(headers);
    if let Some(unchanged) = unchanged.or_else(|| freshness.unwanted(headers)) {
        return Ok(unchanged);
    }
    let mut response = document::json(document)?;
    freshness.stamp(&mut response);
    Ok(response)
}
