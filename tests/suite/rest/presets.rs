//! Presets: queries that take what they leave open from the settings.

use serde_json::json;

use crate::support::{csv::Csv, daemon::Daemon};

const PRESETS: &str = r#"
[presets.meadow]
spacing = 1.5
seed = 7
attributes = ["u1"]

[[presets.forest.layers]]
name = "trees"
spacing = 3
seed = 1
[[presets.forest.layers]]
name = "rocks"
spacing = 2
seed = 2
clear_of = { trees = 1 }
"#;

#[test]
fn a_preset_stands_for_what_a_query_leaves_open() {
    let daemon = Daemon::with_config(PRESETS);
    let text = |path: &str| daemon.get(path).text().to_owned();
    let chunk = "/v1/chunks/16/3/-2?format=csv";
    assert_eq!(
        text(&format!("{chunk}&preset=meadow")),
        text(&format!("{chunk}&spacing=1.5&seed=7&attributes=u1"))
    );
    // What the query says is stronger; another amount replaces the preset's.
    assert_eq!(
        text(&format!("{chunk}&preset=meadow&seed=8&density=2")),
        text(&format!("{chunk}&density=2&seed=8&attributes=u1"))
    );
    let layers = json!([
        { "name": "trees", "spacing": 3, "seed": 1 },
        { "name": "rocks", "spacing": 2, "seed": 2, "clear_of": { "trees": 1 } },
    ]);
    let region = json!({ "chunk": { "size": 16, "x": 3, "y": -2 } });
    let whole = json!({ "region": region, "layers": layers, "format": "csv" });
    let whole = Csv::post(&daemon, &whole);
    let forest = daemon.get(&format!("{chunk}&preset=forest"));
    assert_eq!(forest.text(), whole.answer.text());
    let body = json!({ "region": region, "preset": "forest", "format": "csv" });
    assert_eq!(Csv::post(&daemon, &body).points, whole.points);
    let count = daemon
        .get("/v1/count?bbox=48,-32,64,-16&preset=forest")
        .json();
    assert_eq!(count["count"], whole.points.len());
    let body = json!({ "region": region, "preset": "forest" });
    let split = daemon.post("/v1/points:split?parts=2", &body).json();
    let parts = split["parts"].as_array().expect("a list").clone();
    let points = parts.iter().flat_map(|part| {
        let mut query = part["query"].clone();
        query["format"] = json!("csv");
        Csv::post(&daemon, &query).points
    });
    assert_eq!(points.collect::<Vec<_>>(), whole.points);
}

#[test]
fn settings_decide_so_caches_ask_again() {
    let daemon = Daemon::with_config(PRESETS);
    let address = "/v1/points?bbox=0,0,9,9&preset=meadow&format=csv";
    let answer = daemon.get(address);
    let digest = answer.header("strew-table");
    let pinned = daemon.get(&format!("{address}&table={digest}"));
    assert!(!pinned.header("cache-control").contains("immutable"));
    let other = Daemon::with_config(&PRESETS.replace("1.5", "1.6"));
    assert_ne!(other.get(address).header("etag"), answer.header("etag"));
}

#[test]
fn presets_are_listed_and_unknown_ones_refused() {
    let daemon = Daemon::with_config(PRESETS);
    let list = daemon.get("/v1/presets").json();
    let names: Vec<&str> = (list["presets"].as_array().expect("a list").iter())
        .map(|preset| preset["name"].as_str().expect("text"))
        .collect();
    assert_eq!(names, ["forest", "meadow"]);
    assert_eq!(list["presets"][1]["query"]["spacing"], 1.5);
    let refused = daemon.get("/v1/points?bbox=0,0,9,9&preset=medow");
    assert_eq!(refused.status, 400);
    let fault = &refused.json()["errors"][0];
    assert_eq!(fault["detail"], "unknown preset; did you mean `meadow`?");
    assert_eq!(fault["allowed"], "forest, meadow");
    // Layers have seeds of their own.
    let refused = daemon.get("/v1/points?bbox=0,0,9,9&preset=forest&seed=3");
    assert_eq!(refused.json()["errors"][0]["field"], "seed");
}
