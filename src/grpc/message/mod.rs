//! Messages of requests: read whole, looked at before they are decoded, decoded where their length belongs.
//!
//! tonic would unpack and decode a message on the thread that serves the socket, before any limit of a query is
//! looked at. So requests come to it with their message decoded already, beside an empty one that it decodes:
//! as answers pass by it in frames (`direct.rs`).

mod most;
mod walk;

use std::sync::Arc;

use bytes::Bytes;
use http::HeaderMap;
use http_body_util::{BodyExt as _, Full};
use parking_lot::Mutex;
use strew_core::server::Stop;
use strew_error::Error;
use strew_service::{Held, Service, segments::Segments, unpack::Coding};
use tonic::{Status, body::Body};

use super::{
    compression::SENT,
    frames::{PREFIX, prefix},
    status,
};
use walk::{Decoded, METHODS, Method, no_message};

/// Reading a byte of a picture may take as long as reading this many of text.
const PIXELS: usize = 1 << 10;
/// Besides the message: what it is checked as, and the query.
const COPIES: usize = 3;

/// A decoded message, which a request carries past tonic.
#[derive(Clone)]
struct Carried {
    message: Arc<Mutex<Option<Decoded>>>,
    effort: usize,
}

/// A request with its message.
pub(super) struct Received<T> {
    pub(super) message: Box<T>,
    /// As long as this many bytes of text it takes to check.
    pub(super) effort: usize,
}

/// The message that a request carries.
pub(super) fn received<T: 'static>(request: tonic::Request<T>) -> Received<T> {
    let (_, extensions, empty) = request.into_parts();
    let carried = extensions.get::<Carried>();
    let message = carried.and_then(|carried| {
        let mut message = carried.message.lock();
        message.take()?.downcast::<T>().ok()
    });
    Received {
        message: message.unwrap_or_else(|| empty.into()),
        effort: carried.map_or(0, |carried| carried.effort),
    }
}

/// Reads the message of a request, if it is to a method of the contract. What is held of the byte budget is
/// for the message.
pub(super) async fn read(
    service: &Arc<Service>,
    request: http::Request<Body>,
) -> Result<(http::Request<Body>, Option<Held>), Status> {
    let method = METHODS
        .iter()
        .find(|method| method.path == request.uri().path());
    let (Some(method), Some(coding)) = (method, coding(request.headers())) else {
        // tonic refuses it unread.
        return Ok((request, None));
    };
    let (mut parts, body) = request.into_parts();
    let most = service.limits().max_body_bytes;
    let refused = |error: Error| status::status(&error);
    let (is_packed, bytes) = whole(body, most).await?;
    let coding = match (is_packed, coding) {
        (true, None) => {
            let detail = "it says that it is compressed, and the call does not say how";
            return Err(refused(no_message(detail)));
        }
        (true, coding) => coding,
        (false, _) => None,
    };
    let message = decoded(service, method, coding, bytes).await;
    let Message {
        message,
        effort,
        held,
    } = message.map_err(refused)?;
    parts.extensions.insert(Carried {
        message: Arc::new(Mutex::new(Some(message))),
        effort,
    });
    let empty = Bytes::copy_from_slice(&prefix(0));
    let body = Body::new(Full::new(empty));
    Ok((http::Request::from_parts(parts, body), Some(held)))
}

/// The coding of the messages of a call, if they have one; nothing if it is unknown here.
fn coding(headers: &HeaderMap) -> Option<Option<Coding>> {
    match headers.get(SENT).map(|value| value.as_bytes()) {
        None | Some(b"identity") => Some(None),
        Some(b"gzip") => Some(Some(Coding::Gzip)),
        Some(b"zstd") => Some(Some(Coding::Zstd)),
        Some(_) => None,
    }
}

/// The one message of a body, and whether it is packed.
async fn whole(mut body: Body, most: usize) -> Result<(bool, Bytes), Status> {
    let refused = |error: Error| Err(status::status(&error));
    let mut all = Segments::default();
    let mut head = [0; PREFIX];
    let mut known = 0;
    let length = |head: [u8; PREFIX]| u32::from_be_bytes([head[1], head[2], head[3], head[4]]);
    while let Some(frame) = body.frame().await {
        let Ok(piece) = frame?.into_data() else {
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

/// A message, and what it takes.
struct Message {
    message: Decoded,
    effort: usize,
    held: Held,
}

/// Decodes a message: at once if it is short, else on the workers.
async fn decoded(
    service: &Arc<Service>,
    method: &'static Method,
    coding: Option<Coding>,
    bytes: Bytes,
) -> Result<Message, Error> {
    let bytes = match coding {
        Some(coding) => service.unpacked(coding, bytes, "message").await?,
        None => bytes,
    };
    let (length, held) = (bytes.len(), service.hold(0)?);
    let decode = move |service: &Service, _: &Stop| decode(service, method, &bytes, held);
    service.process(length, decode).await?
}

fn decode(
    service: &Service,
    method: &Method,
    bytes: &Bytes,
    mut held: Held,
) -> Result<Message, Error> {
    let cost = walk::cost(method.shape, bytes, service.limits())?;
    held.grow(COPIES * cost.memory)?;
    let message = (method.decode)(bytes.clone());
    let message = message.map_err(|error| no_message(&error.to_string()))?;
    Ok(Message {
        message,
        effort: bytes.len() + PIXELS * cost.pixels,
        held,
    })
}

#[cfg(test)]
mod tests;
