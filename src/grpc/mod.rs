//! gRPC: messages in, streamed messages out. It decides nothing itself.

mod calls;
mod codec;
mod deadline;
mod documents;
mod field;
mod message;
mod messages;
mod points;
mod query;
mod region;
mod resolved;
mod server;
mod set;
mod status;
mod unpacked;

use std::sync::Arc;

use axum::Router;
use base64::{Engine as _, engine::general_purpose::STANDARD};
use bytes::Bytes;
use http::{HeaderMap, HeaderName, HeaderValue};
use tonic::Status;
use tonic_health::server::HealthReporter;

pub use calls::{Calls, route, unimplemented};
use calls::{NAME, contract, routed};
pub use deadline::Deadline;
pub use status::status;
use strew_error::Error;
pub use strew_proto as proto;
use strew_service::{Interrupted, Service};

use crate::body::{Body, Response};

/// The longest message to the services of health and reflection, which take names: those of files and of
/// symbols.
const NAMES: usize = 4 << 10;

/// The name of a code, as the protocol writes it.
pub const fn code_name(code: u32) -> &'static str {
    match code {
        0 => "OK",
        1 => "CANCELLED",
        3 => "INVALID_ARGUMENT",
        4 => "DEADLINE_EXCEEDED",
        5 => "NOT_FOUND",
        6 => "ALREADY_EXISTS",
        7 => "PERMISSION_DENIED",
        8 => "RESOURCE_EXHAUSTED",
        9 => "FAILED_PRECONDITION",
        10 => "ABORTED",
        11 => "OUT_OF_RANGE",
        12 => "UNIMPLEMENTED",
        13 => "INTERNAL",
        14 => "UNAVAILABLE",
        15 => "DATA_LOSS",
        16 => "UNAUTHENTICATED",
        _ => "UNKNOWN",
    }
}

/// Why the gRPC routes cannot be built: the contract's descriptors do not read.
pub type BuildError = tonic_reflection::server::Error;

/// The calls of gRPC, with reflection and health, and the handle that reports to health checks when the daemon stops.
pub async fn calls(service: Arc<Service>) -> Result<(Calls, Health), BuildError> {
    let (reporter, health) = tonic_health::server::health_reporter();
    let serving = tonic_health::ServingStatus::Serving;
    reporter.set_service_status(NAME, serving).await;
    let reflection = || {
        tonic_reflection::server::Builder::configure()
            .register_encoded_file_descriptor_set(proto::DESCRIPTORS)
            .register_encoded_file_descriptor_set(tonic_types::pb::FILE_DESCRIPTOR_SET)
            .register_encoded_file_descriptor_set(tonic_health::pb::FILE_DESCRIPTOR_SET)
    };
    let (v1, v1alpha) = (reflection().build_v1()?, reflection().build_v1alpha()?);
    let others = routed(Router::new(), 1, health.max_decoding_message_size(NAMES));
    let others = routed(others, 2, v1.max_decoding_message_size(NAMES));
    let others = routed(others, 3, v1alpha.max_decoding_message_size(NAMES));
    let contract = contract(service);
    Ok((Calls { contract, others }, Health(reporter)))
}

/// Sets what the standard health service reports.
#[derive(Clone, Debug)]
pub struct Health(HealthReporter);

impl Health {
    /// Reports from now on whether the service is served.
    pub async fn set(&self, is_serving: bool) {
        let state = match is_serving {
            true => tonic_health::ServingStatus::Serving,
            false => tonic_health::ServingStatus::NotServing,
        };
        for service in ["", NAME] {
            self.0.set_service_status(service, state).await;
        }
    }
}

/// The answer to a call that is not let in, or that cannot be answered at all.
pub fn refusal(error: &Error) -> Response {
    status(error).into_http::<Body>()
}

/// The end of a call whose client broke it off.
pub fn left() -> Status {
    Status::cancelled("the call broke off before the end of its message")
}

/// The trailers of a stream that is not complete.
pub fn interrupted(why: Interrupted) -> Option<HeaderMap> {
    status::trailers(&status::interrupted(why))
}

/// Trailers as the last data of a gRPC-Web body, in Base64 if that is text.
pub fn web_trailers(trailers: &HeaderMap, is_text: bool) -> Bytes {
    /// The flag of a frame that holds trailers.
    const TRAILERS: u8 = 0x80;
    let mut lines = vec![];
    for (name, value) in trailers {
        lines.extend_from_slice(name.as_str().as_bytes());
        lines.push(b':');
        lines.extend_from_slice(value.as_bytes());
        lines.extend_from_slice(b"\r\n");
    }
    let mut frame = vec![TRAILERS];
    frame.extend_from_slice(&u32::try_from(lines.len()).unwrap_or_default().to_be_bytes());
    frame.append(&mut lines);
    if is_text {
        return STANDARD.encode(frame).into();
    }
    frame.into()
}

/// Corrects the statuses that the gRPC library answers with: a message that is too large is
/// RESOURCE_EXHAUSTED, bytes that are not a message are the client's fault, and an unknown method has a
/// text.
pub fn improve(headers: &mut HeaderMap) {
    let Some(code) = headers.get(GRPC_STATUS).map(HeaderValue::as_bytes) else {
        return;
    };
    let message = headers.get(GRPC_MESSAGE).map(HeaderValue::as_bytes);
    let message = String::from_utf8_lossy(message.unwrap_or_default());
    let better = match code {
        b"11" if message.contains("message%20length%20too%20large") => "8",
        b"12" if message.is_empty() => {
            return headers.extend(unimplemented().into_parts().0.headers);
        }
        b"13" if MALFORMED.iter().any(|part| message.contains(part)) => "3",
        _ => return,
    };
    headers.insert(GRPC_STATUS, HeaderValue::from_static(better));
}

/// Parts of the texts with which the libraries report that bytes are not a message.
const MALFORMED: [&str; 5] = [
    "Missing%20request%20message",
    "failed%20to%20decode%20Protobuf",
    "protocol%20error:%20received%20message",
    "Error%20decompressing",
    "Unexpected%20EOF%20decoding",
];

/// The code of a call that has ended.
pub const GRPC_STATUS: HeaderName = HeaderName::from_static("grpc-status");
const GRPC_MESSAGE: HeaderName = HeaderName::from_static("grpc-message");
