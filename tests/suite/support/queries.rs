//! Queries that keep a daemon busy.

/// The path of a little over a billion points, in a format.
pub fn long(format: &str) -> String {
    format!("/v1/points?bbox=0,0,31700,31700&density=1&profile=test&format={format}")
}

/// A body whose points take minutes to count.
pub const SLOW: &str =
    r#"{"region": {"circle": {"center": [0, 0], "radius": 1e8}}, "spacing": 1, "profile": "test"}"#;

/// The setting that lets a daemon count [`SLOW`].
pub const MANY_ROWS: &str = "limits.max_rows=1000000000000";
