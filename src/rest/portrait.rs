//! `GET /v1/profiles/{name}` and `…/spectrum.svg`: one table with its curves and its picture.

use std::sync::Arc;

use axum::{
    body::Body,
    extract::{Path, State},
    response::Response,
    routing,
};
use http::{HeaderMap, HeaderValue, Method, Uri, header};
use serde::Serialize;
use serde_json::{Value, json};
use strew_forge::Aim;

use super::{
    api::{self, Endpoint, Operation, schemas},
    freshness::Freshness,
    profiles::{self, Profile},
};
use crate::service::{
    Entry, Error, Kind, Service,
    query::{Parameter, Shape, parse_pairs},
};

/// The path of the curves.
pub(super) fn endpoint(service: Arc<Service>) -> Endpoint {
    let numbers = |most: u32| {
        let number = json!({ "type": "number" });
        let row = json!({ "type": "array", "items": number, "minItems": most, "maxItems": most });
        schemas::object(json!({
            "columns": { "type": "array", "items": { "type": "string" } },
            "values": { "type": "array", "items": row },
        }))
    };
    let measured = json!({
        "points": { "type": "integer" },
        "radial": numbers(3),
        "rdf": numbers(2),
    });
    let document = json!({
        "table": profiles::schema(),
        "target": target_schema(numbers(2)),
        "measured": schemas::object(measured),
    });
    let operation = operation(
        "getProfile",
        "One noise profile with its curves",
        "The table's provenance and figures; what it was made to be, with the radial power curve it \
         follows if it follows one; radial power, anisotropy and radial distribution of a window of \
         the unbounded pattern.",
        ("application/json", schemas::object(document)),
        "'/v1/profiles/blue?alpha=sqrt(3)'",
    );
    Endpoint::new(
        "/v1/profiles/{name}",
        service,
        vec![(operation, routing::get(get))],
    )
}

/// The JSON Schema of a table's target.
fn target_schema(mut curve: Value) -> Value {
    curve["type"] = json!(["object", "null"]);
    let (text, number) = (json!({ "type": "string" }), json!({ "type": "number" }));
    let side = json!({ "type": "string", "enum": ["at most", "at least"] });
    let bound = schemas::object(json!({ "figure": text, "side": side, "limit": number }));
    let mut target = schemas::object(json!({
        "statement": text,
        "bounds": { "type": "array", "items": bound },
        "curve": curve,
    }));
    target["type"] = json!(["object", "null"]);
    target
}

/// The path of the picture.
pub(super) fn picture(service: Arc<Service>) -> Endpoint {
    let operation = operation(
        "getSpectrum",
        "A picture of one noise profile",
        "Points, radial power, anisotropy and radial distribution.",
        ("image/svg+xml", json!({ "type": "string" })),
        "/v1/profiles/blue/spectrum.svg -o spectrum.svg",
    );
    Endpoint::new(
        "/v1/profiles/{name}/spectrum.svg",
        service,
        vec![(operation, routing::get(svg))],
    )
}

const NAME: &[Parameter] = &[Parameter {
    name: "name",
    about: "The noise profile. The list of profiles says what is loaded.",
    allowed: "the name of a profile that is loaded",
    shape: Shape::Text,
    default: None,
    example: "blue",
}];

fn operation(
    id: &'static str,
    summary: &'static str,
    about: &'static str,
    (content_type, schema): (&str, Value),
    example: &str,
) -> Operation {
    Operation {
        method: Method::GET,
        id,
        summary,
        about,
        path_parameters: NAME,
        parameters: api::given(&[], &["alpha", "map", "table"]),
        body: None,
        answers: vec![
            api::Answer {
                status: 200,
                about: summary,
                headers: vec![],
                contents: vec![(content_type.into(), schema)],
            },
            api::Answer::unchanged(),
        ],
        problems: vec![Kind::Invalid, Kind::NoSuchPath, Kind::OtherTable],
        example: example.into(),
    }
}

