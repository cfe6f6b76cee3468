//! The gRPC door: messages in, streamed messages out. It decides nothing itself.

mod compression;
mod deadline;
mod frames;
mod messages;
mod points;
mod profile;
mod query;
mod region;
mod resolved;
mod set;
mod single;
mod split;
mod status;

use std::sync::Arc;

use bytes::Bytes;
use http_body::Frame;
use tonic::service::Routes;
use tonic_health::server::HealthReporter;

use crate::service::{Error, Interrupted, Service};
pub use deadline::Deadline;
use frames::Direct;
use points::Points;
use proto::point_service_server::PointServiceServer;

/// The messages, server and client made from `proto/strew/v1/`.
#[allow(missing_docs, reason = "the contract documents everything")]
#[allow(clippy::all, reason = "made code")]
#[allow(clippy::allow_attributes_without_reason, reason = "made code")]
pub mod proto {
    tonic::include_proto!("strew.v1");
}

/// The contract as reflection serves it.
const DESCRIPTORS: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/strew_descriptors.bin"));

/// The methods of the contract, by their paths.
pub const METHODS: [&str; 6] = [
    "/strew.v1.PointService/StreamPoints",
    "/strew.v1.PointService/CountPoints",
    "/strew.v1.PointService/SplitPoints",
    "/strew.v1.PointService/GetPoint",
    "/strew.v1.PointService/FindNearest",
    "/strew.v1.PointService/ListProfiles",
];

/// The name of a code, as the protocol writes it.
#[must_use]
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

/// Why the gRPC door cannot be built: the contract's descriptors do not read.
pub type BuildError = tonic_reflection::server::Error;

/// The routes of the gRPC door, with reflection and health, and the handle that tells the world
/// when it closes.
///
/// # Errors
/// Never, unless the program was built wrongly.
pub async fn routes(service: Arc<Service>) -> Result<(Routes, Health), BuildError> {
    let (reporter, health) = tonic_health::server::health_reporter();
    reporter.set_serving::<PointServiceServer<Points>>().await;
    let reflection = || {
        tonic_reflection::server::Builder::configure()
            .register_encoded_file_descriptor_set(DESCRIPTORS)
            .register_encoded_file_descriptor_set(tonic_health::pb::FILE_DESCRIPTOR_SET)
    };
    let most = service.limits().max_body_bytes;
    let points = compression::COMPRESSIONS.into_iter().fold(
        PointServiceServer::new(Points::new(service)).max_decoding_message_size(most),
        |server, coding| server.accept_compressed(coding).send_compressed(coding),
    );
    let routes = Routes::new(Direct(points))
        .add_service(health)
        .add_service(reflection().build_v1()?)
        .add_service(reflection().build_v1alpha()?);
    Ok((routes, Health { reporter }))
}

/// The standard health service's switch.
#[derive(Clone, Debug)]
pub struct Health {
    reporter: HealthReporter,
}

impl Health {
    /// Says that nothing more is served.
    pub async fn close(&self) {
        let state = tonic_health::ServingStatus::NotServing;
        self.reporter.set_service_status("", state).await;
        self.reporter
            .set_not_serving::<PointServiceServer<Points>>()
            .await;
    }
}

/// What a call asks of its answer, put right before the call: how it may be compressed, and by when
/// it must be over.
///
/// # Errors
/// A status that says what is wrong with the call.
pub fn terms(headers: &mut http::HeaderMap) -> Result<Option<Deadline>, tonic::Status> {
    compression::settle(headers);
    Deadline::of(headers)
}

/// The answer to a call that is not let in, or that cannot be answered at all.
#[must_use]
pub fn refusal(error: &Error) -> http::Response<tonic::body::Body> {
    broken(error).into_http()
}

/// An error as what a call ends with.
#[must_use]
pub fn broken(error: &Error) -> tonic::Status {
    status::status(error)
}

/// The last of a stream that is not complete.
#[must_use]
pub fn ending(why: Interrupted) -> Option<Frame<Bytes>> {
    let mut trailers = http::HeaderMap::new();
    let told = status::interrupted(why).add_header(&mut trailers);
    told.ok().map(|()| Frame::trailers(trailers))
}

/// The answer to a method that does not exist.
#[must_use]
pub fn unimplemented() -> http::Response<tonic::body::Body> {
    tonic::Status::unimplemented("there is no such method").into_http()
}
