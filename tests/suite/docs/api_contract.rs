//! The daemon against its OpenAPI document, by a fuzzer that reads it (schemathesis): no request
//! gets a 5xx, and every answer is one that the document describes.
//!
//! `just contract` fuzzes for longer: more examples, and every edge of every schema one after the other.

use std::time::Instant;

use serde_json::{Value, json};

use crate::support::{clients, daemon::Daemon};

/// A check that needs the hooks: without them queries name tables that are not loaded, and regions
/// that hold too many points.
const WITH_HOOKS: &str = "positive_data_acceptance";

/// The variable with which the fuzzer takes its time.
const WHOLE: &str = "STREW_TEST_WHOLE_CONTRACT";

/// The folder of the hooks that make queries valid, so that answers with points are checked, too.
const HOOKS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/suite/docs");

#[test]
fn a_fuzzer_finds_no_breach_of_contract() {
    let fuzzer = || {
        let mut command = clients::python("schemathesis")?;
        command.args(["-m", "schemathesis.cli"]);
        Some(command)
    };
    let Some(mut version) = fuzzer() else {
        return;
    };
    let version = version.arg("--version").output();
    if !version.is_ok_and(|output| output.status.success()) {
        eprintln!("skipped: schemathesis is not installed");
        return;
    }
    let daemon = Daemon::start(&["limits.max_points=100000"]);
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("openapi.json");
    let document = without_fields(daemon.get("/openapi.json").json());
    std::fs::write(&file, document.to_string()).expect("writable");
    let start = Instant::now();
    let (phases, examples) = if std::env::var_os(WHOLE).is_some() {
        ("examples,coverage,fuzzing,stateful", "25")
    } else {
        ("examples,fuzzing,stateful", "12")
    };
    for in_order in [false, true] {
        let mut command = fuzzer().expect("as above");
        if in_order {
            command
                .env("SCHEMATHESIS_HOOKS", "api_contract")
                .env("PYTHONPATH", HOOKS)
                .env("PYTHONDONTWRITEBYTECODE", "1");
        }
        let mode = if in_order { "positive" } else { "all" };
        command
            .arg("run")
            .arg(&file)
            .args(["--url", &daemon.url("/"), "--no-color"])
            .args(["--checks", "all", "--mode", mode, "--phases", phases])
            .args(["--max-examples", examples])
            .args(["--seed", "1", "--generation-deterministic"])
            .args(["--request-timeout", "60"])
            // It writes .schemathesis/ into the folder it runs in.
            .current_dir(folder.path());
        if !in_order {
            command.args(["--exclude-checks", WITH_HOOKS]);
        }
        let output = command.output().expect("Python runs");
        let report = String::from_utf8_lossy(&output.stdout);
        let errors = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{report}\n{errors}");
    }
    eprintln!("fuzzed for {:?}", start.elapsed());
    assert_eq!(daemon.get("/livez").status, 200);
}

/// The document with constant fields only: schemas in schemas of many shapes take the generator many
/// minutes. Bodies with fields are fuzzed by `fuzz/subjects`.
fn without_fields(mut document: Value) -> Value {
    let constant = json!({
        "type": "object",
        "properties": { "constant": { "type": "number", "minimum": 0, "maximum": 1 } },
        "required": ["constant"],
        "additionalProperties": false,
    });
    let schemas = &mut document["components"]["schemas"];
    schemas["Field"] = constant;
    let rules = document["paths"]["/v1/points"]["get"]["x-rules"].clone();
    let terrain = json!([{ "parameter": "terrain", "values": [] }]);
    let rules = rules.as_array().expect("a list").iter();
    let parts = rules
        .filter(|rule| rule["others"] == terrain)
        .filter_map(|rule| rule["parameter"].as_str());
    // Plain numbers, which addresses have, too.
    let parts: Vec<&str> = parts.chain(["settle", "lod"]).collect();
    without_some_members(&mut document, &parts);
    let schemas = &mut document["components"]["schemas"];
    if let Value::Object(members) = &mut schemas["PointsQuery"]["properties"] {
        for member in members.values_mut() {
            let first = member["anyOf"][0].clone();
            if first["type"] == "integer" {
                *member = first;
            }
        }
    }
    // Answers have all shapes.
    schemas["DescribedField"]["properties"]["field"] = json!({});
    document
}

/// Takes some members out of bodies: the generator fails on as many as they have.
fn without_some_members(value: &mut Value, parts: &[&str]) {
    match value {
        Value::Object(members) => {
            if let Some(Value::Object(properties)) = members.get_mut("properties")
                && let Some(terrain) = properties.get("terrain")
                && terrain["type"] != "string"
            {
                for name in parts {
                    properties.remove(*name);
                }
            }
            let inner = members.values_mut();
            inner.for_each(|member| without_some_members(member, parts));
        }
        Value::Array(items) => items
            .iter_mut()
            .for_each(|item| without_some_members(item, parts)),
        _ => {}
    }
}