/// The table of a profile with its measured curves.
async fn get(
    State(service): State<Arc<Service>>,
    Path(name): Path<String>,
    uri: Uri,
    headers: HeaderMap,
) -> Result<Response, Error> {
    let (entry, freshness) = asked(&service, &name, &uri, &headers, "application/json")?;
    if let Some(unchanged) = freshness.unchanged(&headers) {
        return Ok(unchanged);
    }
    let portrait = service.portrait(&entry).await?;
    if let Some(unwanted) = freshness.unwanted(&headers) {
        return Ok(unwanted);
    }
    let aim = entry.aim();
    let document = Document {
        table: Profile::new(&entry),
        target: aim.as_ref().map(Target::new),
        measured: Measured {
            points: portrait.points,
            radial: Curve {
                columns: ["nu", "power", "anisotropy_db"],
                values: &portrait.radial,
            },
            rdf: Curve {
                columns: ["distance", "g"],
                values: &portrait.rdf,
            },
        },
    };
    let mut body = serde_json::to_vec(&document)
        .map_err(|_| Error::Internal("the profile cannot be written"))?;
    body.push(b'\n');
    Ok(typed(body, "application/json", &freshness))
}

/// The picture.
async fn svg(
    State(service): State<Arc<Service>>,
    Path(name): Path<String>,
    uri: Uri,
    headers: HeaderMap,
) -> Result<Response, Error> {
    let (entry, freshness) = asked(&service, &name, &uri, &headers, "image/svg+xml")?;
    if let Some(unchanged) = freshness.unchanged(&headers) {
        return Ok(unchanged);
    }
    let portrait = service.portrait(&entry).await?;
    if let Some(unwanted) = freshness.unwanted(&headers) {
        return Ok(unwanted);
    }
    let picture = portrait.svg.clone().into_bytes();
    Ok(typed(picture, "image/svg+xml", &freshness))
}

/// The table that is asked for, and how fresh what is made of it is.
fn asked(
    service: &Service,
    name: &str,
    uri: &Uri,
    headers: &HeaderMap,
    content_type: &'static str,
) -> Result<(Arc<Entry>, Freshness), Error> {
    let catalog = service.catalog();
    if catalog.alphas(name).is_empty() {
        return Err(Error::NoSuchPath {
            path: uri.path().into(),
            available: catalog
                .profiles()
                .iter()
                .map(|profile| format!("/v1/profiles/{profile}"))
                .collect::<Vec<_>>()
                .join(", "),
        });
    }
    let (parameters, faults) = parse_pairs(uri.query().unwrap_or_default());
    let entry = parameters.entry(&catalog, name, faults)?;
    let freshness = Freshness::of(uri, headers, content_type, &entry.digest);
    Ok((entry, freshness.pinned(parameters.get("table").is_some())))
}

fn typed(body: Vec<u8>, content_type: &'static str, freshness: &Freshness) -> Response {
    let mut response = Response::new(Body::from(body));
    let value = HeaderValue::from_static(content_type);
    response.headers_mut().insert(header::CONTENT_TYPE, value);
    freshness.stamp(&mut response);
    response
}

#[derive(Serialize)]
struct Document<'a> {
    table: Profile<'a>,
    /// `null` for a table that does not tell what it was made to be.
    target: Option<Target<'a>>,
    measured: Measured<'a>,
}

/// What a table was made to be.
#[derive(Serialize)]
struct Target<'a> {
    statement: &'a str,
    bounds: Vec<Limit>,
    curve: Option<Curve<'a, 2>>,
}

/// A bound on a figure.
#[derive(Serialize)]
struct Limit {
    figure: &'static str,
    side: String,
    limit: f64,
}

impl<'a> Target<'a> {
    fn new(aim: &'a Aim) -> Self {
        let bounds = aim.bounds.iter().map(|bound| Limit {
            figure: bound.figure.name(),
            side: bound.side.to_string(),
            limit: bound.limit,
        });
        Self {
            statement: &aim.statement,
            bounds: bounds.collect(),
            curve: aim.curve.as_ref().map(|curve| Curve {
                columns: ["nu", "power"],
                values: curve.points(),
            }),
        }
    }
}

/// What was measured on a window of the unbounded pattern.
#[derive(Serialize)]
struct Measured<'a> {
    points: u64,
    radial: Curve<'a, 3>,
    rdf: Curve<'a, 2>,
}

#[derive(Serialize)]
struct Curve<'a, const N: usize>
where
    [f64; N]: Serialize,
    [&'static str; N]: Serialize,
{
    columns: [&'static str; N],
    values: &'a [[f64; N]],
}
