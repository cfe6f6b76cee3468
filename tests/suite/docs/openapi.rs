//! The OpenAPI document: pinned, consistent, and true of the daemon.

use std::{collections::BTreeSet, path::Path};

use serde_json::Value;
use strew_testkit::http1;

use crate::support::daemon::Daemon;

/// A change of the document is a change of the API: review it, then accept it with
/// `UPDATE_GOLDEN=1 cargo test --test suite openapi`.
#[test]
fn the_document_is_the_pinned_one() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden/openapi.json");
    let document = Daemon::start(&[]).get("/openapi.json");
    assert_eq!(document.status, 200);
    assert_eq!(document.header("content-type"), "application/json");
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        std::fs::write(&path, &document.body).expect("writable");
    }
    let golden = std::fs::read(&path).unwrap_or_default();
    assert!(
        golden == document.body,
        "/openapi.json differs from tests/golden/openapi.json. To accept the change: \
         UPDATE_GOLDEN=1 cargo test --test suite openapi"
    );
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
