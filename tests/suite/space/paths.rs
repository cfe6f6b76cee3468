//! Every path over REST has the points of the library, and partitions have every point once.

use serde_json::{Value, json};
use strew_core::{
    Polygon,
    space::{Ball, Prism, Region, Volume},
};

use super::{lines, set, told, within};
use crate::support::daemon::Daemon;

/// Volumes as regions of a body, and as the library has them.
fn volumes() -> Vec<(Value, Volume)> {
    let region = Region::new([-3.5, 2.0, 100.0], [4.25, 9.0, 107.5]).expect("a box");
    let ball = Ball::new([1.0, -2.0, 3.0], 4.5).expect("a ball");
    let corners = [[0.0, 0.0], [9.0, 1.0], [2.0, 8.0]];
    let base = Polygon::new(&[corners.to_vec()]).expect("a polygon");
    let prism = Prism::new(base, [-1.0, 2.5]).expect("a prism");
    let chunk = Region::chunk(7.0, [3, -2, 0]).expect("a chunk");
    let polygon = json!({ "type": "Polygon", "coordinates": [[[0, 0], [9, 1], [2, 8], [0, 0]]] });
    let described =
        |ball: &Ball| json!({ "ball": { "center": ball.center(), "radius": ball.radius() } });
    let hole = Ball::new([1.0, -2.0, 3.0], 2.0).expect("a ball");
    vec![
        (
            json!({ "bbox": [-3.5, 2, 100, 4.25, 9, 107.5] }),
            region.into(),
        ),
        (described(&ball), ball.into()),
        (
            json!({ "prism": { "polygon": polygon, "bottom": -1, "top": 2.5 } }),
            prism.into(),
        ),
        (
            json!({ "chunk": { "size": 7, "x": 3, "y": -2, "z": 0 } }),
            chunk.into(),
        ),
        (
            json!({ "include": [described(&ball), { "bbox": [0, 0, 0, 3, 3, 9] }], "exclude": [described(&hole)] }),
            Volume::any_of([
                ball.into(),
                Region::new([0.0; 3], [3.0, 3.0, 9.0])
                    .expect("a box")
                    .into(),
            ])
            .without([hole.into()]),
        ),
    ]
}

#[test]
fn volumes_have_the_points_of_the_library() {
    let daemon = Daemon::built_in();
    for (region, volume) in volumes() {
        for (seed, spacing) in [(0, 1.0), (7, 0.8)] {
            let body =
                json!({ "region": region, "spacing": spacing, "seed": seed, "format": "csv" });
            let plan = within(&set(spacing, seed), volume.clone());
            let answer = daemon.post("/v1/space/points", &body);
            assert_eq!(answer.header("strew-count"), plan.count().to_string());
            let expected = match region.get("chunk") {
                // Relative to the corner, as the box beside it shows.
                Some(_) => {
                    assert_eq!(answer.header("strew-origin"), "21.0,-14.0,0.0");
                    let moved = plan.iter().map(|point| {
                        let [x, y, z] = point.at();
                        (point.id().to_string(), [x - 21.0, y + 14.0, z])
                    });
                    moved.collect()
                }
                None => told(&plan.to_vec()),
            };
            let got = lines(&answer);
            assert_eq!(got.len(), expected.len());
            for ((id, at), (own, place)) in got.iter().zip(&expected) {
                assert_eq!(id, own);
                let far = (0..3).any(|axis| (at[axis] - place[axis]).abs() > 1e-13);
                assert!(!far, "{id}: {at:?}, not {place:?}");
            }
            let counted = daemon.post(
                "/v1/space/count",
                &json!({ "region": region, "spacing": spacing, "seed": seed }),
            );
            assert_eq!(counted.json()["count"], json!(plan.count()));
        }
    }
}

#[test]
fn chunks_parts_and_pages_have_every_point_once() {
    let daemon = Daemon::built_in();
    let query = "spacing=0.7&seed=3&format=csv";
    let whole = lines(&daemon.get(&format!("/v1/space/points?bbox=-4,-4,0,4,4,4&{query}")));
    let mut ids: Vec<&str> = whole.iter().map(|(id, _)| id.as_str()).collect();
    let mut chunked = vec![];
    for [x, y] in [[-1, -1], [-1, 0], [0, -1], [0, 0]] {
        let answer = daemon.get(&format!("/v1/space/chunks/4/{x}/{y}/0?{query}"));
        let origin = [x, y].map(|v| f64::from(4 * v));
        for (id, [dx, dy, dz]) in lines(&answer) {
            let own = whole
                .iter()
                .find(|(known, _)| *known == id)
                .expect("in the box");
            let place = [dx + origin[0], dy + origin[1], dz];
            assert!((0..3).all(|axis| (own.1[axis] - place[axis]).abs() < 1e-13));
            chunked.push(id);
        }
    }
    let body = json!({ "region": { "bbox": [-4, -4, 0, 4, 4, 4] }, "spacing": 0.7, "seed": 3 });
    let split = daemon.post("/v1/space/points:split?parts=5", &body).json();
    let mut parted = vec![];
    for part in split["parts"].as_array().expect("a list") {
        let mut query = part["query"].clone();
        query["format"] = json!("csv");
        let lines = lines(&daemon.post("/v1/space/points", &query));
        assert_eq!(json!(lines.len()), part["count"]);
        parted.extend(lines);
    }
    assert_eq!(parted, whole);
    let mut paged = vec![];
    let mut next = String::new();
    loop {
        let cursor = match next.is_empty() {
            true => String::new(),
            false => format!("&cursor={next}"),
        };
        let path = format!("/v1/space/points?bbox=-4,-4,0,4,4,4&{query}&limit=400{cursor}");
        let answer = daemon.get(&path);
        paged.extend(lines(&answer));
        next = answer.header("strew-next").into();
        if next.is_empty() {
            break;
        }
    }
    assert_eq!(paged, whole);
    chunked.sort();
    ids.sort_unstable();
    assert_eq!(chunked, ids);
}

