//! The description of REST: an [`Endpoint`] is a path with its handlers and their
//! description, so that nothing is routed that `/openapi.json` does not describe.
//!
//! To add a path, write a function that returns its endpoint and list it in
//! [`rest::endpoints`](super::endpoints).

mod document;
mod rules;
pub mod schemas;

use axum::{
    handler::Handler,
    routing::{MethodFilter, MethodRouter, on},
};
use http::{Method, Uri};
use schemars::JsonSchema;
use serde_json::Value;
use strew_catalog::Dimension;
use strew_error::Kind;
use strew_query::{Group, Parameter};
use strew_service::Record;

use schemas::Content;

use super::problem::{Problem, wrong_method};

pub(super) use document::document;

#[derive(Clone, Debug)]
pub struct Endpoint {
    pub(super) path: &'static str,
    operations: Vec<Operation>,
    /// Whether everyone is let in.
    pub(super) is_open: bool,
    answers: MethodRouter,
}

#[derive(Clone, Debug)]
pub struct Operation {
    /// GET (which answers HEAD, too) or POST.
    pub method: Method,
    /// A name for programs, in camel case.
    pub id: &'static str,
    pub summary: &'static str,
    pub about: &'static str,
    pub tag: Tag,
    pub path_parameters: &'static [&'static Parameter],
    pub parameters: &'static [Group],
    /// The JSON Schema of the body of a request, if it has one, and a body that is in order on the built-in tables.
    pub body: Option<(Content, Value)>,
    /// The answers that are not problems.
    pub answers: Vec<Answer>,
    /// The problems that this operation can have, besides those that every one can have.
    pub problems: Vec<Kind>,
    /// The rest of a `curl` command that works on the built-in tables: first the address, in single quotes if it needs
    /// them; by default the path.
    pub example: String,
}

macro_rules! tags {
    ($($tag:ident: $name:literal, $about:literal;)+) => {
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Tag {
            $(#[doc = $about] $tag,)+
        }

        impl Tag {
            pub const ALL: &[Self] = &[$(Self::$tag),+];

            pub const fn words(self) -> (&'static str, &'static str) {
                match self {
                    $(Self::$tag => ($name, $about),)+
                }
            }
        }
    };
}

tags! {
    Points: "points", "Points of regions, counts, and single points.";
    Space: "space", "Points in space: three dimensions.";
    Profiles: "profiles", "The noise profiles that are loaded.";
    Fields: "fields", "The fields that are loaded.";
    Worlds: "worlds", "The worlds that are loaded: queries that are described once.";
    Patterns: "patterns", "The AA pattern of any α: arrangements, clusters, maps, figures.";
    About: "about", "Pages for people and this document.";
    Operations: "operations", "Health, metrics and administration.";
}

impl Tag {
    pub(super) fn of(dimension: Dimension) -> Self {
        either(dimension, [Self::Points, Self::Space])
    }
}

/// An answer that is not a problem.
#[derive(Clone, Debug)]
pub struct Answer {
    pub status: u16,
    pub about: &'static str,
    /// Its headers by name, with what they say.
    pub headers: Vec<(&'static str, &'static str)>,
    /// Its media types with the JSON Schemas of their content.
    pub contents: Vec<(&'static str, Content)>,
}

impl Answer {
    pub fn json<T: JsonSchema>(about: &'static str) -> Self {
        Self::file(about, "application/json", schemas::of::<T>)
    }

    pub fn file(about: &'static str, media_type: &'static str, schema: Content) -> Self {
        Self {
            status: 200,
            about,
            headers: vec![],
            contents: vec![(media_type, schema)],
        }
    }

    /// This answer, and those to clients whose conditions say that they do not want it.
    pub(super) fn or_unchanged(self) -> Vec<Self> {
        let unchanged = Self {
            status: 304,
            about: "The copy that the client has (If-None-Match) is still the answer.",
            headers: vec![],
            contents: vec![],
        };
        let failed = Self {
            status: 412,
            about: "The answer has none of the tags of If-Match.",
            headers: vec![],
            contents: vec![("application/problem+json", schemas::of::<Problem<'_>>)],
        };
        vec![self, unchanged, failed]
    }
}

impl Operation {
    /// A GET without parameters, whose only problem of its own is an invalid query. Descriptions of operations state
    /// how they differ from it.
    pub fn new(tag: Tag, answers: Vec<Answer>) -> Self {
        Self {
            method: Method::GET,
            id: "",
            summary: "",
            about: "",
            tag,
            path_parameters: &[],
            parameters: &[],
            body: None,
            answers,
            problems: vec![Kind::Invalid],
            example: String::new(),
        }
    }

    /// As a POST to an address, with a document in JSON as its body.
    pub(super) fn posted(mut self, address: &str, schema: Content, body: Value) -> Self {
        self.method = Method::POST;
        self.problems.push(Kind::BodyTooLarge);
        self.example = format!("{address} -d '{body}'");
        self.body = Some((schema, body));
        self
    }
}

/// The plane's or space's of two.
pub(super) fn either<T>(dimension: Dimension, [plane, space]: [T; 2]) -> T {
    match dimension {
        Dimension::Plane => plane,
        Dimension::Space => space,
    }
}

impl Endpoint {
    pub fn only<S: Clone + Send + Sync + 'static, T: 'static>(
        path: &'static str,
        state: S,
        operation: Operation,
        handle: impl Handler<T, S>,
    ) -> Self {
        let endpoint = Self {
            path,
            operations: vec![],
            is_open: false,
            answers: MethodRouter::new(),
        };
        endpoint.with(state, operation, handle)
    }

    pub fn with<S: Clone + Send + Sync + 'static, T: 'static>(
        mut self,
        state: S,
        mut operation: Operation,
        handle: impl Handler<T, S>,
    ) -> Self {
        let method = MethodFilter::try_from(operation.method.clone()).expect("a usual method");
        self.answers = self.answers.merge(on(method, handle).with_state(state));
        if operation.example.is_empty() {
            operation.example = self.path.into();
        }
        self.operations.push(operation);
        self
    }

    /// Lets everyone in, with a key or without.
    pub fn open(mut self) -> Self {
        self.is_open = true;
        self
    }

    /// What answers requests to the path. Methods that it does not take are answered with a problem.
    pub(super) fn answers(&self) -> MethodRouter {
        let allowed = self.allowed();
        let path = self.path;
        let refuse = async move |method: Method, uri: Uri| {
            Record::at(path);
            wrong_method(&method, &uri, &allowed)
        };
        self.answers.clone().fallback(refuse)
    }

    fn allowed(&self) -> String {
        let methods = self.operations.iter().map(|of| match of.method {
            Method::GET => "GET, HEAD",
            ref method => method.as_str(),
        });
        methods.collect::<Vec<_>>().join(", ")
    }
}
