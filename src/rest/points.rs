//! `GET /v1/points`: the points of a region, streamed.

use std::sync::Arc;

use axum::{body::Body, extract::State, response::Response};
use http::{HeaderMap, HeaderName, HeaderValue, Uri, header};
use strew_core::ALGORITHM_VERSION;

use super::negotiate::{self, Chosen};
use crate::service::{Answer, Error, Planned, Service, encode::write_number, query::parse_pairs};

const COUNT: HeaderName = HeaderName::from_static("strew-count");
const TABLE: HeaderName = HeaderName::from_static("strew-table");
const ALGORITHM: HeaderName = HeaderName::from_static("strew-algorithm");
const ORIGIN: HeaderName = HeaderName::from_static("strew-origin");

/// Answers a query.
pub(super) async fn get(
    State(service): State<Arc<Service>>,
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
    let permit = service.streams().admit()?;
    let planned = service.plan(query).await?;
    let answer = Answer::new(&planned, &output, service.limits().block_bytes)?;
    let mut response_headers = describe(&planned, &answer, chosen)?;
    let body = match answer.size() {
        // Without a body there is nothing to stream, and HTTP wants to hear so at once.
        Some(0) => Body::empty(),
        _ => Body::from_stream(service.blocks(permit, answer)),
    };
    let mut response = Response::new(body);
    std::mem::swap(response.headers_mut(), &mut response_headers);
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
    headers.insert(header::VARY, HeaderValue::from_static("accept"));
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
