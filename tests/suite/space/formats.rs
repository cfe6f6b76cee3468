//! All formats have the points of csv.

use serde_json::{Value, json};
use strew_testkit::http1;

use super::lines;
use crate::support::daemon::Daemon;

const QUERY: &str = "bbox=-3,10,-20,4,16,-15&spacing=0.9&seed=5";

fn get(daemon: &Daemon, format: &str, more: &str) -> http1::Answer {
    let answer = daemon.get(&format!("/v1/space/points?{QUERY}&format={format}{more}"));
    assert_eq!(answer.status, 200, "{format}: {}", answer.text());
    answer
}

/// The places of csv, and those relative to the lower corner.
fn places(daemon: &Daemon) -> (Vec<String>, Vec<[f64; 3]>, Vec<[f64; 3]>) {
    let (ids, places): (Vec<_>, Vec<_>) = lines(&get(daemon, "csv", "")).into_iter().unzip();
    let moved = places
        .iter()
        .map(|[x, y, z]: &[f64; 3]| [x + 3.0, y - 10.0, z + 20.0]);
    let moved = moved.collect();
    (ids, places, moved)
}

fn doubles(bytes: &[u8]) -> Vec<f64> {
    let (chunks, rest) = bytes.as_chunks::<8>();
    assert!(rest.is_empty());
    chunks
        .iter()
        .map(|bytes| f64::from_le_bytes(*bytes))
        .collect()
}

fn singles(bytes: &[u8]) -> Vec<f64> {
    let (chunks, rest) = bytes.as_chunks::<4>();
    assert!(rest.is_empty());
    let all = chunks.iter().map(|bytes| f32::from_le_bytes(*bytes));
    all.map(f64::from).collect()
}

#[test]
fn packed_coordinates_are_triples() {
    let daemon = Daemon::built_in();
    let (_, places, moved) = places(&daemon);
    assert!(places.len() > 200);
    let f64s = get(&daemon, "f64", "");
    assert_eq!(doubles(&f64s.body), places.as_flattened());
    let f32s = get(&daemon, "f32", "");
    assert_eq!(f32s.header("strew-origin"), "-3.0,10.0,-20.0");
    let names: Value = serde_json::from_str(f32s.header("strew-columns")).expect("JSON");
    let names: Vec<&str> = names
        .as_array()
        .expect("a list")
        .iter()
        .filter_map(|c| c["name"].as_str())
        .collect();
    assert_eq!(names, ["x", "y", "z"]);
    for (got, expected) in singles(&f32s.body).iter().zip(moved.as_flattened()) {
        assert!((got - expected).abs() < 1e-6);
    }
    assert_eq!(f32s.body.len(), 12 * places.len());
    let npy = get(&daemon, "npy", "");
    let end = npy.body.len() - f64s.body.len();
    assert_eq!(npy.body[end..], f64s.body);
    let head = String::from_utf8_lossy(&npy.body[10..end]);
    assert!(
        head.contains(&format!("'shape': ({}, 3)", places.len())),
        "{head}"
    );
    let ply = get(&daemon, "ply", "");
    let end = ply.body.len() - f64s.body.len();
    assert_eq!(ply.body[end..], f64s.body);
    assert!(String::from_utf8_lossy(&ply.body[..end]).contains("property double z\nend_header\n"));
}

#[test]
fn texts_have_the_third_part_of_ids() {
    let daemon = Daemon::built_in();
    let (ids, places, _) = places(&daemon);
    let json = get(&daemon, "json", "").json();
    let ndjson = get(&daemon, "ndjson", "&summary=off");
    let lines: Vec<Value> = (ndjson.text().lines())
        .map(|line| serde_json::from_str(line).expect("JSON"))
        .collect();
    assert_eq!(json["points"], json!(lines));
    let features = get(&daemon, "geojson", "").json();
    for (i, point) in lines.iter().enumerate() {
        assert_eq!(point["id"], json!(ids[i]));
        let place = ["x", "y", "z"].map(|axis| point[axis].as_f64().expect("a number"));
        assert_eq!(place, places[i]);
        let feature = &features["features"][i];
        assert_eq!(
            (&feature["id"], &feature["geometry"]["coordinates"]),
            (&point["id"], &json!(place))
        );
    }
    assert_eq!(json["table"]["dimensions"], 3);
    assert_eq!(
        json["query"]["bbox"],
        json!([-3.0, 10.0, -20.0, 4.0, 16.0, -15.0])
    );
}

#[test]
fn things_stand_at_their_heights() {
    let daemon = Daemon::built_in();
    let (_, _, moved) = places(&daemon);
    let posed = "&attributes=rotation,scale&scale_range=0.5,2";
    let multimesh = get(&daemon, "multimesh", posed);
    let records = singles(&multimesh.body);
    assert_eq!(records.len(), 16 * moved.len());
    for (record, [x, y, z]) in records.chunks_exact(16).zip(&moved) {
        for (got, expected) in [record[3], record[7], record[11]].iter().zip([*x, *z, -*y]) {
            assert!((got - expected).abs() < 1e-6);
        }
        // Columns of a rotation have one length, the scale.
        let lengths = [0, 1, 2].map(|i| (0..3).map(|j| record[4 * j + i].powi(2)).sum::<f64>());
        assert!(
            lengths
                .iter()
                .all(|length| (length - lengths[0]).abs() < 1e-5)
        );
        assert!((0.24..4.01).contains(&lengths[0]));
    }
    let instances = get(&daemon, "instances", "&attributes=scale");
    assert_eq!(instances.body.len(), 16 * moved.len());
    let legend: Value = serde_json::from_str(instances.header("strew-columns")).expect("JSON");
    assert_eq!(
        (&legend[2]["name"], &legend[2]["low"], &legend[2]["high"]),
        (&json!("z"), &json!(0.0), &json!(5.0))
    );
    for (record, [.., z]) in instances.body.chunks_exact(16).zip(&moved) {
        let part = f64::from(u16::from_le_bytes([record[8], record[9]])) / 65535.0;
        assert!((part * 5.0 - z).abs() < 1e-4);
    }
    let tilted = daemon.get(&format!("/v1/space/points?{QUERY}&format=instances{posed}"));
    assert_eq!(tilted.status, 400);
}

#[test]
fn a_picture_shows_the_slab_from_above() {
    let daemon = Daemon::built_in();
    let png = get(&daemon, "png", "&size=200");
    assert!(png.body.starts_with(b"\x89PNG"));
    let svg = get(&daemon, "svg", "&size=200");
    assert_eq!(
        svg.text().matches("<circle").count(),
        places(&daemon).0.len()
    );
}

#[test]
fn every_format_has_the_same_number_of_points() {
    let daemon = Daemon::built_in();
    let count = places(&daemon).0.len().to_string();
    for format in [
        "json",
        "csv",
        "f32",
        "arrow",
        "glb",
        "usda",
        "multimesh",
        "geojsonseq",
        "png",
    ] {
        assert_eq!(
            get(&daemon, format, "").header("strew-count"),
            count,
            "{format}"
        );
    }
    // Far from the origin the integers of usda are too small.
    let far = "/v1/space/points?bbox=1e6,0,0,1000002,2,2&spacing=1&format=usda";
    let answer = daemon.get(far);
    assert!(
        answer.status == 400 && answer.text().contains("21 bits"),
        "{}",
        answer.text()
    );
}
