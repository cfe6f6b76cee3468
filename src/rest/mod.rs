//! REST: addresses in, streamed bodies and problems out. It decides nothing itself.

mod answer;
pub mod api;
mod body;
mod coding;
mod context;
mod cors;
mod count;
mod document;
mod except;
mod fields;
mod finish;
mod fixed;
mod freshness;
mod harden;
mod host;
mod mask;
mod negotiate;
mod openapi;
mod page;
mod pattern;
mod periods;
mod points;
mod portrait;
mod problem;
mod profiles;
mod quality;
mod range;
mod routes;
mod single;
mod unknown;
mod vary;
mod worlds;

use std::sync::Arc;

use http::StatusCode;

use api::Endpoint;
pub use context::{Context, Posted, Sent};
pub use document::{JSON, file, json, momentary};
pub use finish::{Finish, Preferences};
pub use page::{Page, Pages, Part};
use problem::Problem;
pub use problem::Refused;
pub use routes::{Paths, Routes};
use strew_catalog::Dimension;
use strew_error::Error;
use strew_service::Service;

use crate::body::{Request, Response};
pub use worlds::world_document;

/// The endpoints of REST, without their description.
pub fn endpoints(service: &Arc<Service>) -> Vec<Endpoint> {
    let of = |dimension| {
        let mut all = points::endpoints(service, dimension);
        all.extend([
            count::counts(service, dimension),
            count::parts_of(service, dimension),
            single::by_id(service, dimension),
            single::nearest(service, dimension),
            profiles::endpoint(service, dimension),
        ]);
        all
    };
    let mut all = of(Dimension::Plane);
    all.extend([
        periods::endpoint(service.clone()),
        mask::endpoint(service.clone()),
        mask::spectrum(service.clone()),
        except::endpoint(service.clone()),
        worlds::list(service.clone()),
        worlds::endpoint(service.clone()),
        worlds::chunks(service.clone()),
        portrait::endpoint(service.clone()),
        portrait::picture(service.clone()),
        fields::list(service.clone()),
        fields::endpoint(service.clone()),
        fields::picture(service.clone()),
    ]);
    all.extend(of(Dimension::Space));
    all.extend(pattern::endpoints(service));
    all
}

/// The whole HTTP/1.1 response to a client whose connection is refused.
pub fn no_place(error: &Error) -> Vec<u8> {
    Problem::last_words(error)
}

/// The answer to a request to a gRPC method that is no call.
pub fn not_a_call(request: &Request) -> Response {
    let detail = format!(
        "`{}` is a gRPC method; allowed: POST with the content type application/grpc or \
         application/grpc-web",
        request.uri().path()
    );
    Problem::of_status(StatusCode::UNSUPPORTED_MEDIA_TYPE, detail)
}

/// The answer to a gRPC call over an HTTP that cannot carry it.
pub fn needs_http2(request: &Request) -> Response {
    let detail = format!(
        "`{}` is a gRPC method; allowed: gRPC over HTTP/2, gRPC-Web over any HTTP",
        request.uri().path()
    );
    Problem::of_status(StatusCode::HTTP_VERSION_NOT_SUPPORTED, detail)
}
