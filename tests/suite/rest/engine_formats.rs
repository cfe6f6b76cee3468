//! The formats of engines, read back by foreign software and compared with csv: Khronos' validator, Pixar's USD,
//! Godot, as far as they are installed.

use std::{
    collections::HashMap,
    f64::consts::TAU,
    path::{Path, PathBuf},
    process::Command,
};

use strew_testkit::http1;

use crate::support::{clients, daemon::Daemon};

/// Three chunks of points; the length of the diagonal is below 2⁸.
const QUERY: &str = "/v1/points?bbox=-3.5,1,120,90.25&density=2&profile=test&seed=5\
                     &attributes=angle,scale,variant,u1&scale_range=0.5,2&variants=oak:3,birch:1";
const ORIGIN: [f64; 2] = [-3.5, 1.0];
/// The last bit of an `f32` below 128.
const ROUNDED: f64 = 1.0 / (1 << 17) as f64;

/// A thing at a point: its id, place, turn, size and variant.
#[derive(Clone, Debug)]
struct Stand {
    id: String,
    place: [f64; 3],
    turn: f64,
    size: f64,
    thing: String,
}

fn stands(text: &str) -> Vec<Stand> {
    let stand = |line: &str| {
        let fields: Vec<&str> = line.split(',').collect();
        let number = |i: usize| fields[i].parse::<f64>().expect("a number");
        Stand {
            id: fields[0].into(),
            place: [1, 2, 3].map(number),
            turn: number(4),
            size: number(5),
            thing: fields[6].into(),
        }
    };
    text.lines().map(stand).collect()
}

/// The things of the csv answer, whose columns are id, x, y, angle, scale, variant, u1.
fn expected(daemon: &Daemon) -> Vec<Stand> {
    let csv = daemon.get(&format!("{QUERY}&format=csv"));
    let stand = |line: &str| {
        let fields: Vec<&str> = line.split(',').collect();
        let number = |i: usize| fields[i].parse::<f64>().expect("a number");
        Stand {
            id: fields[0].into(),
            place: [number(1) - ORIGIN[0], number(2) - ORIGIN[1], 0.0],
            turn: number(3),
            size: number(4),
            thing: fields[5].into(),
        }
    };
    csv.text().lines().skip(1).map(stand).collect()
}

fn written(daemon: &Daemon, format: &str, folder: &Path) -> PathBuf {
    // A record of 16 bytes has no room for the number.
    let query = match format {
        "instances" => QUERY.replace(",u1", ""),
        _ => QUERY.into(),
    };
    let answer = daemon.get(&format!("{query}&format={format}"));
    assert_eq!(answer.status, 200, "{format}: {}", answer.text());
    assert_eq!(answer.header("strew-origin"), "-3.5,1.0", "{format}");
    let file = folder.join(format!("points.{format}"));
    std::fs::write(&file, &answer.body).expect("writable");
    file
}

/// The output of a program; `None` if the program lacks a module.
fn output(command: &mut Command, what: &str) -> Option<String> {
    let output = command.output().expect("the program runs");
    let (text, message) = (
        String::from_utf8_lossy(&output.stdout).into_owned(),
        String::from_utf8_lossy(&output.stderr),
    );
    if output.status.code() == Some(77) {
        eprintln!("skipped: {what}: {}", message.trim());
        return None;
    }
    assert!(output.status.success(), "{what}: {text}{message}");
    Some(text)
}

fn beside(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/suite/rest")
        .join(name)
}

#[test]
fn readers_find_every_point_with_its_turn_size_and_variant() {
    let daemon = Daemon::start(&["limits.block_bytes=4096"]);
    let folder = tempfile::tempdir().expect("a folder");
    let expected = expected(&daemon);
    assert!(expected.len() > 2 << 13);
    // How far numbers are rounded: turns in half precision, in 16 bits.
    for (format, turns, sizes) in [
        ("glb", 1e-6, 1e-6),
        ("usda", 2e-3, 1e-6),
        ("multimesh", 1e-6, 1e-6),
        ("instances", TAU / 131_070.0, 1.5 / 131_070.0),
    ] {
        let file = written(&daemon, format, folder.path());
        let Some(mut python) = clients::python(&format!("a reader of {format}")) else {
            return;
        };
        let script = beside("engine_readers.py");
        let Some(text) = output(python.args([&script, Path::new(format), &file]), format) else {
            continue;
        };
        let found = stands(&text);
        assert_eq!(found.len(), expected.len(), "{format}");
        let by_id: HashMap<&str, &Stand> = expected.iter().map(|s| (&*s.id, s)).collect();
        for (found, in_order) in found.iter().zip(&expected) {
            let wanted = match &*found.id {
                "" => in_order,
                id => by_id[id],
            };
            let off = (0..3).map(|i| (found.place[i] - wanted.place[i]).abs());
            assert!(
                off.fold(0.0, f64::max) <= ROUNDED,
                "{format}: {found:?} {wanted:?}"
            );
            let turned = (found.turn - wanted.turn).rem_euclid(TAU);
            let is_turned = turned.min(TAU - turned) <= turns * 1.001;
            let is_sized = (found.size - wanted.size).abs() <= sizes * 1.001;
            assert!(is_turned && is_sized, "{format}: {found:?} {wanted:?}");
            assert_eq!(found.thing, wanted.thing, "{format}: {found:?}");
        }
    }
}

