//! Features and classes of maps: each has its own number of points, exactly.

use std::collections::BTreeMap;

use serde_json::{Value, json};

use super::geo::{geo, geotiff, municipalities};
use crate::support::command::{Shell, errors};

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
    let shell = Shell::new();
    let map = municipalities(Some("EPSG:25832")).to_string();
    shell.write("map.json", &map);
    let sample = |flags: &str| {
        let line = format!("sample -q --format=csv --features=- {flags}");
        shell.output(&line, &map)
    };
    let own = by_layer(&sample("--feature-id=key --feature-count=trees"));
    let expected = [("09162000".into(), 300), ("09184119".into(), 45)];
    assert_eq!(own, BTreeMap::from(expected));
    let each = by_layer(&sample("--count=12"));
    assert_eq!(each, BTreeMap::from([("0".into(), 12), ("1".into(), 12)]));
    // At one spacing the points are those of one region.
    let rows = |csv: Vec<u8>, from: usize| {
        let text = String::from_utf8(csv).expect("UTF-8");
        let rest = |row: &str| {
            row.splitn(from + 1, ',')
                .last()
                .unwrap_or_default()
                .to_owned()
        };
        let mut rows: Vec<String> = text.lines().skip(1).map(rest).collect();
        rows.sort();
        rows
    };
    let whole = shell.output("sample -q --format=csv --region=- --spacing=30", &map);
    assert_eq!(rows(sample("--spacing=30"), 1), rows(whole, 0));
    for (flags, words) in [
        ("--feature-id=name --count=1", "features[0].properties.name"),
        ("--feature-count=key", "features[0].properties.key"),
        (
            "--feature-count=trees --count=1",
            "--count beside --feature-count trees",
        ),
        ("--count=1 --bbox=0,0,1,1", "a query has one region"),
        ("--count=1 --space", "is flat"),
    ] {
        shell.assert_refused(&format!("sample --features map.json {flags}"), &[words]);
    }
}

#[test]
fn each_class_of_a_raster_has_its_own_number_of_points() {
    let shell = Shell::new();
    let class = |column: u32, row: u32| match (column, row) {
        (..40, _) => 3,
        (_, ..50) => 4,
        _ => 12,
    };
    let corner = [5e5, 5_301_000.0];
    geotiff(&shell.path("cover.tif"), [100, 100], 25832, corner, class);
    let sample = |classes: &str| {
        let line = format!("sample -q --format=csv --strata cover.tif --classes {classes}");
        shell.output(&line, "")
    };
    let csv = sample("3=120,4=30,12=7");
    let expected = [("3".into(), 120), ("4".into(), 30), ("12".into(), 7)];
    assert_eq!(by_layer(&csv), BTreeMap::from(expected));
    for line in std::str::from_utf8(&csv).expect("UTF-8").lines().skip(1) {
        let fields: Vec<&str> = line.split(',').collect();
        let [x, y] = [2, 3].map(|i| fields[i].parse::<f64>().expect("a number"));
        let pixel = [(x - 5e5) / 10.0, (5_301_000.0 - y) / 10.0].map(|v| v as u32);
        assert_eq!(class(pixel[0], pixel[1]).to_string(), fields[0], "{line}");
    }
    let even = by_layer(&sample("3,12 --spacing=20"));
    assert!(
        even["3"].abs_diff(1000) < 60 && even["12"].abs_diff(750) < 60,
        "{even:?}"
    );
    shell.output(
        "sample -q --strata cover.tif --classes=4=5 -o x.parquet",
        "",
    );
    let geo = geo(&shell.path("x.parquet"));
    assert_eq!(geo["columns"]["geometry"]["crs"]["id"]["code"], 25832);
    for (classes, words) in [
        ("3=x", "has no number of points"),
        ("3,3", "twice"),
        ("3=1,4", "some have none"),
        ("a", "no class"),
        // There are no points to be had in a class that is not there.
        ("9=5", "class 9.count 5: no point is left here"),
    ] {
        let line = format!("sample --strata cover.tif --classes={classes}");
        shell.assert_refused(&line, &[words]);
    }
}

