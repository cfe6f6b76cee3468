//! The OpenAPI document (3.1), from the endpoints' own descriptions.

use schemars::SchemaGenerator;
use serde_json::{Map, Value, json};

use super::{Answer, Endpoint, Operation, Tag, examples, rules, schemas, sets};
use crate::{
    error_map,
    rest::problem::Problem,
    service::{
        Encoding, Kind,
        query::{Parameter, Shape, of},
    },
};

const ABOUT: &str = "Strew scatters points: any region of an unbounded plane, at any density, the \
                     same points for the same query, forever. Every GET answers HEAD, too. \
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
    let mut generator = schemas::generator();
    let mut paths = Map::new();
    let answers = examples::all();
    for endpoint in endpoints {
        let mut item = Map::new();
        for operation in endpoint.operations() {
            let method = operation.method.as_str().to_lowercase();
            let mut described = described(operation, endpoint.is_open(), &mut generator);
            if let Some(example) = answers.get(operation.id) {
                examples::put(example, &mut described["responses"]);
            }
            item.insert(method, described);
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
        "tags": Tag::ALL.map(|tag| json!({ "name": tag.name(), "description": tag.about() })),
        "paths": paths,
        // Whether a key is needed is a setting of the server.
        "security": [{}, { "bearer": [] }, { "header": [] }],
        "components": {
            "schemas": generator.take_definitions(true),
            "securitySchemes": {
                "bearer": { "type": "http", "scheme": "bearer" },
                "header": { "type": "apiKey", "in": "header", "name": "x-api-key" },
            },
        },
    })
}

fn described(operation: &Operation, is_open: bool, generator: &mut SchemaGenerator) -> Value {
    let in_path = operation.path_parameters.iter();
    let in_query = of(operation.parameters);
    let rules = rules::of(operation.parameters);
    let parameters: Vec<Value> = in_path
        .map(|parameter| parameter_in("path", parameter, &[], true))
        .chain(in_query.map(|parameter| {
            let with_example = rules::is_first_of_its_kind(parameter);
            parameter_in("query", parameter, &rules, with_example)
        }))
        .collect();
    let mut responses = Map::new();
    for answer in &operation.answers {
        responses.insert(answer.status.to_string(), answered(answer, generator));
    }
    let mut problems: Vec<Kind> = operation.problems.clone();
    problems.extend(EVERYWHERE);
    if operation.body.is_some() {
        problems.extend([Kind::UnknownCoding, Kind::BodyTooSlow]);
    }
    if !is_open {
        problems.extend(AT_THE_GATE);
    }
    for (status, response) in refused(&problems, generator) {
        // A status may be shared with an answer that is not a problem, which is described then.
        responses.entry(status).or_insert(response);
    }
    let mut described = json!({
        "operationId": operation.id,
        "tags": [operation.tag.name()],
        "summary": operation.summary,
        "description": operation.about,
        "parameters": parameters,
        "responses": responses,
        "x-curl": operation.example,
    });
    if !rules.is_empty() {
        described["description"] = rules::below(operation.about, &rules).into();
        described["x-rules"] = json!(rules);
    }
    if is_open {
        described["security"] = json!([]);
    }
    if let Some(body) = &operation.body {
        described["requestBody"] = json!({
            "required": true,
            "content": { body.media_type: { "schema": (body.schema)(generator), "example": body.example } },
        });
    }
    described
}

/// A parameter. Those that exclude each other do not all have an example: examples are valid
/// together.
fn parameter_in(
    place: &str,
    parameter: &Parameter,
    rules: &[rules::Rule],
    with_example: bool,
) -> Value {
    let default = parameter.default;
    let default = default.map_or_else(String::new, |default| format!(" Default: {default}."));
    let text = format!(
        "{} Allowed: {}.{default}{}",
        parameter.about,
        parameter.allowed(),
        rules::at(parameter.name, rules)
    );
    let mut described = json!({
        "name": parameter.name,
        "in": place,
        "required": parameter.is_required,
        "description": text,
        "schema": as_text(parameter.shape),
    });
    if with_example {
        described["example"] = sample(parameter.shape, parameter.example);
    }
    described
}

