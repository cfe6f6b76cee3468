//! Bodies of requests: read whole, up to a limit, whatever their content type; gzip is unpacked.
//!
//! The content type is not looked at: a body is read as JSON anyway, and `curl -d` calls everything
//! a form.

use std::sync::Arc;

use bytes::Bytes;
use futures_util::StreamExt as _;
use http::{HeaderMap, header};
use strew_core::server::Stop;
use strew_error::{Error, Fault};
use strew_query::{Draft, Group, Options, Query, read_body};
use strew_service::{Service, segments::Segments, unpack::Coding};

use crate::body::Body;

/// Reads a whole body.
pub(super) async fn whole(
    service: &Arc<Service>,
    headers: &HeaderMap,
    body: Body,
) -> Result<Bytes, Error> {
    let limit = service.limits().max_body_bytes;
    let is_packed = is_packed(headers)?;
    let length = headers.get(header::CONTENT_LENGTH);
    let length = length.and_then(|length| length.to_str().ok()?.parse::<u64>().ok());
    // A body that announces that it is too long need not even be sent.
    if length.is_some_and(|length| usize::try_from(length).is_ok_and(|length| length > limit)) {
        return Err(Error::BodyTooLarge { limit });
    }
    let mut pieces = body.into_data_stream();
    let mut segments = Segments::default();
    while let Some(piece) = pieces.next().await {
        let piece = piece.map_err(|error| why(&error))?;
        if segments.len() + piece.len() > limit {
            return Err(Error::BodyTooLarge { limit });
        }
        segments.append(&piece);
    }
    let bytes = segments.joined();
    match is_packed {
        true => service.unpacked(Coding::Gzip, bytes, "body").await,
        false => Ok(bytes),
    }
}

/// Whether a body is gzip.
fn is_packed(headers: &HeaderMap) -> Result<bool, Error> {
    let lines = headers.get_all(header::CONTENT_ENCODING).iter();
    let names: Vec<String> = lines
        .flat_map(|line| line.as_bytes().split(|&byte| byte == b','))
        .map(|name| String::from_utf8_lossy(name).trim().to_ascii_lowercase())
        .filter(|name| name != "identity")
        .collect();
    match names.as_slice() {
        [] => Ok(false),
        [name] if name == "gzip" || name == "x-gzip" => Ok(true),
        _ => {
            let coding = names.join(", ").chars().take(60).collect();
            Err(Error::UnknownCoding { coding })
        }
    }
}

/// The bytes of memory that reading takes for each of a body.
pub(super) const COPIES: usize = 4;

/// The query of a body, read and checked: on the workers if it is long.
pub(super) async fn query(
    service: &Arc<Service>,
    body: Bytes,
    groups: &'static [Group],
) -> Result<(Draft, Box<Query>, Options), Error> {
    let (bytes, budget) = (body.len(), service.own_budget());
    let read = move || {
        let _held = budget.hold(COPIES * body.len())?;
        Ok(read_body(&body, groups)?)
    };
    let check = |service: &Service, draft: Draft, stop: &Stop| {
        let (query, options) = service.check(&draft, stop)?;
        Ok((draft, query, options))
    };
    service.read(bytes, read, Draft::price, check).await
}

/// Why a body broke off: as the gate says, or because the client stopped.
fn why(error: &(dyn std::error::Error + 'static)) -> Error {
    let mut cause = Some(error);
    while let Some(inner) = cause {
        if let Some(error) = inner.downcast_ref::<Error>() {
            return error.clone();
        }
        cause = inner.source();
    }
    let detail = "broke off before its end";
    Fault::new("body", "", detail, "a whole body").into()
}
