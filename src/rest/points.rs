//! `GET /v1/points`: the points of a region, streamed.

use std::sync::Arc;

use axum::{body::Body, extract::State, response::Response, routing};
use http::{HeaderMap, HeaderName, HeaderValue, Method, Uri, header};
use serde_json::{Value, json};
use strew_core::ALGORITHM_VERSION;

use super::{
    api::{self, Endpoint, Operation, schemas},
    coding,
    freshness::Freshness,
    negotiate::{self, Chosen},
};
use crate::service::{
    Answer, Error, Kind, Planned, Service, encode::write_number, query::parse_pairs,
};

const COUNT: HeaderName = HeaderName::from_static("strew-count");
const TABLE: HeaderName = HeaderName::from_static("strew-table");
const ALGORITHM: HeaderName = HeaderName::from_static("strew-algorithm");
const ORIGIN: HeaderName = HeaderName::from_static("strew-origin");

/// The path.
pub(super) fn endpoint(service: Arc<Service>) -> Endpoint {
    let optional = [
        "density", "spacing", "profile", "alpha", "map", "seed", "warp", "table", "format",
        "decimals", "size",
    ];
    let operation = Operation {
        method: Method::GET,
        id: "getPoints",
        summary: "The points of a region",
        about: "Streams every point of a half-open box, in a fixed order. The exact count is in \
                the header strew-count before any point is made.",
        path_parameters: &[],
        parameters: api::given(&["bbox"], &optional),
        body: None,
        answers: vec![
            api::Answer {
                status: 200,
                about: "The points.",
                headers: HEADERS.into(),
                contents: contents(),
            },
            api::Answer::unchanged(),
        ],
        problems: vec![
            Kind::Invalid,
            Kind::NotAcceptable,
            Kind::OtherTable,
            Kind::TooManyPoints,
            Kind::Busy,
            Kind::ShuttingDown,
        ],
        example: "'/v1/points?bbox=0,0,3,2&spacing=1&format=csv'".into(),
    };
    Endpoint::new("/v1/points", service, vec![(operation, routing::get(get))])
}

/// The headers of an answer with points, and what they say.
pub(super) const HEADERS: [(&str, &str); 4] = [
    ("strew-count", "Exactly how many points follow."),
    ("strew-table", "The digest of the table that answers."),
    (
        "strew-algorithm",
        "The version of the algorithm that answers.",
    ),
    (
        "strew-origin",
        "With f32: the lower corner, which coordinates are relative to.",
    ),
];

/// The content types of points, with what they hold.
pub(super) fn contents() -> Vec<(String, Value)> {
    let schema = |content_type: &str| match content_type {
        "application/json" => schemas::reference("Points"),
        _ => json!({}),
    };
    negotiate::content_types()
        .into_iter()
        .map(|content_type| (content_type.into(), schema(content_type)))
        .collect()
}

/// Answers a query.
async fn get(
    State(service): State<Arc<Service>>,
    method: Method,
    uri: Uri,
    headers: HeaderMap,
) -> Result<Response, Error> {
    let (parameters, faults) = parse_pairs(uri.query().unwrap_or_default());
    let (query, options) = parameters.check(service.catalog(), faults)?;
    let chosen = match options.encoding {
        Some(encoding) => Chosen::named(encoding),
        None => negotiate::accepted(&headers)?,
    };
    let output = options.output(chosen.encoding)?;
    let entry = service.catalog().entry(&query.key());
    let digest = entry.as_ref().map(|entry| &entry.digest);
    let made_of = (query.resolved(), digest, service.limits().max_points);
    let freshness = Freshness::of(&uri, &headers, chosen.content_type, &made_of)
        .negotiated()
        .pinned(parameters.table.is_some());
    if let Some(unchanged) = freshness.unchanged(&headers) {
        return Ok(unchanged);
    }
    let is_head = method == Method::HEAD;
    let permit = (!is_head).then(|| service.streams().admit()).transpose()?;
    let planned = service.plan(query).await?;
    if let Some(unwanted) = freshness.unwanted(&headers) {
        return Ok(unwanted);
    }
    let answer = Answer::new(&planned, &output, service.limits().block_bytes)?;
    let mut response_headers = describe(&planned, &answer, chosen)?;
    let body = match permit {
        // Without a body there is nothing to stream, and HTTP wants to hear so at once.
        _ if answer.size() == Some(0) => Body::empty(),
        None => coding::unknown_length(),
        Some(permit) => Body::from_stream(service.blocks(permit, answer)),
    };
    let mut response = Response::new(body);
    std::mem::swap(response.headers_mut(), &mut response_headers);
    freshness.stamp(&mut response);
    Ok(response)
}

/// The headers of an answer.
fn describe(planned: &Planned, answer: &Answer, chosen: Chosen) -> Result<HeaderMap, Error> {
    let text = |text: &str| {
        HeaderValue::from_str(text).map_err(|_| Error::Internal("a header is not text"))
    };
    let count = u64::try_from(planned.count())
        .map_err(|_| Error::Internal("a count within the limit is too large"))?;
    let mut headers = HeaderMap::new();
    headers.insert(
        header::CONTENT_TYPE,
        HeaderValue::from_static(chosen.content_type),
    );
    headers.insert(COUNT, count.into());
    headers.insert(TABLE, text(&planned.entry.digest)?);
    headers.insert(ALGORITHM, ALGORITHM_VERSION.into());
    if let Some([x, y]) = answer.origin() {
        let mut origin = vec![];
        write_number(x, &mut origin);
        origin.push(b',');
        write_number(y, &mut origin);
        headers.insert(ORIGIN, text(&String::from_utf8_lossy(&origin))?);
    }
    if let Some(size) = answer.size() {
        headers.insert(header::CONTENT_LENGTH, size.into());
    }
    Ok(headers)
}
