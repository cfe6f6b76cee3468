//! Single points: by id and near a place. Their attributes are the same in every query.

use std::collections::BTreeMap;

use serde_json::{Value, json};
use strew_core::Point;

use crate::support::{csv::Csv, daemon::Daemon};

const SETS: [&str; 3] = [
    "spacing=0.8",
    "min_distance=0.5&seed=11&profile=spaced",
    "density=1.5&seed=3&warp=2&keep=0.6",
];

/// The largest number of intervals of any table.
fn intervals(daemon: &Daemon) -> u64 {
    let tables = daemon.get("/v1/profiles").json()["profiles"].clone();
    let tables = tables.as_array().expect("a list").iter();
    let intervals = tables.filter_map(|table| table["intervals"].as_u64());
    intervals.max().expect("a table")
}

#[test]
fn every_id_finds_its_point() {
    let daemon = Daemon::start(&[]);
    let most = intervals(&daemon);
    for set in SETS {
        for region in ["bbox=-2,-2,3,3", "bbox=5e8,-5e8,500000008,-499999994"] {
            let table = Csv::get(&daemon, &format!("{region}&{set}"));
            assert!(table.points.len() > 5);
            for point in &table.points {
                let answer = daemon.get(&format!("/v1/points/{}?{set}", point.id));
                assert_eq!(answer.status, 200, "{}", answer.text());
                let found = &answer.json()["point"];
                assert_eq!(found["id"], point.id.to_string());
                assert_eq!(
                    (&found["x"], &found["y"]),
                    (&json!(point.x), &json!(point.y))
                );
                let block = found["block"].as_array().expect("a column and a row");
                assert!(block.iter().all(|i| i.as_u64().is_some_and(|i| i < most)));
                assert_eq!(block.len(), 2);
            }
        }
        // Most lattice addresses have no point.
        let none = (0..50).filter(|i| {
            let answer = daemon.get(&format!("/v1/points/{i}:7?{set}"));
            assert!(answer.status == 200 || answer.status == 404);
            if answer.status == 404 {
                assert_eq!(answer.json()["type"], "urn:strew:problem:no-such-point");
            }
            answer.status == 404
        });
        assert!(none.count() > 25);
    }
}

/// All points with their squared distances, nearest first.
fn brute(points: &[Point], at: [f64; 2]) -> Vec<(f64, Point)> {
    let squared = |p: &Point| {
        let [dx, dy] = [p.x - at[0], p.y - at[1]];
        dx * dx + dy * dy
    };
    let mut all: Vec<(f64, Point)> = points.iter().map(|p| (squared(p), *p)).collect();
    all.sort_by(|(d, p), (e, q)| d.total_cmp(e).then(p.id.cmp(&q.id)));
    all
}

#[test]
fn the_nearest_points_are_those_of_a_brute_force_search() {
    let daemon = Daemon::start(&[]);
    for set in SETS {
        let all = Csv::get(&daemon, &format!("bbox=-30,-30,30,30&{set}")).points;
        for at in [[0.0, 0.0], [3.25, -7.5], [-11.0, 0.125]] {
            let expected = brute(&all, at);
            let [x, y] = at;
            for (wanted, rest) in [
                (1, String::new()),
                (8, "&k=8".into()),
                (200, "&k=200".into()),
                (usize::MAX, "&radius=2.5".into()),
                (usize::MAX, "&radius=0.0001".into()),
                (3, "&k=3&radius=9".into()),
                (100, "&k=100&radius=1.5".into()),
            ] {
                let radius = rest
                    .split("radius=")
                    .nth(1)
                    .map_or(f64::INFINITY, |r| r.parse().expect("a number"));
                let expected = expected.iter().filter(|(d, _)| *d <= radius * radius);
                let expected: Vec<_> = expected.take(wanted).collect();
                let path = format!("/v1/nearest?at={x},{y}&{set}{rest}");
                let answer = daemon.get(&path);
                assert_eq!(answer.status, 200, "{}", answer.text());
                let answer = answer.json();
                let got = answer["neighbors"].as_array().expect("a list");
                assert_eq!(got.len(), expected.len(), "{path}");
                for (got, (squared, point)) in got.iter().zip(expected) {
                    assert_eq!(got["id"], point.id.to_string(), "{path}");
                    assert_eq!(got["distance"], squared.sqrt(), "{path}");
                    assert_eq!((&got["x"], &got["y"]), (&json!(point.x), &json!(point.y)));
                }
            }
        }
    }
}

#[test]
fn nothing_beyond_the_radius_is_searched() {
    let daemon = Daemon::start(&[]);
    let nothing = daemon.post("/v1/fields", &json!({ "constant": 0 })).json();
    let nothing = nothing["digest"].as_str().expect("a digest");
    for set in ["keep=1e-6", &format!("field={nothing}")] {
        let address = format!("/v1/nearest?at=0,0&k=5&spacing=1&{set}");
        let refused = daemon.get(&address);
        assert_eq!(refused.status, 400, "{}", refused.text());
        let answer = daemon.get(&format!("{address}&radius=10"));
        assert_eq!(answer.status, 200, "{}", answer.text());
        assert_eq!(answer.json()["neighbors"], json!([]));
    }
}

