//! `GET /v1/pattern/map`: neighborhood maps.

use std::{pin::pin, sync::Arc};

use axum::extract::State;
use strew_query::groups;
use strew_service::{
    Service,
    pattern::{MapDocument, MapQuery},
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
        id: "getMap",
        summary: "A neighborhood map",
        about: "The intervals of index space along each axis, whose pairs are the blocks; all points of a block \
                have the same neighbors up to the half-width R. A larger R refines the map. The number of \
                intervals grows linearly, by 2(α − 1) for each grid unit.",
        parameters: groups::MAP,
        example: "'/v1/pattern/map?alpha=sqrt(3)&radius=10&refined=20&block=3,4'".into(),
        ..Operation::new(
            Tag::Patterns,
            api::Answer::json::<MapDocument>("The map.").or_unchanged(),
        )
    };
    Endpoint::only("/v1/pattern/map", service, operation, get)
}

async fn get(State(service): State<Arc<Service>>, context: Context) -> Result<Response, Refused> {
    let query = MapQuery::check(&context.values(groups::MAP))?;
    let make = service.map(&context.caller, query, |map| document::json(&map));
    Ok(context.answer(document::JSON, &(), pin!(make)).await?)
}
