//! The paths of REST, and what answers them.

use std::{fmt, future::ready};

use http::StatusCode;
use matchit::Router;
use percent_encoding::percent_decode_str;
use strew_access::Caller;

use super::{
    Pages,
    api::Endpoint,
    context::Context,
    openapi, page,
    problem::Problem,
    unknown::{not_found, wrong_method},
};
use crate::body::{Answering, Request, Response};

/// All that a port answers by REST.
#[derive(Debug)]
pub struct Routes {
    endpoints: Vec<Endpoint>,
    /// The places of endpoints by their paths.
    table: Router<usize>,
    /// The paths, for answers to unknown ones.
    paths: String,
}

/// What a path leads to.
pub struct Found<'a> {
    endpoint: &'a Endpoint,
    parameters: Result<Vec<String>, String>,
}

impl fmt::Debug for Found<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.endpoint.path())
    }
}

impl Routes {
    /// The routes of these endpoints, of their description and of the pages, which name `public_url` as their own
    /// address if it is not empty.
    ///
    /// # Panics
    /// For two endpoints of one path.
    #[must_use]
    pub fn new(mut endpoints: Vec<Endpoint>, pages: &Pages, public_url: &str) -> Self {
        endpoints.extend(page::endpoints(pages, public_url));
        endpoints.push(openapi::endpoint(&endpoints));
        let paths: Vec<&str> = endpoints.iter().map(Endpoint::path).collect();
        let paths = paths.join(", ");
        let empty = Self {
            endpoints: vec![],
            table: Router::new(),
            paths,
        };
        empty
            .with(endpoints)
            .with(page::icon(pages).into_iter().collect())
    }

    /// With further endpoints, which are not described.
    ///
    /// # Panics
    /// As [`new`](Self::new).
    #[must_use]
    pub fn with(mut self, more: Vec<Endpoint>) -> Self {
        for endpoint in more {
            let inserted = self.table.insert(endpoint.path(), self.endpoints.len());
            inserted.expect("each path once");
            self.endpoints.push(endpoint);
        }
        self
    }

    /// What a path leads to, if it is known.
    #[must_use]
    pub fn find(&self, path: &str) -> Option<Found<'_>> {
        let found = self.table.at(path).ok()?;
        let parameters = found.params.iter().map(|(name, text)| {
            let text = percent_decode_str(text).decode_utf8();
            let text = text.map_err(|_| format!("Invalid UTF-8 in `{name}`"));
            text.map(Into::into)
        });
        Some(Found {
            parameters: parameters.collect(),
            endpoint: self.endpoints.get(*found.value)?,
        })
    }

    /// The answer to an unknown path.
    #[must_use]
    pub fn nothing(&self, path: &str) -> Response {
        not_found(path, &self.paths)
    }
}

impl Found<'_> {
    /// The path of the endpoint, with its parameters in braces.
    #[must_use]
    pub const fn path(&self) -> &'static str {
        self.endpoint.path()
    }

    /// Whether everyone is let in.
    #[must_use]
    pub const fn is_open(&self) -> bool {
        self.endpoint.is_open()
    }

    /// Answers a request of a caller.
    #[must_use]
    pub fn answer(self, request: Request, caller: Caller) -> Answering {
        let (parts, body) = request.into_parts();
        let Some(handler) = self.endpoint.handler(&parts.method) else {
            let allowed = self.endpoint.allowed();
            return Box::pin(ready(wrong_method(&parts.method, &parts.uri, &allowed)));
        };
        let path = match self.parameters {
            Ok(path) => path,
            Err(detail) => {
                let problem = Problem::of_status(StatusCode::BAD_REQUEST, detail);
                return Box::pin(ready(problem));
            }
        };
        let context = Context {
            caller,
            method: parts.method,
            uri: parts.uri,
            headers: parts.headers,
            path,
        };
        handler.answer(context, body)
    }
}
