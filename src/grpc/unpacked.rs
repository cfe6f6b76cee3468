//! What stands before tonic's server: the message of a call is read whole, within the limit, and unpacked.
//!
//! tonic itself would reserve what the prefix of a message claims as its length, and would unpack on the thread that
//! serves the socket, outside of the budget of bytes. It also would compress for all who list gzip.

use std::{convert::Infallible, sync::Arc};

use bytes::Bytes;
use futures_util::stream::iter;
use http::{HeaderMap, HeaderName, HeaderValue};
use http_body_util::BodyExt as _;
use strew_error::Error;
use strew_service::{Service, segments::Segments, unpack::Coding};
use tonic::{Status, metadata::MetadataValue};

use super::{
    message::no_message,
    status::{self, status},
};
use crate::body::{Body, Request};

const ACCEPTED: HeaderName = HeaderName::from_static("grpc-accept-encoding");
const SENT: HeaderName = HeaderName::from_static("grpc-encoding");

/// The length of the prefix of a message on the wire: whether it is compressed, and its length.
const PREFIX: usize = 5;

/// A request whose message is whole, and not packed; refused if it is no message, too long, or packed in an unknown way.
pub(super) async fn unpacked(service: &Arc<Service>, request: Request) -> Result<Request, Status> {
    let (mut head, body) = request.into_parts();
    let sent = head.headers.remove(SENT);
    let coding = coding(sent.as_ref())?;
    if coding != Some(Coding::Gzip) {
        accept_on_purpose(&mut head.headers);
    }
    let frame = whole(body, service.limits().max_body_bytes).await?;
    let body = match (frame[0], coding) {
        (0, _) => frame.into(),
        (_, None) => {
            let detail = "it says that it is compressed, and the call does not say how";
            return Err(status(&no_message(detail)));
        }
        (_, Some(coding)) => {
            let packed = frame.slice(PREFIX..);
            let message = service.unpacked(coding, packed, "message").await;
            let message = message.map_err(|error| status(&error))?;
            let length = u32::try_from(message.len()).unwrap_or(u32::MAX);
            let prefix = [&[0], &length.to_be_bytes()[..]].concat();
            Body::from_stream(iter([Ok::<_, Infallible>(prefix.into()), Ok(message)]))
        }
    };
    Ok(Request::from_parts(head, body))
}

/// The one message of a body, with its prefix.
async fn whole(mut body: Body, most: usize) -> Result<Bytes, Status> {
    let refused = |error: Error| Err(status(&error));
    let mut all = Segments::default();
    let mut head = [0; PREFIX];
    let mut known = 0;
    let length = |head: [u8; PREFIX]| u32::from_be_bytes([head[1], head[2], head[3], head[4]]);
    while let Some(frame) = body.frame().await {
        let frame = frame.map_err(|error| Status::from_error(error.into_inner()))?;
        let Ok(piece) = frame.into_data() else {
            continue;
        };
        let first = piece.len().min(PREFIX - known);
        head[known..known + first].copy_from_slice(&piece[..first]);
        known += first;
        if known == PREFIX {
            if head[0] > 1 {
                return refused(no_message("its first byte is neither 0 nor 1"));
            }
            let length = length(head) as usize;
            if length > most {
                return refused(Error::BodyTooLarge { limit: most });
            }
            if all.len() + piece.len() > PREFIX + length {
                return refused(no_message("there are bytes after the end of the message"));
            }
        }
        all.append(&piece);
    }
    if known < PREFIX || all.len() < PREFIX + length(head) as usize {
        return refused(no_message("the call ends before its message"));
    }
    Ok(all.joined())
}

/// The coding of the messages of a call, if they have one.
fn coding(sent: Option<&HeaderValue>) -> Result<Option<Coding>, Status> {
    let unknown = match sent.map(HeaderValue::as_bytes) {
        None | Some(b"identity") => return Ok(None),
        Some(b"gzip") => return Ok(Some(Coding::Gzip)),
        Some(b"zstd") => return Ok(Some(Coding::Zstd)),
        Some(unknown) => status::cut(&String::from_utf8_lossy(unknown), 60),
    };
    let detail = format!("Content is compressed with `{unknown}` which isn't supported");
    let mut status = Status::unimplemented(detail);
    let known = MetadataValue::from_static("zstd,gzip,identity");
    status.metadata_mut().insert("grpc-accept-encoding", known);
    Err(status)
}

/// Many libraries list gzip as accepted in every call, whether their user wants it or not, and compressing a stream of
/// points costs more than making it. So gzip goes out to those who send gzip themselves, which is how libraries let a
/// user ask (`compression=Gzip`, `UseCompressor`), and zstd, which clients list only on purpose, to all that accept it.
fn accept_on_purpose(headers: &mut HeaderMap) {
    let Some(listed) = headers.get(ACCEPTED) else {
        return;
    };
    let is_zstd = |listed: &str| listed.split(',').any(|coding| coding.trim() == "zstd");
    match listed.to_str().is_ok_and(is_zstd) {
        true => headers.insert(ACCEPTED, HeaderValue::from_static("zstd")),
        false => headers.remove(ACCEPTED),
    };
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_what_is_listed_zstd_is_on_purpose() {
        for (accepted, expected) in [
            ("identity, deflate, gzip", None),
            ("gzip,zstd", Some("zstd")),
            ("zstd, gzip", Some("zstd")),
            ("", None),
        ] {
            let mut headers = HeaderMap::new();
            headers.insert(ACCEPTED, HeaderValue::from_static(accepted));
            accept_on_purpose(&mut headers);
            let left = headers.get(ACCEPTED).and_then(|left| left.to_str().ok());
            assert_eq!(left, expected, "{accepted}");
        }
    }
}
