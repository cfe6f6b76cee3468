//! Kinds: variants that are evenly spread.

use std::collections::BTreeMap;

use serde_json::{Value, json};
use strew_core::{Point, Table};
use strew_testkit::wait::until;

use crate::support::{
    csv::Csv,
    daemon::{Daemon, no_tables},
};

/// A seeded set on the smallest map, whose mixes are made soonest.
const SET: &str = "map=s&spacing=1&seed=9&attributes=variant&variants=oak:3,birch:1";

/// The points of each variant.
fn by_name(csv: &Csv) -> BTreeMap<String, Vec<Point>> {
    let mut all: BTreeMap<String, Vec<Point>> = BTreeMap::new();
    for (point, name) in csv.points.iter().zip(&csv.columns["variant"]) {
        all.entry(name.clone()).or_default().push(*point);
    }
    all
}

/// The counts of the header.
fn counts(csv: &Csv) -> Value {
    serde_json::from_str(csv.answer.header("strew-kinds")).expect("JSON")
}

#[test]
fn points_do_not_move_and_kinds_are_counted_before_they_come() {
    let daemon = Daemon::built_in();
    let region = "bbox=-40,20,90,150";
    let even = Csv::get(&daemon, &format!("{region}&{SET}&spread=even"));
    let chance = Csv::get(&daemon, &format!("{region}&{SET}"));
    assert_eq!(even.points, chance.points);
    assert_ne!(even.columns["variant"], chance.columns["variant"]);
    let kinds = by_name(&even);
    let [oaks, birches] = ["oak", "birch"].map(|name| &kinds[name]);
    assert_eq!(
        counts(&even),
        json!({ "oak": oaks.len(), "birch": birches.len() })
    );
    // A quarter to within the blocks at the edge, where chance is off by 1.3 % of all.
    let share = birches.len() as f64 / even.points.len() as f64;
    assert!((share - 0.25).abs() < 0.003, "{share}");
    // The distances that they keep.
    let echo = daemon
        .get(&format!("/v1/count?{region}&{SET}&spread=even"))
        .json()["query"]
        .clone();
    let pairs = echo["kind_distances"].as_array().expect("a list");
    assert_eq!(pairs.len(), 3, "{pairs:?}");
    for pair in pairs {
        let [a, b] = [0, 1].map(|i| pair["kinds"][i].as_str().expect("a name"));
        let promised = pair["least_distance"].as_f64().expect("a number");
        let all = kinds[a]
            .iter()
            .flat_map(|one| kinds[b].iter().map(move |other| (one, other)));
        let distances = all.filter(|(one, other)| one.id != other.id);
        let least = distances.map(|(one, other)| (one.x - other.x).hypot(one.y - other.y));
        let least = least.fold(f64::INFINITY, f64::min);
        assert!(
            promised <= least && promised > 0.6 * least,
            "{pair}: {least}"
        );
    }
    // One kind alone, and the order of names does not matter.
    for name in ["oak", "birch"] {
        let turned = SET.replace("oak:3,birch:1", "birch:2,oak:6");
        let only = Csv::get(
            &daemon,
            &format!("{region}&{turned}&spread=even&only={name}"),
        );
        assert_eq!(only.points, kinds[name]);
    }
    // By chunks, by id and near a place.
    let chunk = Csv::chunk(&daemon, &format!("32/1/2?{SET}&spread=even"));
    assert!(!chunk.points.is_empty());
    for (point, name) in chunk.points.iter().zip(&chunk.columns["variant"]) {
        assert!(kinds[name].iter().any(|other| other.id == point.id));
    }
    let first = &chunk.points[0];
    let one = daemon
        .get(&format!("/v1/points/{}?{SET}&spread=even", first.id))
        .json();
    assert_eq!(
        one["point"]["variant"],
        chunk.columns["variant"][0].as_str()
    );
    let near = format!(
        "/v1/nearest?at={},{}&{SET}&spread=even&only=birch",
        first.x + 32.0,
        first.y + 64.0
    );
    let near = daemon.get(&near).json();
    let id = near["neighbors"][0]["id"]
        .as_str()
        .expect("an id")
        .to_owned();
    assert!(birches.iter().any(|birch| birch.id.to_string() == id));
}

