//! REST: addresses in, streamed bodies and problems out. It decides nothing itself.

mod answer;
pub mod api;
mod coding;
mod context;
mod count;
mod document;
mod finish;
mod freshness;
mod mask;
mod named;
mod negotiate;
mod origin;
mod page;
mod pattern;
mod points;
mod problem;
mod profiles;
mod single;

use std::sync::Arc;

use axum::Router;
use http::StatusCode;
use strew_catalog::Dimension;
use strew_service::Service;

use crate::body::{Request, Response};
use api::Endpoint;
pub use context::{Context, Posted, Sent};
pub use count::{Count, Piece, Split};
pub use document::{JSON, file, json, momentary};
pub use finish::{Finish, Preferences};
pub use named::world_document;
pub use page::{Page, Pages, Part};
use problem::Problem;
pub use problem::{Paths, Refused, last_words};
pub use single::{One, Several};

/// The endpoints of REST, without their description.
pub fn endpoints(service: &Arc<Service>) -> Vec<Endpoint> {
    let of = |dimension| {
        let mut all = points::endpoints(service, dimension);
        all.extend([
            count::counts(service, dimension),
            count::parts_of(service, dimension),
            single::by_id(service, dimension),
            single::nearest(service, dimension),
            profiles::list(service, dimension),
        ]);
        all
    };
    let mut all = of(Dimension::Plane);
    all.push(profiles::periods(service));
    all.extend(mask::endpoints(service));
    all.push(named::except(service));
    all.extend(named::worlds(service));
    all.extend(profiles::one(service));
    all.extend(named::fields(service));
    all.extend(of(Dimension::Space));
    all.extend(pattern::endpoints(service));
    all
}

pub fn not_a_call(request: &Request, status: StatusCode, allowed: &str) -> Response {
    let path = request.uri().path();
    let detail = format!("`{path}` is a gRPC method; allowed: {allowed}");
    Problem::of_status(status, detail)
}

pub struct Routes {
    pub gated: Router,
    pub open: Router,
    /// Answers requests to other paths.
    pub paths: Paths,
}

impl Routes {
    /// The routes of these endpoints, of their description and of the pages, which name `public_url` as their own
    /// address if it is not empty; and `more`, which are not described.
    pub fn new(
        mut endpoints: Vec<Endpoint>,
        more: &[Endpoint],
        pages: &Pages,
        public_url: &str,
    ) -> Self {
        endpoints.extend(page::endpoints(pages, public_url));
        endpoints.push(page::description(&endpoints));
        let paths: Vec<&str> = endpoints.iter().map(|endpoint| endpoint.path).collect();
        let paths = Paths(paths.join(", ").into());
        endpoints.extend(page::icon(pages));
        let of = |is_open| {
            let all = endpoints.iter().chain(more);
            let all = all.filter(|endpoint| endpoint.is_open == is_open);
            all.fold(Router::new(), |router, endpoint| {
                router.route(endpoint.path, endpoint.answers())
            })
        };
        Self {
            gated: of(false),
            open: of(true),
            paths,
        }
    }
}
