//! Kinds whose shares vary from place to place.

use serde_json::{Value, json};
use strew_core::Point;
use strew_testkit::{
    http1::{self, Answer},
    wait::until,
};

use crate::support::{
    csv::Csv,
    daemon::{Daemon, no_tables},
    fields::{folder, write},
    problem::assert_fault,
};

/// A seeded set on the smallest map; the field `ramp` rises from 0 at x = 0 to 1 at x = 40.
const SET: &str = "map=s&spacing=1&seed=9&attributes=variant&variants=oak:1,birch:1&spread=even";
const VARIED: &str = "variant_fields=birch:ramp";

/// A daemon with the fields of a folder.
fn daemon(fields: &tempfile::TempDir) -> Daemon {
    let setting = format!("fields.folder={}", fields.path().display());
    Daemon::with_tables(no_tables(), &[&setting, "reload.watch_seconds=0"])
}

/// The points of a variant.
fn named(csv: &Csv, name: &str) -> Vec<Point> {
    let names = csv.points.iter().zip(&csv.columns["variant"]);
    names
        .filter(|(_, own)| *own == name)
        .map(|(point, _)| *point)
        .collect()
}

fn counts(answer: &Answer) -> Value {
    serde_json::from_str(answer.header("strew-kinds")).expect("JSON")
}

#[test]
fn shares_follow_the_field_and_points_do_not_move() {
    let folder = folder();
    let daemon = daemon(&folder);
    let region = "bbox=0,0,40,40";
    let plain = Csv::get(&daemon, &format!("{region}&{SET}"));
    let varied = Csv::get(&daemon, &format!("{region}&{SET}&{VARIED}"));
    assert_eq!(varied.points, plain.points);
    let [oaks, birches] = ["oak", "birch"].map(|name| named(&varied, name));
    assert_eq!(
        counts(&varied.answer),
        json!({ "oak": oaks.len(), "birch": birches.len() })
    );
    let within = |points: &[Point], from: f64| {
        let inside = points.iter().filter(|p| (from..from + 10.0).contains(&p.x));
        inside.count() as f64
    };
    // The weight of a birch is that of the ramp, r, and its share r/(1 + r): on average 0.11 and 0.46.
    for (from, expected) in [(0.0, 0.11), (30.0, 0.466)] {
        let [oak, birch] = [within(&oaks, from), within(&birches, from)];
        let share = birch / (oak + birch);
        assert!((share - expected).abs() < 0.02, "{from}: {share}");
    }
    // One kind alone, in chunks and parts, with its own count.
    for (name, points) in [("oak", &oaks), ("birch", &birches)] {
        let address = format!("{region}&{SET}&{VARIED}&only={name}");
        assert_eq!(&Csv::get(&daemon, &address).points, points);
        let count = daemon.get(&format!("/v1/count?{address}")).json();
        assert_eq!(count["count"], points.len());
        let mut joined = 0;
        for chunk in ["20/0/0", "20/1/0", "20/0/1", "20/1/1"] {
            let chunk = Csv::chunk(&daemon, &format!("{chunk}?{SET}&{VARIED}&only={name}"));
            assert!(
                chunk
                    .points
                    .iter()
                    .all(|p| points.iter().any(|own| own.id == p.id))
            );
            joined += chunk.points.len();
        }
        assert_eq!(joined, points.len());
        let page = Csv::get(&daemon, &format!("{address}&limit=100"));
        let next = page.answer.header("strew-next").to_owned();
        let rest = Csv::get(&daemon, &format!("{address}&cursor={next}"));
        assert_eq!([page.points, rest.points].concat(), *points);
    }
    // By id and near a place.
    let one = daemon
        .get(&format!("/v1/points/{}?{SET}&{VARIED}", birches[0].id))
        .json();
    assert_eq!(one["point"]["variant"], "birch");
    let at = format!("{},{}", birches[0].x, birches[0].y);
    let near = daemon
        .get(&format!("/v1/nearest?at={at}&{SET}&{VARIED}&only=birch"))
        .json();
    assert_eq!(near["neighbors"][0]["id"], birches[0].id.to_string());
    // Thinning changes no kind.
    let thinned = Csv::get(
        &daemon,
        &format!("{region}&{SET}&{VARIED}&keep=0.5&settle=0"),
    );
    let thinned = named(&thinned, "birch");
    assert!(thinned.len() > 50 && thinned.iter().all(|point| birches.contains(point)));
}

