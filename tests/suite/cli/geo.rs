//! Reference systems: the planes of maps reach the files of points, and nothing is guessed.

use std::{fs, path::Path};

use parquet::file::reader::{FileReader as _, SerializedFileReader};
use serde_json::{Value, json};

use crate::support::{
    clients,
    command::{Shell, errors},
};

/// Two municipalities, one of two parts, and one without a place.
pub(super) fn municipalities(crs: Option<&str>) -> Value {
    let feature = |key: &str, trees: u32, geometry: Value| json!({ "type": "Feature", "properties": { "key": key, "trees": trees }, "geometry": geometry });
    let west = json!([[
        [500_000, 5_300_000],
        [501_000, 5_300_000],
        [501_000, 5_301_000],
        [500_000, 5_301_000],
        [500_000, 5_300_000]
    ]]);
    let east = json!([
        [[
            [501_000, 5_300_000],
            [502_000, 5_300_000],
            [501_000, 5_300_900],
            [501_000, 5_300_000]
        ]],
        [[
            [503_000, 5_300_000],
            [503_500, 5_300_000],
            [503_000, 5_300_500],
            [503_000, 5_300_000]
        ]]
    ]);
    let mut all = json!({ "type": "FeatureCollection", "features": [
        feature("09162000", 300, json!({ "type": "Polygon", "coordinates": west })),
        feature("09184119", 45, json!({ "type": "MultiPolygon", "coordinates": east })),
        feature("nowhere", 7, Value::Null),
    ]});
    if let Some(name) = crs {
        all["crs"] = json!({ "type": "name", "properties": { "name": name } });
    }
    all
}

/// A GeoTIFF of bytes, 10 m to the pixel, with its upper left corner at a place, in a system of EPSG.
pub(super) fn geotiff(
    file: &Path,
    [width, height]: [u32; 2],
    epsg: u16,
    [x, y]: [f64; 2],
    of: impl Fn(u32, u32) -> u8,
) {
    let pixels: Vec<u8> = (0..height)
        .flat_map(|row| (0..width).map(move |column| (column, row)))
        .map(|(c, r)| of(c, r))
        .collect();
    let doubles = |all: &[f64]| {
        all.iter()
            .flat_map(|v| v.to_le_bytes())
            .collect::<Vec<u8>>()
    };
    let keys: [u16; 12] = [1, 1, 0, 2, 1024, 0, 1, 1, 3072, 0, 1, epsg];
    let long = [
        doubles(&[10.0, 10.0, 0.0]),
        doubles(&[0.0, 0.0, 0.0, x, y, 0.0]),
        keys.iter().flat_map(|key| key.to_le_bytes()).collect(),
        pixels,
    ];
    const TAGS: u32 = 11;
    let mut places = vec![8 + 2 + 12 * TAGS + 4];
    for bytes in &long {
        places.push(places[places.len() - 1] + bytes.len() as u32);
    }
    let tags: [(u16, u16, u32, u32); TAGS as usize] = [
        (256, 3, 1, width),
        (257, 3, 1, height),
        (258, 3, 1, 8),
        (259, 3, 1, 1),
        (262, 3, 1, 1),
        (273, 4, 1, places[3]),
        (278, 3, 1, height),
        (279, 4, 1, width * height),
        (33550, 12, 3, places[0]),
        (33922, 12, 6, places[1]),
        (34735, 3, 12, places[2]),
    ];
    let mut out = b"II*\0\x08\0\0\0".to_vec();
    out.extend((TAGS as u16).to_le_bytes());
    for (tag, kind, count, value) in tags {
        out.extend([tag.to_le_bytes(), kind.to_le_bytes()].concat());
        out.extend([count.to_le_bytes(), value.to_le_bytes()].concat());
    }
    out.extend([0; 4]);
    out.extend(long.concat());
    fs::write(file, out).expect("writable");
}

/// The metadata of a GeoParquet file.
pub(super) fn geo(file: &Path) -> Value {
    let bytes = bytes::Bytes::from(fs::read(file).expect("written"));
    let reader = SerializedFileReader::new(bytes).expect("Parquet");
    let entries = reader
        .metadata()
        .file_metadata()
        .key_value_metadata()
        .expect("entries");
    let geo = entries
        .iter()
        .find(|entry| entry.key == "geo")
        .and_then(|entry| entry.value.clone());
    serde_json::from_str(&geo.expect("geo")).expect("JSON")
}

/// The code of the reference system of a GeoParquet file.
fn code(shell: &Shell, name: &str) -> Value {
    geo(&shell.path(name))["columns"]["geometry"]["crs"]["id"]["code"].clone()
}

