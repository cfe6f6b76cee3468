//! The points of regions, streamed: of an address, of a body, of a chunk of the world grid; in the plane and in space.

use std::sync::Arc;

use axum::extract::State;
use http::Method;
use serde_json::json;
use strew_catalog::Dimension;
use strew_core::server::Stop;
use strew_error::{Checked, Kind, Together as _};
use strew_query::{Draft, Group, Parameter, RegionDraft, Shape, ShapeDraft, groups};
use strew_service::Service;

use super::{
    answer,
    api::{
        self, Endpoint, Operation, Tag,
        schemas::{self, PointsQuery, SpaceQuery},
    },
    body,
    context::{Context, Sent},
};
use crate::{body::Response, rest::Refused};

/// The paths of a dimension.
pub(super) fn endpoints(service: &Arc<Service>, dimension: Dimension) -> Vec<Endpoint> {
    let (parameters, members) = match dimension {
        Dimension::Plane => (groups::POINTS, groups::QUERY),
        Dimension::Space => (groups::SPACE_POINTS, groups::SPACE_QUERY),
    };
    let get = move |State(service): State<Arc<Service>>, context: Context| async move {
        let draft = Draft::of(context.values(parameters));
        stream(&service, &context, &draft).await
    };
    let post = move |State(service): State<Arc<Service>>, Sent { context, body }: Sent| async move {
        let (_, query, options) = body::query(&service, body, members).await?;
        Ok::<_, Refused>(answer::stream(&service, &context, query, options).await?)
    };
    let (given, posted) = (given(dimension, parameters), posted(dimension));
    let service = service.clone();
    let chunk = chunk(&service, dimension);
    match dimension {
        Dimension::Plane => vec![
            Endpoint::only("/v1/points", service.clone(), given, get),
            Endpoint::only("/v1/points:query", service, posted, post),
            chunk,
        ],
        Dimension::Space => vec![
            Endpoint::only("/v1/space/points", service.clone(), given, get)
                .with(service, posted, post),
            chunk,
        ],
    }
}

/// Answers a query of an address.
pub(super) async fn stream(
    service: &Service,
    context: &Context,
    draft: &Draft,
) -> Result<Response, Refused> {
    let (query, options) = service.check(draft, &Stop::NEVER)?;
    Ok(answer::stream(service, context, query, options).await?)
}

fn given(dimension: Dimension, parameters: &'static [Group]) -> Operation {
    let operation = Operation {
        parameters,
        problems: answer::problems(),
        ..Operation::new(Tag::of(dimension), answer::described().or_unchanged())
    };
    match dimension {
        Dimension::Plane => Operation {
            id: "getPoints",
            summary: "The points of a region",
            about: "Streams every point of a half-open box, a circle or a polygon, in a fixed order. The \
                    exact count is in the header strew-count before any point is made.",
            example: "'/v1/points?bbox=0,0,3,2&spacing=1&format=csv'".into(),
            ..operation
        },
        Dimension::Space => Operation {
            id: "getSpacePoints",
            summary: "The points of a volume",
            about: "Streams every point of a half-open box or a ball, in a fixed order. Ids are x:y:z. With png the \
                    points are seen along z, as a slab.",
            example: "'/v1/space/points?bbox=0,0,0,2,2,1&spacing=1&format=csv'".into(),
            ..operation
        },
    }
}