#[test]
fn answers_say_which_fields_and_change_with_them() {
    let folder = folder();
    let daemon = daemon(&folder);
    let address = format!("/v1/count?bbox=0,0,40,40&{SET}&{VARIED}");
    let answer = daemon.get(&address);
    let query = &answer.json()["query"];
    let digest = daemon.get("/v1/fields/ramp").json()["digest"].clone();
    assert_eq!(query["variant_fields"], json!({ "birch": "ramp" }));
    assert_eq!(query["variant_field_digests"], json!({ "birch": digest }));
    assert!(query.get("kind_distances").is_none(), "{query}");
    // The same points from the field as a description, and others from another field.
    let body = |field: Value| {
        json!({
            "region": { "bbox": [0, 0, 40, 40] }, "map": "s", "spacing": 1, "seed": 9,
            "variants": { "oak": 1, "birch": 1 }, "spread": "even", "variant_fields": { "birch": field },
        })
    };
    let post = |field: Value| daemon.post("/v1/count", &body(field)).json();
    let described = daemon.get("/v1/fields/ramp").json()["field"].clone();
    let same = post(described);
    assert_eq!(same["count"], answer.json()["count"]);
    assert_eq!(same["query"]["kinds"], query["kinds"]);
    assert_eq!(
        same["query"]["variant_field_digests"],
        query["variant_field_digests"]
    );
    assert!(same["query"].get("variant_fields").is_none());
    let none = post(json!({ "constant": 0 }));
    assert_eq!(
        none["query"]["kinds"],
        json!({ "oak": none["count"], "birch": 0 })
    );
    // A cursor is of one field, and so is a tag.
    let first = daemon.get(&format!(
        "/v1/points?bbox=0,0,40,40&{SET}&{VARIED}&limit=9&format=csv"
    ));
    let (next, tag) = (
        first.header("strew-next").to_owned(),
        first.header("etag").to_owned(),
    );
    let other =
        format!("/v1/points?bbox=0,0,40,40&{SET}&variant_fields=birch:left&limit=9&format=csv");
    let answer = daemon.get(&format!("{other}&cursor={next}"));
    assert_fault(&answer, "another field", "cursor", &[]);
    assert_ne!(daemon.get(&other).header("etag"), tag);
}

#[test]
fn tags_of_single_points_change_with_all_that_is_loaded() {
    let folder = folder();
    let daemon = daemon(&folder);
    let near = format!("/v1/nearest?at=20,20&{SET}");
    let table = daemon.get("/v1/points?bbox=0,0,1,1&map=s&spacing=1");
    let table = table.header("strew-table");
    let pin = format!("table={table}");
    let terrain = format!("{near}&terrain=ramp&{pin}");
    let varied = format!("{near}&{VARIED}&{pin}");
    let id = daemon.get(&near).json()["neighbors"][0]["id"].clone();
    let id = id.as_str().expect("an id");
    let single = format!("/v1/points/{id}?{SET}&terrain=ramp&{pin}");
    let paths = [terrain, varied, single];
    let before: Vec<Answer> = paths.iter().map(|path| daemon.get(path)).collect();
    for (path, answer) in paths.iter().zip(&before) {
        assert_eq!(answer.status, 200, "{}", answer.text());
        let kept = answer.header("cache-control");
        assert!(!kept.contains("immutable"), "{path}: {kept}");
    }
    // A described field that names a loaded one may change as well.
    let within = json!({
        "region": { "bbox": [0, 0, 4, 4] }, "spacing": 1, "map": "s", "table": table,
        "field": { "invert": { "name": "ramp" } },
    });
    let within = daemon.post("/v1/points:query", &within);
    assert_eq!(within.status, 200, "{}", within.text());
    assert!(!within.header("cache-control").contains("immutable"));

    write(
        folder.path(),
        "ramp.json",
        br#"{"ramp": {"from": [0, 0], "to": [80, 0]}}"#,
    );
    daemon.signal("HUP");
    until("the field is served", || {
        let answer = daemon.get(&paths[0]);
        answer.body != before[0].body
    });
    for (path, before) in paths.iter().zip(&before) {
        let tag = before.header("etag");
        let after = http1::get(daemon.address(), path, &[("if-none-match", tag)]);
        assert_eq!(after.status, 200, "{path}");
        assert_ne!(after.header("etag"), tag, "{path}");
    }
}

#[test]
fn queries_that_would_take_too_long_are_refused_before_they_begin() {
    let folder = folder();
    let daemon = daemon(&folder);
    let answer = daemon.get(&format!("/v1/count?bbox=0,0,1e6,1e6&{SET}&{VARIED}"));
    assert_eq!(answer.status, 413, "{}", answer.text());
    assert!(answer.text().contains("too-many-rows"), "{}", answer.text());
}
