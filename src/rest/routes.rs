//! The routes of REST: a router of all endpoints, those behind the gate apart from those that are open.

use std::sync::Arc;

use axum::Router;

use super::{Pages, api::Endpoint, openapi, page, unknown::not_found};
use crate::body::Response;

/// All that a port answers by REST.
#[derive(Debug)]
pub struct Routes {
    /// What is let in with a key, where keys are required.
    pub gated: Router,
    /// What everyone is let in to.
    pub open: Router,
    /// Answers requests to other paths.
    pub paths: Paths,
}

/// The paths that are described, for answers to unknown ones.
#[derive(Clone, Debug)]
pub struct Paths(Arc<str>);

impl Paths {
    /// The answer to an unknown path.
    pub fn nothing(&self, path: &str) -> Response {
        not_found(path, &self.0)
    }
}

impl Routes {
    /// The routes of these endpoints, of their description and of the pages, which name `public_url` as their own
    /// address if it is not empty; and `more`, which are not described.
    ///
    /// # Panics
    /// For two endpoints of one path.
    pub fn new(
        mut endpoints: Vec<Endpoint>,
        more: &[Endpoint],
        pages: &Pages,
        public_url: &str,
    ) -> Self {
        endpoints.extend(page::endpoints(pages, public_url));
        endpoints.push(openapi::endpoint(&endpoints));
        let paths: Vec<&str> = endpoints.iter().map(Endpoint::path).collect();
        let paths = Paths(paths.join(", ").into());
        endpoints.extend(page::icon(pages));
        let of = |is_open| {
            let all = endpoints.iter().chain(more);
            let all = all.filter(|endpoint| endpoint.is_open() == is_open);
            all.fold(Router::new(), |router, endpoint| {
                router.route(endpoint.path(), endpoint.answers())
            })
        };
        Self {
            gated: of(false),
            open: of(true),
            paths,
        }
    }
}
