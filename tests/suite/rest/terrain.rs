//! Points on a terrain: heights, normals and rotations in all formats, the same in every query.

use std::collections::HashMap;

use serde_json::{Value, json};

use crate::support::{
    csv::Csv,
    daemon::{Daemon, no_tables},
    fields::folder,
};

/// `ramp` rises from 0 to 1 between x = 0 and x = 40.
fn daemon(fields: &tempfile::TempDir) -> Daemon {
    let setting = format!("fields.folder={}", fields.path().display());
    Daemon::with_tables(no_tables(), &[&setting, "reload.watch_seconds=0"])
}

const RAMP: &str = "bbox=2,0,38,30&spacing=1&seed=7&terrain=ramp&heights=10,30";

fn numbers(csv: &Csv, column: &str) -> Vec<f64> {
    let values = csv.columns[column].iter();
    values.map(|text| text.parse().expect("a number")).collect()
}

#[test]
fn heights_normals_and_rotations_follow_the_ground() {
    let folder = folder();
    let daemon = daemon(&folder);
    let query = format!("{RAMP}&normals=on&align=1&attributes=angle");
    let csv = Csv::get(&daemon, &query);
    assert!(csv.points.len() > 900);
    let length = 1.25f64.sqrt();
    let [z, nx, ny, nz] = ["z", "nx", "ny", "nz"].map(|name| numbers(&csv, name));
    let [qx, qy, qz, qw] = ["qx", "qy", "qz", "qw"].map(|name| numbers(&csv, name));
    for (i, point) in csv.points.iter().enumerate() {
        assert!((z[i] - (10.0 + point.x / 2.0)).abs() < 1e-12, "{point:?}");
        assert!((nx[i] + 0.5 / length).abs() < 1e-12 && ny[i] == 0.0);
        assert!((nz[i] - 1.0 / length).abs() < 1e-12);
        // The up direction of a thing is the normal.
        let up = [
            2.0 * (qx[i] * qz[i] + qy[i] * qw[i]),
            2.0 * (qy[i] * qz[i] - qx[i] * qw[i]),
            1.0 - 2.0 * (qx[i] * qx[i] + qy[i] * qy[i]),
        ];
        let off = [up[0] - nx[i], up[1] - ny[i], up[2] - nz[i]];
        assert!(off.iter().all(|off| off.abs() < 1e-12), "{up:?}");
    }
    let echo = daemon.get(&format!("/v1/points?{query}")).json();
    let echo = &echo["query"];
    assert_eq!(
        (&echo["terrain"], &echo["heights"]),
        (&json!("ramp"), &json!([10.0, 30.0]))
    );
    assert_eq!(
        (&echo["normals"], &echo["align"]),
        (&json!(true), &json!(1.0))
    );
    assert_eq!(echo["terrain_digest"].as_str().map(str::len), Some(64));
    // The terrain moves no point.
    let flat = Csv::get(&daemon, "bbox=2,0,38,30&spacing=1&seed=7");
    assert_eq!(flat.points, csv.points);
}

#[test]
fn a_height_belongs_to_the_point_and_not_to_the_query() {
    let folder = folder();
    let daemon = daemon(&folder);
    let terrain = json!({ "noise": { "wavelength": 9, "octaves": 3 } });
    let rows = |region: Value| {
        let body = json!({
            "region": region, "spacing": 1, "seed": 3, "terrain": terrain, "heights": [-5, 5],
            "normals": true, "align": 0.5, "format": "csv",
        });
        let answer = daemon.post("/v1/points:query", &body);
        assert_eq!(answer.status, 200, "{}", answer.text());
        let mut lines = answer.text().lines().map(str::to_owned);
        assert_eq!(
            lines.next().as_deref(),
            Some("id,x,y,z,nx,ny,nz,qx,qy,qz,qw")
        );
        lines.collect::<Vec<_>>()
    };
    let mut whole = rows(json!({ "bbox": [0, 0, 32, 16] }));
    let mut parts = rows(json!({ "bbox": [0, 0, 13, 16] }));
    parts.extend(rows(json!({ "bbox": [13, 0, 32, 16] })));
    whole.sort();
    parts.sort();
    assert_eq!(whole, parts);
    // In a chunk, places are relative and heights are not.
    let chunk = Csv::get(
        &daemon,
        "bbox=16,16,32,32&spacing=1&seed=3&terrain=ramp&heights=0,40",
    );
    let near =
        daemon.get("/v1/chunks/16/1/1?spacing=1&seed=3&terrain=ramp&heights=0,40&format=csv");
    let near = Csv::of(near);
    let by_id: HashMap<_, _> = chunk
        .points
        .iter()
        .map(|p| p.id)
        .zip(numbers(&chunk, "z"))
        .collect();
    for (point, z) in near.points.iter().zip(numbers(&near, "z")) {
        assert_eq!(by_id[&point.id], z);
    }
}

