//! Reference systems: the planes of maps reach the files of points, and nothing is guessed.

use std::{fs, path::Path};

use parquet::file::reader::{FileReader as _, SerializedFileReader};
use serde_json::{Value, json};

use super::{output, refused};
use crate::support::{clients, command::errors};

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

#[test]
fn the_plane_of_a_region_is_that_of_the_points() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).display().to_string();
    let plain = municipalities(None).to_string();
    let map = municipalities(Some("urn:ogc:def:crs:EPSG::25832")).to_string();
    let sample = |name: &str, region: &str, more: &[&str]| {
        let file = path(name);
        output(
            &[
                &["sample", "-q", "--region=-", "--spacing=40", "-o", &file],
                more,
            ]
            .concat(),
            region,
        );
        folder.path().join(name)
    };
    let of = |file: &Path| geo(file)["columns"]["geometry"]["crs"]["id"]["code"].clone();
    assert_eq!(of(&sample("none.parquet", &plain, &[])), Value::Null);
    assert_eq!(of(&sample("map.parquet", &map, &[])), 25832);
    assert_eq!(
        of(&sample("named.parquet", &plain, &["--crs=EPSG:3035"])),
        3035
    );
    assert_eq!(
        of(&sample("same.parquet", &map, &["--crs=epsg:25832"])),
        25832
    );
    let text = fs::read(sample("map.geojson", &map, &[])).expect("written");
    let text: Value = serde_json::from_slice(&text).expect("JSON");
    assert_eq!(
        text["crs"]["properties"]["name"],
        "urn:ogc:def:crs:EPSG::25832"
    );
    // Formats without a place for it do not mind.
    sample("map.csv", &map, &[]);

    fs::write(path("map.json"), &map).expect("writable");
    let message = refused(
        &[
            "sample",
            "--region",
            &path("map.json"),
            "--spacing=40",
            "--crs=EPSG:4326",
        ],
        2,
    );
    let words = [
        "--crs EPSG:4326: ",
        "coordinates are not converted",
        "allowed: EPSG:25832",
    ];
    assert!(words.iter().all(|word| message.contains(word)), "{message}");
    let message = refused(
        &[
            "sample",
            "--region",
            &path("map.json"),
            "--spacing=40",
            "--crs=EPSG:1",
            "-o",
            &path("x.parquet"),
        ],
        2,
    );
    assert!(message.contains("EPSG:25832"), "{message}");
    let message = refused(
        &[
            "sample",
            "--bbox=0,0,9,9",
            "--spacing=1",
            "--crs=EPSG:1",
            "-o",
            &path("x.parquet"),
        ],
        2,
    );
    assert!(
        message.contains("its definition is not known here"),
        "{message}"
    );
    let message = refused(
        &[
            "sample",
            "--bbox=0,0,9,9",
            "--spacing=1",
            "--crs=EPSG:3857",
            "-o",
            &path("x.csv"),
        ],
        2,
    );
    assert!(
        message.contains("allowed: the formats geojson, parquet"),
        "{message}"
    );
}

#[test]
fn systems_without_a_code_come_from_a_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).display().to_string();
    let own = json!({ "type": "ProjectedCRS", "name": "Our site", "coordinate_system": { "axis": [] },
                      "id": { "authority": "SITE", "code": 1 } });
    fs::write(path("site.projjson"), own.to_string()).expect("writable");
    let sample = [
        "sample",
        "-q",
        "--bbox=0,0,9,9",
        "--spacing=1",
        "--crs",
        &path("site.projjson"),
        "-o",
    ];
    output(&[&sample[..], &[&path("x.parquet")]].concat(), "");
    assert_eq!(
        geo(&folder.path().join("x.parquet"))["columns"]["geometry"]["crs"],
        own
    );
    output(&[&sample[..], &[&path("x.geojson")]].concat(), "");
    let text: Value =
        serde_json::from_slice(&fs::read(path("x.geojson")).expect("written")).expect("JSON");
    assert_eq!(text["crs"]["properties"]["name"], "urn:ogc:def:crs:SITE::1");
    fs::write(
        path("bad.json"),
        r#"{"type": "ProjectedCRS", "name": "x", "coordinate_system": {}}"#,
    )
    .expect("writable");
    let message = refused(
        &[
            "sample",
            "--bbox=0,0,9,9",
            "--spacing=1",
            "--crs",
            &path("bad.json"),
        ],
        2,
    );
    assert!(
        message.contains("has no `id`") && message.contains("projinfo"),
        "{message}"
    );
}

