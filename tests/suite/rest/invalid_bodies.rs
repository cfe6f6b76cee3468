//! Invalid query bodies: the problem names the member at fault, its value, and what is allowed.

use serde_json::{Value, json};
use strew_testkit::http1;

use crate::support::{daemon::Daemon, problem::assert_fault};

/// (members that replace those of a valid query, the field at fault, texts in its fault).
fn members() -> Vec<(Value, &'static str, Vec<&'static str>)> {
    let region = |shape: Value| json!({ "region": shape });
    let layers = |layers: Value| json!({ "layers": layers, "spacing": null });
    let polygon = |rings: Value| json!({ "region": { "polygon": { "type": "Polygon", "coordinates": rings } } });
    let mut nested = json!({ "bbox": [0, 0, 1, 1] });
    for _ in 0..9 {
        nested = json!({ "include": [nested] });
    }
    let path = "region.include[0].include[0].include[0].include[0].include[0].include[0].\
                include[0].include[0].include";
    let many: Vec<Value> = (0..17)
        .map(|i| json!({ "name": format!("l{i}"), "spacing": 1, "keep": 1.0 / f64::from(i + 1) }))
        .collect();
    let features = |features: Value| json!({ "region": null, "spacing": 1, "features": features });
    let empty = json!({ "type": "FeatureCollection", "features": [] });
    vec![
        (features(json!([])), "features", vec!["an object"]),
        (
            features(json!({})),
            "features.of",
            vec!["missing", "FeatureCollection"],
        ),
        (
            features(json!({ "of": empty })),
            "features.of",
            vec!["no feature"],
        ),
        (
            features(json!({ "of": empty, "per": 1 })),
            "features.per",
            vec!["unknown member"],
        ),
        (json!({ "region": null }), "region", vec!["missing"]),
        (
            json!({ "regoin": {} }),
            "regoin",
            vec!["unknown member", "did you mean `region`?"],
        ),
        (region(json!([0, 0, 1, 1])), "region", vec!["[0,0,1,1]"]),
        (region(json!({})), "region", vec!["{}"]),
        (
            region(json!({ "bbox": [0, 0, 1] })),
            "region.bbox",
            vec!["[0,0,1]"],
        ),
        (
            region(json!({ "bbox": [0, 0, 1, "1"] })),
            "region.bbox",
            vec![],
        ),
        (
            region(json!({ "bbox": [0, 0, 0, 1] })),
            "region.bbox",
            vec!["empty"],
        ),
        (
            region(json!({ "bbox": [0, 0, 1e300, 1] })),
            "region.bbox",
            vec!["far"],
        ),
        (
            region(json!({ "circle": { "center": [0, 0] } })),
            "region.circle",
            vec!["radius"],
        ),
        (
            region(json!({ "circle": { "center": [0, 0], "radius": 0 } })),
            "region.circle",
            vec!["0"],
        ),
        (
            region(json!({ "chunk": { "size": 0, "x": 1, "y": 1 } })),
            "region.chunk",
            vec!["above 0"],
        ),
        (
            region(json!({ "chunk": { "size": 1, "x": 0.5, "y": 1 } })),
            "region.chunk",
            vec!["0.5"],
        ),
        (
            region(json!({ "polygon": { "type": "Point", "coordinates": [1, 1] } })),
            "region.polygon",
            vec!["Point"],
        ),
        (polygon(json!([])), "region.polygon", vec![]),
        (
            polygon(json!([[[0, 0], [1, 1]]])),
            "region.polygon",
            vec!["coordinates[0] has 2 positions", "3 or more"],
        ),
        (
            polygon(json!([[[0, 0], [1, 1], [2, null]]])),
            "region.polygon",
            vec![],
        ),
        (
            region(json!({ "include": [] })),
            "region.include",
            vec!["missing"],
        ),
        (
            region(json!({ "include": [{ "bbox": [0, 0, 1, 1] }, 7] })),
            "region.include[1]",
            vec!["7"],
        ),
        (
            region(
                json!({ "include": [{ "bbox": [0, 0, 1, 1] }], "exclude": [{ "bbox": [1, 1, 0, 0] }] }),
            ),
            "region.exclude[0].bbox",
            vec!["reversed"],
        ),
        (region(nested), path, vec!["nested", "8"]),
        (json!({ "spacing": "wide" }), "spacing", vec!["wide"]),
        (json!({ "spacing": null }), "spacing", vec!["missing"]),
        (json!({ "count": 5 }), "count", vec!["spacing is given"]),
        (
            json!({ "spacing": null, "count": 5.5 }),
            "count",
            vec!["5.5"],
        ),
        (json!({ "seed": -1 }), "seed", vec!["-1"]),
        (json!({ "warp": "much" }), "warp", vec!["much"]),
        (json!({ "warp": 2.5 }), "warp", vec!["2.5"]),
        (json!({ "keep": 2 }), "keep", vec!["2"]),
        (json!({ "attributes": [1] }), "attributes", vec!["[1]"]),
        (
            json!({ "attributes": ["variant"] }),
            "variants",
            vec!["missing"],
        ),
        (
            json!({ "attributes": ["variant"], "variants": { "a": "x" } }),
            "variants",
            vec!["x"],
        ),
        (
            json!({ "attributes": ["scale"], "scale_range": [1] }),
            "scale_range",
            vec!["[1]"],
        ),
        (json!({ "offset": -1 }), "offset", vec!["-1"]),
        (json!({ "limit": 0 }), "limit", vec!["0"]),
        (json!({ "cursor": 5 }), "cursor", vec!["5"]),
        (json!({ "format": "xml" }), "format", vec!["xml", "ndjson"]),
        (json!({ "decimals": 18 }), "decimals", vec!["18"]),
        (
            json!({ "size": 5, "format": "png" }),
            "size",
            vec!["5", "4096"],
        ),
        (json!({ "table": "abc" }), "table", vec!["abc"]),
        (json!({ "map": 3 }), "map", vec!["3"]),
        (layers(json!([])), "layers", vec!["empty", "1 to 16"]),
        (layers(json!({})), "layers", vec!["{}"]),
        (layers(json!([5])), "layers[0]", vec!["5"]),
        (layers(json!(many)), "layers", vec!["17", "16"]),
        (
            json!({ "layers": [{ "name": "a", "spacing": 1 }] }),
            "spacing",
            vec!["layer"],
        ),
        (layers(json!([{ "spacing": 1 }])), "layers[0].name", vec![]),
        (
            layers(json!([{ "name": "a\u{7}b", "spacing": 1 }])),
            "layers[0].name",
            vec!["1 to 64 characters"],
        ),
        (
            layers(json!([{ "name": "a", "spacing": 1 }, { "name": "a", "spacing": 1 }])),
            "layers[1].name",
            vec!["a"],
        ),
        (
            layers(json!([{ "name": "a" }])),
            "layers[0].spacing",
            vec!["missing"],
        ),
        (
            layers(json!([{ "name": "a", "spacing": 1, "wide": 1 }])),
            "layers[0].wide",
            vec!["unknown member"],
        ),
        (
            layers(json!([{ "name": "a", "spacing": 1, "region": { "bbox": [1, 1, 0, 0] } }])),
            "layers[0].region.bbox",
            vec!["reversed"],
        ),
        (
            layers(
                json!([{ "name": "a", "spacing": 1, "clear_of": { "b": 1 } },
                       { "name": "b", "spacing": 1 }]),
            ),
            "layers[0].clear_of",
            vec!["b: 1.0"],
        ),
        (
            layers(json!([{ "name": "a", "spacing": 1 },
                       { "name": "b", "spacing": 1, "clear_of": { "a": 0 } }])),
            "layers[1].clear_of",
            vec!["a: 0.0"],
        ),
        (
            layers(json!([{ "name": "a", "spacing": 1 },
                       { "name": "b", "spacing": 1, "clear_of": { "a": 17 } }])),
            "layers[1].clear_of",
            vec!["17", "at most 16"],
        ),
        (
            layers(json!([{ "name": "a", "spacing": 1 },
                       { "name": "b", "count": 5, "clear_of": { "a": 1 } }])),
            "layers[1].count",
            vec!["not with clear_of"],
        ),
        (
            layers(json!([{ "name": "a", "min_distance": 1, "profile": "pink" }])),
            "layers[0].min_distance",
            vec!["pink"],
        ),
    ]
}