#[test]
fn the_plane_of_a_region_is_that_of_the_points() {
    let shell = Shell::new();
    shell.write("plain.json", municipalities(None).to_string());
    let map = municipalities(Some("urn:ogc:def:crs:EPSG::25832"));
    shell.write("map.json", map.to_string());
    for (region, flags, expected) in [
        ("plain.json", "", Value::Null),
        ("map.json", "", json!(25832)),
        ("plain.json", "--crs=EPSG:3035", json!(3035)),
        ("map.json", "--crs=epsg:25832", json!(25832)),
    ] {
        let line = format!("sample -q --region {region} --spacing=40 -o x.parquet {flags}");
        shell.output(&line, "");
        assert_eq!(code(&shell, "x.parquet"), expected, "{line}");
    }
    shell.output("sample -q --region map.json --spacing=40 -o x.geojson", "");
    let text: Value = serde_json::from_slice(&shell.read("x.geojson")).expect("JSON");
    assert_eq!(
        text["crs"]["properties"]["name"],
        "urn:ogc:def:crs:EPSG::25832"
    );
    // Formats without a place for it do not mind.
    shell.output("sample -q --region map.json --spacing=40 -o x.csv", "");
    let of_map = "sample --region map.json --spacing=40";
    let words = [
        "--crs EPSG:4326: ",
        "coordinates are not converted",
        "allowed: EPSG:25832",
    ];
    shell.assert_refused(&format!("{of_map} --crs=EPSG:4326"), &words);
    shell.assert_refused(
        &format!("{of_map} --crs=EPSG:1 -o x.parquet"),
        &["EPSG:25832"],
    );
    let plain = "sample --bbox=0,0,9,9 --spacing=1";
    let words = ["its definition is not known here"];
    shell.assert_refused(&format!("{plain} --crs=EPSG:1 -o x.parquet"), &words);
    let words = ["allowed: the formats geojson, parquet"];
    shell.assert_refused(&format!("{plain} --crs=EPSG:3857 -o x.csv"), &words);
}

#[test]
fn systems_without_a_code_come_from_a_file() {
    let shell = Shell::new();
    let own = json!({ "type": "ProjectedCRS", "name": "Our site", "coordinate_system": { "axis": [] },
                      "id": { "authority": "SITE", "code": 1 } });
    shell.write("site.projjson", own.to_string());
    let sample = "sample -q --bbox=0,0,9,9 --spacing=1 --crs site.projjson -o";
    shell.output(&format!("{sample} x.parquet"), "");
    assert_eq!(
        geo(&shell.path("x.parquet"))["columns"]["geometry"]["crs"],
        own
    );
    shell.output(&format!("{sample} x.geojson"), "");
    let text: Value = serde_json::from_slice(&shell.read("x.geojson")).expect("JSON");
    assert_eq!(text["crs"]["properties"]["name"], "urn:ogc:def:crs:SITE::1");
    let bad = r#"{"type": "ProjectedCRS", "name": "x", "coordinate_system": {}}"#;
    shell.write("bad.json", bad);
    let line = "sample --bbox=0,0,9,9 --spacing=1 --crs bad.json";
    shell.assert_refused(line, &["has no `id`", "projinfo"]);
}

#[test]
fn rasters_in_another_plane_than_the_region_are_refused() {
    let shell = Shell::new();
    let corner = [5e5, 5_301_000.0];
    geotiff(
        &shell.path("utm33.tif"),
        [100, 100],
        32633,
        corner,
        |_, _| 255,
    );
    shell.write("map.json", municipalities(Some("EPSG:25832")).to_string());
    let count = "count --region map.json --spacing=40";
    for flag in ["--raster", "--field", "--terrain"] {
        let words = ["EPSG:32633: another plane than that of region"];
        shell.assert_refused(&format!("{count} {flag} utm33.tif"), &words);
    }
    let bbox = "500000,5300000,501000,5301000";
    shell.output(
        &format!("{count} --raster utm33.tif --raster-bbox={bbox}"),
        "",
    );
    let line = format!("sample -q --bbox={bbox} --spacing=40 --raster utm33.tif -o x.parquet");
    shell.output(&line, "");
    assert_eq!(code(&shell, "x.parquet"), 32633);
    let far = "sample --bbox=0,0,1,1 --spacing=1e-1 --raster utm33.tif --format=geojson";
    let far = errors(&shell.run(far, ""));
    assert!(far.contains("is the region in EPSG:32633"), "{far}");
}

#[test]
fn parquet_is_compressed_inside_only() {
    let shell = Shell::new();
    let length = |level: &str| {
        let line = format!("sample -q --bbox=0,0,300,300 --spacing=1 -o x.parquet {level}");
        shell.output(&line, "");
        shell.read("x.parquet").len()
    };
    let (plain, packed) = (length("--zstd=0"), length(""));
    assert!(packed * 2 < plain, "{packed} of {plain}");
    let sample = "sample --bbox=0,0,9,9 --spacing=1 -o";
    for ending in ["zst", "gz"] {
        shell.assert_refused(
            &format!("{sample} x.parquet.{ending}"),
            &["compressed inside"],
        );
    }
    let words = ["--zstd 3: has no effect in the format csv"];
    shell.assert_refused(&format!("{sample} x.csv --zstd=3"), &words);
}

/// Other readers know the plane, and pass over row groups that are elsewhere.
#[test]
fn readers_of_geoparquet_know_the_plane_and_skip_row_groups() {
    let Some(mut python) = clients::python("readers of GeoParquet") else {
        return;
    };
    let shell = Shell::new();
    let line = "sample -q --bbox=0,0,600,600 --spacing=1 --crs=EPSG:25832 -o x.parquet";
    shell.output(line, "");
    let script = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/tests/suite/cli/geo_readers.py"
    );
    let read = python.arg(script).arg(shell.path("x.parquet")).output();
    let read = read.expect("Python runs");
    println!("{}", String::from_utf8_lossy(&read.stdout));
    assert!(read.status.success(), "{}", errors(&read));
}