#[test]
fn khronos_validator_finds_neither_errors_nor_warnings() {
    let Some(node) = clients::find("node") else {
        return;
    };
    let daemon = Daemon::start(&[]);
    let folder = tempfile::tempdir().expect("a folder");
    let layers = serde_json::json!({
        "region": { "bbox": [1e6, 1e6, 1_000_060.0, 1_000_050.0] },
        "layers": [
            { "name": "old-trees", "spacing": 1, "seed": 3, "attributes": ["angle", "variant"],
              "variants": "a,b" },
            { "name": "rocks", "spacing": 3, "attributes": ["rank", "scale"] },
        ],
        "format": "glb",
    });
    let none = "/v1/points?bbox=0,0,1e-9,1e-9&density=1&profile=test&seed=3&format=glb";
    let plain = "/v1/points?bbox=0,0,200,100&density=1&profile=test&format=glb";
    for (name, answer) in [
        ("points", daemon.get(&format!("{QUERY}&format=glb"))),
        ("layers", daemon.post("/v1/points:query", &layers)),
        ("none", daemon.get(none)),
        ("plain", daemon.get(plain)),
    ] {
        assert_eq!(answer.status, 200, "{name}: {}", answer.text());
        let file = folder.path().join(format!("{name}.glb"));
        std::fs::write(&file, &answer.body).expect("writable");
        let command = &mut Command::new(&node);
        if output(command.args([&beside("gltf_validator.cjs"), &file]), name).is_none() {
            return;
        }
    }
}

#[test]
fn godot_reads_the_buffer_of_a_multimesh() {
    let Some(godot) = clients::find("godot3-server") else {
        return;
    };
    let daemon = Daemon::start(&[]);
    let folder = tempfile::tempdir().expect("a folder");
    let file = written(&daemon, "multimesh", folder.path());
    let mut command = Command::new(godot);
    command
        .env("STREW_MULTIMESH", &file)
        .env("HOME", folder.path());
    command
        .current_dir(folder.path())
        .arg("-s")
        .arg(beside("multimesh.gd"));
    let text = output(&mut command, "godot").expect("it runs");
    let lines: Vec<&str> = text
        .lines()
        .filter_map(|line| line.strip_prefix("instance "))
        .collect();
    let expected = expected(&daemon);
    assert_eq!(lines.len(), expected.len());
    for (line, wanted) in lines.iter().zip(&expected) {
        let numbers: Vec<f64> = line
            .split(',')
            .map(|text| text.parse().expect("a number"))
            .collect();
        let [x, y, _] = wanted.place;
        let turned = (numbers[4] - wanted.turn).rem_euclid(TAU);
        let off = [
            numbers[0] - x,
            numbers[1],
            numbers[2] + y,
            numbers[3] - wanted.size,
        ];
        assert!(off.iter().all(|off| off.abs() < 1e-5), "{line} {wanted:?}");
        assert!(turned.min(TAU - turned) < 1e-5, "{line} {wanted:?}");
        assert_eq!(["birch", "oak"][numbers[5] as usize], wanted.thing);
    }
}

#[test]
fn sizes_are_known_first_where_nothing_is_counted() {
    let daemon = Daemon::start(&[]);
    let path = "/v1/points?bbox=0,0,200,100&density=1&profile=test&seed=2&attributes=angle,scale";
    for (format, content_type) in [
        ("glb", "model/gltf-binary"),
        ("multimesh", "application/octet-stream"),
        ("instances", "application/octet-stream"),
    ] {
        let answer = daemon.get(&format!("{path}&format={format}"));
        assert_eq!(answer.header("content-type"), content_type);
        assert_eq!(
            answer.header("content-length"),
            answer.body.len().to_string(),
            "{format}"
        );
        let count: usize = answer.header("strew-count").parse().expect("a count");
        let bytes = match format {
            "multimesh" => 64,
            "instances" => 16,
            _ => continue,
        };
        assert_eq!(answer.body.len(), bytes * count);
    }
    for (media_type, format) in [
        ("application/vnd.strew.multimesh", "multimesh"),
        ("application/vnd.strew.instances", "instances"),
        ("model/gltf-binary", "glb"),
        ("model/vnd.usda", "usda"),
    ] {
        let answer = http1::get(daemon.address(), path, &[("accept", media_type)]);
        assert_eq!(answer.header("content-type"), media_type);
        let named = daemon.get(&format!("{path}&format={format}"));
        assert_eq!(named.body, answer.body, "{format}");
    }
    let legend = daemon.get(&format!("{path}&scale_range=0.5,2&format=instances"));
    let columns: serde_json::Value =
        serde_json::from_str(legend.header("strew-columns")).expect("JSON");
    assert_eq!(
        columns[4],
        serde_json::json!({ "name": "scale", "type": "u16", "low": 0.5, "high": 2.0 })
    );
}