/// The JSON Schema of a parameter in an address.
fn as_text(shape: Shape) -> Value {
    match shape {
        Shape::Numbers(names) => {
            let more = names.len().saturating_sub(1);
            json!({ "type": "string", "pattern": format!("^{NUMBER}(,{NUMBER}){{{more}}}$") })
        }
        Shape::Integers { names, .. } => {
            let pattern = vec![INTEGER; names.len()].join(",");
            json!({ "type": "string", "pattern": format!("^{pattern}$") })
        }
        Shape::Offsets { .. } => {
            let pair = format!("{INTEGER},{INTEGER}");
            json!({ "type": "string", "pattern": format!("^{pair}([ +]{pair})*$") })
        }
        Shape::Vertices => {
            json!({ "type": "string", "pattern": format!("^{NUMBER},{NUMBER}(,{NUMBER},{NUMBER}){{2,}}$") })
        }
        Shape::Names { pattern } => {
            let name = pattern.trim_start_matches('^').trim_end_matches('$');
            json!({ "type": "string", "pattern": format!("^{name}(,{name})*$") })
        }
        Shape::Weights => {
            let pair = format!("{}(:{NUMBER})?", sets::NAME);
            json!({ "type": "string", "pattern": format!("^{pair}(,{pair})*$") })
        }
        Shape::Ranges => {
            let range = format!("{}:{NUMBER}:{NUMBER}", sets::NAME);
            json!({ "type": "string", "pattern": format!("^{range}(,{range})*$") })
        }
        Shape::Switch => json!({ "type": "string", "enum": ["on", "off"] }),
        Shape::Field => json!({ "type": "string", "pattern": format!("^{}$", sets::NAME) }),
        Shape::Fields => {
            let pair = format!("{}:{}", sets::NAME, sets::NAME);
            json!({ "type": "string", "pattern": format!("^{pair}(,{pair})*$") })
        }
        other => schema(other),
    }
}

/// An integer of up to 15 digits, which is within all bounds.
const INTEGER: &str = r"-?\d{1,15}";

/// A decimal number.
const NUMBER: &str = r"-?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?";

/// The JSON Schema of a parameter in JSON.
pub(super) fn schema(shape: Shape) -> Value {
    match shape {
        Shape::Number { min, max } => json!({ "type": "number", "minimum": min, "maximum": max }),
        Shape::Integer { min, max } => {
            json!({ "type": "integer", "minimum": min, "maximum": max })
        }
        Shape::Signed { limit } => {
            json!({ "type": "integer", "minimum": -limit, "maximum": limit })
        }
        Shape::Switch => json!({ "type": "boolean" }),
        Shape::Strength { max } => json!({ "anyOf": [
            { "type": "string", "enum": ["off", "on"] },
            { "type": "number", "minimum": 0, "maximum": max },
        ] }),
        Shape::Numbers(names) => json!({
            "type": "array", "items": { "type": "number" },
            "minItems": names.len(), "maxItems": names.len(),
        }),
        Shape::Integers { names, limit } => json!({
            "type": "array", "items": { "type": "integer", "minimum": -limit, "maximum": limit },
            "minItems": names.len(), "maxItems": names.len(),
        }),
        Shape::Offsets { limit } => json!({
            "type": "array", "minItems": 1,
            "items": {
                "type": "array", "items": { "type": "integer", "minimum": -limit, "maximum": limit },
                "minItems": 2, "maxItems": 2,
            },
        }),
        Shape::Vertices => json!({ "type": "array", "items": { "type": "number" }, "minItems": 6 }),
        Shape::Names { pattern } => json!({
            "type": "array", "items": { "type": "string", "pattern": pattern },
            "uniqueItems": true,
        }),
        Shape::Weights => json!({
            "type": "object",
            "propertyNames": { "pattern": format!("^{}$", sets::NAME) },
            "additionalProperties": { "type": "number", "minimum": 1e-9, "maximum": 1e9 },
            "minProperties": 1, "maxProperties": 256,
        }),
        Shape::Ranges => json!({
            "type": "object",
            "propertyNames": { "pattern": format!("^{}$", sets::NAME) },
            "additionalProperties": {
                "type": "array", "items": { "type": "number", "minimum": 0, "maximum": 1e9 },
                "minItems": 2, "maxItems": 2,
            },
            "minProperties": 1, "maxProperties": 256,
        }),
        Shape::Choice(words) => json!({ "type": "string", "enum": words }),
        Shape::Format => {
            json!({ "type": "string", "enum": Encoding::ALL.map(Encoding::name) })
        }
        Shape::Pattern(pattern) => json!({ "type": "string", "pattern": pattern }),
        Shape::Fields => json!({
            "type": "object",
            "propertyNames": { "pattern": format!("^{}$", sets::NAME) },
            "additionalProperties": schema(Shape::Field),
            "minProperties": 1, "maxProperties": 32,
        }),
        Shape::Field => json!({ "anyOf": [
            { "type": "string", "pattern": format!("^{}$", sets::NAME) },
            { "$ref": "#/components/schemas/Field" },
        ] }),
        Shape::Quadratic | Shape::Text => json!({ "type": "string" }),
    }
}

