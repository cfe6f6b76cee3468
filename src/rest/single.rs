//! Single points: one by its id, and those nearest to a place; in the plane and in space.

use std::{pin::pin, sync::Arc};

use axum::extract::State;
use schemars::JsonSchema;
use serde::Serialize;
use strew_catalog::Dimension;
use strew_error::Kind;
use strew_plan::{Found, Placed};
use strew_query::{Nearest, Parameter, ResolvedSet, Set, Shape, groups};
use strew_service::Service;

use super::{
    api::{self, Endpoint, Operation, Tag, either},
    context::{Context, Shared},
    document,
    freshness::Freshness,
};
use crate::rest::Refused;

const ID: Parameter = Parameter {
    name: "id",
    about: "The stable id of a point: its lattice address.",
    shape: Shape::Pattern("^-?[0-9]+:-?[0-9]+$"),
    allowed: Some("two integers joined by a colon, such as -31:52"),
    example: "0:0",
    is_required: true,
    ..Parameter::PLAIN
};
const SPACE_ID: Parameter = Parameter {
    shape: Shape::Pattern("^-?[0-9]+:-?[0-9]+:-?[0-9]+$"),
    allowed: Some("three integers joined by colons, such as -31:52:7"),
    example: "0:0:0",
    ..ID
};

pub(super) fn by_id(service: &Arc<Service>, dimension: Dimension) -> Endpoint {
    let answers = api::Answer::json::<One>("The point.").or_unchanged();
    let example = [
        "'/v1/points/0:0?spacing=1&attributes=angle'",
        "'/v1/space/points/0:0:0?spacing=1&attributes=rotation'",
    ];
    let parameters = either(dimension, [groups::SINGLE, groups::SPACE_SINGLE]);
    let operation = Operation {
        id: either(dimension, ["getPoint", "getSpacePoint"]),
        summary: either(
            dimension,
            ["A point by its id", "A point in space by its id"],
        ),
        about: "The parameters of the query that returned the id find the point again.",
        path_parameters: either(dimension, [&[&ID], &[&SPACE_ID]]),
        parameters,
        problems: vec![Kind::Invalid, Kind::OtherTable, Kind::NoSuchPoint],
        example: either(dimension, example).into(),
        ..Operation::new(Tag::of(dimension), answers)
    };
    let get = move |State(service): Shared, context: Context| async move {
        let [id] = context.path();
        let set = Set::single(&context.values(parameters), &service.catalog())?;
        let freshness = freshness(&context, &set);
        let make = async {
            let placed = service.place(&context.caller, set).await?;
            document::json(&One {
                point: placed.point(id)?,
                query: placed.resolved,
            })
        };
        Ok::<_, Refused>(freshness.answer(&context.headers, pin!(make)).await?)
    };
    let path = either(dimension, ["/v1/points/{id}", "/v1/space/points/{id}"]);
    Endpoint::only(path, service.clone(), operation, get)
}

pub(super) fn nearest(service: &Arc<Service>, dimension: Dimension) -> Endpoint {
    let answers = api::Answer::json::<Several>("The points.").or_unchanged();
    let example = [
        "'/v1/nearest?at=100.5,-3&k=2&spacing=1'",
        "'/v1/space/nearest?at=100.5,-3,12&k=2&spacing=1'",
    ];
    let summary = [
        "The points nearest to a place",
        "The points in space nearest to a place",
    ];
    let parameters = either(dimension, [groups::NEAREST, groups::SPACE_NEAREST]);
    let operation = Operation {
        id: either(dimension, ["getNearest", "getSpaceNearest"]),
        summary: either(dimension, summary),
        about: "Exact, nearest first; of equally near ones the smaller id first. With k and radius both must hold; at \
                most 10000 points.",
        parameters,
        problems: vec![Kind::Invalid, Kind::OtherTable],
        example: either(dimension, example).into(),
        ..Operation::new(Tag::of(dimension), answers)
    };
    let get = move |State(service): Shared, context: Context| async move {
        let values = context.values(parameters);
        let (set, nearest) = Nearest::of_set(&values, &service.catalog())?;
        let freshness = freshness(&context, &set);
        let write = |placed: &Placed, neighbors| {
            document::json(&Several {
                neighbors,
                query: placed.resolved.clone(),
            })
        };
        let make = service.nearest(&context.caller, set, nearest, write);
        Ok::<_, Refused>(freshness.answer(&context.headers, pin!(make)).await?)
    };
    let path = either(dimension, ["/v1/nearest", "/v1/space/nearest"]);
    Endpoint::only(path, service.clone(), operation, get)
}

/// A point by its id.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "PointById")]
pub struct One {
    /// The point.
    pub point: Found,
    /// The set of points with everything filled in.
    pub query: ResolvedSet,
}

/// The points nearest to a place.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "Neighbors")]
pub struct Several {
    /// The points, nearest first.
    pub neighbors: Vec<Found>,
    /// The set of points with everything filled in.
    pub query: ResolvedSet,
}

fn freshness(context: &Context, set: &Set) -> Freshness {
    let made_of: Vec<&str> = set.digests().collect();
    let freshness = context.freshness(document::JSON, &made_of);
    freshness.pinned(set.is_pinned())
}
