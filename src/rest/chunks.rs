//! `GET /v1/chunks/{size}/{cx}/{cy}`: the points of a square of the world grid, relative to its
//! corner.

use std::{str::FromStr, sync::Arc};

use axum::{
    extract::{Path, State},
    response::Response,
    routing,
};
use http::{HeaderMap, Method, Uri};

use super::{
    answer::{self, Asked},
    api::{self, Endpoint, Operation},
};
use crate::access::Caller;
use crate::service::{
    Error, Fault, Service,
    query::{
        LOOKS_NAMES, Parameter, RegionDraft, SET_NAMES, Shape, ShapeDraft, WINDOW_NAMES,
        parse_pairs,
    },
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
        path_parameters: ADDRESS,
        parameters: api::given(&[], &[&SET_NAMES[..], &WINDOW_NAMES, &LOOKS_NAMES].concat()),
        body: None,
        answers: vec![answer::told(), api::Answer::unchanged()],
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

const CELL: &str = "an integer within ±4503599627370496";

const ADDRESS: &[Parameter] = &[
    Parameter {
        name: "size",
        about: "The side of a chunk in world units.",
        allowed: "a finite number above 0",
        shape: Shape::Number {
            min: f64::MIN_POSITIVE,
            max: f64::MAX,
        },
        default: None,
        example: "64",
    },
    Parameter {
        name: "cx",
        about: "The column of the chunk.",
        allowed: CELL,
        shape: Shape::Integer {
            min: -(1 << 52),
            max: 1 << 52,
        },
        default: None,
        example: "-3",
    },
    Parameter {
        name: "cy",
        about: "The row of the chunk.",
        allowed: CELL,
        shape: Shape::Integer {
            min: -(1 << 52),
            max: 1 << 52,
        },
        default: None,
        example: "2",
    },
];

async fn get(
    State(service): State<Arc<Service>>,
    caller: Caller,
    Path(address): Path<[String; 3]>,
    method: Method,
    uri: Uri,
    headers: HeaderMap,
) -> Result<Response, Error> {
    let (parameters, mut faults) = parse_pairs(uri.query().unwrap_or_default());
    let [size, cx, cy] = &address;
    let size = read::<f64>("size", size, "a finite number above 0", &mut faults);
    let at =
        [("cx", cx), ("cy", cy)].map(|(name, text)| read::<i64>(name, text, CELL, &mut faults));
    let shape = match (size, at) {
        (Some(size), [Some(x), Some(y)]) => ShapeDraft::Chunk(size, [x, y]),
        _ => return Err(Error::Invalid(faults)),
    };
    let region = RegionDraft {
        path: "chunk".into(),
        shape,
    };
    let most_vertices = service.limits().max_vertices;
    let (query, options) =
        parameters.check(&service.catalog(), most_vertices, Some(region), faults)?;
    let asked = Asked {
        caller,
        method,
        uri,
        headers,
    };
    answer::stream(&service, &asked, query, options).await
}

fn read<T: FromStr>(name: &str, text: &str, allowed: &str, faults: &mut Vec<Fault>) -> Option<T> {
    let value = text.parse().ok();
    if value.is_none() {
        faults.push(Fault::new(name, text, "it is not such a number", allowed));
    }
    value
}
