//! The protocol that a client speaks, and how refusals and broken answers are said in it.

use bytes::Bytes;
use http::{HeaderMap, header};
use http_body::Frame;
use strew_error::Error;
use strew_service::Interrupted;

use super::metrics::Protocol;
use crate::{
    body::{BoxError, Response},
    grpc,
    rest::Refused,
};

/// The protocol of a request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Dialect {
    /// Everything that is not a call.
    Rest,
    /// gRPC.
    Grpc,
    /// gRPC-Web, whose trailers are a part of the body.
    GrpcWeb,
    /// gRPC-Web in Base64.
    GrpcWebText,
}

/// Why an answer ends before it is complete.
#[derive(Clone, Copy, Debug)]
pub(super) enum Ending {
    /// The daemon breaks it off.
    Interrupted(Interrupted),
    /// The deadline of the client is over.
    Deadline(grpc::Deadline),
}

impl Dialect {
    /// The protocol of a request with these headers: calls have content types of their own.
    pub(super) fn of(headers: &HeaderMap) -> Self {
        let content_type = headers.get(header::CONTENT_TYPE);
        let content_type = content_type.map_or(&b""[..], |value| value.as_bytes());
        if !content_type.starts_with(b"application/grpc") {
            Self::Rest
        } else if content_type.starts_with(b"application/grpc-web-text") {
            Self::GrpcWebText
        } else if content_type.starts_with(b"application/grpc-web") {
            Self::GrpcWeb
        } else {
            Self::Grpc
        }
    }

    /// Whether it is a call.
    pub(super) const fn is_call(self) -> bool {
        !matches!(self, Self::Rest)
    }

    /// The protocol as metrics and logs name it.
    pub(super) const fn protocol(self) -> Protocol {
        match self {
            Self::Rest => Protocol::Rest,
            _ => Protocol::Grpc,
        }
    }

    /// An error as a whole answer.
    pub(super) fn refusal(self, error: &Error) -> Response {
        if self.is_call() {
            grpc::refusal(error)
        } else {
            Refused(error.clone()).response()
        }
    }

    /// An error as the reader of the request's body finds it, in the place of the rest.
    pub(super) fn broken(self, error: Error) -> BoxError {
        if self.is_call() {
            grpc::broken(&error).into()
        } else {
            Box::new(error)
        }
    }

    /// The last frame of an answer that is not complete. Calls end with a status, others with an
    /// error, which the client sees as a broken connection or stream.
    pub(super) fn ending(self, why: Ending) -> Option<Result<Frame<Bytes>, BoxError>> {
        let trailers = match why {
            Ending::Interrupted(why) if !self.is_call() => {
                return Some(Err(why.into()));
            }
            Ending::Interrupted(why) => grpc::interrupted(why),
            Ending::Deadline(deadline) => deadline.trailers(),
        }?;
        Some(Ok(match self {
            Self::GrpcWeb => Frame::data(grpc::web_trailers(&trailers, false)),
            Self::GrpcWebText => Frame::data(grpc::web_trailers(&trailers, true)),
            Self::Rest | Self::Grpc => Frame::trailers(trailers),
        }))
    }
}
