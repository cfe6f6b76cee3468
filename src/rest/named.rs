//! What is loaded by name: lists of points that are left out, worlds, fields. Each is listed; of worlds and fields there
//! is one by its name, and its chunks; a client may send lists and fields to be named later.

use std::{pin::pin, sync::Arc};

use axum::extract::State;
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::{json, value::RawValue};
use strew_catalog::{
    except::{NamedList, Section},
    field::{self, Document, NamedField, SIDE},
};
use strew_core::server::Stop;
use strew_error::{Error, Kind, Together as _};
use strew_query::{Draft, Parameter, Value, World, groups, parameters::WORLD};
use strew_service::Service;

use super::{
    answer,
    api::{self, Endpoint, Operation, Tag, schemas},
    context::{Answered, BODY_COPIES, Context, Sent, Shared},
    document,
    points::{self, COLUMN, ROW, SIZE},
};

/// A thing in a path by its name.
const fn name(about: &'static str, allowed: &'static str) -> Parameter {
    Parameter {
        name: "name",
        about,
        allowed: Some(allowed),
        is_required: true,
        example: "forest",
        ..Parameter::PLAIN
    }
}

const WORLD_NAME: Parameter = name(
    "The name of a world. The list of worlds shows what is loaded.",
    "the name of a loaded world",
);
const FIELD_NAME: Parameter = name(
    "The name of a field. The list of fields shows what is loaded.",
    "the name of a loaded field",
);

/// The operation on one thing of a path that may name nothing.
fn of_one(tag: Tag, parameters: &'static [&'static Parameter], answer: api::Answer) -> Operation {
    Operation {
        path_parameters: parameters,
        problems: vec![Kind::Invalid, Kind::NoSuchPath],
        ..Operation::new(tag, answer.or_unchanged())
    }
}

pub(super) fn except(service: &Arc<Service>) -> Endpoint {
    let answers = api::Answer::json::<ExceptLists<'_>>("The lists, sorted by name.");
    let listed = Operation {
        id: "listExcept",
        summary: "The lists of points that are left out",
        about: "Lists of the daemon's configuration and of its folder, for the parameter except.",
        ..Operation::new(Tag::Worlds, answers.or_unchanged())
    };
    let answer = "The list that is held; its name is its digest.";
    let answer = api::Answer::json::<ExceptList<'_>>(answer);
    let example = json!({ "ids": ["trees/18:-17", "trees/23:-15"] });
    let sent = Operation {
        id: "sendExcept",
        summary: "Sends a list of points to be named later",
        about: "Queries name it by its digest: except=DIGEST. The body is an object, or text with an id a line, where \
                what follows # is a comment. The list is held while there is room; a query that names one that is \
                gone is refused, and the client sends the list again.",
        ..Operation::new(Tag::Worlds, vec![answer])
    };
    let sent = sent.posted("/v1/except", schemas::of::<Section<'_>>, example);
    let endpoint = Endpoint::only("/v1/except", service.clone(), listed, lists);
    endpoint.with(service.clone(), sent, hold_list)
}

/// The lists of points that queries may leave out.
#[derive(Serialize, JsonSchema)]
struct ExceptLists<'a> {
    /// Sorted by name.
    lists: Vec<ExceptList<'a>>,
}

/// A list of points.
#[derive(Serialize, JsonSchema)]
struct ExceptList<'a> {
    /// Its name.
    name: &'a str,
    /// The BLAKE3 digest of its ids.
    digest: &'a str,
    /// The number of ids.
    count: usize,
    /// The layers that it has ids of; none if its ids are of no layer.
    layers: Vec<&'a str>,
}

impl<'a> ExceptList<'a> {
    fn new(list: &'a Arc<NamedList>) -> Self {
        Self {
            name: &list.name,
            digest: &list.digest,
            count: list.len(),
            layers: list.layers().collect(),
        }
    }
}

async fn lists(State(service): Shared, context: Context) -> Answered {
    context.values(groups::NONE).read()?;
    let catalog = service.catalog();
    let lists = catalog.except().iter().map(ExceptList::new).collect();
    Ok(context.document(&ExceptLists { lists }).await?)
}

async fn hold_list(State(service): Shared, Sent { body, .. }: Sent) -> Answered {
    let bytes = body.len();
    let hold = move |service: &Service, _: &Stop| service.hold_list(&body);
    let held = service.process(bytes, hold).await??;
    Ok(document::json(&ExceptList::new(&held))?)
}

