//! Amounts: least distances hold, counts are met, and `/v1/count` counts what an answer holds.

use serde_json::json;

use crate::support::{
    csv::{Csv, least_distance},
    daemon::Daemon,
    problem::assert_fault,
};

#[test]
fn a_least_distance_is_kept_by_all_pairs_with_and_without_warp() {
    let daemon = Daemon::start(&[]);
    for profile in ["blue", "spaced", "sharp"] {
        for rest in ["", "&seed=9", "&seed=4&warp=2", "&seed=4&warp=off"] {
            let query = format!("bbox=-20,-20,20,20&min_distance=0.8&profile={profile}{rest}");
            let table = Csv::get(&daemon, &query);
            assert!(table.points.len() > 300, "{query}");
            let least = least_distance(&table.points);
            assert!(least >= 0.8, "{query}: {least}");
            // The points are not sparse: some pair comes close to the least distance.
            assert!(least < 1.5, "{query}: {least}");
        }
    }
    // The echo reports the distance that is guaranteed.
    let query = daemon.get("/v1/count?bbox=0,0,9,9&min_distance=0.8").json()["query"].clone();
    let promised = query["least_distance"].as_f64().expect("a number");
    assert!((0.8..0.80001).contains(&promised), "{query}");
    assert!(query["spacing"].as_f64().expect("a number") > 0.8);
}

#[test]
fn a_count_where_nothing_can_be_is_refused_with_the_reason() {
    let daemon = Daemon::start(&["limits.max_rows=100000"]);
    let far = json!({ "distance": { "distances": [2, 10], "points": [[16, 20]] } });
    let bands = json!({ "noise": { "wavelength": 3, "range": [0, 0.001] } });
    let low = json!({ "curve": { "of": bands, "points": [[0, 0], [0.9, 0], [1, 1]] } });
    for (bbox, field) in [
        ([0.0, 0.0, 20.0, 20.0], json!({ "constant": 0 })),
        ([0.0, 0.0, 0.2, 274.0], json!({ "invert": far })),
        ([0.0, 0.0, 200.0, 200.0], low),
    ] {
        let body = json!({ "region": { "bbox": bbox }, "count": 800, "field": field });
        let answer = daemon.post("/v1/points:query", &body);
        let texts = ["the field is 0 in all of the region", "leaves points"];
        assert_fault(&answer, &body.to_string(), "count", &texts);
    }
    // Bounds over the box around the region do not suffice.
    let body = json!({
        "region": { "polygon": { "type": "Polygon", "coordinates": [[[0, 0], [20, 0], [0, 20], [0, 0]]] } },
        "count": 5, "field": { "ramp": { "from": [10.5, 10.5], "to": [20, 20] } },
    });
    let answer = daemon.post("/v1/points:query", &body);
    let texts = ["no point is left here, down to", "leaves points"];
    assert_fault(&answer, &body.to_string(), "count", &texts);
}

#[test]
fn counts_by_get_and_post_are_the_lengths_of_answers() {
    let daemon = Daemon::start(&[]);
    let queries = [
        ("bbox=-3,0.5,44,31", json!({ "bbox": [-3, 0.5, 44, 31] })),
        (
            "circle=1,2,9.5",
            json!({ "circle": { "center": [1, 2], "radius": 9.5 } }),
        ),
        (
            "polygon=0,0,30,0,3,20",
            json!({ "polygon": { "type": "Polygon", "coordinates": [[[0, 0], [30, 0], [3, 20]]] } }),
        ),
    ];
    for (text, region) in queries {
        for seed in [0, 6] {
            let table = Csv::get(&daemon, &format!("{text}&density=3&seed={seed}"));
            let body = json!({ "region": region, "density": 3, "seed": seed });
            assert_eq!(Csv::post(&daemon, &body).points, table.points);
            let got = daemon.get(&format!("/v1/count?{text}&density=3&seed={seed}"));
            let posted = daemon.post("/v1/count", &body);
            for answer in [&got, &posted] {
                assert_eq!(answer.json()["count"], table.points.len(), "{body}");
            }
        }
    }
}

#[test]
fn numbers_beyond_64_bits_are_counted() {
    let daemon = Daemon::start(&[]);
    let query = "bbox=-1e14,-1e14,1e14,1e14&density=1";
    let whole: u128 = {
        let answer = daemon.get(&format!("/v1/count?{query}"));
        let text = answer
            .text()
            .strip_prefix("{\"count\":\"")
            .expect("a count");
        text.split('"')
            .next()
            .expect("digits")
            .parse()
            .expect("digits")
    };
    assert!(
        whole.abs_diff(4 * 10u128.pow(28)) < 10u128.pow(22),
        "{whole}"
    );
    let offset = 10_000_000_000_000_000_000u128;
    let points = Csv::get(&daemon, &format!("{query}&offset={offset}&limit=3"));
    assert_eq!(points.points.len(), 3);
}
