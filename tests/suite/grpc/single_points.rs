//! Single points and counts are those of REST.

use serde_json::{Value, json};
use strew::grpc::proto::{
    CountPointsRequest, FindNearestRequest, GetPointRequest, Point, PointSet, Position,
    StreamPointsRequest, point_service_client::PointServiceClient, point_set::Amount, value,
};

use crate::support::{
    daemon::Daemon,
    grpc::{boxed, normal},
};

const SET: &str = "spacing=1.5&seed=9&attributes=angle,variant,u3&variants=oak:3,birch:1";

/// [`SET`] as a message.
fn set() -> PointSet {
    let variants = [("oak", 3.0), ("birch", 1.0)];
    PointSet {
        amount: Some(Amount::Spacing(1.5)),
        seed: Some(9),
        attributes: ["angle", "variant", "u3"].map(Into::into).into(),
        variants: variants.map(|(name, weight)| (name.into(), weight)).into(),
        ..PointSet::default()
    }
}

/// A point as REST writes it.
fn written(point: &Point) -> Value {
    let mut written = json!({ "id": point.id, "x": point.x, "y": point.y });
    if let Some(distance) = point.distance {
        written["distance"] = distance.into();
    }
    for attribute in &point.attributes {
        written[&attribute.name] = match attribute.value.as_ref().expect("one") {
            value::Value::Number(number) => (*number).into(),
            value::Value::Text(text) => text.clone().into(),
        };
    }
    written
}

#[tokio::test]
async fn a_point_is_found_by_its_id() {
    let daemon = Daemon::start(&[]);
    let mut client = PointServiceClient::new(daemon.channel().await);
    let list = daemon
        .get(&format!("/v1/points?bbox=-9,-9,9,9&{SET}"))
        .json();
    let listed = list["points"].as_array().expect("a list");
    assert!(listed.len() > 100);
    for expected in listed {
        let request = GetPointRequest {
            id: expected["id"].as_str().expect("a text").into(),
            set: Some(set()),
        };
        let answer = client
            .get_point(request)
            .await
            .expect("a point")
            .into_inner();
        let point = answer.point.expect("set");
        assert_eq!(normal(&written(&point)), normal(expected));
        let block = point.block.expect("set");
        let by_rest = daemon.get(&format!("/v1/points/{}?{SET}", point.id)).json();
        let expected = &by_rest["point"]["block"];
        assert_eq!(json!([block.column, block.row]), *expected);
        let resolved = answer.set.expect("set").set.expect("set");
        assert_eq!(list["table"]["digest"], resolved.table());
        let asked = set();
        assert_eq!(
            (resolved.amount, resolved.seed, resolved.warp),
            (asked.amount, asked.seed, Some(1.0))
        );
        assert_eq!(
            (resolved.attributes, resolved.variants),
            (asked.attributes, asked.variants)
        );
    }
}

#[tokio::test]
async fn neighbors_are_those_of_rest() {
    let daemon = Daemon::start(&[]);
    let mut client = PointServiceClient::new(daemon.channel().await);
    for (k, radius) in [
        (None, None),
        (Some(8), None),
        (None, Some(4.0)),
        (Some(3), Some(2.0)),
    ] {
        let request = FindNearestRequest {
            at: Some(Position {
                x: 100.5,
                y: -3.0,
                z: None,
            }),
            k,
            radius,
            set: Some(set()),
        };
        let answer = client
            .find_nearest(request)
            .await
            .expect("points")
            .into_inner();
        let mut path = format!("/v1/nearest?at=100.5,-3&{SET}");
        path.extend(k.map(|k| format!("&k={k}")));
        path.extend(radius.map(|radius| format!("&radius={radius}")));
        let expected = daemon.get(&path).json();
        let neighbors: Vec<Value> = answer.neighbors.iter().map(written).collect();
        assert!(!neighbors.is_empty());
        assert_eq!(
            normal(&neighbors.into()),
            normal(&expected["neighbors"]),
            "{path}"
        );
        let set = answer.set.expect("set");
        assert_eq!(set.least_distance, expected["query"]["least_distance"]);
    }
}

#[tokio::test]
async fn counts_are_exact_beyond_64_bits() {
    let daemon = Daemon::start(&[]);
    let mut client = PointServiceClient::new(daemon.channel().await);
    for side in [1e3, 1e9, 1e12] {
        let request = StreamPointsRequest {
            region: boxed([0.0, 0.0, side, side]),
            set: Some(PointSet {
                amount: Some(Amount::Spacing(1.0)),
                ..PointSet::default()
            }),
            ..StreamPointsRequest::default()
        };
        let request = CountPointsRequest {
            query: Some(request),
        };
        let answer = client
            .count_points(request)
            .await
            .expect("a count")
            .into_inner();
        let rest = daemon.get(&format!("/v1/count?bbox=0,0,{side},{side}&spacing=1"));
        // Numbers that `JSON.parse` would round are text.
        let is_long = answer.digits.parse::<u128>().expect("digits") >= 1 << 53;
        let quote = if is_long { "\"" } else { "" };
        let expected = format!("{{\"count\":{quote}{}{quote},", answer.digits);
        assert!(
            rest.text().starts_with(&expected),
            "{expected} {}",
            rest.text()
        );
        let exact: u128 = answer.digits.parse().expect("digits");
        assert_eq!(answer.count, u64::try_from(exact).unwrap_or(u64::MAX));
    }
}
