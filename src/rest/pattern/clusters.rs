//! `GET /v1/pattern/clusters`: the shapes of clusters.

use std::{pin::pin, sync::Arc};

use axum::extract::State;
use strew_query::groups;
use strew_service::{
    Service,
    pattern::{ClustersDocument, ClustersQuery},
};

use super::{
    api::{self, Endpoint, Operation, Tag},
    context::Context,
    document,
};
use crate::{body::Response, rest::Refused};

/// The path.
pub(super) fn endpoint(service: Arc<Service>) -> Endpoint {
    let operation = Operation {
        id: "getClusters",
        summary: "The shapes of clusters of pattern points",
        about: "Points at most a distance apart are neighbors, and points that neighbors connect are a cluster. \
                Exact up to a number of points: the density of a shape is the area of index space that holds \
                its first points. A search that takes too long ends with its client, or with the time for an \
                answer.",
        parameters: groups::CLUSTERS,
        example: "'/v1/pattern/clusters?alpha=sqrt(3)&distance=2&up_to=symmetry'".into(),
        ..Operation::new(
            Tag::Patterns,
            api::Answer::json::<ClustersDocument>("The clusters.").or_unchanged(),
        )
    };
    Endpoint::only("/v1/pattern/clusters", service, operation, get)
}

async fn get(State(service): State<Arc<Service>>, context: Context) -> Result<Response, Refused> {
    let query = ClustersQuery::check(&context.values(groups::CLUSTERS))?;
    let make = service.clusters(&context.caller, query, move |found| {
        document::json(&query.document(found))
    });
    Ok(context.answer(document::JSON, &(), pin!(make)).await?)
}
