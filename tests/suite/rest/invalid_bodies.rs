//! What bodies are refused for: the problem names the member at fault, its value, and what is allowed.

use serde_json::{Value, json};
use strew_testkit::http1;
use tempfile::TempDir;

use crate::support::{
    daemon::Daemon,
    fields::{base64, folder, png},
    problem::assert_faults,
    table::rows,
};

/// A daemon with fields and lists of points taken away.
pub(super) fn daemon() -> (TempDir, Daemon) {
    let fields = folder();
    let config = format!(
        "fields.folder = '{}'\n[except.felled]\nids = ['oak/1:2']\n[except.dug]\nids = ['3:4']\n",
        fields.path().display()
    );
    (fields, Daemon::with_config(&config))
}

/// Bodies, the field at fault, and words of its problem. Members replace those of a query that lacks nothing; `null`
/// and layers, which have amounts of their own, take one away.
const BODIES: &str = r#"
# Features
{"region": null, "features": []} | features | an object
{"region": null, "features": {}} | features.of | missing | FeatureCollection
{"region": null, "features": {"of": {"type": "FeatureCollection", "features": []}}} | features.of | no feature
{"region": null, "features": {"of": {"type": "FeatureCollection", "features": []}, "per": 1}} | features.per | unknown member
# Regions
{"region": null} | region | missing
{"regoin": {}} | regoin | unknown member | did you mean `region`?
{"region": [0, 0, 1, 1]} | region | [0,0,1,1]
{"region": {}} | region | {}
{"region": {"bbox": [0, 0, 1]}} | region.bbox | [0,0,1]
{"region": {"bbox": [0, 0, 1, "1"]}} | region.bbox
{"region": {"bbox": [0, 0, 0, 1]}} | region.bbox | empty
{"region": {"bbox": [0, 0, 1e300, 1]}} | region.bbox | far
{"region": {"circle": {"center": [0, 0]}}} | region.circle | radius
{"region": {"circle": {"center": [0, 0], "radius": 0}}} | region.circle | 0
{"region": {"chunk": {"size": 0, "x": 1, "y": 1}}} | region.chunk | above 0
{"region": {"chunk": {"size": 1, "x": 0.5, "y": 1}}} | region.chunk | 0.5
{"region": {"polygon": {"type": "Point", "coordinates": [1, 1]}}} | region.polygon | Point
{"region": {"polygon": {"type": "Polygon", "coordinates": []}}} | region.polygon
{"region": {"polygon": {"type": "Polygon", "coordinates": [[[0, 0], [1, 1]]]}}} | region.polygon | coordinates[0] has 2 positions | 3 or more
{"region": {"polygon": {"type": "Polygon", "coordinates": [[[0, 0], [1, 1], [2, null]]]}}} | region.polygon
{"region": {"include": []}} | region.include | missing
{"region": {"include": [{"bbox": [0, 0, 1, 1]}, 7]}} | region.include[1] | 7
{"region": {"include": [{"bbox": [0, 0, 1, 1]}], "exclude": [{"bbox": [1, 1, 0, 0]}]}} | region.exclude[0].bbox | reversed
{"region": {"ball": {"center": [0, 0, 0], "radius": 1}}} | region.ball | a shape of space
# Sets
{"spacing": "wide"} | spacing | wide
{"spacing": null} | spacing | missing
{"count": 5} | count | spacing is given
{"spacing": null, "count": 5.5} | count | 5.5
{"seed": -1} | seed | -1
{"warp": "much"} | warp | much
{"warp": 2.5} | warp | 2.5
{"keep": 2} | keep | 2
{"attributes": [1]} | attributes, variants | [1]
{"attributes": ["variant"]} | variants | missing
{"attributes": ["variant"], "variants": {"a": "x"}} | variants | x
{"attributes": ["scale"], "scale_range": [1]} | scale_range | [1]
{"offset": -1} | offset | -1
{"limit": 0} | limit | 0
{"cursor": 5} | cursor | 5
{"format": "xml"} | format | xml | ndjson
{"decimals": 18} | decimals | 18
{"size": 5, "format": "png"} | size | 5 | 4096
{"table": "abc"} | table | abc
{"map": 3} | map | 3
{"variants": {"a": 1, "b": 1}, "spread": "even", "variant_fields": {"a": {"noise": {"period": -1}}}} | variant_fields.a.noise.period
# Layers
{"layers": []} | layers | empty | 1 to 16
{"layers": {}} | layers | {}
{"layers": [5]} | layers[0] | 5
{"layers": [{"name": "a", "spacing": 1}], "spacing": 1} | spacing | layer
{"layers": [{"spacing": 1}]} | layers[0].name
{"layers": [{"name": "a\u0007b", "spacing": 1}]} | layers[0].name | 1 to 64 characters
{"layers": [{"name": "a", "spacing": 1}, {"name": "a", "spacing": 1}]} | layers[1].name | a
{"layers": [{"name": "a"}]} | layers[0].spacing | missing
{"layers": [{"name": "a", "spacing": 1, "wide": 1}]} | layers[0].wide | unknown member
{"layers": [{"name": "a", "spacing": 1, "region": {"bbox": [1, 1, 0, 0]}}]} | layers[0].region.bbox | reversed
{"layers": [{"name": "a", "spacing": 1, "clear_of": {"b": 1}}, {"name": "b", "spacing": 1}]} | layers[0].clear_of | b: 1.0
{"layers": [{"name": "a", "spacing": 1}, {"name": "b", "spacing": 1, "clear_of": {"a": 0}}]} | layers[1].clear_of | a: 0.0
{"layers": [{"name": "a", "spacing": 1}, {"name": "b", "spacing": 1, "clear_of": {"a": 17}}]} | layers[1].clear_of | 17 | at most 16
{"layers": [{"name": "a", "spacing": 1}, {"name": "b", "count": 5, "clear_of": {"a": 1}}]} | layers[1].count | not with clear_of
{"layers": [{"name": "a", "min_distance": 1, "profile": "pink"}]} | layers[0].min_distance | pink
{"layers": [{"name": "a", "spacing": 2, "periodic": 5000}]} | layers[0].periodic
# Fields and terrains
{"spacing": null, "min_distance": 1, "field": {"ramp": {"from": [0, 0], "to": [9, 0], "shares": [1, 0]}}} | min_distance | points settle | settle=0
{"field": {"noise": {"wavelength": 9, "octaves": 99}}} | field.noise.octaves | 1 to 8
{"field": {"multiply": [{"name": "ramp"}, {"ring": 1}]}} | field.multiply[1] | ring
{"field": {"raster": {"file": "left.png"}}} | field.raster.file | name no files
{"field": 7} | field | must be a name or an object
{"layers": [{"name": "a", "spacing": 1}, {"name": "b", "spacing": 1, "field": 7}]} | layers[1].field | must be a name
{"layers": [{"name": "a", "spacing": 1, "field": {"noise": {"octaves": 0}}}]} | layers[0].field.noise
{"layers": [{"name": "b", "spacing": 1, "terrain": {"noise": {"wavelength": -1}}}]} | layers[0].terrain.noise.wavelength | -1
# Points taken away
{"layers": [{"name": "oak", "spacing": 1}], "except": ["1:2"]} | except[0] | beside layers an id needs
{"layers": [{"name": "oak", "spacing": 1}], "except": ["felled", "ash/1:2"]} | except[1] | unknown layer
{"layers": [{"name": "oak", "spacing": 1}], "except": ["dug"]} | except[0] | the list has ids without a layer
{"layers": [{"name": "elm", "spacing": 2}], "except": ["elm/1:0"]} | except[0] | the layer elm has no such point
"#;