pub(super) fn worlds(service: &Arc<Service>) -> [Endpoint; 3] {
    let answers = api::Answer::json::<Worlds<'_>>("The list, sorted by name.");
    let listed = Operation {
        id: "listWorlds",
        summary: "The worlds that are loaded",
        about: "Worlds of the daemon's configuration and of its folder, which queries name.",
        ..Operation::new(Tag::Worlds, answers.or_unchanged())
    };
    let answer = api::Answer::json::<DescribedWorld<'_>>("The world.");
    let one = Operation {
        id: "getWorld",
        summary: "One world",
        about: "Its digest and its description.",
        example: "/v1/worlds/forest".into(),
        ..of_one(Tag::Worlds, &[&WORLD_NAME], answer)
    };
    let at = &[&WORLD_NAME, &SIZE, &COLUMN, &ROW];
    let chunk = Operation {
        id: "getWorldChunk",
        summary: "The points of a chunk of a world",
        about: "As a chunk of /v1/chunks with world. Parameters are stronger than the world's: seed is the common \
                seed of its layers, only the one layer that is wanted.",
        parameters: groups::WORLD_CHUNK,
        problems: [answer::problems(), vec![Kind::NoSuchPath]].concat(),
        example: "'/v1/worlds/forest/chunks/64/3/-2?format=csv'".into(),
        ..of_one(Tag::Points, at, answer::described())
    };
    let chunks = "/v1/worlds/{name}/chunks/{size}/{cx}/{cy}";
    [
        Endpoint::only("/v1/worlds", service.clone(), listed, all_worlds),
        Endpoint::only("/v1/worlds/{name}", service.clone(), one, one_world),
        Endpoint::only(chunks, service.clone(), chunk, world_chunk),
    ]
}

/// The worlds that are loaded.
#[derive(Serialize, JsonSchema)]
struct Worlds<'a> {
    /// Sorted by name.
    worlds: Vec<LoadedWorld<'a>>,
}

/// A world that is loaded.
#[derive(Serialize, JsonSchema)]
struct LoadedWorld<'a> {
    /// Its name.
    name: &'a str,
    /// The BLAKE3 digest of all that its points depend on.
    digest: &'a str,
    /// The names of its layers; none if it is one set of points.
    layers: &'a [String],
}

impl<'a> LoadedWorld<'a> {
    fn new(world: &'a World) -> Self {
        Self {
            name: &world.name,
            digest: &world.digest,
            layers: &world.layers,
        }
    }
}

/// A world that is loaded, with its description.
#[derive(Serialize, JsonSchema)]
struct DescribedWorld<'a> {
    #[serde(flatten)]
    summary: LoadedWorld<'a>,
    /// Members of a query: those that it lacks are taken from here.
    #[schemars(with = "serde_json::Map<String, serde_json::Value>")]
    query: &'a RawValue,
}

impl<'a> DescribedWorld<'a> {
    fn new(world: &'a World) -> Result<Self, Error> {
        let unreadable = |_| Error::Internal("a world is no JSON");
        Ok(Self {
            summary: LoadedWorld::new(world),
            query: serde_json::from_str(&world.json).map_err(unreadable)?,
        })
    }
}

/// The body of the answer to `/v1/worlds/{name}`.
pub fn world_document(world: &World) -> Result<Vec<u8>, Error> {
    document::written(&DescribedWorld::new(world)?)
}

async fn all_worlds(State(service): Shared, context: Context) -> Answered {
    context.values(groups::NONE).read()?;
    let catalog = service.catalog();
    let worlds = catalog.worlds.iter();
    let worlds = worlds.map(|world| LoadedWorld::new(world)).collect();
    Ok(context.document(&Worlds { worlds }).await?)
}

async fn one_world(State(service): Shared, context: Context) -> Answered {
    let [name] = context.path();
    context.values(groups::NONE).read()?;
    let world = world(&service, name, &context)?;
    let described = DescribedWorld::new(&world)?;
    Ok(context.document(&described).await?)
}

async fn world_chunk(State(service): Shared, context: Context) -> Answered {
    let [name, size, x, y] = context.path();
    world(&service, name, &context)?;
    let mut values = context.values(groups::WORLD_CHUNK);
    values.replace(&WORLD, Some(Value::Text(name.into())));
    let draft = Draft::new(values).within(points::square([size, x, y]));
    points::stream(&service, &context, &draft).await
}

fn world(service: &Service, name: &str, context: &Context) -> Result<Arc<World>, Error> {
    let worlds = &service.catalog().worlds;
    let nothing = || context.nothing_named("/v1/worlds/{name}", &worlds.names());
    worlds.get(name).cloned().ok_or_else(nothing)
}

const PNG: &str = "image/png";