#[test]
fn rasters_in_another_plane_than_the_region_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).display().to_string();
    geotiff(
        &folder.path().join("utm33.tif"),
        [100, 100],
        32633,
        [5e5, 5_301_000.0],
        |_, _| 255,
    );
    fs::write(
        path("map.json"),
        municipalities(Some("EPSG:25832")).to_string(),
    )
    .expect("writable");
    let (raster, region) = (path("utm33.tif"), path("map.json"));
    for flag in ["--raster", "--field", "--terrain"] {
        let message = refused(
            &["count", "--region", &region, "--spacing=40", flag, &raster],
            2,
        );
        assert!(
            message.contains("EPSG:32633: another plane than that of region"),
            "{message}"
        );
    }
    let own = [
        "--raster",
        &raster,
        "--raster-bbox=500000,5300000,501000,5301000",
    ];
    output(
        &[&["count", "--region", &region, "--spacing=40"], &own[..]].concat(),
        "",
    );
    let file = path("x.parquet");
    output(
        &[
            "sample",
            "-q",
            "--bbox=500000,5300000,501000,5301000",
            "--spacing=40",
            "--raster",
            &raster,
            "-o",
            &file,
        ],
        "",
    );
    assert_eq!(
        geo(Path::new(&file))["columns"]["geometry"]["crs"]["id"]["code"],
        32633
    );
    let far = [
        "sample",
        "--bbox=0,0,1,1",
        "--spacing=1e-1",
        "--raster",
        &raster,
        "--format=geojson",
    ];
    let far = crate::support::command::run(&far, "");
    assert!(
        errors(&far).contains("is the region in EPSG:32633"),
        "{}",
        errors(&far)
    );
}

#[test]
fn parquet_is_compressed_inside_only() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).display().to_string();
    let length = |level: &[&str]| {
        let file = path("x.parquet");
        output(
            &[
                &[
                    "sample",
                    "-q",
                    "--bbox=0,0,300,300",
                    "--spacing=1",
                    "-o",
                    &file,
                ],
                level,
            ]
            .concat(),
            "",
        );
        fs::metadata(&file).expect("written").len()
    };
    let (plain, packed) = (length(&["--zstd=0"]), length(&[]));
    assert!(packed * 2 < plain, "{packed} of {plain}");
    let sample = ["sample", "--bbox=0,0,9,9", "--spacing=1", "-o"];
    for ending in ["zst", "gz"] {
        let message = refused(
            &[&sample[..], &[&path(&format!("x.parquet.{ending}"))]].concat(),
            2,
        );
        assert!(message.contains("compressed inside"), "{message}");
    }
    let message = refused(&[&sample[..], &[&path("x.csv"), "--zstd=3"]].concat(), 2);
    assert!(
        message.contains("--zstd 3: has no effect in the format csv"),
        "{message}"
    );
}

/// Other readers know the plane, and pass over row groups that are elsewhere.
#[test]
fn readers_of_geoparquet_know_the_plane_and_skip_row_groups() {
    let Some(mut python) = clients::python("readers of GeoParquet") else {
        return;
    };
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("x.parquet");
    let sample = [
        "sample",
        "-q",
        "--bbox=0,0,600,600",
        "--spacing=1",
        "--crs=EPSG:25832",
        "-o",
    ];
    output(&[&sample[..], &[&file.display().to_string()]].concat(), "");
    let script = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/tests/suite/cli/geo_readers.py"
    );
    let read = python.arg(script).arg(&file).output().expect("Python runs");
    println!("{}", String::from_utf8_lossy(&read.stdout));
    assert!(read.status.success(), "{}", errors(&read));
}