/// The same for volumes.
const VOLUMES: &str = r#"
{"region": {"circle": {"center": [0, 0], "radius": 1}}} | region.circle | a shape of the plane
{"region": {"bbox": [0, 0, 1, 1]}} | region.bbox | max_z
{"region": {"ball": {"center": [0, 0], "radius": 1}}} | region.ball | center
{"region": {"prism": {"polygon": {"type": "Polygon", "coordinates": [[[0, 0], [1, 0], [0, 1]]]}, "bottom": 0}}} | region.prism.top | missing
{"region": {"prism": {"polygon": {"type": "Polygon", "coordinates": [[[0, 0], [1, 0], [0, 1]]]}, "bottom": 1, "top": 1}}} | region.prism | empty
{"region": {"prism": {"polygon": {"type": "Polygon", "coordinates": [[[0, 0], [1, 0], [0, 1]]]}, "bottom": 2, "top": 1}}} | region.prism | top
{"region": {"include": [{"ball": {"center": [0, 0, 0], "radius": 1}}, {"circle": {"center": [0, 0], "radius": 1}}]}} | region.include[1].circle | a shape of the plane
{"region": {"include": []}} | region.include | missing
{"region": {"bbox": [0, 0, 0, 9, 9, 9]}, "spacing": null, "min_distance": 1, "field": {"ramp": {"from": [0, 0], "to": [9, 0], "shares": [1, 0]}}} | min_distance | points settle | settle=0
"#;

/// A body with members of a case.
fn body(region: &Value, members: &Value) -> Value {
    let mut body = json!({ "region": region, "spacing": 1 });
    if members.get("layers").is_some() {
        body["spacing"].take();
    }
    for (name, value) in members.as_object().expect("an object") {
        body[name] = value.clone();
    }
    body.as_object_mut()
        .expect("an object")
        .retain(|_, value| !value.is_null());
    body
}