#[test]
fn single_points_and_neighbors_stand_on_it() {
    let folder = folder();
    let daemon = daemon(&folder);
    let set = "spacing=1&seed=7&terrain=ramp&heights=10,30&normals=on&align=0.25&attributes=angle";
    let csv = Csv::get(&daemon, &format!("bbox=2,0,38,30&{set}"));
    let id = csv.points[5].id;
    let one = daemon.get(&format!("/v1/points/{id}?{set}"));
    assert_eq!(one.status, 200, "{}", one.text());
    let one = one.json();
    let one = one.get("point").unwrap_or(&one);
    for name in ["z", "nx", "ny", "nz", "qx", "qy", "qz", "qw", "angle"] {
        assert_eq!(
            one[name].as_f64(),
            Some(numbers(&csv, name)[5]),
            "{name}: {one}"
        );
    }
}

#[test]
fn every_format_carries_the_height() {
    let folder = folder();
    let daemon = daemon(&folder);
    let csv = Csv::get(&daemon, RAMP);
    let z = numbers(&csv, "z");
    let get = |format: &str| {
        let answer = daemon.get(&format!("/v1/points?{RAMP}&format={format}"));
        assert_eq!(answer.status, 200, "{format}: {}", answer.text());
        answer
    };
    let json = get("json").json();
    let points = json["points"].as_array().expect("points");
    assert!(
        points
            .iter()
            .zip(&z)
            .all(|(point, z)| point["z"].as_f64() == Some(*z))
    );
    let records = |bytes: &[u8], size: usize, at: usize| -> Vec<f64> {
        let number = |record: &[u8]| f64::from_le_bytes(record[at..at + 8].try_into().expect("8"));
        bytes.chunks_exact(size).map(number).collect()
    };
    assert_eq!(records(&get("f64").body, 24, 16), z);
    let ply = get("ply");
    let end = b"property double z\nend_header\n";
    let at = ply
        .body
        .windows(end.len())
        .position(|part| part == end)
        .expect("one z");
    assert_eq!(records(&ply.body[at + end.len()..], 24, 16), z);
    let near = |bytes: &[u8], size: usize, at: usize| -> Vec<f32> {
        let number = |record: &[u8]| f32::from_le_bytes(record[at..at + 4].try_into().expect("4"));
        bytes.chunks_exact(size).map(number).collect()
    };
    let rounded: Vec<f32> = z.iter().map(|z| *z as f32).collect();
    assert_eq!(near(&get("multimesh").body, 64, 28), rounded);
    let glb = get("glb").body;
    // One node: its places are the last but ids.
    let places = glb.len() - z.len() * 20..glb.len() - z.len() * 8;
    assert_eq!(near(&glb[places], 12, 4), rounded);
    let instances = get("instances");
    let columns: Value = serde_json::from_str(instances.header("strew-columns")).expect("JSON");
    assert_eq!(
        columns[2],
        json!({ "name": "z", "type": "u16", "low": 10.0, "high": 30.0 })
    );
    for (record, z) in instances.body.chunks_exact(16).zip(&z) {
        let part = f64::from(u16::from_le_bytes([record[8], record[9]])) / 65535.0;
        assert!((10.0 + 20.0 * part - z).abs() <= 20.0 / 131_070.0 + 1e-12);
    }
    let usda = get("usda");
    let line = usda
        .text()
        .lines()
        .find(|line| line.contains("point3f[] positions"));
    let first = line
        .and_then(|line| line.split(')').next())
        .and_then(|text| text.rsplit(", ").next());
    assert_eq!(first.and_then(|text| text.parse().ok()), Some(rounded[0]));
}
