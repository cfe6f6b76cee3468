//! `/v1/space/…`: points in space. The paths, their parameters and bodies are those of the plane with a third axis.

use std::sync::Arc;

use axum::extract::State;
use http::Method;
use serde_json::{Value, json};
use strew_core::server::Stop;
use strew_error::{Checked, Kind, Together as _};
use strew_query::{Draft, Parameter, RegionDraft, Shape, ShapeDraft, VolumeDraft, groups};
use strew_service::Service;

use super::{
    answer,
    api::{
        self, Endpoint, Operation, Tag,
        schemas::{self, SpaceQuery},
    },
    body,
    chunks::{COLUMN, ROW, SIZE},
    context::{Context, Posted, Sent},
    count::{self, Count},
    profiles, query, single,
    split::{self, Split},
};
use crate::{body::Response, rest::Refused};

/// The paths.
pub(super) fn endpoints(service: &Arc<Service>) -> Vec<Endpoint> {
    vec![
        points(service),
        chunks(service),
        counts(service),
        parts(service),
        by_id(service),
        nearest(service),
        listed(service),
    ]
}

fn example() -> Value {
    json!({ "region": { "ball": { "center": [5, 5, 5], "radius": 2 } }, "spacing": 1, "format": "csv" })
}

fn points(service: &Arc<Service>) -> Endpoint {
    let about = "Streams every point of a half-open box or a ball, in a fixed order. Ids are x:y:z. With png the \
                 points are seen along z, as a slab.";
    let given = Operation {
        id: "getSpacePoints",
        summary: "The points of a volume",
        about,
        parameters: groups::SPACE_POINTS,
        problems: answer::problems(),
        example: "'/v1/space/points?bbox=0,0,0,2,2,1&spacing=1&format=csv'".into(),
        ..Operation::new(Tag::Space, answer::described().or_unchanged())
    };
    let posted = Operation {
        method: Method::POST,
        id: "querySpacePoints",
        summary: "The points of any volume, in layers",
        about: "The same as GET, with volumes of all kinds and several layers at once, streamed one after another \
                in one answer.",
        body: Some(query::body(schemas::of::<SpaceQuery>, example())),
        problems: [answer::problems(), vec![Kind::BodyTooLarge]].concat(),
        example: format!("/v1/space/points -d '{}'", example()),
        ..Operation::new(Tag::Space, vec![answer::described()])
    };
    Endpoint::new("/v1/space/points")
        .with(service.clone(), given, get_points)
        .with(service.clone(), posted, post_points)
}

async fn get_points(
    State(service): State<Arc<Service>>,
    context: Context,
) -> Result<Response, Refused> {
    let draft = Draft::of(context.values(groups::SPACE_POINTS));
    let (query, options) = service.check(&draft, &Stop::NEVER)?;
    Ok(answer::stream(&service, &context, query, options).await?)
}

async fn post_points(State(service): State<Arc<Service>>, sent: Sent) -> Result<Response, Refused> {
    let Sent { context, body } = sent;
    let (_, query, options) = body::query(&service, body, groups::SPACE_QUERY).await?;
    Ok(answer::stream(&service, &context, query, options).await?)
}

const LEVEL: Parameter = Parameter {
    name: "cz",
    about: "The level of the chunk.",
    shape: COLUMN.shape,
    example: "0",
    is_required: true,
    ..Parameter::PLAIN
};

fn chunks(service: &Arc<Service>) -> Endpoint {
    let operation = Operation {
        id: "getSpaceChunk",
        summary: "The points of a chunk of space",
        about: "A chunk is a cube of the world grid: size·cx ≤ x < size·(cx + 1), and so for y and z. Coordinates are \
                relative to its corner. Neighbors share no point and lose none.",
        path_parameters: &[&SIZE, &COLUMN, &ROW, &LEVEL],
        parameters: groups::SPACE_QUERY,
        problems: answer::problems(),
        example: "'/v1/space/chunks/16/-3/2/0?spacing=8&format=csv'".into(),
        ..Operation::new(Tag::Space, answer::described().or_unchanged())
    };
    let path = "/v1/space/chunks/{size}/{cx}/{cy}/{cz}";
    Endpoint::only(path, service.clone(), operation, get_chunk)
}

async fn get_chunk(
    State(service): State<Arc<Service>>,
    context: Context,
) -> Result<Response, Refused> {
    let draft = Draft::new(context.values(groups::SPACE_QUERY)).within(chunk(context.path()));
    let (query, options) = service.check(&draft, &Stop::NEVER)?;
    Ok(answer::stream(&service, &context, query, options).await?)
}

/// The region of a path.
fn chunk([size, x, y, z]: [&str; 4]) -> Checked<RegionDraft> {
    let address = (SIZE.read(size), COLUMN.read(x), ROW.read(y), LEVEL.read(z));
    address.together().map(|(size, x, y, z)| RegionDraft {
        path: "chunk".into(),
        shape: ShapeDraft::Volume(VolumeDraft::Chunk(size, [x, y, z])),
    })
}

