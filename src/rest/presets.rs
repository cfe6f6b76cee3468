//! `GET /v1/presets`: the presets of the settings.

use std::sync::Arc;

use axum::{extract::State, response::Response, routing};
use http::Method;
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::value::RawValue;

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
        id: "listPresets",
        summary: "The presets of the settings",
        about: "Parts of queries by their names, for the parameter preset.",
        tag: Tag::Profiles,
        path_parameters: &[],
        parameters: groups::NONE,
        body: None,
        answers: vec![
            api::Answer::json::<List<'_>>("The list, sorted by name."),
            api::Answer::unchanged(),
        ],
        problems: vec![Kind::Invalid],
        example: "/v1/presets".into(),
    };
    Endpoint::new("/v1/presets", service, vec![(operation, routing::get(get))])
}

async fn get(State(service): State<Arc<Service>>, context: Context) -> Result<Response, Error> {
    context.values(groups::NONE).read()?;
    let made_of: Vec<(&str, &str)> = service.presets().iter().collect();
    let freshness = Freshness::of(&context.uri, &context.headers, document::JSON, &made_of);
    let make = async {
        let presets = service.presets().iter();
        let preset = |(name, json)| {
            let query = serde_json::from_str(json).ok()?;
            Some(Preset { name, query })
        };
        document::json(&List {
            presets: presets.filter_map(preset).collect(),
        })
    };
    freshness.answer(&context.headers, make).await
}

/// The presets of the settings.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "Presets")]
struct List<'a> {
    /// Sorted by name.
    presets: Vec<Preset<'a>>,
}

/// A preset.
#[derive(Serialize, JsonSchema)]
struct Preset<'a> {
    /// Its name.
    name: &'a str,
    /// Members of a query: those that it lacks are taken from here.
    #[schemars(with = "serde_json::Map<String, serde_json::Value>")]
    query: &'a RawValue,
}
