//! Messages of requests: read whole, looked at before they are decoded, decoded where their length belongs.

mod most;
mod walk;

use std::sync::Arc;

use bytes::Bytes;
use http_body_util::BodyExt as _;
use prost::DecodeError;
use strew_core::server::Stop;
use strew_error::Error;
use strew_service::access::Caller;
use strew_service::{Held, Service, charge_reading, segments::Segments};
use tonic::Status;

use super::{compression, frames::PREFIX, status};
use crate::body::{Body, Request};
use walk::no_message;

/// Reading a byte of a picture may take as long as reading this many of text.
const PIXELS: usize = 1 << 10;
/// Besides the message: what it is checked as, and the query.
const COPIES: usize = 3;

/// A request with its message.
pub(super) struct Received<T> {
    pub(super) message: Box<T>,
    /// As long as this many bytes of text it takes to check.
    pub(super) effort: usize,
}

/// Decodes a message.
type Decode<T> = fn(Bytes) -> Result<T, DecodeError>;

/// Reads the message of a request: decoded, as long as this many bytes of text it takes to check, and what is held of
/// the byte budget for it.
pub(super) async fn read<T: Send + 'static>(
    service: &Arc<Service>,
    caller: &Caller,
    (shape, decode): (usize, Decode<T>),
    request: Request,
) -> Result<(T, usize, Held), Status> {
    let coding = compression::sent(request.headers())?;
    let most = service.limits().max_body_bytes;
    let refused = |error: Error| status::status(&error);
    let (is_packed, bytes) = whole(request.into_body(), most).await?;
    let bytes = match (is_packed, coding) {
        (false, _) => bytes,
        (true, Some(coding)) => {
            let unpacked = service.unpacked(coding, bytes, "message").await;
            unpacked.map_err(refused)?
        }
        (true, None) => {
            let detail = "it says that it is compressed, and the call does not say how";
            return Err(refused(no_message(detail)));
        }
    };
    let length = bytes.len();
    charge_reading(caller, length).map_err(refused)?;
    let mut held = service.hold(0).map_err(refused)?;
    let decode = move |service: &Service, _: &Stop| {
        let cost = walk::cost(shape, &bytes, service.limits())?;
        held.grow(COPIES * cost.memory)?;
        let message = decode(bytes).map_err(|error| no_message(&error.to_string()))?;
        Ok((message, length + PIXELS * cost.pixels, held))
    };
    let decoded = service.process(length, decode).await;
    decoded.flatten().map_err(refused)
}

/// The one message of a body, and whether it is packed.
async fn whole(mut body: Body, most: usize) -> Result<(bool, Bytes), Status> {
    let refused = |error: Error| Err(status::status(&error));
    let mut all = Segments::default();
    let mut head = [0; PREFIX];
    let mut known = 0;
    let length = |head: [u8; PREFIX]| u32::from_be_bytes([head[1], head[2], head[3], head[4]]);
    while let Some(frame) = body.frame().await {
        let frame = frame.map_err(|error| Status::from_error(error.into_inner()))?;
        let Ok(piece) = frame.into_data() else {
            continue;
        };
        let (first, rest) = piece.split_at(piece.len().min(PREFIX - known));
        head[known..known + first.len()].copy_from_slice(first);
        known += first.len();
        if known < PREFIX {
            continue;
        }
        if head[0] > 1 {
            return refused(no_message("its first byte is neither 0 nor 1"));
        }
        let length = length(head) as usize;
        if length > most {
            return refused(Error::BodyTooLarge { limit: most });
        }
        if all.len() + rest.len() > length {
            return refused(no_message("there are bytes after the end of the message"));
        }
        all.append(rest);
    }
    if known < PREFIX || all.len() < length(head) as usize {
        return refused(no_message("the call ends before its message"));
    }
    Ok((head[0] == 1, all.joined()))
}

#[cfg(test)]
mod tests;
