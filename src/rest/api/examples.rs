//! Example answers in the description of the API: what the daemon answers to the examples of requests, as far as that is
//! short. A test compares them with its answers.

use serde_json::{Map, Value};

/// Answers by the names of operations: documents, and text as strings.
const ANSWERS: &str = include_str!("examples.json");

/// All example answers.
pub(super) fn all() -> Map<String, Value> {
    serde_json::from_str(ANSWERS).expect("the example answers are a JSON object")
}

/// Puts the example answer of an operation where its answers are described.
pub(super) fn put(example: &Value, responses: &mut Value) {
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