const ATTRIBUTES: &str = "attributes=angle,scale,variant,rank,u1,u16&scale_range=0.5,2&\
                          variants=oak:3,birch,ash:0.5";

/// The attributes of points in JSON, by id.
fn values(points: &Value) -> BTreeMap<String, Value> {
    let point = |point: &Value| {
        let mut point = point.clone();
        let members = point.as_object_mut().expect("an object");
        let id = members.remove("id").expect("an id");
        for name in ["x", "y", "distance", "layer"] {
            members.remove(name);
        }
        (id.as_str().expect("a text").to_owned(), point)
    };
    points
        .as_array()
        .expect("a list")
        .iter()
        .map(point)
        .collect()
}

#[test]
fn attributes_are_the_same_in_every_query_and_within_their_ranges() {
    let daemon = Daemon::start(&[]);
    let set = "spacing=0.4&seed=21";
    let all = daemon
        .get(&format!("/v1/points?bbox=-8,-8,8,8&{set}&{ATTRIBUTES}"))
        .json();
    let all = values(&all["points"]);
    assert!(all.len() > 1000);
    for value in all.values() {
        let number = |name: &str| value[name].as_f64().expect("a number");
        assert!((0.0..std::f64::consts::TAU).contains(&number("angle")));
        assert!((0.5..=2.0).contains(&number("scale")));
        for name in ["rank", "u1", "u16"] {
            assert!((0.0..1.0).contains(&number(name)));
        }
    }
    let share = |name: &str| {
        let of = all.values().filter(|value| value["variant"] == name);
        of.count() as f64 / all.len() as f64
    };
    for (name, weight) in [("oak", 3.0), ("birch", 1.0), ("ash", 0.5)] {
        assert!((share(name) - weight / 4.5).abs() < 0.05, "{name}");
    }

    let layers = json!({
        "region": { "circle": { "center": [1, 1], "radius": 5 } },
        "layers": [{
            "name": "all", "spacing": 0.4, "seed": 21, "scale_range": [0.5, 2],
            "attributes": ["angle", "scale", "variant", "rank", "u1", "u16"],
            "variants": { "oak": 3, "birch": 1, "ash": 0.5 },
        }],
    });
    let others = [
        daemon
            .get(&format!("/v1/chunks/4/-1/0?{set}&{ATTRIBUTES}"))
            .json()["points"]
            .clone(),
        daemon
            .get(&format!("/v1/nearest?at=0,0&k=50&{set}&{ATTRIBUTES}"))
            .json()["neighbors"]
            .clone(),
        daemon
            .get(&format!(
                "/v1/points?polygon=0,0,7,1,2,6&{set}&keep=0.5&{ATTRIBUTES}"
            ))
            .json()["points"]
            .clone(),
        daemon.post("/v1/points:query", &layers).json()["points"].clone(),
    ];
    for (i, other) in others.iter().enumerate() {
        let other = values(other);
        assert!(other.len() >= 50);
        for (id, value) in &other {
            // In an object, variants are ordered by name, which changes who gets which.
            let (mut value, mut known) = (value.clone(), all[id].clone());
            if i == 3 {
                value["variant"] = Value::Null;
                known["variant"] = Value::Null;
            }
            assert_eq!(value, known, "{i} {id}");
        }
    }
    let (id, value) = all.first_key_value().expect("some");
    let mut one = daemon
        .get(&format!("/v1/points/{id}?{set}&{ATTRIBUTES}"))
        .json();
    // Only a single point reports its block.
    let block = one["point"]
        .as_object_mut()
        .and_then(|point| point.remove("block"));
    assert!(block.is_some());
    assert_eq!(values(&json!([one["point"]]))[id], *value);
}

#[test]
fn a_share_keeps_the_points_of_lowest_rank() {
    let daemon = Daemon::start(&[]);
    for set in ["spacing=0.5", "spacing=0.5&seed=6&profile=step"] {
        let region = "bbox=-15,-15,15,15";
        let all = Csv::get(&daemon, &format!("{region}&{set}&attributes=rank"));
        let ranks: Vec<f64> = all.columns["rank"]
            .iter()
            .map(|text| text.parse().expect("a number"))
            .collect();
        for share in [0.01, 0.25, 0.5, 0.99] {
            let kept = Csv::get(&daemon, &format!("{region}&{set}&keep={share}&settle=0")).points;
            let lesser = all
                .points
                .iter()
                .zip(&ranks)
                .filter(|(_, rank)| **rank < share);
            let lesser: Vec<Point> = lesser.map(|(point, _)| *point).collect();
            assert_eq!(kept, lesser, "{set} {share}");
            let part = kept.len() as f64 / all.points.len() as f64;
            assert!((part - share).abs() < 0.02, "{set} {share}: {part}");
        }
    }
}
