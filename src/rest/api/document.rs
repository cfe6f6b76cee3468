//! The OpenAPI document (3.1), from the endpoints' own descriptions.

use std::collections::BTreeMap;

use schemars::SchemaGenerator;
use serde_json::{Map, Value, json};
use strew_error::Kind;
use strew_query::{Parameter, of};

use super::{Answer, Endpoint, Operation, Tag, rules, schemas};
use crate::rest::problem::{self, Problem};

const ABOUT: &str = "Strew scatters points: any region of an unbounded plane, at any density, the \
                     same points for the same query, forever. Every GET answers HEAD, too. \
                     Errors are problem documents (RFC 9457). Text answers come with gzip or zstd \
                     if the client accepts it.";

const EVERYWHERE: [Kind; 4] = [
    Kind::NoSuchMethod,
    Kind::Busy,
    Kind::TimeOver,
    Kind::Internal,
];

const AT_THE_GATE: [Kind; 2] = [Kind::Unauthenticated, Kind::TooFast];

struct Components {
    generator: SchemaGenerator,
    /// By section, then by name.
    sections: Map<String, Value>,
}

impl Components {
    /// Adds a part to a section and returns a reference to it. If another part has the name already, a number is added.
    fn share(&mut self, section: &str, name: &str, part: Value) -> Value {
        let known = self.sections.entry(section).or_insert_with(|| json!({}));
        let mut key = name.to_owned();
        let mut number = 1;
        while known.get(&key).is_some_and(|other| *other != part) {
            number += 1;
            key = format!("{name}-{number}");
        }
        let reference = json!({ "$ref": format!("#/components/{section}/{key}") });
        known[key] = part;
        reference
    }
}

pub(in crate::rest) fn document<'a>(endpoints: impl IntoIterator<Item = &'a Endpoint>) -> Value {
    let mut components = Components {
        generator: schemas::generator(),
        sections: Map::new(),
    };
    let mut paths = Map::new();
    let answers = example_answers();
    for endpoint in endpoints {
        let mut item = Map::new();
        for operation in &endpoint.operations {
            let method = operation.method.as_str().to_lowercase();
            let mut described = described(operation, endpoint.is_open, &mut components);
            if let Some(example) = answers.get(operation.id) {
                put_example(example, &mut described["responses"]);
            }
            item.insert(method, described);
        }
        paths.insert(endpoint.path.into(), Value::Object(item));
    }
    let sections = &mut components.sections;
    let schemas = components.generator.take_definitions(true);
    sections.insert("schemas".into(), Value::Object(schemas));
    let schemes = json!({
        "bearer": { "type": "http", "scheme": "bearer" },
        "header": { "type": "apiKey", "in": "header", "name": "x-api-key" },
    });
    sections.insert("securitySchemes".into(), schemes);
    let tags = Tag::ALL.iter().map(|tag| {
        let (name, description) = tag.words();
        json!({ "name": name, "description": description })
    });
    json!({
        "openapi": "3.1.0",
        "info": {
            "title": "Strew",
            "version": env!("CARGO_PKG_VERSION"),
            "description": ABOUT,
            "license": { "name": "MIT OR Apache-2.0", "identifier": "MIT OR Apache-2.0" },
        },
        "servers": [{ "url": "/" }],
        "tags": tags.collect::<Vec<_>>(),
        "paths": paths,
        // Whether a key is needed is a setting of the server.
        "security": [{}, { "bearer": [] }, { "header": [] }],
        "components": sections,
    })
}

fn described(operation: &Operation, is_open: bool, components: &mut Components) -> Value {
    let rules = rules::of(operation.parameters);
    let in_path = operation.path_parameters.iter();
    let in_path = in_path.map(|&parameter| parameter_in("path", parameter, &[], true));
    let in_query = of(operation.parameters).map(|parameter| {
        let with_example = rules::is_first_of_its_kind(parameter);
        parameter_in("query", parameter, &rules, with_example)
    });
    let shared = |(name, parameter)| components.share("parameters", name, parameter);
    let parameters: Vec<Value> = in_path.chain(in_query).map(shared).collect();
    let mut responses = Map::new();
    for answer in &operation.answers {
        responses.insert(answer.status.to_string(), answered(answer, components));
    }
    let mut problems: Vec<Kind> = operation.problems.clone();
    problems.extend(EVERYWHERE);
    if operation.body.is_some() {
        problems.extend([Kind::UnknownCoding, Kind::BodyTooSlow]);
    }
    if !is_open {
        problems.extend(AT_THE_GATE);
    }
    for (status, kinds) in by_status(problems) {
        // A status may be shared with an answer that is not a problem, which is described then.
        responses
            .entry(status.to_string())
            .or_insert_with(|| refused(&kinds, components));
    }
    let mut described = json!({
        "operationId": operation.id,
        "tags": [operation.tag.words().0],
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
    if let Some((schema, example)) = &operation.body {
        let content = json!({ "schema": schema(&mut components.generator), "example": example });
        described["requestBody"] =
            json!({ "required": true, "content": { "application/json": content } });
    }
    described
}

/// A parameter with its name. Those that exclude each other do not all have an example: examples are valid
/// together.
fn parameter_in(
    place: &str,
    parameter: &Parameter,
    rules: &[rules::Rule],
    with_example: bool,
) -> (&'static str, Value) {
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
        "schema": schemas::as_text(parameter.shape),
    });
    if with_example {
        described["example"] = schemas::sample(parameter.shape, parameter.example);
    }
    (parameter.name, described)
}

