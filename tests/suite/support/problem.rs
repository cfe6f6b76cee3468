//! Problem documents of invalid queries.

use serde_json::Value;
use strew_testkit::http1;

/// The faults of a problem document of an invalid query; each has a value and what is allowed. `asked` names the
/// request in messages.
fn faults(answer: &http1::Answer, asked: &str) -> Vec<Value> {
    assert_eq!(
        answer.status,
        400,
        "{asked}: {:.2000}",
        String::from_utf8_lossy(&answer.body)
    );
    assert_eq!(answer.header("content-type"), "application/problem+json");
    assert!(answer.body.len() < 6000, "{asked}: {}", answer.body.len());
    let problem = answer.json();
    assert_eq!(
        problem["type"], "urn:strew:problem:invalid-query",
        "{asked}"
    );
    assert_eq!(problem["status"], 400);
    let faults = problem["errors"].as_array().expect("a list").clone();
    for fault in &faults {
        let missing = fault["detail"] == "missing";
        assert_eq!(fault["value"].is_null(), missing, "{asked}: {fault}");
        let [allowed, field] =
            ["allowed", "field"].map(|name| fault[name].as_str().expect("a text"));
        assert!(!allowed.is_empty(), "{asked}");
        assert!(
            problem["detail"]
                .as_str()
                .is_some_and(|detail| detail.contains(field))
        );
    }
    faults
}

fn assert_has(faults: &[Value], asked: &str, texts: &[&str]) {
    let said = Value::from(faults).to_string();
    for text in texts {
        assert!(said.contains(text), "{asked}: no `{text}`: {said}");
    }
}

/// Fails unless an answer is the problem document of an invalid query with exactly these `fields`, joined by commas,
/// and these `texts`.
pub fn assert_faults(answer: &http1::Answer, asked: &str, fields: &str, texts: &[&str]) {
    let faults = faults(answer, asked);
    let named: Vec<&str> = faults
        .iter()
        .filter_map(|fault| fault["field"].as_str())
        .collect();
    assert_eq!(named.join(", "), fields, "{asked}");
    assert_has(&faults, asked, texts);
}

/// Fails unless an answer is the problem document of an invalid query whose fault of `field` contains `texts`.
pub fn assert_fault(answer: &http1::Answer, asked: &str, field: &str, texts: &[&str]) {
    let mut faults = faults(answer, asked);
    faults.retain(|fault| fault["field"] == field);
    assert!(!faults.is_empty(), "{asked}: no {field}: {}", answer.text());
    assert_has(&faults, asked, texts);
}
