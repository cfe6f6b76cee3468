//! Each format read back by independent software: NumPy, PyArrow, plyfile, GDAL, Pillow, as far as
//! the Python of `STREW_TEST_PYTHON` has them.

use std::{collections::HashSet, path::Path};

use strew_core::Point;

use crate::support::{
    clients,
    daemon::{Daemon, PROFILE, strew, tables},
    library::{plan, points},
};

const QUERY: &str = "/v1/points?bbox=-3.5,1,40,33.25&density=7&profile=test&seed=5&format=";

/// The points that a reader finds in a file, as ids (empty where the format has none) and
/// coordinates; `None` if the reader is not installed.
fn read(format: &str, file: &Path) -> Option<Vec<(String, [f64; 2])>> {
    let text = clients::read_by("tests/suite/rest/format_readers.py", format, file)?;
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("id,x,y"));
    let row = |line: &str| {
        let parts: Vec<&str> = line.split(',').collect();
        let [id, x, y] = parts[..] else {
            panic!("{format}: {line}")
        };
        let number = |text: &str| text.parse().expect("a number");
        (id.to_owned(), [number(x), number(y)])
    };
    Some(lines.map(row).collect())
}

/// Fails unless a reader finds exactly these points.
fn assert_holds(format: &str, file: &Path, expected: &[Point]) {
    let Some(rows) = read(format, file) else {
        return;
    };
    let without_ids = ["npy", "ply", "f64"].contains(&format);
    assert_eq!(rows.len(), expected.len(), "{format}");
    for ((id, place), point) in rows.iter().zip(expected) {
        let expected = if without_ids {
            String::new()
        } else {
            point.id.to_string()
        };
        assert_eq!((id, *place), (&expected, [point.x, point.y]), "{format}");
    }
}

/// Readers find the library's points in every answer.
#[test]
fn independent_readers_find_every_point() {
    let (daemon, plan) = (Daemon::start(&["limits.block_bytes=4096"]), plan());
    let expected = points(&plan);
    let folder = tempfile::tempdir().expect("a folder");
    for format in ["f64", "npy", "ply", "arrow", "geojson", "geojsonseq"] {
        let answer = daemon.get(&format!("{QUERY}{format}"));
        assert_eq!(answer.status, 200, "{format}: {:?}", answer.headers);
        let file = folder.path().join(format!("points.{format}"));
        std::fs::write(&file, &answer.body).expect("writable");
        assert_holds(format, &file, &expected);
    }
    let mut near = vec![[0f32; 2]; expected.len()];
    plan.blocks_f32().fill(&mut near);
    let file = folder.path().join("points.f32");
    std::fs::write(&file, daemon.get(&format!("{QUERY}f32")).body).expect("writable");
    if let Some(rows) = read("f32", &file) {
        let rows: Vec<_> = rows.into_iter().map(|(_, place)| place).collect();
        let near: Vec<_> = near.iter().map(|pair| pair.map(f64::from)).collect();
        assert_eq!(rows, near);
    }
}

/// `strew sample` chooses the format by the file extension, and writes the bytes that the daemon
/// sends.
#[test]
fn sampled_files_equal_streamed_answers_and_parquet_reads_back() {
    let (daemon, folder) = (Daemon::start(&[]), tables());
    let expected = points(&plan());
    let ends = [
        ("npy", "npy"),
        ("ply", "ply"),
        ("arrow", "arrows"),
        ("geojson", "geojson"),
        ("geojsonseq", "geojsons"),
        ("parquet", "parquet"),
    ];
    for (format, end) in ends {
        let file = folder.path().join(format!("points.{end}"));
        let output = strew()
            .args(["sample", "--bbox=-3.5,1,40,33.25", "--density=7"])
            .args(["--seed=5", "--profile", PROFILE, "--tables"])
            .args([folder.path(), Path::new("-o"), &file])
            .output()
            .expect("the program runs");
        let message = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{end}: {message}");
        if format == "parquet" {
            assert_holds(format, &file, &expected);
        } else {
            let answer = daemon.get(&format!("{QUERY}{format}"));
            let bytes = std::fs::read(&file).expect("written");
            assert!(
                bytes == answer.body,
                "the file of {format} differs from the answer"
            );
        }
    }
}

/// Dots are where the points are, with y upward, and nowhere else.
#[test]
fn pictures_show_every_point() {
    let (daemon, plan) = (Daemon::start(&["limits.block_bytes=4096"]), plan());
    let scale = 512.0 / 43.5;
    let places: Vec<[f64; 2]> = points(&plan)
        .iter()
        .map(|point| [(point.x + 3.5) * scale, (33.25 - point.y) * scale])
        .collect();
    let folder = tempfile::tempdir().expect("a folder");
    let rows = |format: &str| {
        let answer = daemon.get(&format!("{QUERY}{format}"));
        assert_eq!(answer.status, 200, "{format}");
        assert!(answer.header("content-type").starts_with("image/"));
        let file = folder.path().join(format);
        std::fs::write(&file, &answer.body).expect("writable");
        let rows = read(format, &file);
        rows.map(|rows| rows.into_iter().map(|(_, place)| place).collect::<Vec<_>>())
    };
    if let Some(centers) = rows("svg") {
        assert_eq!(centers.len(), places.len());
        for (center, place) in centers.iter().zip(&places) {
            let near = |axis: usize| (center[axis] - place[axis]).abs() < 0.0051;
            assert!(near(0) && near(1), "{center:?} {place:?}");
        }
    }
    let Some(pixels) = rows("png") else {
        return;
    };
    let drawn: HashSet<[i64; 2]> = pixels.iter().map(|place| place.map(|v| v as i64)).collect();
    let mut allowed = HashSet::new();
    for place in &places {
        let [x, y] = place.map(|v| v as i64);
        assert!(drawn.contains(&[x, y]), "no dot at {place:?}");
        allowed.extend((-2..=2).flat_map(|dy| (-2..=2).map(move |dx| [x + dx, y + dy])));
    }
    assert!(drawn.is_subset(&allowed));
}

#[test]
fn pictures_have_the_requested_size() {
    let daemon = Daemon::start(&[]);
    let size = |path: &str| {
        let answer = daemon.get(&format!("{QUERY}png{path}"));
        assert_eq!(answer.status, 200, "{path}");
        // In a PNG, width and height follow the first 16 bytes.
        let side = |at: usize| u32::from_be_bytes(answer.body[at..at + 4].try_into().expect("4"));
        (side(16), side(20))
    };
    assert_eq!(size(""), (512, 380));
    assert_eq!(size("&size=16"), (16, 12));
    assert_eq!(size("&size=4096"), (4096, 3037));
    let tall = daemon.get("/v1/points?bbox=0,0,1,1000&density=1&profile=test&format=svg&size=100");
    assert!(tall.text().contains("width=\"1\" height=\"100\""));
}

#[test]
fn formats_with_fixed_records_announce_their_length() {
    let daemon = Daemon::start(&[]);
    for (format, content_type) in [("npy", "application/x-npy"), ("ply", "application/ply")] {
        let answer = daemon.get(&format!("{QUERY}{format}"));
        assert_eq!(answer.header("content-type"), content_type);
        let size = answer.body.len().to_string();
        assert_eq!(answer.header("content-length"), size, "{format}");
    }
}