/// Cases that are too large to be written down.
fn large() -> Vec<(Value, String, Vec<&'static str>)> {
    let mut nested = json!({ "bbox": [0, 0, 1, 1] });
    for _ in 0..9 {
        nested = json!({ "include": [nested] });
    }
    let deep = format!("region{}.include", ".include[0]".repeat(8));
    let layer =
        |i: u32| json!({ "name": format!("l{i}"), "spacing": 1, "keep": 1.0 / f64::from(i + 1) });
    let layers: Vec<Value> = (0..17).map(layer).collect();
    let kinds: Vec<String> = (0..50).map(|i| format!("v{i}:1")).collect();
    let ids: Vec<String> = (0..10_001).map(|i| format!("{i}:0")).collect();
    let wide = base64(&png([1500, 1500], |_, _| 0));
    vec![
        (json!({ "region": nested }), deep, vec!["nested", "8"]),
        (
            json!({ "layers": layers }),
            "layers".into(),
            vec!["17", "16"],
        ),
        (
            json!({ "variants": kinds.join(","), "spread": "even" }),
            "variants".into(),
            vec!["2 to 32"],
        ),
        (
            json!({ "except": ids }),
            "except".into(),
            vec!["10001 names, more than 10000"],
        ),
        (
            json!({ "field": { "raster": { "png": wide } } }),
            "field.raster.png".into(),
            vec!["1500 × 1500", "1048576"],
        ),
    ]
}

#[test]
fn problems_of_bodies_name_the_member() {
    let (_fields, daemon) = daemon();
    let read = |row: Vec<&'static str>| {
        let members = serde_json::from_str(row[0]).expect("JSON");
        (members, row[1].to_owned(), row[2..].to_vec())
    };
    let square = json!({ "bbox": [0, 0, 9, 9] });
    for (members, field, texts) in rows(BODIES).map(read).chain(large()) {
        let body = body(&square, &members);
        // Every path reads a query alike; counts have no window and no output.
        let of_points = ["offset", "limit", "cursor", "format", "decimals", "size"];
        let count = (!of_points.contains(&&*field)).then_some("count");
        for path in ["points:query", "points:split?parts=2"]
            .into_iter()
            .chain(count)
        {
            let answer = daemon.post(&format!("/v1/{path}"), &body);
            let asked = format!("{path} {members:.300}");
            assert_faults(&answer, &asked, &field, &texts);
        }
    }
    for (members, field, texts) in rows(VOLUMES).map(read) {
        let body = body(&Value::Null, &members);
        for path in ["points", "count", "points:split?parts=2"] {
            let answer = daemon.post(&format!("/v1/space/{path}"), &body);
            assert_faults(&answer, &format!("{path} {members}"), &field, &texts);
        }
    }
    let body = body(&square, &json!({}));
    for (path, field) in [
        ("points:split", "parts"),
        ("points:split?parts=0", "parts"),
        ("points:split?parts=10001", "parts"),
        ("points:split?parts=2&seed=3", "seed"),
        ("points:query?seed=3", "query"),
        ("count?seed=3", "query"),
    ] {
        let answer = daemon.post(&format!("/v1/{path}"), &body);
        assert_faults(&answer, path, field, &[]);
    }
}

#[test]
fn a_body_that_is_not_a_json_object_is_a_fault_of_the_body() {
    let daemon = Daemon::start(&[]);
    let bodies: [&[u8]; 7] = [
        b"",
        b"{",
        b"[]",
        b"null",
        b"region=1&spacing=1",
        b"{\"spacing\": NaN}",
        b"\xff\xfe",
    ];
    for path in ["points:query", "count", "points:split?parts=2"] {
        for body in bodies {
            let answer = http1::post(daemon.address(), &format!("/v1/{path}"), &[], body);
            let asked = format!("{path} {body:?}");
            assert_faults(&answer, &asked, "body", &["a JSON object"]);
        }
    }
}

#[test]
fn the_content_type_of_a_body_does_not_matter() {
    let daemon = Daemon::start(&[]);
    let body = br#"{ "region": { "bbox": [0, 0, 9, 9] }, "spacing": 1 }"#;
    // `curl -d` labels every body a form.
    for content_type in [
        "application/json",
        "application/x-www-form-urlencoded",
        "text/plain",
        "?",
    ] {
        let headers = [("content-type", content_type)];
        let answer = http1::post(daemon.address(), "/v1/count", &headers, body);
        assert_eq!(answer.json()["count"], 81, "{content_type}");
    }
    let picture =
        json!({ "region": { "bbox": [0, 0, 9, 9] }, "spacing": 1, "format": "svg", "size": 64 });
    assert_eq!(daemon.post("/v1/points:query", &picture).status, 200);
}
