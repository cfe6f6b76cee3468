//! `GET /v1/chunks/{size}/{cx}/{cy}`: the points of a square of the world grid, relative to its
//! corner.

use std::sync::Arc;

use axum::extract::State;
use strew_core::server::Stop;
use strew_error::{Checked, Together as _};
use strew_query::{Draft, Parameter, RegionDraft, Shape, ShapeDraft, groups};
use strew_service::Service;

use super::{
    answer,
    api::{Endpoint, Operation, Tag},
    context::Context,
};
use crate::{body::Response, rest::Refused};

/// The path.
pub(super) fn endpoint(service: Arc<Service>) -> Endpoint {
    let operation = Operation {
        id: "getChunk",
        summary: "The points of a chunk",
        about: "A chunk is a square of the world grid: size·cx ≤ x < size·(cx + 1), and so for y. \
                Coordinates are relative to its corner, so that f32 is exact enough at any \
                distance. Neighbors share no point and lose none.",
        path_parameters: &[&SIZE, &COLUMN, &ROW],
        parameters: groups::CHUNK,
        problems: answer::problems(),
        example: "'/v1/chunks/64/-3/2?spacing=16&format=csv'".into(),
        ..Operation::new(Tag::Points, answer::described().or_unchanged())
    };
    Endpoint::only("/v1/chunks/{size}/{cx}/{cy}", service, operation, get)
}

/// The greatest distance of a chunk from the origin, in chunks.
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

async fn get(State(service): State<Arc<Service>>, context: Context) -> Result<Response, Refused> {
    let [size, x, y] = context.path();
    let draft = Draft::new(context.values(groups::CHUNK)).within(region([size, x, y]));
    let (query, options) = service.check(&draft, &Stop::NEVER)?;
    Ok(answer::stream(&service, &context, query, options).await?)
}

/// The region of a path.
pub(super) fn region([size, x, y]: [&str; 3]) -> Checked<RegionDraft> {
    let address = (SIZE.read(size), COLUMN.read(x), ROW.read(y));
    address.together().map(|(size, x, y)| RegionDraft {
        path: "chunk".into(),
        shape: ShapeDraft::Chunk(size, [x, y]),
    })
}
