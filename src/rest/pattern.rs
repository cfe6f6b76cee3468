//! `/v1/pattern/…`: what is known of the pattern of any α, without a table: arrangements (facts, counts and lists of
//! occurrences), shapes of clusters, neighborhood maps, figures.

use std::{
    pin::pin,
    sync::{Arc, LazyLock},
};

use axum::extract::State;
use futures_util::StreamExt as _;
use http::{HeaderValue, Method};
use schemars::JsonSchema;
use serde_json::json;
use strew_core::server::Stop;
use strew_error::{Error, Kind, integer::Long};
use strew_query::{groups, read_members};
use strew_service::{
    Interrupted, Record, Service,
    pattern::{
        ArrangementQuery, ClustersDocument, ClustersQuery, Facts, Figure, FigureQuery, Format,
        MapDocument, MapQuery,
    },
};

use super::{
    Refused,
    answer::{COUNT, NEXT},
    api::{
        self, Endpoint, Operation, Tag,
        schemas::{self, ArrangementQuery as ArrangementBody},
    },
    coding::unknown_length,
    context::{Answered, Context, Sent, Shared},
    document,
};
use crate::body::{Body, Response};

pub(super) fn endpoints(service: &Arc<Service>) -> Vec<Endpoint> {
    let mut all = vec![arrangements(service), clusters(service), map(service)];
    for (described, [svg, png]) in FIGURES.into_iter().zip(&*NAMED) {
        all.push(figure(service, described, Format::Svg, svg));
        all.push(figure(service, described, Format::Png, png));
    }
    all
}

const ABOUT: &str = "An arrangement is a point of the pattern with others at some offsets from it. It exists iff its image in \
     index space fits the set region, and the area of the margin that is left is the exact density of its \
     occurrences. In a box of the grid occurrences are counted in closed form, whatever its size; list returns \
     every one of them, and with an amount the displaced places of its points.";

fn arrangements(service: &Arc<Service>) -> Endpoint {
    let path = "/v1/pattern/arrangements";
    let given = Operation {
        id: "getArrangement",
        summary: "An arrangement, and where it occurs",
        about: ABOUT,
        parameters: groups::ARRANGEMENT,
        problems: vec![
            Kind::Invalid,
            Kind::OtherTable,
            Kind::TooManyPoints,
            Kind::TooManyStreams,
            Kind::ShuttingDown,
        ],
        example: format!("'{path}?alpha=sqrt(3)&offsets=2,0+1,2&grid=0,0,40,40'"),
        ..Operation::new(Tag::Patterns, described().or_unchanged())
    };
    let body = json!({ "alpha": "sqrt(3)", "offsets": [[2, 0], [1, 2]], "grid": [0, 0, 40, 40] });
    let posted = Operation {
        id: "findArrangement",
        parameters: groups::NONE,
        answers: vec![described()],
        ..given
            .clone()
            .posted(path, schemas::of::<ArrangementBody>, body)
    };
    Endpoint::only(path, service.clone(), given, get).with(service.clone(), posted, post)
}

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
            (document::JSON, schemas::of::<ArrangementAnswer>),
            ("application/x-ndjson", schemas::any),
            ("text/csv", schemas::text),
        ],
    }
}

/// An arrangement, alone or with a list.
#[derive(JsonSchema)]
#[serde(untagged)]
#[allow(dead_code, reason = "only described")]
enum ArrangementAnswer {
    /// Without a list.
    Facts(Facts),
    /// With list=json.
    Listed(ArrangementList),
}