#[test]
fn kinds_thin_out_together_and_fill_exact_numbers() {
    let daemon = Daemon::built_in();
    let region = "bbox=0,0,120,120";
    for more in [
        "keep=0.3",
        "count=3000",
        "keep=0.5&count=1111",
        "field=forest",
    ] {
        let set = match more.contains("count") {
            true => SET.replace("spacing=1&", ""),
            false => SET.to_owned(),
        };
        let csv = Csv::get(&daemon, &format!("{region}&{set}&spread=even&{more}"));
        let kinds = by_name(&csv);
        let numbers: BTreeMap<&String, usize> = kinds
            .iter()
            .map(|(name, points)| (name, points.len()))
            .collect();
        assert_eq!(counts(&csv), json!(numbers), "{more}");
        let share = kinds["birch"].len() as f64 / csv.points.len() as f64;
        assert!((share - 0.25).abs() < 0.02, "{more}: {share}");
        let count = daemon
            .get(&format!("/v1/count?{region}&{set}&spread=even&{more}"))
            .json();
        assert_eq!(count["query"]["kinds"], json!(numbers), "{more}");
    }
    // Each half of the region has its share of a kind: a random choice varies three times as much.
    let set = format!("{SET}&spread=even&only=birch");
    let mut squares = 0.0;
    for i in 0..64 {
        let [x, y] = [i % 8 * 10, i / 8 * 10];
        let count = daemon.get(&format!(
            "/v1/count?bbox={x},{y},{},{}&{set}",
            x + 10,
            y + 10
        ));
        let count = count.json()["count"].as_f64().expect("a number");
        squares += (count - 25.0).powi(2);
    }
    assert!(squares / 64.0 < 0.35 * 25.0 * 0.75, "{}", squares / 64.0);
}

#[test]
fn layers_pages_and_parts_have_their_kinds() {
    let daemon = Daemon::built_in();
    let layers = json!([
        { "name": "trees", "spacing": 2, "seed": 1, "map": "s", "attributes": ["variant"],
          "variants": { "oak": 3, "birch": 1 }, "spread": "even" },
        { "name": "rocks", "spacing": 1, "seed": 2, "map": "s", "clear_of": { "trees": 1 },
          "attributes": ["variant"], "variants": { "big": 1, "small": 1 }, "spread": "even", "only": "big" },
    ]);
    let body = json!({ "region": { "bbox": [0, 0, 60, 60] }, "layers": layers });
    let whole = Csv::post(&daemon, &body);
    let of = |layer: &str, name: &str| {
        let rows = whole.columns["layer"].iter().zip(&whole.columns["variant"]);
        rows.filter(|(other, kind)| *other == layer && *kind == name)
            .count()
    };
    let expected = json!({
        "trees": { "oak": of("trees", "oak"), "birch": of("trees", "birch") },
        "rocks": { "big": of("rocks", "big"), "small": 0 },
    });
    assert_eq!(counts(&whole), expected);
    assert!(of("rocks", "big") > 100 && of("rocks", "small") == 0);
    let split = daemon.post("/v1/points:split?parts=3", &body).json();
    let parts = split["parts"].as_array().expect("a list").clone();
    let points = parts
        .iter()
        .flat_map(|part| Csv::post(&daemon, &part["query"]).points);
    assert_eq!(points.collect::<Vec<_>>(), whole.points);
}

