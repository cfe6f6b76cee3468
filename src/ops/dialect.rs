//! The protocol that a client speaks, and how refusals and broken answers are said in it.

use bytes::Bytes;
use http::{HeaderMap, header};
use http_body::Frame;
use strew_error::{Error, Fault};
use strew_service::Interrupted;

use super::metrics::{Broken, Protocol};
use crate::{
    body::{BoxError, Response},
    grpc,
    rest::Refused,
};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Dialect {
    /// Everything that is not a call.
    Rest,
    Grpc,
    /// gRPC-Web, whose trailers are a part of the body.
    GrpcWeb,
    GrpcWebText,
}

/// Why an answer ends before it is complete.
#[derive(Clone, Copy, Debug)]
pub(super) enum Ending {
    Interrupted(Interrupted),
    Deadline(grpc::Deadline),
}

impl Ending {
    fn trailers(self) -> Option<HeaderMap> {
        match self {
            Self::Interrupted(why) => grpc::interrupted(why),
            Self::Deadline(deadline) => deadline.trailers(),
        }
    }

    pub(super) fn code(self) -> Option<u32> {
        self.trailers().as_ref().and_then(grpc_code)
    }

    /// The side that wants no more.
    pub(super) const fn by(self) -> Broken {
        match self {
            Self::Interrupted(_) => Broken::Server,
            Self::Deadline(_) => Broken::Client,
        }
    }
}

pub(super) fn grpc_code(headers: &HeaderMap) -> Option<u32> {
    headers.get(grpc::GRPC_STATUS)?.to_str().ok()?.parse().ok()
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

    pub(super) const fn is_call(self) -> bool {
        !matches!(self, Self::Rest)
    }

    pub(super) const fn protocol(self) -> Protocol {
        match self {
            Self::Rest => Protocol::Rest,
            _ => Protocol::Grpc,
        }
    }

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
            grpc::status(&error).into()
        } else {
            Box::new(error)
        }
    }

    /// The error of a body that cannot be read to its end, in the place of the rest.
    pub(super) fn unreadable(self, error: BoxError) -> BoxError {
        match self {
            Self::Rest => error,
            Self::Grpc => grpc::left().into(),
            // Of these the library says that it failed itself.
            Self::GrpcWeb | Self::GrpcWebText => {
                let detail = "it broke off, or is not framed as the content type says";
                let error = Fault::new("body", "", detail, "gRPC-Web, in Base64 as text").into();
                self.broken(error)
            }
        }
    }

    /// The last frame of an answer that is not complete. Calls end with a status, others with an
    /// error, which the client sees as a broken connection or stream.
    pub(super) fn ending(self, why: Ending) -> Option<Result<Frame<Bytes>, BoxError>> {
        if let (Ending::Interrupted(why), false) = (why, self.is_call()) {
            return Some(Err(why.into()));
        }
        let trailers = why.trailers()?;
        Some(Ok(match self {
            Self::GrpcWeb => Frame::data(grpc::web_trailers(&trailers, false)),
            Self::GrpcWebText => Frame::data(grpc::web_trailers(&trailers, true)),
            Self::Rest | Self::Grpc => Frame::trailers(trailers),
        }))
    }
}
