//! The OpenAPI document: pinned, consistent, and true of the daemon.

use std::{collections::BTreeSet, path::Path};

use serde_json::Value;
use strew_core::table::Digest;
use strew_testkit::http1;

use crate::support::daemon::Daemon;

/// A change of the document is a change of the API: review the lines that differ, then accept them with
/// `UPDATE_GOLDEN=1 cargo test --test suite openapi`.
#[test]
fn the_document_is_the_pinned_one() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden/openapi.txt");
    let document = Daemon::start(&[]).get("/openapi.json");
    assert_eq!(document.status, 200);
    assert_eq!(document.header("content-type"), "application/json");
    let document = document.json();
    assert_eq!(document["info"]["version"], env!("CARGO_PKG_VERSION"));
    let outline = outline(document);
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        std::fs::write(&path, &outline).expect("writable");
    }
    let golden = std::fs::read_to_string(&path).unwrap_or_default();
    let lines = |text: &str| text.lines().map(String::from).collect::<BTreeSet<_>>();
    let (old, new) = (lines(&golden), lines(&outline));
    assert!(
        golden == outline,
        "/openapi.json differs from tests/golden/openapi.txt: {:#?} became {:#?}. To accept the \
         change: UPDATE_GOLDEN=1 cargo test --test suite openapi",
        &old - &new,
        &new - &old
    );
}

/// The document in short. Each operation and each component is a line: the beginning of the digest of its JSON, its name,
/// and its types. The first line is the digest of everything else but the version, which every release changes.
fn outline(mut document: Value) -> String {
    let line = |entry: &Value, text: &str| {
        let digest = Digest::of(entry.to_string().as_bytes()).to_string();
        format!("{} {}\n", &digest[..8], text.trim_end())
    };
    let mut lines = vec![];
    for (path, method, operation) in operations(&document) {
        let mut parts = vec![format!("{method} {path}")];
        parts.push(joined(list(&operation["parameters"]).map(shape), " "));
        parts.extend(operation.get("requestBody").map(shape));
        for (status, answer) in operation["responses"].as_object().expect("an object") {
            parts.push(format!("{status} {}", shape(answer)));
        }
        parts.retain(|part| !part.is_empty());
        lines.push(line(&operation, &parts.join(" | ")));
    }
    for (kind, components) in document["components"].as_object().expect("an object") {
        for (name, component) in components.as_object().expect("an object") {
            let text = format!("{kind} {name}: {}", shape(component));
            lines.push(line(component, &text));
        }
    }
    for rest in ["/paths", "/components", "/info/version"] {
        document.pointer_mut(rest).expect("there").take();
    }
    line(&document, "document") + &lines.concat()
}

/// A type, a parameter or a content in short: what it refers to, or its members, items, or alternatives.
fn shape(value: &Value) -> String {
    if let Value::String(name) = value {
        name.clone()
    } else if let Some(reference) = value["$ref"].as_str() {
        reference.rsplit('/').next().unwrap_or_default().into()
    } else if let Some(content) = value["content"].as_object() {
        let of = |(name, content): (&String, &Value)| {
            let text = format!("{name} {}", shape(&content["schema"]));
            text.trim_end().to_owned()
        };
        joined(content.iter().map(of), ", ")
    } else if let Some(schema) = value.get("schema") {
        let optional = if value["required"] == false { "?" } else { "" };
        let named = |place| format!("{} {}{optional} ", shape(place), shape(&value["name"]));
        value.get("in").map(named).unwrap_or_default() + &shape(schema)
    } else if let Some(members) = value["properties"].as_object() {
        let is_required = |name: &String| list(&value["required"]).any(|other| other == name);
        let members = members.iter().map(|(name, member)| {
            let optional = if is_required(name) { "" } else { "?" };
            format!("{name}{optional} {}", shape(member))
        });
        format!("{{ {} }}", joined(members, ", "))
    } else if let Some(items) = value.get("items") {
        format!("[{}]", shape(items))
    } else {
        let mut names = ["enum", "anyOf", "oneOf", "type"].iter();
        match names.find_map(|name| value.get(name)) {
            Some(Value::Array(alternatives)) => joined(alternatives.iter().map(shape), " | "),
            Some(one) => shape(one),
            None => String::new(),
        }
    }
}

/// The items of an array, if it is one.
fn list(value: &Value) -> impl Iterator<Item = &Value> {
    value.as_array().into_iter().flatten()
}

fn joined(parts: impl Iterator<Item = String>, between: &str) -> String {
    parts.collect::<Vec<_>>().join(between)
}

/// Every operation as (path, method, operation).
fn operations(document: &Value) -> Vec<(String, String, Value)> {
    let paths = document["paths"].as_object().expect("an object");
    let of = |(path, item): (&String, &Value)| {
        let item = item.as_object().expect("an object").clone();
        let path = path.clone();
        item.into_iter()
            .map(move |(method, operation)| (path.clone(), method.to_uppercase(), operation))
    };
    paths.iter().flat_map(of).collect()
}

#[test]
fn references_resolve_and_operation_ids_are_unique() {
    let document = Daemon::start(&[]).get("/openapi.json").json();
    assert_eq!(document["openapi"], "3.1.0");
    let mut open = vec![&document];
    while let Some(value) = open.pop() {
        match value {
            Value::Object(members) => {
                if let Some(Value::String(reference)) = members.get("$ref") {
                    let pointer = reference.strip_prefix('#').expect("inside");
                    assert!(document.pointer(pointer).is_some(), "{reference}");
                }
                open.extend(members.values());
            }
            Value::Array(items) => open.extend(items),
            _ => {}
        }
    }
    let ids: Vec<Value> = operations(&document)
        .iter()
        .map(|(_, _, operation)| operation["operationId"].clone())
        .collect();
    let unique: BTreeSet<String> = ids.iter().map(Value::to_string).collect();
    assert_eq!(unique.len(), ids.len());
}

#[test]
fn every_get_example_is_answered() {
    let worlds = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/worlds");
    let daemon = Daemon::start(&[&format!("worlds.folder={}", worlds.display())]);
    let document = daemon.get("/openapi.json").json();
    let (mut asked, mut shown) = (0, 0);
    for (path, method, operation) in operations(&document) {
        let curl = operation["x-curl"].as_str().expect("an example");
        if method != "GET" {
            continue;
        }
        let address = curl.trim_start_matches('\'');
        let address = address.split(['\'', ' ']).next().expect("an address");
        let answer = http1::get(daemon.address(), address, &[]);
        assert_eq!(answer.status, 200, "{path}: {address}: {:?}", answer.text());
        let described = &operation["responses"]["200"]["content"];
        let content_type = answer.header("content-type");
        assert!(
            described.get(content_type).is_some(),
            "{address} is {content_type}, which is not described"
        );
        asked += 1;
        let example = &described[content_type]["example"];
        if example.is_null() {
            continue;
        }
        let answered = match example {
            Value::String(_) => Value::from(answer.text()),
            _ => answer.json(),
        };
        assert_eq!(*example, answered, "src/rest/api/examples.json: {path}");
        shown += 1;
    }
    assert!(asked >= 6 && shown >= 12, "{asked}, {shown}");
}
