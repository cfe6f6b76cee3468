//! `GET /v1/worlds`: the worlds that are loaded, one of them, and its chunks.

use std::sync::Arc;

use axum::extract::State;
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::value::RawValue;
use strew_error::{Error, Kind};
use strew_query::{Draft, Parameter, Value, World, groups, parameters::WORLD};
use strew_service::Service;

use super::{
    answer,
    api::{self, Endpoint, Operation, Tag},
    context::Context,
    document,
    points::{self, COLUMN, ROW, SIZE},
};
use crate::{body::Response, rest::Refused};

const NAME: Parameter = Parameter {
    name: "name",
    about: "The name of a world. The list of worlds shows what is loaded.",
    allowed: Some("the name of a loaded world"),
    is_required: true,
    example: "forest",
    ..Parameter::PLAIN
};

/// The path of the list.
pub(super) fn list(service: Arc<Service>) -> Endpoint {
    let operation = Operation {
        id: "listWorlds",
        summary: "The worlds that are loaded",
        about: "Worlds of the daemon's configuration and of its folder, which queries name.",
        example: "/v1/worlds".into(),
        ..Operation::new(
            Tag::Worlds,
            api::Answer::json::<List<'_>>("The list, sorted by name.").or_unchanged(),
        )
    };
    Endpoint::only("/v1/worlds", service, operation, all)
}

/// The path of one world.
pub(super) fn endpoint(service: Arc<Service>) -> Endpoint {
    let operation = Operation {
        id: "getWorld",
        summary: "One world",
        about: "Its digest and its description.",
        example: "/v1/worlds/forest".into(),
        ..operation(api::Answer::json::<Described<'_>>("The world."))
    };
    Endpoint::only("/v1/worlds/{name}", service, operation, one)
}

/// The path of chunks.
pub(super) fn chunks(service: Arc<Service>) -> Endpoint {
    let operation = Operation {
        id: "getWorldChunk",
        summary: "The points of a chunk of a world",
        about: "As a chunk of /v1/chunks with world. Parameters are stronger than the world's: seed is the common \
                seed of its layers, only the one layer that is wanted.",
        tag: Tag::Points,
        path_parameters: &[&NAME, &SIZE, &COLUMN, &ROW],
        parameters: groups::WORLD_CHUNK,
        problems: [answer::problems(), vec![Kind::NoSuchPath]].concat(),
        example: "'/v1/worlds/forest/chunks/64/3/-2?format=csv'".into(),
        ..operation(answer::described())
    };
    Endpoint::only(
        "/v1/worlds/{name}/chunks/{size}/{cx}/{cy}",
        service,
        operation,
        chunk,
    )
}

/// The parts that the operations share.
fn operation(answer: api::Answer) -> Operation {
    Operation {
        path_parameters: &[&NAME],
        problems: vec![Kind::Invalid, Kind::NoSuchPath],
        ..Operation::new(Tag::Worlds, answer.or_unchanged())
    }
}

/// The worlds that are loaded.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "Worlds")]
struct List<'a> {
    /// Sorted by name.
    worlds: Vec<Summary<'a>>,
}

/// A world that is loaded.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "LoadedWorld")]
struct Summary<'a> {
    /// Its name.
    name: &'a str,
    /// The BLAKE3 digest of all that its points depend on.
    digest: &'a str,
    /// The names of its layers; none if it is one set of points.
    layers: &'a [String],
}

/// A world that is loaded, with its description.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "DescribedWorld")]
struct Described<'a> {
    #[serde(flatten)]
    summary: Summary<'a>,
    /// Members of a query: those that it lacks are taken from here.
    #[schemars(with = "serde_json::Map<String, serde_json::Value>")]
    query: &'a RawValue,
}

impl<'a> Summary<'a> {
    fn new(world: &'a World) -> Self {
        Self {
            name: &world.name,
            digest: &world.digest,
            layers: &world.layers,
        }
    }
}

async fn all(State(service): State<Arc<Service>>, context: Context) -> Result<Response, Refused> {
    context.values(groups::NONE).read()?;
    let catalog = service.catalog();
    let worlds = List {
        worlds: (catalog.worlds.iter())
            .map(|world| Summary::new(world))
            .collect(),
    };
    Ok(context.document(&worlds).await?)
}

async fn one(State(service): State<Arc<Service>>, context: Context) -> Result<Response, Refused> {
    let [name] = context.path();
    context.values(groups::NONE).read()?;
    let world = named(&service, name, &context)?;
    let described = Described::new(&world)?;
    Ok(context.document(&described).await?)
}

impl<'a> Described<'a> {
    fn new(world: &'a World) -> Result<Self, Error> {
        let unreadable = |_| Error::Internal("a world is no JSON");
        Ok(Self {
            summary: Summary::new(world),
            query: serde_json::from_str(&world.json).map_err(unreadable)?,
        })
    }
}

/// The body of the answer to `/v1/worlds/{name}`.
pub fn world_document(world: &World) -> Result<Vec<u8>, Error> {
    document::written(&Described::new(world)?)
}

async fn chunk(State(service): State<Arc<Service>>, context: Context) -> Result<Response, Refused> {
    let [name, size, x, y] = context.path();
    named(&service, name, &context)?;
    let mut values = context.values(groups::WORLD_CHUNK);
    values.replace(&WORLD, Some(Value::Text(name.into())));
    let draft = Draft::new(values).within(points::square([size, x, y]));
    points::stream(&service, &context, &draft).await
}

/// The world of a path.
fn named(service: &Service, name: &str, context: &Context) -> Result<Arc<World>, Error> {
    let catalog = service.catalog();
    let names = || catalog.worlds.names();
    let world = catalog.worlds.get(name).cloned();
    world.ok_or_else(|| context.nothing(format!("/v1/worlds/{{name}}, where name is {}", names())))
}
