//! Single points, neighbors and large counts: the same by REST, gRPC and the command line.

use serde_json::{Map, Value, json};
use strew::grpc::proto::{FindNearestRequest, GetPointRequest, Point, PointSet, Position, value};
use tonic_types::StatusExt as _;

use super::{assert_echoed, client, daemon};
use crate::support::{
    command::run,
    grpc::normal,
    messages::{message, query, set},
    table::rows,
};

/// Sets for single points: the dimension, a list of points, and the set.
const SINGLE: &str = r"
plane | bbox=-9,-9,9,9 | spacing=1.5&seed=9&attributes=angle,variant,u3&variants=oak:3,birch:1
plane | bbox=-9,-9,9,9 | map=s&spacing=1&seed=9&attributes=variant&variants=oak:3,birch:1&spread=even&only=birch
plane | limit=99 | periodic=1500&map=s&spacing=2&seed=7&attributes=rank
space | bbox=100,-4,10,103,0,14 | spacing=0.9&seed=9&attributes=rotation,rank
";

/// A point as REST writes it.
fn written(point: &Point) -> Value {
    let mut written = json!({ "id": point.id, "x": point.x, "y": point.y });
    for (name, value) in [("z", point.z), ("distance", point.distance)] {
        if let Some(value) = value {
            written[name] = json!(value);
        }
    }
    for attribute in &point.attributes {
        written[&attribute.name] = match attribute.value.as_ref().expect("one") {
            value::Value::Number(number) => json!(number),
            value::Value::Text(text) => json!(text),
        };
    }
    written
}

#[tokio::test]
async fn single_points_and_neighbors_are_the_same() {
    let daemon = daemon();
    let mut client = client(&daemon).await;
    for row in rows(SINGLE) {
        let [dimension, region, query] = row[..] else {
            panic!("{row:?}")
        };
        let is_space = dimension == "space";
        let path = if is_space { "/v1/space" } else { "/v1" };
        let pairs = query
            .split('&')
            .map(|pair| pair.split_once('=').expect("a pair"));
        let member = |(name, text): (&str, &str)| {
            let value = serde_json::from_str(text).unwrap_or_else(|_| json!(text));
            (name.to_owned(), value)
        };
        let body: Map<String, Value> = pairs.clone().map(member).collect();
        let own: PointSet = message(&set(&body.into()));
        let flags = pairs.map(|(name, value)| format!("--{name}={value}"));
        let flags: Vec<String> = flags.chain(is_space.then(|| "--space".into())).collect();
        let printed = |command: &[&str]| {
            let flags = flags.iter().map(String::as_str);
            let arguments: Vec<&str> = command
                .iter()
                .copied()
                .chain(["--json"])
                .chain(flags)
                .collect();
            let output = run(&arguments, "");
            (output.status.success(), output.stdout)
        };

        let list = daemon
            .get(&format!("{path}/points?{region}&{query}"))
            .json();
        let listed = list["points"].as_array().expect("a list");
        assert!(listed.len() > 50, "{query}: {}", listed.len());
        for (i, expected) in listed.iter().enumerate() {
            let id = expected["id"].as_str().expect("a text");
            let request = GetPointRequest {
                id: id.into(),
                set: Some(own.clone()),
            };
            let answer = client
                .get_point(request)
                .await
                .expect("a point")
                .into_inner();
            let point = answer.point.expect("set");
            assert_eq!(normal(&written(&point)), normal(expected));
            let by_rest = daemon.get(&format!("{path}/points/{id}?{query}"));
            let block = point.block.map(|block| json!([block.column, block.row]));
            assert_eq!(json!(block), by_rest.json()["point"]["block"]);
            let resolved = answer.set.expect("set");
            assert_echoed(&resolved, &by_rest.json()["query"], &json!(query));
            assert_eq!(list["table"]["digest"], resolved.set.expect("set").table());
            if i < 2 {
                assert_eq!(printed(&["point", id]), (true, by_rest.body));
            }
        }
        if query.contains("periodic") {
            continue;
        }
        let at = ["x", "y", "z"].map(|axis| listed[20][axis].as_f64().map(|place| place + 0.3));
        let text: Vec<String> = at
            .into_iter()
            .flatten()
            .map(|place| place.to_string())
            .collect();
        let at = Position {
            x: at[0].expect("x"),
            y: at[1].expect("y"),
            z: at[2],
        };
        let text = text.join(",");
        for (k, radius) in [
            (None, None),
            (Some(8), None),
            (None, Some(4.0)),
            (Some(3), Some(2.0)),
        ] {
            let request = FindNearestRequest {
                at: Some(at),
                k,
                radius,
                set: Some(own.clone()),
            };
            let answer = client
                .find_nearest(request)
                .await
                .expect("points")
                .into_inner();
            let more = [
                k.map(|k| format!("k={k}")),
                radius.map(|radius| format!("radius={radius}")),
            ];
            let more: Vec<String> = more.into_iter().flatten().collect();
            let expected = daemon.get(&format!(
                "{path}/nearest?at={text}&{query}&{}",
                more.join("&")
            ));
            let neighbors: Vec<Value> = answer.neighbors.iter().map(written).collect();
            assert!(!neighbors.is_empty());
            assert_eq!(
                normal(&json!(neighbors)),
                normal(&expected.json()["neighbors"]),
                "{more:?}"
            );
            let least = answer.set.expect("set").least_distance;
            assert_eq!(least, expected.json()["query"]["least_distance"]);
            let at = format!("--at={text}");
            let more: Vec<String> = more.iter().map(|flag| format!("--{flag}")).collect();
            let more = more.iter().map(String::as_str);
            let command: Vec<&str> = ["nearest", &at].into_iter().chain(more).collect();
            assert_eq!(printed(&command), (true, expected.body));
        }
        // What is no point of the set is found by none of the three.
        let id = if is_space { "1:0:0" } else { "1:0" };
        let by_rest = daemon.get(&format!("{path}/points/{id}?{query}")).status;
        let request = GetPointRequest {
            id: id.into(),
            set: Some(own),
        };
        let status = client.get_point(request).await.expect_err("no point");
        assert_eq!(
            (by_rest, status.code()),
            (404, tonic::Code::NotFound),
            "{query}"
        );
        let reason = status.get_details_error_info().expect("details").reason;
        assert_eq!(reason, "NO_SUCH_POINT");
        assert!(!printed(&["point", id]).0);
    }
}

#[tokio::test]
async fn counts_are_exact_beyond_64_bits() {
    let daemon = daemon();
    let mut client = client(&daemon).await;
    for side in [1e3, 1e9, 1e12] {
        let body = json!({ "region": { "bbox": [0, 0, side, side] }, "spacing": 1 });
        let answer = client
            .count_points(query(&body, 0))
            .await
            .expect("a count")
            .into_inner();
        let exact: u128 = answer.digits.parse().expect("digits");
        assert_eq!(answer.count, u64::try_from(exact).unwrap_or(u64::MAX));
        // Numbers that `JSON.parse` would round are text.
        let quote = if exact >= 1 << 53 { "\"" } else { "" };
        let expected = format!("{{\"count\":{quote}{exact}{quote},");
        let by_rest = daemon.post("/v1/count", &body);
        assert!(
            by_rest.text().starts_with(&expected),
            "{expected} {}",
            by_rest.text()
        );
    }
}
