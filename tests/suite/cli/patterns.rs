//! `strew figure` and `strew arrangement`.

use serde_json::Value;

use super::{printed, refused};
use crate::support::daemon::Daemon;

#[test]
fn figures_are_files_and_standard_output() {
    let folder = tempfile::tempdir().expect("a folder");
    for name in ["index", "arrangement", "clusters", "map"] {
        let file = folder.path().join(name).with_extension("svg");
        let path = file.to_str().expect("UTF-8");
        printed(&["figure", name, "--alpha", "13/8", "--output", path]);
        let drawn = std::fs::read_to_string(&file).expect("written");
        assert!(drawn.contains("α = 13/8"), "{name}");
        assert_eq!(
            printed(&["figure", name, "--alpha", "1.625"]),
            drawn,
            "{name}"
        );
        let picture = file.with_extension("png");
        let path = picture.to_str().expect("UTF-8");
        printed(&["figure", name, "--size", "300", "--output", path]);
        let decoder = png::Decoder::new(std::io::BufReader::new(
            std::fs::File::open(&picture).expect("written"),
        ));
        let info = decoder.read_info().expect("a PNG").info().size();
        assert_eq!(info.0.max(info.1), 300, "{name}");
    }
}

#[test]
fn masks_have_each_threshold_as_often() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = |name: &str| folder.path().join(name).to_str().expect("UTF-8").to_owned();
    let (mask, spectrum) = (file("mask.png"), file("spectrum.svg"));
    let flags = [
        "mask", "--map", "s", "--size", "64", "--seed", "3", "-o", &mask,
    ];
    printed(&[&flags[..], &["--spectrum", &spectrum]].concat());
    let decoder = png::Decoder::new(std::io::BufReader::new(
        std::fs::File::open(&mask).expect("written"),
    ));
    let mut reader = decoder.read_info().expect("a PNG");
    let mut pixels = vec![0; reader.output_buffer_size().expect("small")];
    reader.next_frame(&mut pixels).expect("pixels");
    let mut counts = [0; 256];
    pixels.iter().for_each(|&v| counts[usize::from(v)] += 1);
    assert_eq!(counts, [16; 256]);
    let drawn = std::fs::read_to_string(&spectrum).expect("written");
    assert!(drawn.contains("low power 0.0"), "{drawn}");
    assert!(refused(&["mask", "--size", "5000"], 2).contains("16 to 1024"));
    assert!(refused(&["mask", "--bits", "4"], 2).contains("8 or 16"));
    assert!(refused(&["mask", "--spectrum", "a.txt", "-o", &mask], 2).contains(".svg or .png"));
}

#[test]
fn arrangements_have_facts_counts_and_places() {
    let grid = ["--grid", "-300,-200,400,500"];
    let facts = |more: &[&str]| -> Value {
        let args = [&["arrangement", "2,1 3,3", "--seed", "7"], more].concat();
        serde_json::from_str(&printed(&args)).expect("JSON")
    };
    assert_eq!(facts(&[])["exists"], true);
    let count = facts(&grid)["count"].as_u64().expect("a number");
    let listed = printed(
        &[
            &["arrangement", "2,1 3,3", "--seed", "7", "--list"],
            &grid[..],
        ]
        .concat(),
    );
    assert_eq!(listed.lines().count() as u64, count + 1);
    let expected = facts(&[])["density"].as_f64().expect("a number") * 490_000.0;
    assert!(
        (count as f64 / expected - 1.0).abs() < 0.02,
        "{count} {expected}"
    );
    // The places are ids of the points that `strew sample` has under the seed.
    let (x, y) = listed
        .lines()
        .nth(1)
        .and_then(|line| line.split_once(','))
        .expect("a place");
    let (x, y): (i64, i64) = (
        x.parse().expect("an integer"),
        y.parse().expect("an integer"),
    );
    for (i, j) in [(0, 0), (2, 1), (3, 3)] {
        let id = format!("{}:{}", x + i, y + j);
        printed(&["point", &id, "--seed", "7", "--spacing", "1"]);
    }
    // With an amount the places are those of the points.
    let placed = [
        &[
            "arrangement",
            "2,1 3,3",
            "--seed",
            "7",
            "--list",
            "--spacing",
            "0.5",
        ],
        &grid[..],
    ];
    let placed = printed(&placed.concat());
    let columns = |text: &str| text.lines().next().map(|line| line.split(',').count());
    assert_eq!(columns(&placed), Some(8));
    let first = placed.lines().nth(1).expect("an occurrence");
    let id = format!("{x}:{y}");
    let point: Value =
        serde_json::from_str(&printed(&["point", &id, "--seed", "7", "--spacing", "0.5"]))
            .expect("JSON");
    assert!(
        first.starts_with(&format!("{x},{y},{},{},", point["x"], point["y"])),
        "{first} {point}"
    );
    let lone: Value = serde_json::from_str(&printed(&["arrangement", "1,0"])).expect("JSON");
    assert_eq!(
        (&lone["exists"], &lone["margin"]),
        (&Value::Bool(false), &Value::Null)
    );
}

#[test]
fn lists_are_those_of_the_daemon_byte_for_byte() {
    let daemon = Daemon::start(&[]);
    for list in ["csv", "json", "ndjson"] {
        for (flags, parameters) in [
            (&[][..], ""),
            (&["--spacing", "0.5"][..], "&spacing=0.5"),
            (
                &["--limit", "9", "--cursor", "3:4"][..],
                "&limit=9&cursor=3:4",
            ),
        ] {
            let given = format!("--list={list}");
            let own = [
                "arrangement",
                "2,1 3,3",
                "--seed",
                "7",
                "--alpha",
                "sqrt(3)",
                &given,
            ];
            let grid = ["--grid", "-30,-20,40,50"];
            let printed = printed(&[&own[..], &grid, flags].concat());
            let address = format!(
                "/v1/pattern/arrangements?offsets=2,1+3,3&seed=7&alpha=sqrt(3)&list={list}&grid=-30,-20,40,50{parameters}"
            );
            assert_eq!(daemon.get(&address).text(), printed, "{address}");
        }
    }
}
