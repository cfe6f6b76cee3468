//! `GET /v1/fields`: the fields that are loaded, one of them, and its picture.

use std::{pin::pin, sync::Arc};

use axum::extract::State;
use http::Method;
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::json;
use strew_catalog::field::{self, Document, NamedField, SIDE};
use strew_core::server::Stop;
use strew_error::{Error, Kind, Together as _};
use strew_query::{Parameter, groups};
use strew_service::Service;

use super::{
    api::{self, Endpoint, Operation, Tag, schemas},
    body,
    context::{Context, Sent},
    document,
    points::{COLUMN, ROW, SIZE},
};
use crate::{body::Response, rest::Refused};

const NAME: Parameter = Parameter {
    name: "name",
    about: "The name of a field. The list of fields shows what is loaded.",
    allowed: Some("the name of a loaded field"),
    is_required: true,
    example: "forest",
    ..Parameter::PLAIN
};

/// The content type of pictures.
const PNG: &str = "image/png";

/// The path of the list.
pub(super) fn list(service: Arc<Service>) -> Endpoint {
    let listed = Operation {
        id: "listFields",
        summary: "The fields that are loaded",
        about: "Fields of the daemon's configuration and of its folder, which queries name.",
        example: "/v1/fields".into(),
        ..Operation::new(
            Tag::Fields,
            api::Answer::json::<Fields<'_>>("The list, sorted by name.").or_unchanged(),
        )
    };
    let sent = Operation {
        method: Method::POST,
        id: "sendField",
        summary: "Sends a field to be named later",
        about: "Queries name it by its digest: field=DIGEST. So a mask is sent once, and used chunk by chunk. \
                It is held while there is room; a query that names one that is gone is refused, \
                and the client sends the field again.",
        body: Some(api::Body::json(schemas::of::<Document>, example())),
        problems: vec![Kind::Invalid, Kind::BodyTooLarge],
        example: format!("/v1/fields -d '{}'", example()),
        ..Operation::new(
            Tag::Fields,
            vec![api::Answer::json::<Summary<'_>>(
                "The field that is held; its name is its digest.",
            )],
        )
    };
    Endpoint::new("/v1/fields")
        .with(service.clone(), listed, all)
        .with(service, sent, post)
}

fn example() -> serde_json::Value {
    json!({ "radial": { "center": [10, 10], "radii": [5, 20] } })
}

async fn post(State(service): State<Arc<Service>>, sent: Sent) -> Result<Response, Refused> {
    let Sent { body, .. } = sent;
    let (bytes, budget) = (body.len(), service.own_budget());
    let read = move || {
        let _held = budget.hold(body::COPIES * body.len())?;
        let text = String::from_utf8_lossy(&body);
        Ok(field::read_json("field", text.trim())?)
    };
    let hold =
        |service: &Service, document: Document, stop: &Stop| service.hold_field(document, stop);
    let held = service.read(bytes, read, Document::price, hold).await?;
    Ok(document::json(&Summary::new(&held))?)
}

/// The path of one field.
pub(super) fn endpoint(service: Arc<Service>) -> Endpoint {
    let operation = Operation {
        id: "getField",
        summary: "One field",
        about: "Its digest and its description; of pixels only the name of their file.",
        example: "/v1/fields/forest".into(),
        ..operation(api::Answer::json::<Described<'_>>("The field."))
    };
    Endpoint::only("/v1/fields/{name}", service, operation, one)
}

/// The path of pictures.
pub(super) fn picture(service: Arc<Service>) -> Endpoint {
    let operation = Operation {
        id: "getFieldChunk",
        summary: "A picture of a field on a chunk",
        about: "256 × 256 pixels, whose gray is the share at their centers: black for 0, white for 1. Chunks \
                are those of the points.",
        path_parameters: &[&NAME, &SIZE, &COLUMN, &ROW],
        example: "/v1/fields/forest/chunks/64/0/0 -o field.png".into(),
        ..operation(api::Answer::file("The picture.", PNG, schemas::any))
    };
    Endpoint::only(
        "/v1/fields/{name}/chunks/{size}/{cx}/{cy}",
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
        ..Operation::new(Tag::Fields, answer.or_unchanged())
    }
}

/// The fields that are loaded.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "Fields")]
struct Fields<'a> {
    /// Sorted by name.
    fields: Vec<Summary<'a>>,
}

/// A field that is loaded.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "LoadedField")]
struct Summary<'a> {
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

/// A field that is loaded, with its description.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "DescribedField")]
struct Described<'a> {
    #[serde(flatten)]
    summary: Summary<'a>,
    /// Its description.
    field: Document,
}

impl<'a> Summary<'a> {
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

async fn all(State(service): State<Arc<Service>>, context: Context) -> Result<Response, Refused> {
    context.values(groups::NONE).read()?;
    let catalog = service.catalog();
    let fields = || catalog.fields().iter();
    let made_of: Vec<(&str, String)> = fields().map(|f| (f.name.as_str(), f.digest())).collect();
    let make = async {
        document::json(&Fields {
            fields: fields().map(|field| Summary::new(field)).collect(),
        })
    };
    Ok(context.answer(document::JSON, &made_of, pin!(make)).await?)
}

async fn one(State(service): State<Arc<Service>>, context: Context) -> Result<Response, Refused> {
    let [name] = context.path();
    context.values(groups::NONE).read()?;
    let field = named(&service, name, &context)?;
    let described = Described {
        summary: Summary::new(&field),
        field: field.document.without_folders(),
    };
    Ok(context.document(&described).await?)
}

async fn chunk(State(service): State<Arc<Service>>, context: Context) -> Result<Response, Refused> {
    let [name, size, x, y] = context.path();
    context.values(groups::NONE).read()?;
    let field = named(&service, name, &context)?;
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

/// The field of a path.
fn named(service: &Service, name: &str, context: &Context) -> Result<Arc<NamedField>, Error> {
    let catalog = service.catalog();
    let names = || catalog.fields().names();
    let field = catalog.field(name);
    field.ok_or_else(|| context.nothing(format!("/v1/fields/{{name}}, where name is {}", names())))
}