pub(super) fn fields(service: &Arc<Service>) -> [Endpoint; 3] {
    let answers = api::Answer::json::<Fields<'_>>("The list, sorted by name.");
    let listed = Operation {
        id: "listFields",
        summary: "The fields that are loaded",
        about: "Fields of the daemon's configuration and of its folder, which queries name.",
        ..Operation::new(Tag::Fields, answers.or_unchanged())
    };
    let answer = "The field that is held; its name is its digest.";
    let answer = api::Answer::json::<LoadedField<'_>>(answer);
    let example = json!({ "radial": { "center": [10, 10], "radii": [5, 20] } });
    let sent = Operation {
        id: "sendField",
        summary: "Sends a field to be named later",
        about: "Queries name it by its digest: field=DIGEST. So a mask is sent once, and used chunk by chunk. \
                It is held while there is room; a query that names one that is gone is refused, \
                and the client sends the field again.",
        ..Operation::new(Tag::Fields, vec![answer])
    };
    let sent = sent.posted("/v1/fields", schemas::of::<Document>, example);
    let answer = api::Answer::json::<DescribedField<'_>>("The field.");
    let one = Operation {
        id: "getField",
        summary: "One field",
        about: "Its digest and its description; of pixels only the name of their file.",
        example: "/v1/fields/forest".into(),
        ..of_one(Tag::Fields, &[&FIELD_NAME], answer)
    };
    let at = &[&FIELD_NAME, &SIZE, &COLUMN, &ROW];
    let answer = api::Answer::file("The picture.", PNG, schemas::any);
    let chunk = Operation {
        id: "getFieldChunk",
        summary: "A picture of a field on a chunk",
        about: "256 × 256 pixels, whose gray is the share at their centers: black for 0, white for 1. Chunks \
                are those of the points.",
        example: "/v1/fields/forest/chunks/64/0/0 -o field.png".into(),
        ..of_one(Tag::Fields, at, answer)
    };
    let chunks = "/v1/fields/{name}/chunks/{size}/{cx}/{cy}";
    let all = Endpoint::only("/v1/fields", service.clone(), listed, all_fields);
    [
        all.with(service.clone(), sent, hold_field),
        Endpoint::only("/v1/fields/{name}", service.clone(), one, one_field),
        Endpoint::only(chunks, service.clone(), chunk, field_chunk),
    ]
}

/// The fields that are loaded.
#[derive(Serialize, JsonSchema)]
struct Fields<'a> {
    /// Sorted by name.
    fields: Vec<LoadedField<'a>>,
}

/// A field that is loaded.
#[derive(Serialize, JsonSchema)]
struct LoadedField<'a> {
    /// Its name.
    name: &'a str,
    /// The BLAKE3 digest of all that its shares depend on.
    digest: String,
    /// The shape that it is.
    shape: &'static str,
    /// The number of shapes in it.
    parts: usize,
    /// A box around its pixels, if it has any: min x, min y, max x, max y.
    #[serde(skip_serializing_if = "Option::is_none")]
    bbox: Option<[f64; 4]>,
}

impl<'a> LoadedField<'a> {
    fn new(field: &'a NamedField) -> Self {
        Self {
            name: &field.name,
            digest: field.digest(),
            shape: field.document.shape(),
            parts: field.spec.parts(),
            bbox: field.bbox,
        }
    }
}

/// A field that is loaded, with its description.
#[derive(Serialize, JsonSchema)]
struct DescribedField<'a> {
    #[serde(flatten)]
    summary: LoadedField<'a>,
    /// Its description.
    field: Document,
}

async fn all_fields(State(service): Shared, context: Context) -> Answered {
    context.values(groups::NONE).read()?;
    let catalog = service.catalog();
    let fields = catalog.fields().iter();
    let fields = fields.map(|field| LoadedField::new(field)).collect();
    Ok(context.document(&Fields { fields }).await?)
}

async fn hold_field(State(service): Shared, Sent { body, .. }: Sent) -> Answered {
    let (bytes, budget) = (body.len(), service.own_budget());
    let read = move || {
        let _held = budget.hold(BODY_COPIES * body.len())?;
        let text = String::from_utf8_lossy(&body);
        Ok(field::read_json("field", text.trim())?)
    };
    let held = service.read(bytes, read, Document::price, Service::hold_field);
    let held = held.await?;
    Ok(document::json(&LoadedField::new(&held))?)
}

async fn one_field(State(service): Shared, context: Context) -> Answered {
    let [name] = context.path();
    context.values(groups::NONE).read()?;
    let field = field(&service, name, &context)?;
    let described = DescribedField {
        summary: LoadedField::new(&field),
        field: field.document.without_folders(),
    };
    Ok(context.document(&described).await?)
}

async fn field_chunk(State(service): Shared, context: Context) -> Answered {
    let [name, size, x, y] = context.path();
    context.values(groups::NONE).read()?;
    let field = field(&service, name, &context)?;
    let (size, x, y) = (SIZE.read(size), COLUMN.read(x), ROW.read(y)).together()?;
    let parts = field.spec.parts();
    let digest = field.digest();
    let price = field.picture_price(size, [x, y]);
    let make = async {
        context.caller.charge(price)?;
        let draw = move |_: &Service, stop: &Stop| field.picture(size, [x, y], stop);
        let picture = service.process(SIDE * SIDE * parts, draw).await??;
        Ok(document::file(picture, PNG))
    };
    Ok(context.answer(PNG, &digest, pin!(make)).await?)
}

fn field(service: &Service, name: &str, context: &Context) -> Result<Arc<NamedField>, Error> {
    let catalog = service.catalog();
    let nothing = || context.nothing_named("/v1/fields/{name}", &catalog.fields().names());
    catalog.field(name).ok_or_else(nothing)
}
