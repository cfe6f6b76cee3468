//! The profile `pattern` answers for every alpha, without a table, exactly as brute force finds its points.

use std::collections::BTreeSet;

use serde_json::json;
use strew_core::{Alpha, Pattern};

use crate::support::{csv::Csv, daemon::Daemon};

/// Rational and not, with few blocks and many.
const ALPHAS: [&str; 9] = [
    "3/2",
    "4/3",
    "7/5",
    "1.01",
    "1.999",
    "183/112",
    "sqrt(2)",
    "(1+sqrt(5))/2",
    "3-sqrt(2)",
];

/// The ids of the points of a pattern in a box, at a mean spacing of 1.
fn brute(alpha: &str, [min_x, min_y, max_x, max_y]: [f64; 4]) -> BTreeSet<String> {
    let alpha: Alpha = alpha.parse().expect("valid");
    let (pattern, step) = (Pattern::new(alpha), alpha.set_side_f64());
    let cells = |min: f64, max: f64| (min / step).ceil() as i64..(max / step).ceil() as i64;
    let mut ids = BTreeSet::new();
    for y in cells(min_y, max_y) {
        for x in cells(min_x, max_x) {
            if pattern.contains(x, y) {
                ids.insert(format!("{x}:{y}"));
            }
        }
    }
    ids
}

#[test]
fn the_points_of_every_alpha_are_those_of_brute_force() {
    let daemon = Daemon::built_in();
    for alpha in ALPHAS {
        let set = format!(
            "profile=pattern&alpha={}&spacing=1",
            alpha.replace('+', "%2B")
        );
        for (region, bbox) in [
            ("bbox=0,0,19,11", [0.0, 0.0, 19.0, 11.0]),
            ("bbox=-7.5,-3.25,2,2.5", [-7.5, -3.25, 2.0, 2.5]),
        ] {
            let query = format!("{region}&{set}");
            let found = Csv::get(&daemon, &query);
            let found = &found.columns["id"];
            let ids: BTreeSet<String> = found.iter().cloned().collect();
            assert_eq!(ids.len(), found.len(), "{query}");
            assert_eq!(ids, brute(alpha, bbox), "{query}");
            let counted = daemon.get(&format!("/v1/count?{query}")).json();
            assert_eq!(counted["count"], ids.len(), "{query}");
        }
        // A point by its id, the nearest one, chunks, warped sets and thinned ones.
        let origin = daemon.get(&format!("/v1/points/0:0?{set}")).json();
        assert_eq!(
            (&origin["point"]["x"], &origin["point"]["y"]),
            (&json!(0.0), &json!(0.0)),
            "{alpha}"
        );
        let nearest = daemon.get(&format!("/v1/nearest?at=0.1,0.1&{set}"));
        assert_eq!(nearest.status, 200, "{alpha}: {}", nearest.text());
        let parts = [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[x, y]| {
            let path = format!("/v1/chunks/8/{x}/{y}?{set}&seed=5&keep=0.4&format=csv");
            let chunk = daemon.get(&path);
            assert_eq!(chunk.status, 200, "{path}: {}", chunk.text());
            chunk.text().lines().count() - 1
        });
        let whole = daemon.get(&format!("/v1/count?bbox=0,0,16,16&{set}&seed=5&keep=0.4"));
        assert_eq!(
            whole.json()["count"],
            parts.iter().sum::<usize>(),
            "{alpha}"
        );
        let body = json!({
            "region": { "bbox": [0, 0, 16, 16] },
            "layers": [
                { "name": "a", "profile": "pattern", "alpha": alpha, "count": 100, "seed": 1 },
                { "name": "b", "spacing": 2, "clear_of": { "a": 0.5 } },
            ],
            "format": "csv",
        });
        let layers = daemon.post("/v1/points:query", &body);
        assert_eq!(layers.status, 200, "{alpha}: {}", layers.text());
    }
}

#[test]
fn every_map_of_a_pattern_has_the_same_points() {
    let daemon = Daemon::built_in();
    let of = |map: &str| {
        let query = format!("bbox=0,0,30,20&spacing=1&profile=pattern&alpha=13/8&seed=3{map}");
        Csv::get(&daemon, &query)
            .columns
            .remove("id")
            .expect("a column")
    };
    let plain = of("");
    for map in [
        "&map=s",
        "&map=m",
        "&map=l",
        "&map=r0",
        "&map=r1",
        "&map=r256",
    ] {
        assert_eq!(of(map), plain, "{map}");
    }
    // The table has a digest, which can be pinned.
    let path = "/v1/points?bbox=0,0,3,3&spacing=1&profile=pattern&alpha=13/8&format=csv";
    let digest = daemon.get(path).header("strew-table").to_owned();
    assert_eq!(daemon.get(&format!("{path}&table={digest}")).status, 200);
    assert_eq!(
        daemon.get(&format!("{path}&map=m&table={digest}")).status,
        409
    );
}