fn counts(service: &Arc<Service>) -> Endpoint {
    let about = "Exact, in a fraction of a millisecond for a box without warp, whatever it holds; otherwise in time \
                 proportional to its surface.";
    let answers = || api::Answer::json::<Count>("The count.");
    let given = Operation {
        id: "getSpaceCount",
        summary: "The number of points of a volume",
        about,
        parameters: groups::SPACE_COUNT,
        problems: count::problems(),
        example: "'/v1/space/count?bbox=-5e8,-5e8,-5e8,5e8,5e8,5e8&spacing=1'".into(),
        ..Operation::new(Tag::Space, answers().or_unchanged())
    };
    let region = json!({ "ball": { "center": [0, 0, 0], "radius": 9 } });
    let body = json!({ "region": region, "spacing": 1 });
    let posted = Operation {
        method: Method::POST,
        id: "countSpacePoints",
        summary: "The number of points of a query in space",
        about,
        example: format!("/v1/space/count -d '{body}'"),
        body: Some(query::body(schemas::of::<SpaceQuery>, body)),
        problems: [count::problems(), vec![Kind::BodyTooLarge]].concat(),
        ..Operation::new(Tag::Space, vec![answers()])
    };
    Endpoint::new("/v1/space/count")
        .with(service.clone(), given, get_count)
        .with(service.clone(), posted, post_count)
}

async fn get_count(
    State(service): State<Arc<Service>>,
    context: Context,
) -> Result<Response, Refused> {
    count::given(&service, &context, groups::SPACE_COUNT).await
}

async fn post_count(State(service): State<Arc<Service>>, sent: Sent) -> Result<Response, Refused> {
    count::posted(&service, sent, groups::SPACE_QUERY).await
}

fn parts(service: &Arc<Service>) -> Endpoint {
    let region = json!({ "bbox": [0, 0, 0, 4, 4, 4] });
    let body = json!({ "region": region, "spacing": 1 });
    let operation = Operation {
        method: Method::POST,
        id: "splitSpacePoints",
        summary: "A query in space in parts",
        about: "Queries of equal numbers of points, give or take one, that together return the points of the query in \
                its order; each is a body of POST /v1/space/points. Parts without points are left out.",
        parameters: groups::SPLIT,
        example: format!("'/v1/space/points:split?parts=2' -d '{body}'"),
        body: Some(query::body(schemas::of::<SpaceQuery>, body)),
        problems: [count::problems(), vec![Kind::BodyTooLarge]].concat(),
        ..Operation::new(Tag::Space, vec![api::Answer::json::<Split>("The parts.")])
    };
    Endpoint::only(
        "/v1/space/points:split",
        service.clone(),
        operation,
        post_parts,
    )
}

async fn post_parts(
    State(service): State<Arc<Service>>,
    Posted { context, body }: Posted,
) -> Result<Response, Refused> {
    split::posted(service, context, body, groups::SPACE_QUERY).await
}

const ID: Parameter = Parameter {
    name: "id",
    about: "The stable id of a point: its lattice address.",
    shape: Shape::Pattern("^-?[0-9]+:-?[0-9]+:-?[0-9]+$"),
    allowed: Some("three integers joined by colons, such as -31:52:7"),
    example: "0:0:0",
    is_required: true,
    ..Parameter::PLAIN
};

fn by_id(service: &Arc<Service>) -> Endpoint {
    let operation = Operation {
        id: "getSpacePoint",
        summary: "A point in space by its id",
        about: "The parameters of the query that returned the id find the point again.",
        path_parameters: &[&ID],
        parameters: groups::SPACE_SET,
        problems: vec![Kind::Invalid, Kind::OtherTable, Kind::NoSuchPoint],
        example: "'/v1/space/points/0:0:0?spacing=1&attributes=rotation'".into(),
        ..Operation::new(
            Tag::Space,
            api::Answer::json::<single::One>("The point.").or_unchanged(),
        )
    };
    Endpoint::only(
        "/v1/space/points/{id}",
        service.clone(),
        operation,
        get_point,
    )
}

async fn get_point(
    State(service): State<Arc<Service>>,
    context: Context,
) -> Result<Response, Refused> {
    single::by_id_in(&service, &context, groups::SPACE_SET).await
}

fn nearest(service: &Arc<Service>) -> Endpoint {
    let operation = Operation {
        id: "getSpaceNearest",
        summary: "The points in space nearest to a place",
        about: "Exact, nearest first; of equally near ones the smaller id first. With k and radius both must hold; at \
                most 10000 points.",
        parameters: groups::SPACE_NEAREST,
        problems: vec![Kind::Invalid, Kind::OtherTable],
        example: "'/v1/space/nearest?at=100.5,-3,12&k=2&spacing=1'".into(),
        ..Operation::new(
            Tag::Space,
            api::Answer::json::<single::Several>("The points.").or_unchanged(),
        )
    };
    Endpoint::only("/v1/space/nearest", service.clone(), operation, get_nearest)
}

fn listed(service: &Arc<Service>) -> Endpoint {
    let answer = api::Answer::json::<profiles::Profiles<'_>>("The tables.");
    let operation = Operation {
        id: "listSpaceProfiles",
        summary: "The tables of points in space",
        about: "The tables that are loaded, as GET /v1/profiles lists those of the plane.",
        example: "/v1/space/profiles".into(),
        ..Operation::new(Tag::Space, answer.or_unchanged())
    };
    Endpoint::only(
        "/v1/space/profiles",
        service.clone(),
        operation,
        get_profiles,
    )
}

async fn get_profiles(
    State(service): State<Arc<Service>>,
    context: Context,
) -> Result<Response, Refused> {
    context.values(groups::NONE).read()?;
    let catalog = service.catalog();
    let entries: Vec<_> = catalog.in_space().collect();
    profiles::list(&context, &catalog, &entries).await
}

async fn get_nearest(
    State(service): State<Arc<Service>>,
    context: Context,
) -> Result<Response, Refused> {
    single::near_in(&service, &context, groups::SPACE_NEAREST).await
}