/// An example in the type of its schema.
fn sample(shape: Shape, text: &str) -> Value {
    match shape {
        Shape::Number { .. } | Shape::Integer { .. } | Shape::Signed { .. } => {
            serde_json::from_str(text).unwrap_or_else(|_| text.into())
        }
        _ => text.into(),
    }
}

fn answered(answer: &Answer, generator: &mut SchemaGenerator) -> Value {
    let headers: Map<String, Value> = answer
        .headers
        .iter()
        .map(|&(name, about)| {
            let header = json!({ "description": about, "schema": { "type": "string" } });
            (name.to_owned(), header)
        })
        .collect();
    let contents: Map<String, Value> = answer
        .contents
        .iter()
        .map(|&(media_type, schema)| {
            (
                media_type.to_owned(),
                json!({ "schema": schema(generator) }),
            )
        })
        .collect();
    let mut described = json!({ "description": answer.about });
    if !headers.is_empty() {
        described["headers"] = Value::Object(headers);
    }
    if !contents.is_empty() {
        described["content"] = Value::Object(contents);
    }
    described
}

/// The problems by status: several kinds can share one.
fn refused(kinds: &[Kind], generator: &mut SchemaGenerator) -> Vec<(String, Value)> {
    let mut by_status: Vec<(String, Vec<String>)> = vec![];
    for &kind in kinds {
        let problem = error_map::wire(kind);
        let status = problem.status.as_u16().to_string();
        let text = format!("{} (`{}`)", problem.title, error_map::urn(kind));
        match by_status.iter_mut().find(|(known, _)| *known == status) {
            Some((_, texts)) if texts.contains(&text) => {}
            Some((_, texts)) => texts.push(text),
            None => by_status.push((status, vec![text])),
        }
    }
    let schema = schemas::of::<Problem<'_>>(generator);
    by_status
        .into_iter()
        .map(|(status, texts)| {
            let response = json!({
                "description": format!("{}.", texts.join(", or: ")),
                "content": {
                    "application/problem+json": { "schema": schema },
                },
            });
            (status, response)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::{
        config::Layers,
        service::{Catalog, Service, Workers},
    };

    #[test]
    fn an_added_parameter_is_described() {
        let catalog = Catalog::load(true, None).expect("built in");
        let settings = Layers::new().and_then(Layers::finish).expect("valid");
        let workers = Workers::new(1).expect("threads");
        let service = Arc::new(Service::new(catalog, settings.limits, workers));
        let document = document(&crate::rest::endpoints(&service));
        let parameters = &document["paths"]["/v1/points"]["get"]["parameters"];
        let names = parameters
            .as_array()
            .expect("a list")
            .iter()
            .map(|p| &p["name"]);
        assert!(names.clone().any(|name| name == "added"), "{parameters}");
        let schemas = &document["components"]["schemas"];
        assert_eq!(
            schemas["PointsQuery"]["properties"]["added"]["maximum"],
            json!(9)
        );
        assert_eq!(schemas["Set"]["properties"]["added"]["maximum"], json!(9));
    }
}
