//! `GET /v1/except`: the lists of points that queries may leave out.

use std::sync::Arc;

use axum::{extract::State, response::Response, routing};
use http::Method;
use schemars::JsonSchema;
use serde::Serialize;

use super::{
    api::{self, Endpoint, Operation, Tag},
    context::Context,
    document,
    freshness::Freshness,
};
use crate::service::{Error, Kind, Service, query::groups};

/// The path.
pub(super) fn endpoint(service: Arc<Service>) -> Endpoint {
    let operation = Operation {
        method: Method::GET,
        id: "listExcept",
        summary: "The lists of points that are left out",
        about: "Lists of the daemon's configuration and of its folder, for the parameter except.",
        tag: Tag::Worlds,
        path_parameters: &[],
        parameters: groups::NONE,
        body: None,
        answers: vec![
            api::Answer::json::<Lists<'_>>("The lists, sorted by name."),
            api::Answer::unchanged(),
        ],
        problems: vec![Kind::Invalid],
        example: "/v1/except".into(),
    };
    Endpoint::new("/v1/except", service, vec![(operation, routing::get(all))])
}

/// The lists of points that queries may leave out.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "ExceptLists")]
struct Lists<'a> {
    /// Sorted by name.
    lists: Vec<List<'a>>,
}

/// A list of points.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "ExceptList")]
struct List<'a> {
    /// Its name.
    name: &'a str,
    /// The BLAKE3 digest of its ids.
    digest: &'a str,
    /// The number of ids.
    count: usize,
    /// The layers that it has ids of; none if its ids are of no layer.
    layers: Vec<&'a str>,
}

async fn all(State(service): State<Arc<Service>>, context: Context) -> Result<Response, Error> {
    context.values(groups::NONE).read()?;
    let catalog = service.catalog();
    let lists = Lists {
        lists: (catalog.except().iter())
            .map(|list| List {
                name: &list.name,
                digest: &list.digest,
                count: list.len(),
                layers: list.layers().collect(),
            })
            .collect(),
    };
    let freshness = Freshness::of(&context.uri, &context.headers, document::JSON, &lists);
    let make = async { document::json(&lists) };
    freshness.answer(&context.headers, make).await
}
