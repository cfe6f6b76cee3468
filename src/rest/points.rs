//! The points of regions, streamed: of an address, of a body, of a chunk of the world grid; in the plane and in space.

use std::sync::Arc;

use axum::extract::State;

use serde_json::json;
use strew_catalog::Dimension;
use strew_core::server::Stop;
use strew_error::{Checked, Together as _};
use strew_query::{Draft, Group, Parameter, RegionDraft, Shape, ShapeDraft, groups};
use strew_service::Service;

use super::{
    answer,
    api::{
        Endpoint, Operation, Tag, either,
        schemas::{self, PointsQuery, SpaceQuery},
    },
    context::{Answered, Context, Sent, Shared, query_of_body},
};
use crate::rest::Refused;

pub(super) fn endpoints(service: &Arc<Service>, dimension: Dimension) -> Vec<Endpoint> {
    let parameters = either(dimension, [groups::POINTS, groups::SPACE_POINTS]);
    let members = either(dimension, [groups::QUERY, groups::SPACE_QUERY]);
    let get = move |State(service): Shared, context: Context| async move {
        let draft = Draft::of(context.values(parameters));
        stream(&service, &context, &draft).await
    };
    let post = move |State(service): Shared, Sent { context, body }: Sent| async move {
        let (_, query, options) = query_of_body(&service, body, members).await?;
        Ok::<_, Refused>(answer::stream(&service, &context, query, options).await?)
    };
    let given = Endpoint::only(
        either(dimension, ["/v1/points", "/v1/space/points"]),
        service.clone(),
        given(dimension, parameters),
        get,
    );
    let posted = posted(dimension);
    let service = service.clone();
    let chunk = chunk(&service, dimension);
    match dimension {
        Dimension::Plane => {
            let post = Endpoint::only("/v1/points:query", service, posted, post);
            vec![given, post, chunk]
        }
        Dimension::Space => vec![given.with(service, posted, post), chunk],
    }
}

pub(super) async fn stream(service: &Service, context: &Context, draft: &Draft) -> Answered {
    let (query, options) = service.check(draft, &Stop::NEVER)?;
    Ok(answer::stream(service, context, query, options).await?)
}

fn given(dimension: Dimension, parameters: &'static [Group]) -> Operation {
    let about = [
        "Streams every point of a half-open box, a circle or a polygon, in a fixed order. The exact count is in the \
         header strew-count before any point is made.",
        "Streams every point of a half-open box or a ball, in a fixed order. Ids are x:y:z. With png the points are \
         seen along z, as a slab.",
    ];
    let example = [
        "'/v1/points?bbox=0,0,3,2&spacing=1&format=csv'",
        "'/v1/space/points?bbox=0,0,0,2,2,1&spacing=1&format=csv'",
    ];
    Operation {
        id: either(dimension, ["getPoints", "getSpacePoints"]),
        summary: either(
            dimension,
            ["The points of a region", "The points of a volume"],
        ),
        about: either(dimension, about),
        parameters,
        problems: answer::problems(),
        example: either(dimension, example).into(),
        ..Operation::new(Tag::of(dimension), answer::described().or_unchanged())
    }
}

fn posted(dimension: Dimension) -> Operation {
    let operation = Operation {
        problems: answer::problems(),
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
                ..operation.posted("/v1/points:query", schemas::of::<PointsQuery>, example)
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
                ..operation.posted("/v1/space/points", schemas::of::<SpaceQuery>, example)
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
    const AT: [&[&Parameter]; 2] = [&[&SIZE, &COLUMN, &ROW], &[&SIZE, &COLUMN, &ROW, &LEVEL]];
    let path = [
        "/v1/chunks/{size}/{cx}/{cy}",
        "/v1/space/chunks/{size}/{cx}/{cy}/{cz}",
    ];
    let summary = ["The points of a chunk", "The points of a chunk of space"];
    let about = [
        "A chunk is a square of the world grid: size·cx ≤ x < size·(cx + 1), and so for y. Coordinates are relative \
         to its corner, so that f32 is exact enough at any distance. Neighbors share no point and lose none.",
        "A chunk is a cube of the world grid: size·cx ≤ x < size·(cx + 1), and so for y and z. Coordinates are \
         relative to its corner. Neighbors share no point and lose none.",
    ];
    let example = [
        "'/v1/chunks/64/-3/2?spacing=16&format=csv'",
        "'/v1/space/chunks/16/-3/2/0?spacing=8&format=csv'",
    ];
    let parameters = either(dimension, [groups::CHUNK, groups::SPACE_QUERY]);
    let operation = Operation {
        id: either(dimension, ["getChunk", "getSpaceChunk"]),
        summary: either(dimension, summary),
        about: either(dimension, about),
        path_parameters: either(dimension, AT),
        parameters,
        problems: answer::problems(),
        example: either(dimension, example).into(),
        ..Operation::new(Tag::of(dimension), answer::described().or_unchanged())
    };
    let get = move |State(service): Shared, context: Context| async move {
        let region = match dimension {
            Dimension::Plane => square(context.path()),
            Dimension::Space => cube(context.path()),
        };
        let draft = Draft::new(context.values(parameters)).within(region);
        stream(&service, &context, &draft).await
    };
    Endpoint::only(either(dimension, path), service.clone(), operation, get)
}

pub(super) fn square([size, x, y]: [&str; 3]) -> Checked<RegionDraft> {
    let address = (SIZE.read(size), COLUMN.read(x), ROW.read(y));
    address.together().map(|(size, x, y)| RegionDraft {
        path: "chunk".into(),
        shape: ShapeDraft::Chunk(size, [x, y]),
    })
}

fn cube([size, x, y, z]: [&str; 4]) -> Checked<RegionDraft> {
    let address = (SIZE.read(size), COLUMN.read(x), ROW.read(y), LEVEL.read(z));
    address.together().map(|(size, x, y, z)| RegionDraft {
        path: "chunk".into(),
        shape: ShapeDraft::Cube(size, [x, y, z]),
    })
}
