//! `GET /v1/chunks/{size}/{cx}/{cy}`: the points of a square of the world grid, relative to its
//! corner.

use std::sync::Arc;

use axum::{
    extract::{Path, State},
    response::Response,
    routing,
};
use http::Method;
use strew_core::server::Stop;

use super::{
    answer,
    api::{self, Endpoint, Operation, Tag},
    context::Context,
};
use crate::service::{
    Draft, Error, Service,
    query::{Checked, Parameter, RegionDraft, Shape, ShapeDraft, Together as _, groups},
};

/// The path.
pub(super) fn endpoint(service: Arc<Service>) -> Endpoint {
    let operation = Operation {
        method: Method::GET,
        id: "getChunk",
        summary: "The points of a chunk",
        about: "A chunk is a square of the world grid: size·cx ≤ x < size·(cx + 1), and so for y. \
                Coordinates are relative to its corner, so that f32 is exact enough at any \
                distance. Neighbors share no point and lose none.",
        tag: Tag::Points,
        path_parameters: &[&SIZE, &COLUMN, &ROW],
        parameters: groups::CHUNK,
        body: None,
        answers: vec![answer::described(), api::Answer::unchanged()],
        problems: answer::problems(),
        example: "'/v1/chunks/64/-3/2?spacing=16&format=csv'".into(),
    };
    let handler = routing::get(get);
    Endpoint::new(
        "/v1/chunks/{size}/{cx}/{cy}",
        service,
        vec![(operation, handler)],
    )
}

/// How far from the origin chunks are counted.
const CELLS: Shape = Shape::Signed { limit: 1 << 52 };

pub(super) const SIZE: Parameter = Parameter {
    name: "size",
    about: "The side of a chunk in world units.",
    shape: Shape::Number {
        min: f64::MIN_POSITIVE,
        max: f64::MAX,
    },
    allowed: Some("a finite number above 0"),
    example: "64",
    is_required: true,
    ..Parameter::PLAIN
};
pub(super) const COLUMN: Parameter = Parameter {
    name: "cx",
    about: "The column of the chunk.",
    shape: CELLS,
    example: "-3",
    is_required: true,
    ..Parameter::PLAIN
};
pub(super) const ROW: Parameter = Parameter {
    name: "cy",
    about: "The row of the chunk.",
    shape: CELLS,
    example: "2",
    is_required: true,
    ..Parameter::PLAIN
};

async fn get(
    State(service): State<Arc<Service>>,
    Path([size, x, y]): Path<[String; 3]>,
    context: Context,
) -> Result<Response, Error> {
    let draft = Draft::new(context.values(groups::CHUNK)).within(region([&size, &x, &y]));
    let (query, options) = service.check(&draft, &Stop::NEVER)?;
    answer::stream(&service, &context, query, options).await
}

/// The region of a path.
pub(super) fn region([size, x, y]: [&str; 3]) -> Checked<RegionDraft> {
    let address = (SIZE.read(size), COLUMN.read(x), ROW.read(y));
    address.together().map(|(size, x, y)| RegionDraft {
        path: "chunk".into(),
        shape: ShapeDraft::Chunk(size, [x, y]),
    })
}
