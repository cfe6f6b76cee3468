//! `GET /v1/points/{id}` and `GET /v1/nearest`: single points.

use std::{pin::pin, sync::Arc};

use axum::extract::State;
use schemars::JsonSchema;
use serde::Serialize;
use strew_error::Kind;
use strew_plan::{Found, Placed};
use strew_query::{Group, Nearest, Parameter, ResolvedSet, Set, Shape, groups};
use strew_service::Service;

use super::{
    api::{self, Endpoint, Operation, Tag},
    context::Context,
    document,
    freshness::Freshness,
};
use crate::{body::Response, rest::Refused};

const ID: Parameter = Parameter {
    name: "id",
    about: "The stable id of a point: its lattice address.",
    shape: Shape::Pattern("^-?[0-9]+:-?[0-9]+$"),
    allowed: Some("two integers joined by a colon, such as -31:52"),
    example: "0:0",
    is_required: true,
    ..Parameter::PLAIN
};

/// The path of points by id.
pub(super) fn by_id(service: Arc<Service>) -> Endpoint {
    let operation = Operation {
        id: "getPoint",
        summary: "A point by its id",
        about: "The parameters of the query that returned the id find the point again.",
        path_parameters: &[&ID],
        parameters: groups::SINGLE,
        problems: vec![Kind::Invalid, Kind::OtherTable, Kind::NoSuchPoint],
        example: "'/v1/points/0:0?spacing=1&attributes=angle'".into(),
        ..Operation::new(
            Tag::Points,
            api::Answer::json::<One>("The point.").or_unchanged(),
        )
    };
    Endpoint::only("/v1/points/{id}", service, operation, point)
}

/// The path of the points near a place.
pub(super) fn nearest(service: Arc<Service>) -> Endpoint {
    let operation = Operation {
        id: "getNearest",
        summary: "The points nearest to a place",
        about: "Exact, nearest first; of equally near ones the smaller id first. With k and radius \
                both must hold; at most 10000 points.",
        parameters: groups::NEAREST,
        problems: vec![Kind::Invalid, Kind::OtherTable],
        example: "'/v1/nearest?at=100.5,-3&k=2&spacing=1'".into(),
        ..Operation::new(
            Tag::Points,
            api::Answer::json::<Several>("The points.").or_unchanged(),
        )
    };
    Endpoint::only("/v1/nearest", service, operation, near)
}

/// A point by its id.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "PointById")]
pub(super) struct One {
    /// The point.
    point: Found,
    /// The set of points with everything filled in.
    query: ResolvedSet,
}

/// The points nearest to a place.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "Neighbors")]
pub(super) struct Several {
    /// The points, nearest first.
    neighbors: Vec<Found>,
    /// The set of points with everything filled in.
    query: ResolvedSet,
}

async fn point(State(service): State<Arc<Service>>, context: Context) -> Result<Response, Refused> {
    by_id_in(&service, &context, groups::SINGLE).await
}

async fn near(State(service): State<Arc<Service>>, context: Context) -> Result<Response, Refused> {
    near_in(&service, &context, groups::NEAREST).await
}

/// The point of a path, of a set of some parameters.
pub(super) async fn by_id_in(
    service: &Service,
    context: &Context,
    groups: &'static [Group],
) -> Result<Response, Refused> {
    let [id] = context.path();
    let values = context.values(groups);
    let set = Set::single(&values, &service.catalog())?;
    let freshness = freshness(context, &set);
    let make = async {
        let placed = service.place(&context.caller, set).await?;
        document::json(&One {
            point: placed.point(id)?,
            query: placed.resolved,
        })
    };
    Ok(freshness.answer(&context.headers, pin!(make)).await?)
}

/// The neighbors of the place among some parameters.
pub(super) async fn near_in(
    service: &Service,
    context: &Context,
    groups: &'static [Group],
) -> Result<Response, Refused> {
    let values = context.values(groups);
    let (set, nearest) = Nearest::of_set(&values, &service.catalog())?;
    let freshness = freshness(context, &set);
    let write = |placed: &Placed, neighbors| {
        document::json(&Several {
            neighbors,
            query: placed.resolved.clone(),
        })
    };
    let make = service.nearest(&context.caller, set, nearest, write);
    Ok(freshness.answer(&context.headers, pin!(make)).await?)
}

/// The freshness of a document about single points of a set.
fn freshness(context: &Context, set: &Set) -> Freshness {
    let made_of: Vec<&str> = set.digests().collect();
    let freshness = context.freshness(document::JSON, &made_of);
    freshness.pinned(set.is_pinned())
}
