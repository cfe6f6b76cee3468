//! `GET /v1/profiles`: what is loaded.

use std::sync::Arc;

use axum::{body::Body, extract::State, response::Response, routing};
use http::{HeaderMap, HeaderValue, Method, Uri, header};
use serde::{Serialize, Serializer, ser::SerializeMap as _};
use serde_json::{Value, json};
use strew_core::{ALGORITHM_VERSION, table};

use super::{
    api::{self, Endpoint, Operation, schemas},
    freshness::Freshness,
};
use crate::service::{Entry, Error, Fault, Kind, Service};

/// The path.
pub(super) fn endpoint(service: Arc<Service>) -> Endpoint {
    let document = json!({
        "algorithm": { "type": "integer" },
        "profiles": { "type": "array", "items": schema() },
    });
    let operation = Operation {
        method: Method::GET,
        id: "listProfiles",
        summary: "The noise profiles that are loaded",
        about: "Every table with its provenance and its measured figures.",
        path_parameters: &[],
        parameters: vec![],
        body: None,
        answers: vec![
            api::Answer {
                status: 200,
                about: "The list, sorted by profile, then alpha.",
                headers: vec![],
                contents: vec![("application/json".into(), schemas::object(document))],
            },
            api::Answer::unchanged(),
        ],
        problems: vec![Kind::Invalid],
        example: "/v1/profiles".into(),
    };
    Endpoint::new(
        "/v1/profiles",
        service,
        vec![(operation, routing::get(get))],
    )
}

/// The JSON Schema of a table's description.
pub(super) fn schema() -> Value {
    let (text, number) = (json!({ "type": "string" }), json!({ "type": "integer" }));
    let figures = json!({
        "subject": text,
        "seen": { "type": "boolean" },
        "points": number,
        "values": { "type": "object", "additionalProperties": { "type": "number" } },
    });
    let provenance = json!({
        "optimizer": text,
        "parameters": { "type": "object", "additionalProperties": text },
        "seed": number,
        "twins": { "type": "array", "items": text },
        "figures": { "type": "array", "items": schemas::object(figures) },
    });
    schemas::object(json!({
        "profile": text,
        "alpha": text,
        "map": text,
        "radius": number,
        "intervals": number,
        "blocks": number,
        "bytes": number,
        "digest": schemas::reference("Digest"),
        "provenance": schemas::object(provenance),
    }))
}

/// Lists the tables.
async fn get(
    State(service): State<Arc<Service>>,
    uri: Uri,
    headers: HeaderMap,
) -> Result<Response, Error> {
    if let Some(text) = uri.query().filter(|text| !text.is_empty()) {
        let detail = "this list takes no parameters";
        return Err(Error::Invalid(vec![Fault::new(
            "query", text, detail, "none",
        )]));
    }
    let catalog = service.catalog();
    let made_of: Vec<&str> = (catalog.entries())
        .map(|entry| entry.digest.as_str())
        .collect();
    let freshness = Freshness::of(&uri, &headers, "application/json", &made_of);
    let unchanged = freshness.unchanged(&headers);
    if let Some(unchanged) = unchanged.or_else(|| freshness.unwanted(&headers)) {
        return Ok(unchanged);
    }
    let document = Profiles {
        algorithm: ALGORITHM_VERSION,
        profiles: catalog.entries().map(|entry| Profile::new(entry)).collect(),
    };
    let mut body = serde_json::to_vec(&document)
        .map_err(|_| Error::Internal("the list of profiles cannot be written"))?;
    body.push(b'\n');
    let mut response = Response::new(Body::from(body));
    let json = HeaderValue::from_static("application/json");
    response.headers_mut().insert(header::CONTENT_TYPE, json);
    freshness.stamp(&mut response);
    Ok(response)
}

#[derive(Serialize)]
struct Profiles<'a> {
    algorithm: u32,
    profiles: Vec<Profile<'a>>,
}

/// A table.
#[derive(Serialize)]
pub(super) struct Profile<'a> {
    profile: &'a str,
    alpha: String,
    map: String,
    radius: u32,
    intervals: usize,
    blocks: usize,
    bytes: usize,
    digest: &'a str,
    provenance: Provenance<'a>,
}

#[derive(Serialize)]
struct Provenance<'a> {
    optimizer: &'a str,
    #[serde(serialize_with = "as_map")]
    parameters: &'a [(String, String)],
    seed: u64,
    twins: Vec<String>,
    figures: Vec<Figures<'a>>,
}

#[derive(Serialize)]
struct Figures<'a> {
    subject: &'a str,
    seen: bool,
    points: u64,
    #[serde(serialize_with = "as_map")]
    values: &'a [(String, f64)],
}

impl<'a> Profile<'a> {
    pub(super) fn new(entry: &'a Entry) -> Self {
        Self {
            profile: &entry.key.profile,
            alpha: entry.key.alpha.to_string(),
            map: entry.key.size.to_string(),
            radius: entry.radius,
            intervals: entry.intervals,
            blocks: entry.blocks(),
            bytes: entry.bytes().len(),
            digest: &entry.digest,
            provenance: Provenance::new(&entry.provenance),
        }
    }
}

impl<'a> Provenance<'a> {
    fn new(of: &'a table::Provenance) -> Self {
        Self {
            optimizer: &of.optimizer,
            parameters: &of.parameters,
            seed: of.seed,
            twins: of
                .twins
                .iter()
                .map(|t| format!("{}/{}", t.p(), t.q()))
                .collect(),
            figures: of
                .figures
                .iter()
                .map(|figures| Figures {
                    subject: &figures.subject,
                    seen: figures.seen,
                    points: figures.points,
                    values: &figures.values,
                })
                .collect(),
        }
    }
}

/// Pairs as an object, in their order.
fn as_map<S: Serializer, T: Serialize>(
    pairs: &&[(String, T)],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    let mut map = serializer.serialize_map(Some(pairs.len()))?;
    for (name, value) in *pairs {
        map.serialize_entry(name, value)?;
    }
    map.end()
}
