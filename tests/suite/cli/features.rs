//! Features and classes of maps: each has its own number of points, exactly.

use std::{collections::BTreeMap, fs, path::Path};

use serde_json::{Value, json};

use super::{
    geo::{geo, geotiff, municipalities},
    output, refused,
};

/// The number of points of each layer.
fn by_layer(csv: &[u8]) -> BTreeMap<String, usize> {
    let mut counts = BTreeMap::new();
    for line in std::str::from_utf8(csv).expect("UTF-8").lines().skip(1) {
        *counts
            .entry(line.split(',').next().unwrap_or_default().to_owned())
            .or_default() += 1;
    }
    counts
}

#[test]
fn each_feature_has_its_own_number_of_points() {
    let map = municipalities(Some("EPSG:25832")).to_string();
    let sample = |more: &[&str]| {
        output(
            &[&["sample", "-q", "--format=csv", "--features=-"], more].concat(),
            &map,
        )
    };
    let own = by_layer(&sample(&["--feature-id=key", "--feature-count=trees"]));
    assert_eq!(
        own,
        BTreeMap::from([("09162000".into(), 300), ("09184119".into(), 45)])
    );
    let each = by_layer(&sample(&["--count=12"]));
    assert_eq!(each, BTreeMap::from([("0".into(), 12), ("1".into(), 12)]));
    // At one spacing the points are those of one region.
    let rows = |csv: Vec<u8>, from: usize| {
        let text = String::from_utf8(csv).expect("UTF-8");
        let rows = text.lines().skip(1);
        let mut rows: Vec<String> = rows
            .map(|row| {
                row.splitn(from + 1, ',')
                    .last()
                    .unwrap_or_default()
                    .to_owned()
            })
            .collect();
        rows.sort();
        rows
    };
    let whole = output(
        &["sample", "-q", "--format=csv", "--region=-", "--spacing=30"],
        &map,
    );
    assert_eq!(rows(sample(&["--spacing=30"]), 1), rows(whole, 0));
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("map.json").display().to_string();
    fs::write(&file, &map).expect("writable");
    for (flags, words) in [
        (
            &["--feature-id=name", "--count=1"][..],
            "features[0].properties.name",
        ),
        (&["--feature-count=key"], "features[0].properties.key"),
        (
            &["--feature-count=trees", "--count=1"],
            "--count beside --feature-count trees",
        ),
        (&["--count=1", "--bbox=0,0,1,1"], "a query has one region"),
        (&["--count=1", "--space"], "is flat"),
    ] {
        let message = refused(&[&["sample", "--features", &file], flags].concat(), 2);
        assert!(message.contains(words), "{message}");
    }
}

#[test]
fn each_class_of_a_raster_has_its_own_number_of_points() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).display().to_string();
    let class = |column: u32, row: u32| match (column, row) {
        (..40, _) => 3,
        (_, ..50) => 4,
        _ => 12,
    };
    geotiff(
        &folder.path().join("cover.tif"),
        [100, 100],
        25832,
        [5e5, 5_301_000.0],
        class,
    );
    let cover = path("cover.tif");
    let sample = |classes: &str, more: &[&str]| {
        output(
            &[
                &[
                    "sample",
                    "-q",
                    "--format=csv",
                    "--strata",
                    &cover,
                    "--classes",
                    classes,
                ],
                more,
            ]
            .concat(),
            "",
        )
    };
    let csv = sample("3=120,4=30,12=7", &[]);
    assert_eq!(
        by_layer(&csv),
        BTreeMap::from([("3".into(), 120), ("4".into(), 30), ("12".into(), 7)])
    );
    for line in std::str::from_utf8(&csv).expect("UTF-8").lines().skip(1) {
        let fields: Vec<&str> = line.split(',').collect();
        let [x, y] = [2, 3].map(|i| fields[i].parse::<f64>().expect("a number"));
        let pixel = [(x - 5e5) / 10.0, (5_301_000.0 - y) / 10.0].map(|v| v as u32);
        assert_eq!(class(pixel[0], pixel[1]).to_string(), fields[0], "{line}");
    }
    let even = by_layer(&sample("3,12", &["--spacing=20"]));
    assert!(
        even["3"].abs_diff(1000) < 60 && even["12"].abs_diff(750) < 60,
        "{even:?}"
    );
    let file = path("x.parquet");
    let sample = [
        "sample",
        "-q",
        "--strata",
        &cover,
        "--classes=4=5",
        "-o",
        &file,
    ];
    output(&sample, "");
    assert_eq!(
        geo(Path::new(&file))["columns"]["geometry"]["crs"]["id"]["code"],
        25832
    );
    for (classes, words) in [
        ("3=x", "has no number of points"),
        ("3,3", "twice"),
        ("3=1,4", "some have none"),
        ("a", "no class"),
    ] {
        let message = refused(&["sample", "--strata", &cover, "--classes", classes], 2);
        assert!(message.contains(words), "{message}");
    }
    // There are no points to be had in a class that is not there.
    let message = refused(&["sample", "--strata", &cover, "--classes=9=5"], 2);
    assert!(
        message.contains("class 9.count 5: no point is left here"),
        "{message}"
    );
}

