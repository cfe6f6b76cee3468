//! Wrong flags and wrong files: the message and the exit code.

use crate::support::command::run;

/// (arguments, texts in the message).
const WRONG: [(&str, &[&str]); 37] = [
    (
        "sample --bbox 0,0,9,9 --spacing 1 -o trees.shp",
        &["--output", ".shp", "--format", "parquet"],
    ),
    (
        "sample --bbox 0,0,9,9 --spacing 1 --set limits.max_points=10",
        &["has 81 points", "allow 10", "--set limits.max_points=81"],
    ),
    (
        "sample --bbox 0,0,9,9 --spacing 1 --set limits.max_streams=3",
        &["--set limits.max_streams=3", "no effect", "limits.max_rows"],
    ),
    (
        "sample --bbox 0,0,9,9 --spacing 1 --tables /a --set tables.folder=/b",
        &["`tables.folder`", "--set tables.folder=/b and by --tables"],
    ),
    (
        "probe --url http://127.0.0.1:1 --listen 127.0.0.1:2",
        &["--listen has no effect", "--url"],
    ),
    ("nearest --at 0,0", &["--spacing, --min-distance\n"]),
    (
        "nearest --at 0,0 --spacing 1 --radius 1000",
        &["--radius 1000", "3141593", "10000"],
    ),
    ("sample", &["--bbox", "--query", "--min-distance"]),
    (
        "sample --spacing 1",
        &["region is missing", "--chunk", "--region"],
    ),
    (
        "sample --bbox 0,0,1,1",
        &["amount is missing", "--density", "--count"],
    ),
    (
        "sample --bbox 0,0,1 --spacing x --keep 3",
        &[
            "3 errors",
            "--bbox 0,0,1",
            "--spacing x",
            "--keep 3",
            "1e-6",
        ],
    ),
    (
        "sample --bbox 0,0,1,1 --chunk 1/1/1 --spacing 1",
        &["--bbox and --chunk"],
    ),
    (
        "sample --chunk 64/1 --spacing 1",
        &["--chunk 64/1", "SIZE/CX/CY"],
    ),
    (
        "sample --chunk 0/1/1 --spacing 1",
        &["--chunk 0", "above 0"],
    ),
    (
        "sample --region /nowhere --spacing 1",
        &["--region", "/nowhere", "No such file"],
    ),
    (
        "sample --query /nowhere",
        &["--query", "/nowhere", "No such file"],
    ),
    (
        "sample --query - --seed 3 --chunk 1/1/1",
        &["--seed, --chunk", "--query -", "--decimals"],
    ),
    (
        "sample --bbox 0,0,9,9 --spacing 1 --format cvs",
        &["--format cvs", "ndjson", "parquet"],
    ),
    (
        "sample --bbox 0,0,9,9 --spacing 1 --format png --decimals 2",
        &["--decimals 2", "png", "csv"],
    ),
    (
        "sample --bbox 0,0,9,9 --spacing 1 --attributes variant",
        &["--variants is missing", "oak:3"],
    ),
    (
        "sample --bbox 0,0,9,9 --spacing 1 --attributes angel",
        &["--attributes angel", "rank"],
    ),
    (
        "sample --bbox 0,0,9,9 --spacing 1 --scale-range 1",
        &["--scale-range 1", "expected 2 numbers, got 1"],
    ),
    (
        "sample --bbox 0,0,9,9 --spacing 1 --limit 0",
        &["--limit 0"],
    ),
    (
        "sample --bbox 0,0,9,9 --spacing 1 --cursor 00",
        &["--cursor 00", "earlier answer"],
    ),
    (
        "sample --bbox 0,0,9,9 --spacing 1 --table 00",
        &["--table 00", "64 hexadecimal"],
    ),
    (
        "sample --bbox 0,0,9,9 --spacing 1 --profile mauve",
        &["--profile mauve", "blue"],
    ),
    (
        "sample --bbox 0,0,9,9 --profile step --min-distance 1",
        &["--min-distance 1", "step", "no least distance"],
    ),
    (
        "sample --bbox 0,0,9,9 --count 99999999999",
        &["99999999999", "limits.max_points="],
    ),
    (
        "count --circle 0,0,1e8 --spacing 1",
        &["lattice rows", "limits.max_rows="],
    ),
    (
        "count --bbox 0,0,9,9 --spacing 1 --format csv",
        &["--format"],
    ),
    ("point abc --spacing 1", &["abc", "-31:52"]),
    ("point 0:0", &["amount is missing"]),
    ("nearest --spacing 1", &["--at is missing"]),
    (
        "nearest --spacing 1 --at 1",
        &["--at 1", "expected 2 numbers, got 1"],
    ),
    (
        "nearest --spacing 1 --at 1,1 --k 0",
        &["--k 0", "1 to 10000"],
    ),
    ("split --bbox 0,0,9,9 --spacing 1", &["--parts is missing"]),
    (
        "split --bbox 0,0,9,9 --spacing 1 --parts 0",
        &["--parts 0", "1 to 10000"],
    ),
];

