//! `GET /v1/pattern/clusters`: the shapes of clusters.

use std::sync::Arc;

use axum::{extract::State, response::Response, routing};
use http::Method;

use super::{
    api::{self, Endpoint, Operation, Tag},
    context::Context,
    document,
    freshness::Freshness,
};
use crate::service::{
    Error, Kind, Service,
    pattern::{ClustersDocument, ClustersQuery},
    query::groups,
};

/// The path.
pub(super) fn endpoint(service: Arc<Service>) -> Endpoint {
    let operation = Operation {
        method: Method::GET,
        id: "getClusters",
        summary: "The shapes of clusters of pattern points",
        about: "Points at most a distance apart are neighbors, and points that neighbors connect are a cluster. \
                Exact up to a number of points: the density of a shape is the area of index space that holds \
                its first points. A search that takes too long ends with its client, or with the time for an \
                answer.",
        tag: Tag::Patterns,
        path_parameters: &[],
        parameters: groups::CLUSTERS,
        body: None,
        answers: vec![
            api::Answer::json::<ClustersDocument>("The clusters."),
            api::Answer::unchanged(),
        ],
        problems: vec![Kind::Invalid],
        example: "'/v1/pattern/clusters?alpha=sqrt(3)&distance=2&up_to=symmetry'".into(),
    };
    let handler = routing::get(get);
    Endpoint::new("/v1/pattern/clusters", service, vec![(operation, handler)])
}

async fn get(State(service): State<Arc<Service>>, context: Context) -> Result<Response, Error> {
    let query = ClustersQuery::check(&context.values(groups::CLUSTERS))?;
    let freshness = Freshness::of(&context.uri, &context.headers, document::JSON, &());
    let make = service.clusters(&context.caller, query, move |found| {
        document::json(&query.document(found))
    });
    freshness.answer(&context.headers, make).await
}
