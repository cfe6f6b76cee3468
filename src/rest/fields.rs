//! `GET /v1/fields`: the fields that are loaded, one of them, and its picture.

use std::sync::Arc;

use axum::{
    body::Body,
    extract::{Path, State},
    response::Response,
    routing,
};
use http::{HeaderValue, Method, header};
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::json;
use strew_core::server::Stop;

use super::{
    api::{self, Endpoint, Operation, Tag, schemas},
    body::{self, Whole},
    chunks::{COLUMN, ROW, SIZE},
    context::Context,
    document,
    freshness::Freshness,
    query,
};
use crate::service::{
    Error, Kind, Service,
    field::{self, Document, NamedField, SIDE},
    query::{Parameter, Together as _, groups},
};

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
        path_parameters: &[],
        problems: vec![Kind::Invalid],
        example: "/v1/fields".into(),
        ..operation(api::Answer::json::<Fields<'_>>("The list, sorted by name."))
    };
    let sent = Operation {
        method: Method::POST,
        id: "sendField",
        summary: "Sends a field to be named later",
        about: "Queries name it by its digest: field=DIGEST. So a mask is sent once, and used chunk by chunk. \
                It is held for as long as there is room; one that is gone is \
                no loaded field, and is sent again.",
        path_parameters: &[],
        body: Some(query::body(schemas::of::<Document>, example())),
        answers: vec![api::Answer::json::<Summary<'_>>(
            "What is held; its name is its digest.",
        )],
        problems: vec![Kind::Invalid, Kind::BodyTooLarge],
        example: format!("/v1/fields -d '{}'", example()),
        ..operation(api::Answer::unchanged())
    };
    let operations = vec![(listed, routing::get(all)), (sent, routing::post(post))];
    Endpoint::new("/v1/fields", service, operations)
}

fn example() -> serde_json::Value {
    json!({ "radial": { "center": [10, 10], "radii": [5, 20] } })
}

async fn post(
    State(service): State<Arc<Service>>,
    context: Context,
    Whole(body): Whole,
) -> Result<Response, Error> {
    context.no_parameters()?;
    let (bytes, budget) = (body.len(), service.own_budget());
    let read = move || {
        let _held = budget.hold(body::COPIES * body.len())?;
        let text = String::from_utf8_lossy(&body);
        Ok(field::read_json("field", text.trim())?)
    };
    let hold =
        |service: &Service, document: Document, stop: &Stop| service.hold_field(document, stop);
    let held = service.read(bytes, read, Document::price, hold).await?;
    document::json(&Summary::new(&held))
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
    Endpoint::new(
        "/v1/fields/{name}",
        service,
        vec![(operation, routing::get(one))],
    )
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
        ..operation(api::Answer {
            status: 200,
            about: "The picture.",
            headers: vec![],
            contents: vec![(PNG, schemas::any)],
        })
    };
    Endpoint::new(
        "/v1/fields/{name}/chunks/{size}/{cx}/{cy}",
        service,
        vec![(operation, routing::get(chunk))],
    )
}

/// What the operations share.
fn operation(answer: api::Answer) -> Operation {
    Operation {
        method: Method::GET,
        id: "",
        summary: "",
        about: "",
        tag: Tag::Fields,
        path_parameters: &[&NAME],
        parameters: groups::NONE,
        body: None,
        answers: vec![answer, api::Answer::unchanged()],
        problems: vec![Kind::Invalid, Kind::NoSuchPath],
        example: String::new(),
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

async fn all(State(service): State<Arc<Service>>, context: Context) -> Result<Response, Error> {
    context.values(groups::NONE).read()?;
    let catalog = service.catalog();
    let fields = || catalog.fields().iter();
    let made_of: Vec<(&str, String)> = fields().map(|f| (f.name.as_str(), f.digest())).collect();
    let freshness = Freshness::of(&context.uri, &context.headers, document::JSON, &made_of);
    let make = async {
        document::json(&Fields {
            fields: fields().map(|field| Summary::new(field)).collect(),
        })
    };
    freshness.answer(&context.headers, make).await
}

async fn one(
    State(service): State<Arc<Service>>,
    Path(name): Path<String>,
    context: Context,
) -> Result<Response, Error> {
    context.values(groups::NONE).read()?;
    let field = named(&service, &name, &context)?;
    let described = Described {
        summary: Summary::new(&field),
        field: field.document.without_folders(),
    };
    let freshness = Freshness::of(&context.uri, &context.headers, document::JSON, &described);
    let make = async { document::json(&described) };
    freshness.answer(&context.headers, make).await
}

async fn chunk(
    State(service): State<Arc<Service>>,
    Path([name, size, x, y]): Path<[String; 4]>,
    context: Context,
) -> Result<Response, Error> {
    context.values(groups::NONE).read()?;
    let field = named(&service, &name, &context)?;
    let (size, x, y) = (SIZE.read(&size), COLUMN.read(&x), ROW.read(&y)).together()?;
    let freshness = Freshness::of(&context.uri, &context.headers, PNG, &field.digest());
    let parts = field.spec.parts();
    let make = async {
        let draw = move |_: &Service, _: &Stop| field.picture(size, [x, y]);
        let picture = service.process(SIDE * SIDE * parts, draw).await??;
        let mut response = Response::new(Body::from(picture));
        let value = HeaderValue::from_static(PNG);
        response.headers_mut().insert(header::CONTENT_TYPE, value);
        Ok(response)
    };
    freshness.answer(&context.headers, make).await
}

/// The field of a path.
fn named(service: &Service, name: &str, context: &Context) -> Result<Arc<NamedField>, Error> {
    let catalog = service.catalog();
    catalog.field(name).ok_or_else(|| Error::NoSuchPath {
        path: context.uri.path().into(),
        available: format!(
            "/v1/fields/{{name}}, where name is {}",
            catalog.fields().names()
        ),
    })
}