/// RFC 7946, 3.1.6 and 3.1, and RFC 8259, 8.1: what files of countries and of GIS have in them changes no number.
#[test]
fn holes_empty_geometries_and_byte_order_marks_are_read_as_their_standards_say() {
    let square = |x: f64, side: f64| {
        let end = x + side;
        json!([[x, x], [end, x], [end, end], [x, end], [x, x]])
    };
    let (land, lake, sea) = (square(0.0, 20.0), square(5.0, 8.0), square(30.0, 4.0));
    let of = |rings: Value| json!({ "type": "Polygon", "coordinates": rings });
    let count = |text: String| -> u64 {
        let printed = output(&["count", "--region=-", "--spacing=1"], &text);
        let printed = String::from_utf8(printed).expect("UTF-8");
        printed.trim().parse().expect("a number")
    };
    let plain = count(of(json!([land])).to_string());
    let one = count(of(json!([land, lake])).to_string());
    assert!((330..=340).contains(&one), "{one}");
    assert_eq!(count(of(json!([land, lake, lake])).to_string()), one);
    assert_eq!(count(of(json!([land, lake, sea])).to_string()), one);
    assert_eq!(count(format!("\u{feff}{}", of(json!([land, []])))), plain);
    let both = json!({ "type": "GeometryCollection", "geometries": [of(json!([])), of(json!([land])), null] });
    assert_eq!(count(both.to_string()), plain);
    for (file, words) in [
        (of(json!([])).to_string(), "contains no polygon"),
        (String::new(), "it is empty"),
        ("SQLite format 3\0…".into(), "a GeoPackage"),
        ("<kml/>".into(), "XML"),
    ] {
        let run = crate::support::command::run(&["count", "--region=-", "--spacing=1"], &file);
        let message = crate::support::command::errors(&run);
        assert!(message.contains(words), "{message}");
    }
}

#[test]
fn features_have_any_names_and_a_field_of_all() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).display().to_string();
    // White in the upper half.
    let half = |_, row| if row < 50 { 255 } else { 0 };
    let raster = "über my+mask.tif";
    geotiff(
        &folder.path().join(raster),
        [100, 100],
        25832,
        [5e5, 5_301_000.0],
        half,
    );
    let mut map = municipalities(Some("EPSG:25832"));
    map["features"][0]["properties"]["key"] = json!("Bad Tölz, \"alt\"");
    map["features"][0]["properties"]["trees"] = json!(30.0);
    map["features"][1]["properties"]["trees"] = Value::Null;
    fs::write(path("map.json"), map.to_string()).expect("writable");
    for flag in ["--field", "--raster"] {
        let csv = output(
            &[
                "sample",
                "-q",
                "--format=csv",
                "--features",
                &path("map.json"),
                "--feature-id=key",
                "--feature-count=trees",
                flag,
                &path(raster),
            ],
            "",
        );
        let csv = String::from_utf8(csv).expect("UTF-8");
        let rows: Vec<&str> = csv.lines().skip(1).collect();
        assert_eq!(rows.len(), 30);
        for row in rows {
            assert!(row.starts_with("\"Bad Tölz, \"\"alt\"\"\","), "{row}");
            let y: f64 = row
                .rsplit(',')
                .next()
                .and_then(|y| y.parse().ok())
                .expect("a number");
            assert!(y >= 5_300_500.0 - 10.0, "{row}");
        }
    }
    // Without area no number of points fits.
    map["features"][0]["geometry"]["coordinates"] = json!([[
        [5e5, 5_300_000.0],
        [5e5, 5_300_100.0],
        [5e5, 5_300_000.0],
        [5e5, 5_300_000.0]
    ]]);
    fs::write(path("flat.json"), map.to_string()).expect("writable");
    let flat = [
        "sample",
        "-q",
        "--format=csv",
        "--features",
        &path("flat.json"),
    ];
    let counted = [&flat[..], &["--feature-count=trees"]].concat();
    let message = crate::support::command::errors(&crate::support::command::run(&counted, ""));
    assert!(message.contains("has no area"), "{message}");
    let thin = output(&[&flat[..], &["--spacing=1000"]].concat(), "");
    assert!(!by_layer(&thin).contains_key("0"));
    // Degrees by RFC 7946 over a raster in metres.
    let degrees = r#"{"type": "Polygon", "coordinates": [[[8.9, 47.8], [9.1, 47.8], [9.1, 47.9], [8.9, 47.8]]]}"#;
    fs::write(path("degrees.json"), degrees).expect("writable");
    let over = [
        "count",
        "--spacing=10",
        "--region",
        &path("degrees.json"),
        "--raster",
        &path(raster),
    ];
    let message = refused(&over, 2);
    assert!(
        message.contains("WGS 84") && message.contains("EPSG:25832"),
        "{message}"
    );
    let said = ["sample", "-q", "--format=geojson", "--crs=EPSG:25832"];
    output(&[&said[..], &over[1..]].concat(), "");
    // Each class in each feature.
    let mut one = municipalities(Some("EPSG:25832"));
    one["features"]
        .as_array_mut()
        .expect("features")
        .truncate(1);
    fs::write(path("one.json"), one.to_string()).expect("writable");
    let csv = output(
        &[
            "sample",
            "-q",
            "--format=csv",
            "--features",
            &path("one.json"),
            "--feature-id=key",
            "--strata",
            &path(raster),
            "--classes=255=5,0=3",
        ],
        "",
    );
    let expected = [("09162000/255".into(), 5), ("09162000/0".into(), 3)];
    assert_eq!(by_layer(&csv), BTreeMap::from(expected));
}