fn posted(dimension: Dimension) -> Operation {
    let operation = Operation {
        method: Method::POST,
        problems: [answer::problems(), vec![Kind::BodyTooLarge]].concat(),
        ..Operation::new(Tag::of(dimension), vec![answer::described()])
    };
    match dimension {
        Dimension::Plane => {
            let example = json!({
                "region": { "circle": { "center": [10, 10], "radius": 4 } },
                "layers": [
                    { "name": "trees", "spacing": 2, "seed": 1, "attributes": ["angle"] },
                    { "name": "rocks", "spacing": 1, "seed": 2, "clear_of": { "trees": 0.8 } },
                ],
                "format": "csv",
            });
            Operation {
                id: "queryPoints",
                summary: "The points of any region, in layers",
                about: "The same as GET /v1/points, with regions of all kinds and several layers at once, \
                        streamed one after another in one answer.",
                example: format!("/v1/points:query -d '{example}'"),
                body: Some(api::Body::json(schemas::of::<PointsQuery>, example)),
                ..operation
            }
        }
        Dimension::Space => {
            let region = json!({ "ball": { "center": [5, 5, 5], "radius": 2 } });
            let example = json!({ "region": region, "spacing": 1, "format": "csv" });
            Operation {
                id: "querySpacePoints",
                summary: "The points of any volume, in layers",
                about: "The same as GET, with volumes of all kinds and several layers at once, streamed one after \
                        another in one answer.",
                example: format!("/v1/space/points -d '{example}'"),
                body: Some(api::Body::json(schemas::of::<SpaceQuery>, example)),
                ..operation
            }
        }
    }
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
pub(super) const COLUMN: Parameter = cell("cx", "The column of the chunk.", "-3");
pub(super) const ROW: Parameter = cell("cy", "The row of the chunk.", "2");
const LEVEL: Parameter = cell("cz", "The level of the chunk.", "0");

const fn cell(name: &'static str, about: &'static str, example: &'static str) -> Parameter {
    Parameter {
        name,
        about,
        shape: CELLS,
        example,
        is_required: true,
        ..Parameter::PLAIN
    }
}

fn chunk(service: &Arc<Service>, dimension: Dimension) -> Endpoint {
    let operation = Operation {
        problems: answer::problems(),
        ..Operation::new(Tag::of(dimension), answer::described().or_unchanged())
    };
    let (path, operation) = match dimension {
        Dimension::Plane => (
            "/v1/chunks/{size}/{cx}/{cy}",
            Operation {
                id: "getChunk",
                summary: "The points of a chunk",
                about: "A chunk is a square of the world grid: size·cx ≤ x < size·(cx + 1), and so for y. \
                        Coordinates are relative to its corner, so that f32 is exact enough at any \
                        distance. Neighbors share no point and lose none.",
                path_parameters: &[&SIZE, &COLUMN, &ROW],
                parameters: groups::CHUNK,
                example: "'/v1/chunks/64/-3/2?spacing=16&format=csv'".into(),
                ..operation
            },
        ),
        Dimension::Space => (
            "/v1/space/chunks/{size}/{cx}/{cy}/{cz}",
            Operation {
                id: "getSpaceChunk",
                summary: "The points of a chunk of space",
                about: "A chunk is a cube of the world grid: size·cx ≤ x < size·(cx + 1), and so for y and z. \
                        Coordinates are relative to its corner. Neighbors share no point and lose none.",
                path_parameters: &[&SIZE, &COLUMN, &ROW, &LEVEL],
                parameters: groups::SPACE_QUERY,
                example: "'/v1/space/chunks/16/-3/2/0?spacing=8&format=csv'".into(),
                ..operation
            },
        ),
    };
    let parameters = operation.parameters;
    let get = move |State(service): State<Arc<Service>>, context: Context| async move {
        let region = match dimension {
            Dimension::Plane => square(context.path()),
            Dimension::Space => cube(context.path()),
        };
        let draft = Draft::new(context.values(parameters)).within(region);
        stream(&service, &context, &draft).await
    };
    Endpoint::only(path, service.clone(), operation, get)
}

/// The chunk of a path.
pub(super) fn square([size, x, y]: [&str; 3]) -> Checked<RegionDraft> {
    let address = (SIZE.read(size), COLUMN.read(x), ROW.read(y));
    address.together().map(|(size, x, y)| RegionDraft {
        path: "chunk".into(),
        shape: ShapeDraft::Chunk(size, [x, y]),
    })
}

/// The chunk of a path, in space.
fn cube([size, x, y, z]: [&str; 4]) -> Checked<RegionDraft> {
    let address = (SIZE.read(size), COLUMN.read(x), ROW.read(y), LEVEL.read(z));
    address.together().map(|(size, x, y, z)| RegionDraft {
        path: "chunk".into(),
        shape: ShapeDraft::Cube(size, [x, y, z]),
    })
}
