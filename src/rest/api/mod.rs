//! What REST offers, described once: an [`Endpoint`] is a path with its handlers and their
//! description, so that nothing is routed that `/openapi.json` does not describe.
//!
//! To add a path, write a module with `pub(super) fn endpoint(service) -> Endpoint` and list it in
//! [`rest::endpoints`](super::endpoints).

mod document;
mod examples;
mod rules;
pub mod schemas;
mod sets;

use axum::{Router, routing::MethodRouter};
use http::Method;
use schemars::JsonSchema;
use serde_json::Value;

use super::unknown::wrong_method;
use crate::service::{
    Kind,
    query::{Group, Parameter},
};
use schemas::Content;

pub(super) use document::document;

/// A path that answers, and what it answers.
#[derive(Debug)]
pub struct Endpoint {
    path: &'static str,
    operations: Vec<Operation>,
    is_open: bool,
    router: Router,
}

/// One method of a path.
#[derive(Clone, Debug)]
pub struct Operation {
    /// GET (which answers HEAD, too) or POST.
    pub method: Method,
    /// A name for programs, in camel case.
    pub id: &'static str,
    /// What it does, in a few words.
    pub summary: &'static str,
    /// What else is to know.
    pub about: &'static str,
    /// What the operation belongs to.
    pub tag: Tag,
    /// The parameters of the path, in its order.
    pub path_parameters: &'static [&'static Parameter],
    /// The parameters of the query.
    pub parameters: &'static [Group],
    /// The body of a request, if it has one.
    pub body: Option<Body>,
    /// The answers that are not problems.
    pub answers: Vec<Answer>,
    /// The problems that this operation can have, besides those that every one can have.
    pub problems: Vec<Kind>,
    /// The rest of a `curl` command that works on the built-in tables: first the address, in single
    /// quotes if it needs them.
    pub example: String,
}

/// What operations belong to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tag {
    /// Points of regions.
    Points,
    /// Noise profiles.
    Profiles,
    /// Fields.
    Fields,
    /// Worlds.
    Worlds,
    /// Tables made on demand.
    Tables,
    /// Patterns without displacements.
    Patterns,
    /// Pages and documents about the daemon.
    About,
    /// What operators use.
    Operations,
}

impl Tag {
    /// All of them.
    pub const ALL: [Self; 8] = [
        Self::Points,
        Self::Profiles,
        Self::Fields,
        Self::Worlds,
        Self::Tables,
        Self::Patterns,
        Self::About,
        Self::Operations,
    ];

    /// The name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Points => "points",
            Self::Profiles => "profiles",
            Self::Fields => "fields",
            Self::Worlds => "worlds",
            Self::Tables => "tables",
            Self::Patterns => "patterns",
            Self::About => "about",
            Self::Operations => "operations",
        }
    }

    /// What is in it.
    #[must_use]
    pub const fn about(self) -> &'static str {
        match self {
            Self::Points => "Points of regions, counts, and single points.",
            Self::Profiles => "The noise profiles that are loaded.",
            Self::Fields => "The fields that are loaded.",
            Self::Worlds => "The worlds that are loaded: queries that are described once.",
            Self::Tables => "Tables made on demand, and the jobs that make them.",
            Self::Patterns => "The AA pattern of any α: arrangements, clusters, maps, figures.",
            Self::About => "Pages for people and this document.",
            Self::Operations => "Health, metrics and administration.",
        }
    }
}

/// The body of a request.
#[derive(Clone, Debug)]
pub struct Body {
    /// Its media type.
    pub media_type: &'static str,
    /// Its JSON Schema.
    pub schema: Content,
    /// A body that is in order on the built-in tables.
    pub example: Value,
}

/// An answer that is not a problem.
#[derive(Clone, Debug)]
pub struct Answer {
    /// Its status.
    pub status: u16,
    /// What it is.
    pub about: &'static str,
    /// Its headers by name, with what they say.
    pub headers: Vec<(&'static str, &'static str)>,
    /// Its media types with the JSON Schemas of their content.
    pub contents: Vec<(&'static str, Content)>,
}

impl Answer {
    /// A JSON document of a type.
    pub(super) fn json<T: JsonSchema>(about: &'static str) -> Self {
        Self {
            status: 200,
            about,
            headers: vec![],
            contents: vec![("application/json", schemas::of::<T>)],
        }
    }

    /// The answer to a client whose copy is still right.
    #[must_use]
    pub const fn unchanged() -> Self {
        Self {
            status: 304,
            about: "What the client has (If-None-Match) is still the answer.",
            headers: vec![],
            contents: vec![],
        }
    }
}

impl Endpoint {
    /// A path with a handler for each of its operations, in the same order. Other methods are
    /// answered with a problem.
    pub fn new<S: Clone + Send + Sync + 'static>(
        path: &'static str,
        state: S,
        operations: Vec<(Operation, MethodRouter<S>)>,
    ) -> Self {
        let mut methods = MethodRouter::new();
        let mut allowed: Vec<String> = vec![];
        let mut described = vec![];
        for (operation, handler) in operations {
            methods = methods.merge(handler);
            allowed.push(operation.method.to_string());
            if operation.method == Method::GET {
                allowed.push("HEAD".into());
            }
            described.push(operation);
        }
        let allowed = allowed.join(", ");
        let fallback = move |method, uri| {
            let allowed = allowed.clone();
            async move { wrong_method(&method, &uri, &allowed) }
        };
        Self {
            path,
            operations: described,
            is_open: false,
            router: Router::new()
                .route(path, methods.fallback(fallback))
                .with_state(state),
        }
    }

    /// Lets everyone in, with a key or without.
    #[must_use]
    pub fn open(mut self) -> Self {
        self.is_open = true;
        self
    }

    /// Whether everyone is let in.
    #[must_use]
    pub const fn is_open(&self) -> bool {
        self.is_open
    }

    /// The path, with its parameters in braces.
    #[must_use]
    pub const fn path(&self) -> &'static str {
        self.path
    }

    /// What it answers.
    #[must_use]
    pub fn operations(&self) -> &[Operation] {
        &self.operations
    }

    /// Its routes.
    pub(super) fn into_router(self) -> Router {
        self.router
    }
}
