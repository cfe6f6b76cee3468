//! Bodies of requests: read whole, up to a limit, whatever they are said to be.
//!
//! The content type is not looked at: a body is read as JSON anyway, and `curl -d` calls everything
//! a form.

use std::{error::Error as _, sync::Arc};

use axum::extract::{FromRequest, Request};
use bytes::Bytes;
use futures_util::StreamExt as _;
use http::header;
use strew_core::server::Stop;

use crate::service::{
    Draft, Error, Fault, Options, Query, Service,
    query::{Group, read_body},
};

/// A whole body.
#[derive(Debug)]
pub(super) struct Whole(pub(super) Bytes);

impl FromRequest<Arc<Service>> for Whole {
    type Rejection = Error;

    async fn from_request(request: Request, service: &Arc<Service>) -> Result<Self, Error> {
        let limit = service.limits().max_body_bytes;
        let length = request.headers().get(header::CONTENT_LENGTH);
        let length = length.and_then(|length| length.to_str().ok()?.parse::<u64>().ok());
        // What says that it is too long need not even be sent.
        if length.is_some_and(|length| usize::try_from(length).is_ok_and(|length| length > limit)) {
            return Err(Error::BodyTooLarge { limit });
        }
        let mut pieces = request.into_body().into_data_stream();
        let (mut length, mut segments) = (0, Segments::default());
        while let Some(piece) = pieces.next().await {
            let piece = piece.map_err(|error| why(&error))?;
            length += piece.len();
            if length > limit {
                return Err(Error::BodyTooLarge { limit });
            }
            segments.append(&piece);
        }
        Ok(Self(segments.joined()))
    }
}

/// What has come of a body. A vector that grows would leave behind as much memory as it takes, and
/// hundreds of bodies may arrive at once.
#[derive(Debug, Default)]
struct Segments(Vec<Vec<u8>>);

impl Segments {
    const SIZE: usize = 64 << 10;

    fn append(&mut self, mut piece: &[u8]) {
        while !piece.is_empty() {
            let last = self.0.last_mut();
            let Some(last) = last.filter(|last| last.len() < last.capacity()) else {
                // Most bodies come in one piece.
                let is_first = self.0.is_empty();
                let size = if is_first { piece.len() } else { Self::SIZE };
                self.0.push(Vec::with_capacity(size));
                continue;
            };
            let room = last.capacity() - last.len();
            let (now, later) = piece.split_at(piece.len().min(room));
            last.extend_from_slice(now);
            piece = later;
        }
    }

    fn joined(mut self) -> Bytes {
        let whole = match self.0.len() {
            1 => self.0.swap_remove(0),
            _ => self.0.concat(),
        };
        whole.into()
    }
}

/// The query that a body asks, as it was read and checked: on the workers if it is long.
pub(super) async fn query(
    service: &Arc<Service>,
    body: Bytes,
    groups: &'static [Group],
) -> Result<(Draft, Query, Options), Error> {
    let bytes = body.len();
    let read = move || Ok(read_body(&body, groups)?);
    let check = |service: &Service, draft: Draft, stop: &Stop| {
        let (query, options) = service.check(&draft, stop)?;
        Ok((draft, query, options))
    };
    service.read(bytes, read, Draft::price, check).await
}

/// Why a body broke off: as the gate says, or because the client stopped.
fn why(error: &axum::Error) -> Error {
    let mut cause = error.source();
    while let Some(inner) = cause {
        if let Some(error) = inner.downcast_ref::<Error>() {
            return error.clone();
        }
        cause = inner.source();
    }
    let detail = "broke off before its end";
    Fault::new("body", "", detail, "a whole body").into()
}