#[test]
fn single_points_and_neighbors_are_those_of_the_library() {
    let daemon = Daemon::built_in();
    let own = set(1.5, 9);
    let query = "spacing=1.5&seed=9&attributes=rotation,rank";
    let answer = daemon.get(&format!("/v1/space/nearest?at=100.5,-3,12&k=6&{query}"));
    let found = own.nearest([100.5, -3.0, 12.0], 6).expect("near");
    for (told, expected) in answer.json()["neighbors"]
        .as_array()
        .expect("a list")
        .iter()
        .zip(&found)
    {
        assert_eq!(told["id"], json!(expected.member.id().to_string()));
        assert_eq!(told["z"], json!(expected.member.point().z));
        assert_eq!(told["distance"], json!(expected.distance));
        let id = expected.member.id();
        assert_eq!(told["rank"], json!(own.rank(id)));
        let single = daemon.get(&format!("/v1/space/points/{id}?{query}")).json();
        let mut point = told.clone();
        point.as_object_mut().expect("an object").remove("distance");
        assert_eq!(single["point"], point);
        let squares =
            ["qx", "qy", "qz", "qw"].map(|name| told[name].as_f64().expect("a number").powi(2));
        assert!((squares.iter().sum::<f64>() - 1.0).abs() < 1e-12);
    }
    let within = daemon
        .get(&format!("/v1/space/nearest?at=0,0,0&radius=4&{query}"))
        .json();
    let expected = own.nearest_within([0.0; 3], 10_000, 4.0).expect("near");
    assert_eq!(
        within["neighbors"].as_array().map(Vec::len),
        Some(expected.len())
    );
}

#[test]
fn layers_keep_clear_of_each_other_and_have_seeds_of_their_own() {
    let daemon = Daemon::built_in();
    let layers = json!([
        { "name": "stars", "spacing": 2, "attributes": ["rotation"] },
        { "name": "dust", "spacing": 0.8, "clear_of": { "stars": 1.1 }, "region": { "bbox": [0, 0, 0, 5, 9, 9] } },
    ]);
    let body = json!({ "region": { "bbox": [0, 0, 0, 9, 9, 9] }, "seed": 4, "layers": layers, "format": "json" });
    let answer = daemon.post("/v1/space/points", &body).json();
    let points = answer["points"].as_array().expect("a list");
    let of = |name: &str| -> Vec<[f64; 3]> {
        let own = points.iter().filter(|point| point["layer"] == name);
        let place = |p: &Value| ["x", "y", "z"].map(|axis| p[axis].as_f64().expect("a number"));
        own.map(place).collect()
    };
    let (stars, dust) = (of("stars"), of("dust"));
    assert!(
        stars.len() > 60 && dust.len() > 100,
        "{} {}",
        stars.len(),
        dust.len()
    );
    let squared =
        |a: &[f64; 3], b: &[f64; 3]| -> f64 { (0..3).map(|i| (a[i] - b[i]).powi(2)).sum() };
    for grain in &dust {
        assert!(grain[0] < 5.0);
        assert!(stars.iter().all(|star| squared(star, grain) >= 1.1 * 1.1));
    }
    let seeds = answer["query"]["layers"].as_array().expect("a list");
    assert_ne!(seeds[0]["seed"], seeds[1]["seed"]);
    let lone = json!({ "region": { "bbox": [0, 0, 0, 5, 9, 9] }, "seed": seeds[1]["seed"], "spacing": 0.8 });
    let all = daemon.post("/v1/space/count", &lone).json()["count"].as_u64();
    assert!(all.expect("a number") > dust.len() as u64);
}

#[test]
fn what_a_client_has_is_not_sent_again_and_pins_hold() {
    let daemon = Daemon::built_in();
    let path = "/v1/space/points?bbox=0,0,0,4,4,4&spacing=1&format=f32";
    let answer = daemon.get(path);
    let tag = answer.header("etag").to_owned();
    let again = strew_testkit::http1::get(daemon.address(), path, &[("if-none-match", &tag)]);
    assert_eq!(again.status, 304);
    let table = answer.header("strew-table").to_owned();
    let pinned = daemon.get(&format!("{path}&table={table}"));
    assert_eq!(pinned.status, 200);
    assert!(pinned.header("cache-control").contains("immutable"));
    let other = daemon.get(&format!("{path}&table={}", "0".repeat(64)));
    assert_eq!(other.status, 409);
}
