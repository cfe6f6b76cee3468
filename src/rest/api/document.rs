//! The OpenAPI document (3.1), from the endpoints' own descriptions.

use serde_json::{Map, Value, json};

use super::{Answer, Endpoint, Given, Operation, schemas};
use crate::{
    error_map,
    service::{
        Kind,
        query::{Parameter, Shape},
    },
};

const ABOUT: &str = "Strew scatters points: any region of an unbounded plane, at any density, the \
                     same points for the same question, forever. Every GET answers HEAD, too. \
                     Errors are problem documents (RFC 9457). Text answers come with gzip or zstd \
                     if the client accepts it.";

/// The problems that any request can have.
const EVERYWHERE: [Kind; 4] = [
    Kind::NoSuchMethod,
    Kind::Busy,
    Kind::TimeOver,
    Kind::Internal,
];

/// Those of a request that is not let in.
const AT_THE_GATE: [Kind; 2] = [Kind::Unauthenticated, Kind::TooFast];

/// The document.
pub(in crate::rest) fn document(endpoints: &[Endpoint]) -> Value {
    let mut paths = Map::new();
    for endpoint in endpoints {
        let mut item = Map::new();
        for operation in endpoint.operations() {
            let method = operation.method.as_str().to_lowercase();
            item.insert(method, described(operation, endpoint.is_open()));
        }
        paths.insert(endpoint.path().into(), Value::Object(item));
    }
    json!({
        "openapi": "3.1.0",
        "info": {
            "title": "Strew",
            "version": env!("CARGO_PKG_VERSION"),
            "description": ABOUT,
            "license": { "name": "MIT OR Apache-2.0", "identifier": "MIT OR Apache-2.0" },
        },
        "servers": [{ "url": "/" }],
        "paths": paths,
        // Whether a key is needed is a setting of the server.
        "security": [{}, { "bearer": [] }, { "header": [] }],
        "components": {
            "schemas": schemas::shared(),
            "securitySchemes": {
                "bearer": { "type": "http", "scheme": "bearer" },
                "header": { "type": "apiKey", "in": "header", "name": "x-api-key" },
            },
        },
    })
}

fn described(operation: &Operation, is_open: bool) -> Value {
    let in_path = operation.path_parameters.iter().map(|parameter| Given {
        parameter,
        required: true,
    });
    let parameters: Vec<Value> = in_path
        .map(|given| told("path", &given, true))
        .chain(in_query(&operation.parameters))
        .collect();
    let mut responses = Map::new();
    for answer in &operation.answers {
        responses.insert(answer.status.to_string(), answered(answer));
    }
    let mut problems: Vec<Kind> = operation.problems.clone();
    problems.extend(EVERYWHERE);
    problems.extend(operation.body.is_some().then_some(Kind::BodyTooSlow));
    if !is_open {
        problems.extend(AT_THE_GATE);
    }
    for (status, response) in refused(&problems) {
        // A status may be shared with an answer that is not a problem; that one is told.
        responses.entry(status).or_insert(response);
    }
    let mut told = json!({
        "operationId": operation.id,
        "summary": operation.summary,
        "description": operation.about,
        "parameters": parameters,
        "responses": responses,
        "x-curl": operation.example,
    });
    if is_open {
        told["security"] = json!([]);
    }
    if let Some(body) = &operation.body {
        told["requestBody"] = json!({
            "required": true,
            "content": { body.media_type: { "schema": body.schema, "example": body.example } },
        });
    }
    told
}

/// Of parameters that exclude each other, which their same words about what is allowed tell, only
/// the first has an example: examples are in order together.
fn in_query(all: &[Given]) -> Vec<Value> {
    let is_first = |at: usize, given: &Given| {
        let same = |other: &Given| other.parameter.allowed == given.parameter.allowed;
        !all[..at].iter().any(same)
    };
    let numbered = all.iter().enumerate();
    numbered
        .map(|(at, given)| told("query", given, is_first(at, given)))
        .collect()
}

fn told(place: &str, given: &Given, with_example: bool) -> Value {
    let Parameter {
        name,
        about,
        allowed,
        default,
        example,
        shape,
    } = given.parameter;
    let default = default.map_or_else(String::new, |default| format!(" Default: {default}."));
    let mut told = json!({
        "name": name,
        "in": place,
        "required": given.required,
        "description": format!("{about} Allowed: {allowed}.{default}"),
        "schema": schema(*shape),
    });
    if with_example {
        told["example"] = sample(*shape, example);
    }
    told
}

/// The JSON Schema of a parameter's values, as they are once read.
pub(super) fn schema(shape: Shape) -> Value {
    match shape {
        Shape::Number { min, max } => json!({ "type": "number", "minimum": min, "maximum": max }),
        Shape::Integer { min, max } => {
            json!({ "type": "integer", "minimum": min, "maximum": max })
        }
        Shape::Numbers(count) => {
            let number = r"-?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?";
            let more = count.saturating_sub(1);
            json!({ "type": "string", "pattern": format!("^{number}(,{number}){{{more}}}$") })
        }
        Shape::OneOf(names) => json!({ "type": "string", "enum": names() }),
        Shape::NameOrNumber { names, min, max } => json!({ "anyOf": [
            { "type": "string", "enum": names },
            { "type": "number", "minimum": min, "maximum": max },
        ] }),
        Shape::Pattern(pattern) => json!({ "type": "string", "pattern": pattern }),
        Shape::Text => json!({ "type": "string" }),
    }
}

/// An example in the type of its schema.
fn sample(shape: Shape, text: &str) -> Value {
    match shape {
        Shape::Number { .. } | Shape::Integer { .. } => {
            serde_json::from_str(text).unwrap_or_else(|_| text.into())
        }
        _ => text.into(),
    }
}

fn answered(answer: &Answer) -> Value {
    let headers: Map<String, Value> = answer
        .headers
        .iter()
        .map(|&(name, about)| {
            let told = json!({ "description": about, "schema": { "type": "string" } });
            (name.to_owned(), told)
        })
        .collect();
    let contents: Map<String, Value> = answer
        .contents
        .iter()
        .map(|(media_type, schema)| (media_type.clone(), json!({ "schema": schema })))
        .collect();
    let mut told = json!({ "description": answer.about });
    if !headers.is_empty() {
        told["headers"] = Value::Object(headers);
    }
    if !contents.is_empty() {
        told["content"] = Value::Object(contents);
    }
    told
}

/// The problems by status: several kinds can share one.
fn refused(kinds: &[Kind]) -> Vec<(String, Value)> {
    let mut by_status: Vec<(String, Vec<String>)> = vec![];
    for &kind in kinds {
        let problem = error_map::http(kind);
        let status = problem.status.as_u16().to_string();
        let text = format!("{} (`{}`)", problem.title, error_map::urn(kind));
        match by_status.iter_mut().find(|(known, _)| *known == status) {
            Some((_, texts)) if texts.contains(&text) => {}
            Some((_, texts)) => texts.push(text),
            None => by_status.push((status, vec![text])),
        }
    }
    by_status
        .into_iter()
        .map(|(status, texts)| {
            let response = json!({
                "description": format!("{}.", texts.join(", or: ")),
                "content": {
                    "application/problem+json": { "schema": schemas::reference("Problem") },
                },
            });
            (status, response)
        })
        .collect()
}