#[test]
fn errors_name_the_flag_and_what_is_allowed() {
    for (arguments, texts) in WRONG {
        let arguments: Vec<&str> = arguments.split_whitespace().collect();
        let output = run(&arguments, "{}");
        let message = String::from_utf8(output.stderr).expect("UTF-8");
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {message}");
        assert!(output.stdout.is_empty(), "{arguments:?}");
        for text in texts {
            assert!(
                message.contains(text),
                "{arguments:?}: no `{text}`: {message}"
            );
        }
    }
}

#[test]
fn errors_name_the_file_and_the_member() {
    let line = r#"{"type": "Feature", "geometry": {"type": "LineString", "coordinates": [[0, 0], [1, 1]]}}"#;
    for (flag, input, texts) in [
        ("--query=-", "{", &["--query -", "not JSON"][..]),
        ("--query=-", "[]", &["--query -", "must be an object"]),
        ("--query=-", "{}", &["2 errors", "`region`", "`spacing`"]),
        (
            "--query=-",
            r#"{"region": {"bbox": [0, 0, 1, 1]}, "spacin": 1}"#,
            &["`spacin` = `1`", "spacing"],
        ),
        (
            "--query=-",
            r#"{"bbox": [0, 0, 1, 1], "spacing": 1}"#,
            &["`bbox`", "belongs in `region`"],
        ),
        (
            "--query=-",
            r#"{"region": {"circle": [0, 0, 1]}, "layers": [{"spacing": 1}]}"#,
            &["`region.circle`", "center", "`layers[0].name`: missing"],
        ),
        ("--region=-", "{", &["--region -", "not JSON"]),
        (
            "--region=-",
            line,
            &["geometry has the type `LineString`", "GeoJSON"],
        ),
        (
            "--region=-",
            r#"{"type": "Polygon", "coordinates": [[[0, 0], [1, 1]]]}"#,
            &["--region", "coordinates[0] has 2 positions"],
        ),
    ] {
        let mut arguments = vec!["sample", flag];
        arguments.extend((flag == "--region=-").then_some("--spacing=1"));
        let output = run(&arguments, input);
        let message = String::from_utf8(output.stderr).expect("UTF-8");
        assert_eq!(output.status.code(), Some(2), "{input}: {message}");
        for text in texts {
            assert!(message.contains(text), "{input}: no `{text}`: {message}");
        }
    }
}

#[test]
fn a_missing_point_is_not_a_usage_error() {
    let output = run(&["point", "1:0", "--spacing=1"], "");
    let message = String::from_utf8(output.stderr).expect("UTF-8");
    assert_eq!(output.status.code(), Some(1), "{message}");
    assert!(message.contains("1:0"), "{message}");
}