#[test]
fn faults_name_the_wrong_member() {
    let daemon = Daemon::start(&[]);
    for (members, field, texts) in members() {
        let mut body = json!({ "region": { "bbox": [0, 0, 9, 9] }, "spacing": 1 });
        for (name, value) in members.as_object().expect("an object") {
            match value {
                // Stands for a member that is not there.
                Value::Null => drop(body.as_object_mut().expect("an object").remove(name)),
                value => body[name] = value.clone(),
            }
        }
        // Every path reads a query alike; counts have no window and no output.
        let paths = ["points:query", "points:split?parts=2", "count"];
        let is_of_points =
            ["offset", "limit", "cursor", "format", "decimals", "size"].contains(&field);
        for path in &paths[..if is_of_points { 2 } else { 3 }] {
            let answer = daemon.post(&format!("/v1/{path}"), &body);
            assert_fault(&answer, &format!("{path} {body}"), field, &texts);
        }
    }
    let body = json!({ "region": { "bbox": [0, 0, 9, 9] }, "spacing": 1 });
    for (path, field) in [
        ("points:split", "parts"),
        ("points:split?parts=0", "parts"),
        ("points:split?parts=10001", "parts"),
        ("points:split?parts=2&seed=3", "seed"),
        ("points:query?seed=3", "query"),
        ("count?seed=3", "query"),
    ] {
        assert_fault(
            &daemon.post(&format!("/v1/{path}"), &body),
            path,
            field,
            &[],
        );
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
            assert_fault(
                &answer,
                &format!("{path} {body:?}"),
                "body",
                &["a JSON object"],
            );
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