/// RFC 7946, 3.1.6 and 3.1, and RFC 8259, 8.1: what files of countries and of GIS have in them changes no number.
#[test]
fn holes_empty_geometries_and_byte_order_marks_are_read_as_their_standards_say() {
    let shell = Shell::new();
    let square = |x: f64, side: f64| {
        let end = x + side;
        json!([[x, x], [end, x], [end, end], [x, end], [x, x]])
    };
    let (land, lake, sea) = (square(0.0, 20.0), square(5.0, 8.0), square(30.0, 4.0));
    let of = |rings: Value| json!({ "type": "Polygon", "coordinates": rings });
    let count = |text: String| -> u64 {
        let printed = shell.output("count --region=- --spacing=1", &text);
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
        let message = errors(&shell.run("count --region=- --spacing=1", &file));
        assert!(message.contains(words), "{message}");
    }
}

#[test]
fn features_have_any_names_and_a_field_of_all() {
    let shell = Shell::new();
    // White in the upper half.
    let half = |_, row| if row < 50 { 255 } else { 0 };
    let corner = [5e5, 5_301_000.0];
    let raster = "über my+mask.tif";
    geotiff(&shell.path(raster), [100, 100], 25832, corner, half);
    let mut map = municipalities(Some("EPSG:25832"));
    map["features"][0]["properties"]["key"] = json!("Bad Tölz, \"alt\"");
    map["features"][0]["properties"]["trees"] = json!(30.0);
    map["features"][1]["properties"]["trees"] = Value::Null;
    shell.write("map.json", map.to_string());
    for flag in ["--field", "--raster"] {
        let flags = format!("--feature-id=key --feature-count=trees {flag} '{raster}'");
        let line = format!("sample -q --format=csv --features map.json {flags}");
        let csv = String::from_utf8(shell.output(&line, "")).expect("UTF-8");
        let rows: Vec<&str> = csv.lines().skip(1).collect();
        assert_eq!(rows.len(), 30);
        for row in rows {
            assert!(row.starts_with("\"Bad Tölz, \"\"alt\"\"\","), "{row}");
            let y = row.rsplit(',').next().map(str::parse::<f64>);
            let y = y.expect("a field").expect("a number");
            assert!(y >= 5_300_500.0 - 10.0, "{row}");
        }
    }
    // Without area no number of points fits.
    let ends = [5_300_000, 5_300_100, 5_300_000, 5_300_000];
    map["features"][0]["geometry"]["coordinates"] = json!([ends.map(|y| [500_000, y])]);
    shell.write("flat.json", map.to_string());
    let flat = "sample -q --format=csv --features flat.json";
    let message = errors(&shell.run(&format!("{flat} --feature-count=trees"), ""));
    assert!(message.contains("has no area"), "{message}");
    let thin = shell.output(&format!("{flat} --spacing=1000"), "");
    assert!(!by_layer(&thin).contains_key("0"));
    // Degrees by RFC 7946 over a raster in metres.
    let degrees = r#"{"type": "Polygon", "coordinates": [[[8.9, 47.8], [9.1, 47.8], [9.1, 47.9], [8.9, 47.8]]]}"#;
    shell.write("degrees.json", degrees);
    let over = format!("--spacing=10 --region degrees.json --raster '{raster}'");
    shell.assert_refused(&format!("count {over}"), &["WGS 84", "EPSG:25832"]);
    shell.output(
        &format!("sample -q --format=geojson --crs=EPSG:25832 {over}"),
        "",
    );
    // Each class in each feature.
    let mut one = municipalities(Some("EPSG:25832"));
    one["features"]
        .as_array_mut()
        .expect("features")
        .truncate(1);
    shell.write("one.json", one.to_string());
    let flags = format!("--feature-id=key --strata '{raster}' --classes=255=5,0=3");
    let line = format!("sample -q --format=csv --features one.json {flags}");
    let expected = [("09162000/255".into(), 5), ("09162000/0".into(), 3)];
    assert_eq!(by_layer(&shell.output(&line, "")), BTreeMap::from(expected));
}
