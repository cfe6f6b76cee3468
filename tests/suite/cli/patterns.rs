//! `strew figure` and `strew arrangement`.

use serde_json::Value;

use crate::support::command;

/// What a command that succeeds prints.
fn run(arguments: &[&str]) -> String {
    let output = command::run(arguments, "");
    assert!(
        output.status.success(),
        "{arguments:?}: {}",
        command::errors(&output)
    );
    String::from_utf8(output.stdout).expect("UTF-8")
}

/// What a command that is refused for its flags prints.
fn errors(arguments: &[&str]) -> String {
    let output = command::run(arguments, "");
    assert_eq!(output.status.code(), Some(2), "{arguments:?}");
    command::errors(&output)
}

#[test]
fn figures_are_files_and_standard_output() {
    let folder = tempfile::tempdir().expect("a folder");
    for name in ["index", "arrangement", "clusters", "map"] {
        let file = folder.path().join(name).with_extension("svg");
        let path = file.to_str().expect("UTF-8");
        run(&["figure", name, "--alpha", "13/8", "--output", path]);
        let drawn = std::fs::read_to_string(&file).expect("written");
        assert!(drawn.contains("α = 13/8"), "{name}");
        assert_eq!(run(&["figure", name, "--alpha", "1.625"]), drawn, "{name}");
    }
}

#[test]
fn arrangements_have_facts_counts_and_places() {
    let grid = ["--grid", "-300", "-200", "400", "500"];
    let facts = |more: &[&str]| -> Value {
        let args = [&["arrangement", "2,1 3,3", "--seed", "7"], more].concat();
        serde_json::from_str(&run(&args)).expect("JSON")
    };
    assert_eq!(facts(&[])["exists"], true);
    let count = facts(&grid)["count"].as_u64().expect("a number");
    let listed = run(&[
        &["arrangement", "2,1 3,3", "--seed", "7", "--list"],
        &grid[..],
    ]
    .concat());
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
        run(&["point", &id, "--seed", "7", "--spacing", "1"]);
    }
    let lone: Value = serde_json::from_str(&run(&["arrangement", "1,0"])).expect("JSON");
    assert_eq!(
        (&lone["exists"], &lone["margin"]),
        (&Value::Bool(false), &Value::Null)
    );
}

#[test]
fn wrong_settings_are_refused_by_name() {
    for (args, expected) in [
        (&["figure", "index", "--alpha", "1"][..], "between 1 and 2"),
        (&["figure", "index", "--alpha", "2"], "between 1 and 2"),
        (&["figure", "index", "--window", "5000"], "--window 5000"),
        (
            &["figure", "map", "--radius", "1000000"],
            "--radius 1000000",
        ),
        (
            &["figure", "map", "--block", "27,0"],
            "two integers from 0 to 26",
        ),
        (&["figure", "clusters", "--distance", "99"], "--distance 99"),
        (&["figure", "index", "-o", "x.png"], ".svg"),
        (&["arrangement", "2"], "two integers joined by a comma"),
        (&["arrangement", "2,9007199254740993"], "offsets[0]"),
        (
            &["arrangement", "2,1", "--grid", "5", "0", "4", "9"],
            "--grid",
        ),
        (&["arrangement", "2,1", "--list"], "--grid"),
    ] {
        let text = errors(args);
        assert!(text.contains(expected), "{args:?}: {text}");
    }
}