/// An arrangement with its occurrences.
#[derive(JsonSchema)]
#[allow(dead_code, reason = "only described; a stream writes it")]
struct ArrangementList {
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
#[allow(dead_code, reason = "only described; a stream writes it")]
struct Occurrence {
    /// The column and the row of its first point, which are the point's id.
    at: [Long<i64>; 2],
    /// With an amount: the places of its points, the first one and those at the offsets.
    #[schemars(default)]
    places: Option<Vec<[f64; 2]>>,
}

async fn get(State(service): Shared, context: Context) -> Answered {
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

async fn post(State(service): Shared, Sent { context, body }: Sent) -> Answered {
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
        true => unknown_length(),
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

fn clusters(service: &Arc<Service>) -> Endpoint {
    let answers = api::Answer::json::<ClustersDocument>("The clusters.").or_unchanged();
    let operation = Operation {
        id: "getClusters",
        summary: "The shapes of clusters of pattern points",
        about: "Points at most a distance apart are neighbors, and points that neighbors connect are a cluster. \
                Exact up to a number of points: the density of a shape is the area of index space that holds \
                its first points. A search that takes too long ends with its client, or with the time for an \
                answer.",
        parameters: groups::CLUSTERS,
        example: "'/v1/pattern/clusters?alpha=sqrt(3)&distance=2&up_to=symmetry'".into(),
        ..Operation::new(Tag::Patterns, answers)
    };
    let get = async |State(service): Shared, context: Context| {
        let query = ClustersQuery::check(&context.values(groups::CLUSTERS))?;
        let make = service.clusters(&context.caller, query, move |found| {
            document::json(&query.document(found))
        });
        Ok::<_, Refused>(context.answer(document::JSON, &(), pin!(make)).await?)
    };
    Endpoint::only("/v1/pattern/clusters", service.clone(), operation, get)
}

fn map(service: &Arc<Service>) -> Endpoint {
    let answers = api::Answer::json::<MapDocument>("The map.").or_unchanged();
    let operation = Operation {
        id: "getMap",
        summary: "A neighborhood map",
        about: "The intervals of index space along each axis, whose pairs are the blocks; all points of a block \
                have the same neighbors up to the half-width R. A larger R refines the map. The number of \
                intervals grows linearly, by 2(α − 1) for each grid unit.",
        parameters: groups::MAP,
        example: "'/v1/pattern/map?alpha=sqrt(3)&radius=10&refined=20&block=3,4'".into(),
        ..Operation::new(Tag::Patterns, answers)
    };
    let get = async |State(service): Shared, context: Context| {
        let query = MapQuery::check(&context.values(groups::MAP))?;
        let make = service.map(&context.caller, query, |map| document::json(&map));
        Ok::<_, Refused>(context.answer(document::JSON, &(), pin!(make)).await?)
    };
    Endpoint::only("/v1/pattern/map", service.clone(), operation, get)
}

/// The figures, with their names, a few words and the rest of the address of an example.
const FIGURES: [(Figure, &str, &str, &str); 4] = [
    (
        Figure::Index,
        "Index",
        "A figure of the pattern, the index torus and the set region",
        "alpha=sqrt(3)&window=32",
    ),
    (
        Figure::Arrangement,
        "Arrangement",
        "A figure of an arrangement, its image and its margin",
        "offsets=2,1+3,3",
    ),
    (
        Figure::Clusters,
        "Clusters",
        "A figure of clusters in the plane and in the set region",
        "alpha=sqrt(3)&distance=2&window=32",
    ),
    (
        Figure::Map,
        "Map",
        "A figure of a neighborhood map, a block's neighbors and the growth with R",
        "radius=20&block=3,8",
    ),
];

/// The path of each figure as SVG and as PNG, and the id of its operation.
static NAMED: LazyLock<[[[String; 2]; 2]; 4]> = LazyLock::new(|| {
    FIGURES.map(|(_, name, ..)| {
        [("svg", "Figure"), ("png", "Picture")].map(|(ending, of)| {
            let path = format!("/v1/pattern/figures/{}.{ending}", name.to_lowercase());
            [path, format!("get{name}{of}")]
        })
    })
});

fn figure(
    service: &Arc<Service>,
    (figure, _, summary, query): (Figure, &str, &'static str, &str),
    format: Format,
    [path, id]: &'static [String; 2],
) -> Endpoint {
    let (content, ending, more) = match format {
        Format::Svg => (schemas::text as schemas::Content, "svg", ""),
        Format::Png => (schemas::any as schemas::Content, "png", "&size=800"),
    };
    let content_type = format.content_type();
    let answers = api::Answer::file("The figure.", content_type, content).or_unchanged();
    let operation = Operation {
        id,
        summary,
        about: "As strew figure draws it, for any α.",
        parameters: figure.groups(format),
        example: format!("'{path}?{query}{more}' -o figure.{ending}"),
        ..Operation::new(Tag::Patterns, answers)
    };
    let get = move |State(service): Shared, context: Context| async move {
        let query = FigureQuery::check(figure, &context.values(figure.groups(format)))?;
        let make = async {
            let file = service.figure(&context.caller, query, format).await?;
            Ok(document::file(file, content_type))
        };
        Ok::<_, Refused>(context.answer(content_type, &(), pin!(make)).await?)
    };
    Endpoint::only(path, service.clone(), operation, get)
}
