//! The grammar: what it reads, what it makes, and the paths of what is wrong.

use std::cell::Cell;

use strew_core::{Field as _, field::FieldSpec};
use strew_error::{Checked, Error};
use strew_raster::Price;

use super::*;

fn sources(pixels: usize) -> Sources<'static> {
    Sources::new(
        &|name| (name == "half").then(|| (FieldSpec::constant(0.5).expect("a share"), None)),
        &|| "half".into(),
        Allowance::UNLIMITED,
        pixels,
    )
}

fn made(json: &str) -> Checked<FieldSpec> {
    build("field", &read_json("field", json)?, &sources(100))
}

fn share(json: &str, at: [f64; 2]) -> f64 {
    made(json)
        .unwrap_or_else(|faults| panic!("{json}: {faults:?}"))
        .share(at)
}

/// The path of the first fault, and what is wrong.
fn fault(json: &str) -> (String, String) {
    let faults = made(json).expect_err(json);
    let first = &faults.as_slice()[0];
    (first.field.clone(), first.detail.clone())
}

/// Two rows of two bytes: the upper one white, the lower one black.
const UPPER: &str = r#"{"raster": {"f32": "AACAPwAAgD8AAAAAAAAAAA==", "width": 2, "height": 2,
                       "bbox": [0, 0, 10, 10], "filter": "nearest"}}"#;

#[test]
fn every_shape_can_be_written() {
    for (json, at, expected) in [
        (r#""half""#, [0.0, 0.0], 0.5),
        (r#"{"name": "half"}"#, [0.0, 0.0], 0.5),
        (r#"{"constant": 1}"#, [0.0, 0.0], 1.0),
        (
            r#"{"ramp": {"from": [0, 0], "to": [10, 0]}}"#,
            [2.5, 9.0],
            0.25,
        ),
        (
            r#"{"radial": {"center": [0, 0], "radii": [0, 10]}}"#,
            [2.5, 0.0],
            0.75,
        ),
        (
            r#"{"distance": {"lines": [[[0, 0], [10, 0]]], "distances": [2, 4]}}"#,
            [5.0, 3.0],
            0.5,
        ),
        (
            r#"{"distance": {"points": [[0, 0]], "distances": [0, 4], "shares": [1, 0]}}"#,
            [0.0, 1.0],
            0.75,
        ),
        (
            r#"{"multiply": [{"name": "half"}, {"constant": 0.5}]}"#,
            [0.0, 0.0],
            0.25,
        ),
        (
            r#"{"min": [{"name": "half"}, {"constant": 0.25}]}"#,
            [0.0, 0.0],
            0.25,
        ),
        (
            r#"{"max": [{"name": "half"}, {"constant": 0.25}]}"#,
            [0.0, 0.0],
            0.5,
        ),
        (r#"{"invert": {"constant": 0.25}}"#, [0.0, 0.0], 0.75),
        (
            r#"{"curve": {"of": {"name": "half"}, "points": [[0, 0], [0.25, 0], [0.75, 1]]}}"#,
            [0.0, 0.0],
            0.5,
        ),
        // The first row is at the top.
        (UPPER, [5.0, 9.0], 1.0),
        (UPPER, [5.0, 1.0], 0.0),
        (
            r#"{"height": {"terrain": {"f32": "AADIQgAASEM=", "width": 2, "height": 1,
                "bbox": [0, 0, 2, 1], "filter": "nearest"}, "heights": [0, 400]}}"#,
            [1.5, 0.5],
            0.5,
        ),
        (
            r#"{"slope": {"terrain": {"f32": "AAAAAAAAAAA=", "width": 2, "height": 1},
                "slopes": [0, 1]}}"#,
            [1.0, 0.5],
            1.0,
        ),
    ] {
        assert_eq!(share(json, at), expected, "{json}");
    }
    let noise = share(r#"{"noise": {"wavelength": 9, "octaves": 3}}"#, [3.0, 4.0]);
    assert!(noise > 0.0 && noise < 1.0);
}

#[test]
fn toml_says_the_same() {
    let table = "multiply = [{ name = 'half' }, { ramp = { from = [0, 0], to = [10, 0] } }]";
    let read = |toml: &str| {
        let table: toml::Table = toml.parse().expect("TOML");
        read_json("fields.a", &serde_json::to_string(&table).expect("JSON"))
    };
    let document = read(table).expect("a field");
    let json = r#"{"multiply": [{"name": "half"}, {"ramp": {"from": [0, 0], "to": [10, 0]}}]}"#;
    assert_eq!(document, read_json("field", json).expect("a field"));
    let faults = read("[noise]\nwavelength = 'long'").expect_err("no number");
    assert_eq!(faults.as_slice()[0].field, "fields.a.noise.wavelength");
}

