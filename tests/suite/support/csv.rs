//! Answers as CSV, parsed.

use std::collections::BTreeMap;

use serde_json::Value;
use strew_core::Point;
use strew_testkit::http1;

use super::daemon::Daemon;

/// An answer in CSV: points, and the values of all columns by name.
pub struct Csv {
    pub answer: http1::Answer,
    pub points: Vec<Point>,
    pub columns: BTreeMap<String, Vec<String>>,
}

impl Csv {
    /// Parses an answer, which must be a success.
    pub fn of(answer: http1::Answer) -> Self {
        assert_eq!(answer.status, 200, "{}", answer.text());
        let text = answer.text().to_owned();
        let mut lines = text.lines();
        let names: Vec<&str> = lines.next().expect("names").split(',').collect();
        let at = |name: &str| {
            names
                .iter()
                .position(|other| *other == name)
                .expect("a column")
        };
        let [id, x, y] = ["id", "x", "y"].map(at);
        let mut columns: BTreeMap<String, Vec<String>> = BTreeMap::new();
        let mut points = vec![];
        for line in lines {
            let values: Vec<&str> = line.split(',').collect();
            points.push(Point {
                id: values[id].parse().expect("an id"),
                x: values[x].parse().expect("a number"),
                y: values[y].parse().expect("a number"),
            });
            for (name, value) in names.iter().zip(values) {
                columns
                    .entry((*name).into())
                    .or_default()
                    .push(value.into());
            }
        }
        assert_eq!(answer.header("strew-count"), points.len().to_string());
        Self {
            answer,
            points,
            columns,
        }
    }

    /// The answer to a GET; `query` without a format.
    pub fn get(daemon: &Daemon, query: &str) -> Self {
        Self::of(daemon.get(&format!("/v1/points?{query}&format=csv")))
    }

    /// The answer to a body without a format.
    pub fn post(daemon: &Daemon, body: &Value) -> Self {
        let mut body = body.clone();
        body["format"] = "csv".into();
        Self::of(daemon.post("/v1/points:query", &body))
    }

    /// The answer for a chunk; `rest` is the path after `chunks/`, with a query.
    pub fn chunk(daemon: &Daemon, rest: &str) -> Self {
        Self::of(daemon.get(&format!("/v1/chunks/{rest}&format=csv")))
    }
}

/// Sorts points by id.
pub fn sorted(mut points: Vec<Point>) -> Vec<Point> {
    points.sort_by_key(|point| point.id);
    points
}

/// The least distance of any two points.
pub fn least_distance(points: &[Point]) -> f64 {
    let mut least = f64::INFINITY;
    for (i, p) in points.iter().enumerate() {
        for q in &points[..i] {
            least = least.min((p.x - q.x).hypot(p.y - q.y));
        }
    }
    least
}