fn answered(answer: &Answer, components: &mut Components) -> Value {
    let mut described = json!({ "description": answer.about });
    for &(name, about) in &answer.headers {
        let header = json!({ "description": about, "schema": { "type": "string" } });
        described["headers"][name] = components.share("headers", name, header);
    }
    for &(media_type, schema) in &answer.contents {
        described["content"][media_type] = json!({ "schema": schema(&mut components.generator) });
    }
    if answer.status == 304 {
        return components.share("responses", "unchanged", described);
    }
    described
}

fn by_status(problems: Vec<Kind>) -> BTreeMap<u16, Vec<Kind>> {
    let mut by_status = BTreeMap::<_, Vec<_>>::new();
    for kind in problems {
        let same = by_status.entry(kind.wire().status).or_default();
        if !same.contains(&kind) {
            same.push(kind);
        }
    }
    by_status
}

fn refused(kinds: &[Kind], components: &mut Components) -> Value {
    let text = |kind: &Kind| format!("{} (`{}`)", kind.wire().title, problem::urn(*kind));
    let texts: Vec<String> = kinds.iter().map(text).collect();
    let schema = schemas::of::<Problem<'_>>(&mut components.generator);
    let response = json!({
        "description": format!("{}.", texts.join(", or: ")),
        "content": { "application/problem+json": { "schema": schema } },
    });
    let slugs: Vec<&str> = kinds.iter().map(|kind| kind.slug()).collect();
    components.share("responses", &slugs.join("."), response)
}

/// Answers by the names of operations: documents, and text as strings.
const ANSWERS: &str = include_str!("examples.json");

fn example_answers() -> Map<String, Value> {
    serde_json::from_str(ANSWERS).expect("the example answers are a JSON object")
}

fn put_example(example: &Value, responses: &mut Value) {
    let media_type = if example.is_string() {
        "text/csv"
    } else {
        "application/json"
    };
    let contents = responses["200"]["content"].as_object_mut();
    let content = contents
        .into_iter()
        .flatten()
        .find(|(name, _)| name.starts_with(media_type));
    if let Some((_, content)) = content {
        content["example"] = example.clone();
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use strew_catalog::Catalog;
    use strew_config::Layers;
    use strew_query::{groups, parameters::PARAMETERS};
    use strew_service::{Service, Workers};

    use super::*;
    use crate::recipe::ADDED;

    #[test]
    fn an_added_parameter_is_described() {
        let (name, described) = parameter_in("query", &ADDED, &[], true);
        assert_eq!(name, "added");
        assert_eq!(described["schema"]["maximum"], json!(9));
        assert_eq!(described["example"], json!(3));
    }

    #[test]
    fn parameters_and_members_are_loops_over_the_table() {
        let catalog = Catalog::load(true, None).expect("built in");
        let settings = Layers::new().and_then(Layers::finish).expect("valid");
        let workers = Workers::new(1);
        let service = Arc::new(Service::new(catalog, settings.limits, workers));
        let document = document(&crate::rest::endpoints(&service));
        let listed = &document["paths"]["/v1/points"]["get"]["parameters"];
        let listed = listed.as_array().expect("a list").iter();
        let references = listed.map(|parameter| parameter["$ref"].as_str().expect("shared"));
        assert!(
            references.eq(of(groups::POINTS)
                .map(|parameter| format!("#/components/parameters/{}", parameter.name)))
        );
        let members = |schema: &str| {
            let properties = &document["components"]["schemas"][schema]["properties"];
            let properties = properties.as_object().expect("an object").keys();
            properties.map(String::as_str).collect::<Vec<_>>()
        };
        for (schema, groups) in [
            ("PointsQuery", groups::QUERY),
            ("CountQuery", groups::COUNTED),
        ] {
            let named = of(groups).map(|parameter| parameter.name);
            let expected: Vec<&str> = named.chain(["region", "layers", "features"]).collect();
            assert_eq!(members(schema), expected);
        }
        let echoed = members("Set");
        for parameter in PARAMETERS.iter().filter(|parameter| parameter.is_echoed) {
            assert!(echoed.contains(&parameter.name), "{}", parameter.name);
        }
    }
}
