//! `GET` and `POST /v1/pattern/arrangements`: facts, counts and lists of occurrences.

use std::{pin::pin, sync::Arc};

use axum::extract::State;
use futures_util::StreamExt as _;
use http::{HeaderName, HeaderValue, Method};
use schemars::JsonSchema;
use serde_json::json;
use strew_core::server::Stop;
use strew_error::{Error, Kind, integer::Long};
use strew_query::{groups, read_members};
use strew_service::{
    Interrupted, Record, Service,
    pattern::{ArrangementQuery, Facts},
};

use super::{
    api::{
        self, Endpoint, Operation, Tag,
        schemas::{self, ArrangementQuery as ArrangementBody},
    },
    context::{Context, Sent},
    document,
};
use crate::{
    body::{Body, Response},
    rest::Refused,
};

const COUNT: HeaderName = HeaderName::from_static("strew-count");
const NEXT: HeaderName = HeaderName::from_static("strew-next");

/// The definition of an arrangement, for the description.
const ABOUT: &str = "An arrangement is a point of the pattern with others at some offsets from it. It exists iff its image in \
     index space fits the set region, and the area of the margin that is left is the exact density of its \
     occurrences. In a box of the grid occurrences are counted in closed form, whatever its size; list returns \
     every one of them, and with an amount the displaced places of its points.";

/// The path.
pub(super) fn endpoint(service: Arc<Service>) -> Endpoint {
    let body = json!({ "alpha": "sqrt(3)", "offsets": [[2, 0], [1, 2]], "grid": [0, 0, 40, 40] });
    let problems = || {
        vec![
            Kind::Invalid,
            Kind::OtherTable,
            Kind::TooManyPoints,
            Kind::TooManyStreams,
            Kind::ShuttingDown,
        ]
    };
    let given = Operation {
        id: "getArrangement",
        summary: "An arrangement, and where it occurs",
        about: ABOUT,
        parameters: groups::ARRANGEMENT,
        problems: problems(),
        example: "'/v1/pattern/arrangements?alpha=sqrt(3)&offsets=2,0+1,2&grid=0,0,40,40'".into(),
        ..Operation::new(Tag::Patterns, described().or_unchanged())
    };
    let posted = Operation {
        method: Method::POST,
        id: "findArrangement",
        parameters: groups::NONE,
        body: Some(api::Body::json(
            schemas::of::<ArrangementBody>,
            body.clone(),
        )),
        answers: vec![described()],
        problems: [problems(), vec![Kind::BodyTooLarge]].concat(),
        example: format!("/v1/pattern/arrangements -d '{body}'"),
        ..given.clone()
    };
    Endpoint::new("/v1/pattern/arrangements")
        .with(service.clone(), given, get)
        .with(service, posted, post)
}

/// The answer, with a list or without.
fn described() -> api::Answer {
    api::Answer {
        status: 200,
        about: "The arrangement; with list, its occurrences.",
        headers: vec![
            (
                "strew-count",
                "With list: the exact number of occurrences that follow.",
            ),
            (
                "strew-next",
                "With list and a limit: the cursor of the occurrences after these, if there are any.",
            ),
        ],
        contents: vec![
            (document::JSON, schemas::of::<Answered>),
            ("application/x-ndjson", schemas::any),
            ("text/csv", schemas::text),
        ],
    }
}

/// An arrangement, alone or with a list.
#[derive(JsonSchema)]
#[serde(untagged)]
#[schemars(rename = "ArrangementAnswer")]
#[allow(dead_code, reason = "only described")]
enum Answered {
    /// Without a list.
    Facts(Facts),
    /// With list=json.
    Listed(Listed),
}

/// An arrangement with its occurrences.
#[derive(JsonSchema)]
#[schemars(rename = "ArrangementList")]
#[allow(dead_code, reason = "only described; a stream writes it")]
struct Listed {
    /// The arrangement.
    arrangement: Facts,
    /// The number of occurrences in the list.
    listed: u64,
    /// The cursor of those after them, if there are any.
    next: Option<String>,
    /// The occurrences. Lines of ndjson are like them.
    occurrences: Vec<Occurrence>,
}

/// An occurrence of an arrangement. As CSV: column, row, and then x and y of each place.
#[derive(JsonSchema)]
#[schemars(rename = "Occurrence")]
#[allow(dead_code, reason = "only described; a stream writes it")]
struct Occurrence {
    /// The column and the row of its first point, which are the point's id.
    at: [Long<i64>; 2],
    /// With an amount: the places of its points, the first one and those at the offsets.
    #[schemars(default)]
    places: Option<Vec<[f64; 2]>>,
}

async fn get(State(service): State<Arc<Service>>, context: Context) -> Result<Response, Refused> {
    let query = ArrangementQuery::check(&context.values(groups::ARRANGEMENT), &service.catalog())?;
    let content_type = query
        .list
        .map_or(document::JSON, |list| list.content_type());
    let digest = query.set.as_ref().map(|set| &set.entry.digest);
    let made_of = (digest, service.limits().max_points);
    let freshness = context.freshness(content_type, &made_of);
    let make = answer(&service, &context, query);
    Ok(freshness.answer(&context.headers, pin!(make)).await?)
}

async fn post(State(service): State<Arc<Service>>, sent: Sent) -> Result<Response, Refused> {
    let Sent { context, body } = sent;
    let bytes = body.len();
    let read = move |service: &Service, _: &Stop| {
        let values = read_members(&body, groups::ARRANGEMENT)?;
        ArrangementQuery::check(&values, &service.catalog())
    };
    let query = service.process(bytes, read).await??;
    Ok(answer(&service, &context, query).await?)
}

async fn answer(
    service: &Service,
    context: &Context,
    query: ArrangementQuery,
) -> Result<Response, Error> {
    let facts = query.facts();
    let Some(list) = query.list else {
        return document::json(&facts);
    };
    Record::in_format(list.name());
    let (permit, listing) = service.list(&context.caller, &query).await?;
    let (count, next) = (listing.count, listing.cursor());
    let body = match context.method == Method::HEAD {
        true => crate::rest::coding::unknown_length(),
        false => {
            let blocks = service.stream(permit, listing.text(list, &facts));
            Body::from_stream(blocks.map(|made| {
                made?.map_err(|error| {
                    tracing::error!(%error, "a list of occurrences broke off");
                    Interrupted::Failed
                })
            }))
        }
    };
    let mut response = document::file(body, list.content_type());
    let headers = response.headers_mut();
    headers.insert(COUNT, count.into());
    if let Some(next) = next.and_then(|next| HeaderValue::from_str(&next).ok()) {
        headers.insert(NEXT, next);
    }
    Ok(response)
}
