//! Problem documents of invalid queries.

use strew_testkit::http1;

/// Fails unless an answer is the problem document of an invalid query whose fault of `field`
/// contains `texts`. `asked` names the request in messages.
pub fn assert_fault(answer: &http1::Answer, asked: &str, field: &str, texts: &[&str]) {
    assert_eq!(answer.status, 400, "{asked}: {}", answer.text());
    assert_eq!(answer.header("content-type"), "application/problem+json");
    let problem = answer.json();
    assert_eq!(
        problem["type"], "urn:strew:problem:invalid-query",
        "{asked}"
    );
    let errors = problem["errors"].as_array().expect("a list");
    let found = errors.iter().find(|error| error["field"] == field);
    let found = found.unwrap_or_else(|| panic!("{asked}: no {field}: {problem}"));
    let missing = found["detail"] == "missing";
    assert_eq!(found["value"].is_null(), missing, "{asked}: {found}");
    let allowed = found["allowed"].as_str().expect("a text");
    assert!(!allowed.is_empty(), "{asked}");
    for text in texts {
        assert!(
            found.to_string().contains(text),
            "{asked}: no `{text}`: {found}"
        );
    }
    assert!(answer.body.len() < 6000, "{asked}: {}", answer.body.len());
}
