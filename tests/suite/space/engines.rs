//! Readers of others read points in space: pyarrow, geopandas, OpenUSD, and Khronos' validator of glTF, as far as they
//! are installed.

use std::{fs, path::Path, process::Command};

use tempfile::TempDir;

use super::lines;
use crate::support::{
    clients,
    daemon::{Daemon, strew},
};

const QUERY: &str = "bbox=-3,10,-20,4,16,-15&spacing=0.9&seed=5";
const ATTRIBUTES: &str = "&attributes=rotation,variant&variants=ice:1,rock:3";

/// The lines that a reader makes of a file; `None` if it is not installed.
fn read(format: &str, file: &Path) -> Option<Vec<(String, [f64; 3])>> {
    let text = clients::read_by("tests/suite/space/readers.py", format, file)?;
    let read = |line: &str| {
        let fields: Vec<&str> = line.split(',').collect();
        let number = |i: usize| fields[i].parse().expect("a number");
        (fields[0].to_owned(), [number(1), number(2), number(3)])
    };
    Some(text.lines().map(read).collect())
}

#[test]
fn foreign_readers_find_the_points() {
    let daemon = Daemon::built_in();
    let expected = lines(&daemon.get(&format!("/v1/space/points?{QUERY}&format=csv")));
    let folder = TempDir::new().expect("a folder");
    for format in ["arrow", "usda"] {
        let answer = daemon.get(&format!(
            "/v1/space/points?{QUERY}{ATTRIBUTES}&format={format}"
        ));
        let file = folder.path().join(format!("points.{format}"));
        fs::write(&file, &answer.body).expect("written");
        let Some(found) = read(format, &file) else {
            continue;
        };
        // A stage has floats from the corner on.
        let rounding = if format == "usda" { 1e-5 } else { 0.0 };
        assert_eq!(found.len(), expected.len());
        for ((id, place), (own, at)) in found.iter().zip(&expected) {
            assert_eq!(id, own);
            assert!(
                (0..3).all(|axis| (place[axis] - at[axis]).abs() <= rounding),
                "{id}"
            );
        }
    }
    let file = folder.path().join("points.parquet");
    let output = strew()
        .args([
            "sample",
            "--space",
            "--bbox=-3,10,-20,4,16,-15",
            "--spacing=0.9",
            "--seed=5",
            "--output",
        ])
        .arg(&file)
        .output()
        .expect("it runs");
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    if let Some(found) = read("parquet", &file) {
        assert_eq!(found, expected);
    }
}

#[test]
fn the_validator_of_gltf_finds_no_fault() {
    let daemon = Daemon::built_in();
    let folder = TempDir::new().expect("a folder");
    let answer = daemon.get(&format!("/v1/space/points?{QUERY}{ATTRIBUTES}&format=glb"));
    let file = folder.path().join("points.glb");
    fs::write(&file, &answer.body).expect("written");
    let Some(node) = clients::find("node") else {
        return;
    };
    let script = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/tests/suite/rest/gltf_validator.cjs"
    );
    let output = Command::new(node)
        .arg(script)
        .arg(&file)
        .output()
        .expect("node runs");
    let message = String::from_utf8_lossy(&output.stderr);
    match output.status.code() {
        Some(77) => eprintln!("skipped: {}", message.trim()),
        code => assert_eq!(code, Some(0), "{message}"),
    }
}