#[test]
fn faults_name_the_path() {
    for (json, path, detail) in [
        ("7", "field", "must be a name or an object"),
        ("{}", "field", "expected value"),
        (r#""other""#, "field", "no such field is loaded"),
        (r#"{"ring": 1}"#, "field", "unknown variant `ring`"),
        (r#"{"constant": 2}"#, "field.constant", ""),
        (
            r#"{"constant": "1"}"#,
            "field.constant",
            "invalid type: string",
        ),
        (
            r#"{"noise": {"octaves": 2}}"#,
            "field.noise",
            "missing field `wavelength`",
        ),
        (
            r#"{"multiply": [{"constant": 1}, {"noise": {"wavelength": 9, "octaves": 99}}]}"#,
            "field.multiply[1].noise.octaves",
            "",
        ),
        (
            r#"{"multiply": [{"constant": 1}, {"noise": {"wavelength": 9, "octaves": "x"}}]}"#,
            "field.multiply[1].noise.octaves",
            "invalid type: string",
        ),
        (r#"{"multiply": []}"#, "field.multiply", ""),
        (
            r#"{"invert": {"name": "x"}}"#,
            "field.invert",
            "no such field is loaded",
        ),
        (
            r#"{"curve": {"of": {"constant": 1}, "points": [[0, 0]]}}"#,
            "field.curve.points",
            "",
        ),
        (
            r#"{"ramp": {"from": [0, 0], "to": [0, 0]}}"#,
            "field.ramp.to",
            "",
        ),
        (
            r#"{"ramp": {"from": [0, 0], "too": [0, 0]}}"#,
            "field.ramp.too",
            "unknown field",
        ),
        (
            r#"{"distance": {"distances": [0, 1]}}"#,
            "field.distance.points",
            "missing",
        ),
        (
            r#"{"distance": {"points": [], "distances": [0, 1]}}"#,
            "field.distance.points",
            "",
        ),
        (
            r#"{"raster": {"file": "/etc/passwd"}}"#,
            "field.raster.file",
            "queries name no files",
        ),
        (r#"{"raster": {}}"#, "field.raster.png", "missing"),
        (
            r#"{"raster": {"png": "***"}}"#,
            "field.raster.png",
            "not base64",
        ),
        (
            r#"{"raster": {"png": "AAAA"}}"#,
            "field.raster.png",
            "it is of no known format",
        ),
        (
            r#"{"raster": {"f32": "AAAA", "width": 1}}"#,
            "field.raster.height",
            "missing",
        ),
        (
            r#"{"raster": {"f32": "AAAA", "width": 1, "height": 1}}"#,
            "field.raster.f32",
            "the array is damaged or truncated: 1 × 1 pixels take 4 bytes, there are 3",
        ),
        (
            r#"{"raster": {"f32": "AACAfw==", "width": 1, "height": 1}}"#,
            "field.raster.f32",
            "the pixel in column 0, row 0 is inf",
        ),
        (
            r#"{"raster": {"f32": "AAAAQA==", "width": 1, "height": 1}}"#,
            "field.raster",
            "its numbers reach from 2 to 2",
        ),
        (
            r#"{"raster": {"f32": "AAAAQA==", "width": 11, "height": 10}}"#,
            "field.raster.f32",
            "it has 11 × 10 pixels",
        ),
        (
            r#"{"raster": {"f32": "AAAAAA==", "width": 1, "height": 1, "bbox": [0, 0, 0, 1]}}"#,
            "field.raster.bbox",
            "not a box",
        ),
        (
            r#"{"raster": {"f32": "AAAAAA==", "width": 1, "height": 1, "gamma": 0}}"#,
            "field.raster.gamma",
            "",
        ),
        (
            r#"{"slope": {"terrain": {"f32": "AAAAAA==", "width": 1, "height": 1, "gamma": 2},
                "slopes": [0, 1]}}"#,
            "field.slope.terrain.gamma",
            "has no effect on a terrain",
        ),
    ] {
        let (found, told) = fault(json);
        assert_eq!(found, path, "{json}: {told}");
        assert!(told.starts_with(detail), "{json}: {told}");
    }
}

#[test]
fn white_and_black_say_what_counts() {
    let json =
        r#"{"raster": {"f32": "AAAAQA==", "width": 1, "height": 1, "black": 1, "white": 5}}"#;
    assert_eq!(share(json, [0.5, 0.5]), 0.25);
}

#[test]
fn pixels_that_are_missing_are_empty_in_all_that_is_made_of_them() {
    // NaN and 1.
    let pixels = r#""f32": "AADAfwAAgD8=", "width": 2, "height": 1"#;
    let raster = |more: &str| format!(r#"{{"raster": {{{pixels}{more}}}}}"#);
    let low = raster(r#", "low": 1, "high": 0.5"#);
    let black = raster(r#", "black": -9, "white": 11"#);
    let inverted = format!(
        r#"{{"invert": {}}}"#,
        raster(r#", "black": 0.5, "white": 2.5"#)
    );
    let height = format!(
        r#"{{"height": {{"terrain": {{{pixels}}}, "heights": [0, 9], "shares": [1, 0]}}}}"#
    );
    let slope = format!(r#"{{"slope": {{"terrain": {{{pixels}}}, "slopes": [0, 1]}}}}"#);
    for (json, expected) in [
        (raster(""), 1.0),
        (low, 0.5),
        (black, 0.5),
        (inverted, 0.75),
        (height, 1.0 - 1.0 / 9.0),
        (slope, 1.0),
    ] {
        assert_eq!(share(&json, [0.99, 0.5]), 0.0, "{json}");
        assert!((share(&json, [1.0, 0.5]) - expected).abs() < 1e-7, "{json}");
    }
}

#[test]
fn long_and_deep_documents_are_refused_unbuilt() {
    let long = format!(
        r#"{{"multiply": [{}{{"constant": 1}}]}}"#,
        r#"{"constant": 1},"#.repeat(999)
    );
    assert_eq!(fault(&long).0, "field.multiply");
    let deep = format!(
        "{}{}{}",
        r#"{"invert": "#.repeat(20),
        r#"{"constant": 1}"#,
        "}".repeat(20)
    );
    assert!(made(&deep).is_err());
    let deeper = format!("{}1{}", r#"{"invert": "#.repeat(9999), "}".repeat(9999));
    assert!(made(&deeper).is_err());
}

#[test]
fn all_layers_of_a_query_share_the_pixels_it_may_bring() {
    let document = read_json("field", UPPER).expect("a field");
    let sources = sources(7);
    assert!(build("field", &document, &sources).is_ok());
    let faults = build("field", &document, &sources).expect_err("too many");
    assert!(
        faults.as_slice()[0].allowed.contains("3 in all"),
        "{faults:?}"
    );
}

/// A gray PNG of 64 × 64 pixels, and a field of it.
fn png_field() -> (Vec<u8>, String) {
    let mut file = vec![];
    let mut writer = png::Encoder::new(&mut file, 64, 64)
        .write_header()
        .expect("a header");
    writer.write_image_data(&[7; 4096]).expect("written");
    writer.finish().expect("written");
    let text = base64::Engine::encode(&base64::prelude::BASE64_STANDARD, &file);
    (file, format!(r#"{{"raster": {{"png": "{text}"}}}}"#))
}

#[test]
fn memory_is_taken_before_pixels_are_decoded() {
    let (file, field) = png_field();
    let document = read_json("field", &field).expect("a field");
    let price = Price::of_png(&file);
    assert_eq!((document.price(), price.pixels), (price, 4096));
    assert!(price.bytes >= 4096);
    let held = Cell::new(0);
    let hold = |bytes: usize| {
        held.set(held.get() + bytes);
        match held.get() > price.bytes {
            true => Err(Error::TooManyBytes { limit: 1 }),
            false => Ok(()),
        }
    };
    let sources = Sources {
        allowance: Allowance {
            hold: &hold,
            ..Allowance::UNLIMITED
        },
        ..sources(10_000)
    };
    assert!(build("field", &document, &sources).is_ok());
    assert!(build("field", &document, &sources).is_err());
    let refused = sources.refused.take();
    assert_eq!(refused, Some(Error::TooManyBytes { limit: 1 }));
    // A refused raster is decoded no further than its header.
    assert_eq!(sources.bytes.get(), 4096);
}

#[test]
fn a_field_that_is_not_wanted_any_more_is_not_made() {
    let stop = strew_core::server::Stop::new();
    let sources = Sources {
        allowance: Allowance {
            stop: &stop,
            ..Allowance::UNLIMITED
        },
        ..sources(10_000)
    };
    for field in [png_field().1, UPPER.into(), r#"{"constant": 1}"#.into()] {
        let document = read_json("field", &field).expect("a field");
        assert!(build("field", &document, &sources).is_ok());
    }
    stop.raise();
    let document = read_json("field", UPPER).expect("a field");
    let faults = build("field", &document, &sources).expect_err("stopped");
    assert_eq!(faults.as_slice()[0].detail, "not wanted any more");
}

#[test]
fn faults_of_pixels_say_what_they_are_in_instead_of_showing_them() {
    let faults = made(r#"{"raster": {"png": "AADgQAAA4EAAAOBA"}}"#).expect_err("no PNG");
    let fault = &faults.as_slice()[0];
    assert_eq!(fault.value.as_deref(), Some("a png of 12 bytes"));
    assert_eq!(
        (&*fault.detail, &*fault.allowed),
        ("it is of no known format", "a PNG")
    );
    let beyond = r#"{"raster": {"f32": "AADgQAAA4EAAAOBA", "width": 3, "height": 1}}"#;
    let faults = made(beyond).expect_err("no shares");
    assert_eq!(
        faults.as_slice()[0].value.as_deref(),
        Some("an f32 of 12 bytes")
    );
}