#[test]
fn joint_kinds_have_points_of_their_own() {
    let daemon = Daemon::built_in();
    let set = SET.replace("map=s", "map=m");
    let region = "bbox=0,0,60,60";
    let plain = Csv::get(&daemon, &format!("{region}&{set}"));
    let joint = Csv::get(&daemon, &format!("{region}&{set}&spread=joint"));
    assert_ne!(joint.points, plain.points);
    assert_ne!(
        joint.answer.header("strew-table"),
        plain.answer.header("strew-table")
    );
    let kinds = by_name(&joint);
    let numbers = json!({ "oak": kinds["oak"].len(), "birch": kinds["birch"].len() });
    assert_eq!(counts(&joint), numbers);
    // Birches keep apart as a set of a quarter of the density does.
    assert!(crate::support::csv::least_distance(&kinds["birch"]) > 1.1);
    // Pinned by its own digest; without kinds the plain table answers.
    let digest = joint.answer.header("strew-table");
    let pinned = Csv::get(
        &daemon,
        &format!("{region}&{set}&spread=joint&table={digest}"),
    );
    assert_eq!(pinned.points, joint.points);
    assert!(pinned.answer.header("cache-control").contains("immutable"));
    let other = daemon.get(&format!("/v1/points?{region}&{set}&table={digest}"));
    assert_eq!(other.status, 409, "{}", other.text());
    let profiles = daemon.get("/v1/profiles").json();
    let all = profiles["profiles"].as_array().expect("a list");
    let of = |map: &str| {
        let is_it = |entry: &&Value| entry["profile"] == "blue" && entry["map"] == map;
        all.iter().find(is_it).expect("built in").clone()
    };
    let mut joint: Vec<String> =
        serde_json::from_value(of("m")["joint_kinds"].clone()).expect("a list");
    joint.sort();
    assert_eq!(joint, ["1:1", "1:1:2", "1:3", "1:3:10"]);
    assert_eq!(of("s")["joint_kinds"], json!([]));
}

#[test]
fn an_answer_that_waits_for_labels_says_so_and_when_to_come_back() {
    let daemon = Daemon::with_tables(no_tables(), &["server.first_byte_seconds=0.1"]);
    let address = "/v1/count?bbox=0,0,30,30&spacing=1&map=m";
    until("the table is read", || daemon.get(address).status == 200);
    let mut waits = vec![];
    until("the labels are made", || {
        let kinds = "spread=even&variants=oak:13,birch:7,ash:5,elm:3,fir:2,yew:1";
        let answer = daemon.get(&format!("{address}&{kinds}"));
        if answer.status == 200 {
            return Some(());
        }
        assert_eq!((answer.status, answer.header("retry-after")), (503, "5"));
        waits.push(answer.json()["detail"].to_string());
        None
    });
    let words = "labels of these kinds are being made";
    assert!(
        waits.iter().any(|detail| detail.contains(words)),
        "{waits:?}"
    );
}

#[test]
fn a_restart_finds_what_was_made() {
    let address = format!("/v1/points?bbox=0,0,30,30&{SET}&spread=even&format=csv");
    let folder = no_tables();
    let kept = folder.path().join("mixes");
    let daemon = Daemon::with_tables(folder, &[]);
    let answer = daemon.get(&address).text().to_owned();
    let files = || -> Vec<_> {
        let files = std::fs::read_dir(&kept).expect("a folder");
        files.map(|file| file.expect("a file").path()).collect()
    };
    let [file] = &files()[..] else {
        panic!("{:?}", files())
    };
    let bytes = std::fs::read(file).expect("readable");
    let table = Table::from_bytes(&bytes).expect("a table");
    assert_eq!(table.mix().expect("kinds").shares().to_string(), "1:3");
    // In a folder of tables it serves as well.
    let tables = no_tables();
    std::fs::write(tables.path().join("mix.strew"), &bytes).expect("writable");
    let again = Daemon::with_tables(tables, &[]);
    assert_eq!(again.get(&address).text(), answer);
    assert!(!again.folder().join("mixes").exists());
    // A damaged one is made again.
    let damaged = no_tables();
    let name = file.file_name().expect("a name");
    let path = damaged.path().join("mixes").join(name);
    std::fs::create_dir(damaged.path().join("mixes")).expect("writable");
    std::fs::write(&path, &bytes[..bytes.len() / 2]).expect("writable");
    let again = Daemon::with_tables(damaged, &[]);
    assert_eq!(again.get(&address).text(), answer);
    assert_eq!(std::fs::read(&path).expect("readable"), bytes);
}
