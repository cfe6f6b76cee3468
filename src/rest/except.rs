//! `/v1/except`: the lists of points that queries may leave out, and how clients send one.

use std::sync::Arc;

use axum::extract::State;
use http::Method;
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::json;
use strew_catalog::except::{NamedList, Section};
use strew_core::server::Stop;
use strew_error::Kind;
use strew_query::groups;
use strew_service::Service;

use super::{
    api::{self, Endpoint, Operation, Tag, schemas},
    context::{Context, Sent},
    document,
};
use crate::{body::Response, rest::Refused};

/// The path.
pub(super) fn endpoint(service: Arc<Service>) -> Endpoint {
    let listed = Operation {
        id: "listExcept",
        summary: "The lists of points that are left out",
        about: "Lists of the daemon's configuration and of its folder, for the parameter except.",
        example: "/v1/except".into(),
        ..Operation::new(
            Tag::Worlds,
            api::Answer::json::<Lists<'_>>("The lists, sorted by name.").or_unchanged(),
        )
    };
    let sent = Operation {
        method: Method::POST,
        id: "sendExcept",
        summary: "Sends a list of points to be named later",
        about: "Queries name it by its digest: except=DIGEST. The body is an object, or text with an id a line, where \
                what follows # is a comment. The list is held while there is room; a query that names one that is \
                gone is refused, and the client sends the list again.",
        body: Some(api::Body::json(schemas::of::<Section<'_>>, example())),
        answers: vec![api::Answer::json::<List<'_>>(
            "The list that is held; its name is its digest.",
        )],
        problems: vec![Kind::Invalid, Kind::BodyTooLarge],
        example: format!("/v1/except -d '{}'", example()),
        ..listed.clone()
    };
    Endpoint::new("/v1/except")
        .with(service.clone(), listed, all)
        .with(service, sent, post)
}

fn example() -> serde_json::Value {
    json!({ "ids": ["trees/18:-17", "trees/23:-15"] })
}

async fn post(State(service): State<Arc<Service>>, sent: Sent) -> Result<Response, Refused> {
    let Sent { body, .. } = sent;
    let bytes = body.len();
    let hold = move |service: &Service, _: &Stop| service.hold_list(&body);
    let held = service.process(bytes, hold).await??;
    Ok(document::json(&List::new(&held))?)
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

impl<'a> List<'a> {
    fn new(list: &'a NamedList) -> Self {
        Self {
            name: &list.name,
            digest: &list.digest,
            count: list.len(),
            layers: list.layers().collect(),
        }
    }
}

async fn all(State(service): State<Arc<Service>>, context: Context) -> Result<Response, Refused> {
    context.values(groups::NONE).read()?;
    let catalog = service.catalog();
    let lists = Lists {
        lists: (catalog.except().iter())
            .map(|list| List::new(list))
            .collect(),
    };
    Ok(context.document(&lists).await?)
}
