//! Queries as bodies that are wrong, or too much.

use std::{
    io::{Read as _, Write as _},
    net::TcpStream,
};

use serde_json::{Value, json};

use crate::{
    addresses::fault,
    daemon::{Daemon, PATIENCE},
    raw,
};

/// (what is put into a query that is in order, the field at fault, texts that its fault has).
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
        .map(|i| json!({ "name": format!("l{i}"), "spacing": 1 }))
        .collect();
    vec![
        (json!({ "region": null }), "region", vec!["missing"]),
        (
            json!({ "regoin": {} }),
            "regoin",
            vec!["no such member", "region"],
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
            vec!["2 different vertices"],
        ),
        (
            polygon(json!([[[0, 0], [1, 1], [2, null]]])),
            "region.polygon",
            vec![],
        ),
        (
            polygon(json!([[[0, 0], [1, 1], [2, 0]], [[0, 0], [0, 0], [0, 0]]])),
            "region.polygon",
            vec!["ring 1"],
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
        (json!({ "spacing": null }), "density", vec!["missing"]),
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
        (layers(json!([])), "layers", vec!["[]"]),
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
            layers(json!([{ "name": "a b", "spacing": 1 }])),
            "layers[0].name",
            vec!["a b"],
        ),
        (
            layers(json!([{ "name": "a", "spacing": 1 }, { "name": "a", "spacing": 1 }])),
            "layers[1].name",
            vec!["a"],
        ),
        (
            layers(json!([{ "name": "a" }])),
            "layers[0].density",
            vec!["missing"],
        ),
        (
            layers(json!([{ "name": "a", "spacing": 1, "wide": 1 }])),
            "layers[0].wide",
            vec!["no such"],
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
            vec!["17", "1.6e1"],
        ),
        (
            layers(json!([{ "name": "a", "spacing": 1 },
                       { "name": "b", "count": 5, "clear_of": { "a": 1 } }])),
            "layers[1].count",
            vec!["keeps clear"],
        ),
        (
            layers(json!([{ "name": "a", "min_distance": 1, "profile": "pink" }])),
            "layers[0].min_distance",
            vec!["pink"],
        ),
    ]
}

#[test]
fn bodies_are_faulted_member_by_member() {
    let daemon = Daemon::start(&[]);
    for (members, field, texts) in members() {
        let mut body = json!({ "region": { "bbox": [0, 0, 9, 9] }, "spacing": 1 });
        for (name, value) in members.as_object().expect("an object") {
            body[name] = value.clone();
        }
        // Whatever is asked of a query, it is read alike.
        for path in ["points:query", "count", "points:split?parts=2"] {
            let answer = daemon.post(&format!("/v1/{path}"), &body);
            fault(&answer, &format!("{path} {body}"), field, &texts);
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
        fault(
            &daemon.post(&format!("/v1/{path}"), &body),
            path,
            field,
            &[],
        );
    }
}

#[test]
fn what_is_no_json_object_is_a_fault_of_the_body() {
    let daemon = Daemon::start(&[]);
    let bodies: [&[u8]; 8] = [
        b"",
        b"{",
        b"[]",
        b"null",
        b"region=1&spacing=1",
        b"{\"spacing\": NaN}",
        b"{\"spacing\": 1e999}",
        b"\xff\xfe",
    ];
    for path in ["points:query", "count", "points:split?parts=2"] {
        for body in bodies {
            let answer = raw::posted(daemon.address(), &format!("/v1/{path}"), &[], body);
            fault(
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
    let body = br#"{ "region": { "bbox": [0, 0, 9, 9] }, "spacing": 1, "size": null }"#;
    // `curl -d` calls everything a form.
    for content_type in [
        "application/json",
        "application/x-www-form-urlencoded",
        "text/plain",
        "?",
    ] {
        let headers = [("content-type", content_type)];
        let answer = raw::posted(daemon.address(), "/v1/count", &headers, body);
        assert_eq!(answer.json()["count"], 81, "{content_type}");
    }
    let picture =
        json!({ "region": { "bbox": [0, 0, 9, 9] }, "spacing": 1, "format": "svg", "size": 64 });
    assert_eq!(daemon.post("/v1/points:query", &picture).status, 200);
}

#[test]
fn bodies_are_read_up_to_a_limit() {
    let daemon = Daemon::start(&["limits.max_body_bytes=2000"]);
    let body = |bytes: usize| {
        let query = r#"{ "region": { "bbox": [0, 0, 9, 9] }, "spacing": 1 }"#;
        format!("{query:<bytes$}").into_bytes()
    };
    for path in ["/v1/points:query", "/v1/count", "/v1/points:split?parts=2"] {
        assert_eq!(
            raw::posted(daemon.address(), path, &[], &body(2000)).status,
            200
        );
        let refused = raw::posted(daemon.address(), path, &[], &body(2001));
        check_refusal(&refused.json());
        assert_eq!(refused.header("content-type"), "application/problem+json");
    }
    // What says how long it is need not be sent.
    let head = "POST /v1/count HTTP/1.1\r\nhost: x\r\nconnection: close\r\n";
    let mut stream = TcpStream::connect(daemon.address()).expect("connected");
    stream.set_read_timeout(Some(PATIENCE)).expect("a socket");
    write!(stream, "{head}content-length: 100000000000\r\n\r\n").expect("sent");
    let mut text = String::new();
    stream.read_to_string(&mut text).expect("UTF-8");
    assert!(text.starts_with("HTTP/1.1 413"), "{text}");
    // What does not say it is read as far as the limit.
    let mut stream = TcpStream::connect(daemon.address()).expect("connected");
    stream.set_read_timeout(Some(PATIENCE)).expect("a socket");
    let piece = String::from_utf8(body(1500)).expect("UTF-8");
    write!(stream, "{head}transfer-encoding: chunked\r\n\r\n").expect("sent");
    write!(stream, "5dc\r\n{piece}\r\n5dc\r\n{piece}\r\n").expect("sent");
    let mut text = String::new();
    let _ = stream.read_to_string(&mut text);
    assert!(text.starts_with("HTTP/1.1 413"), "{text}");
    let problem = text.split("\r\n\r\n").nth(1).expect("a body");
    check_refusal(&serde_json::from_str(problem).expect("JSON"));
}

fn check_refusal(problem: &Value) {
    assert_eq!(problem["type"], "urn:strew:problem:body-too-large");
    assert_eq!(problem["status"], 413);
    assert_eq!(problem["limit"], 2000);
}

#[test]
fn what_would_take_too_long_to_count_is_refused_at_once() {
    let daemon = Daemon::start(&["limits.max_rows=1000", "limits.max_points=1000000"]);
    let ring = |ring: Value| json!({ "polygon": { "type": "Polygon", "coordinates": [ring] } });
    let stripes: Vec<Value> = (0..200)
        .map(|i| json!({ "bbox": [0, i, 40, i as f64 + 0.5] }))
        .collect();
    for region in [
        json!({ "circle": { "center": [0, 0], "radius": 100 } }),
        ring(json!([[0, 0], [2000, 0], [2000, 1], [0, 1]])),
        ring(json!([[0, 0], [1, 0], [1, 2000], [0, 2000]])),
        json!({ "include": stripes }),
    ] {
        let body = json!({ "region": region, "spacing": 1 });
        let answer = daemon.post("/v1/count", &body);
        assert_eq!(answer.status, 413, "{body}: {}", answer.text());
        assert_eq!(answer.json()["type"], "urn:strew:problem:too-many-rows");
        assert_eq!(answer.json()["limit"], 1000);
        let narrow = json!({ "region": region, "spacing": 40 });
        assert_eq!(daemon.post("/v1/count", &narrow).status, 200, "{narrow}");
    }
    // Points that keep clear of others are looked at one by one.
    let layers = json!({ "region": { "bbox": [0, 0, 90, 90] }, "layers": [
        { "name": "a", "spacing": 1 },
        { "name": "b", "spacing": 1, "seed": 3, "warp": "off", "clear_of": { "a": 0.5 } },
    ] });
    let answer = daemon.post("/v1/count", &layers);
    assert_eq!(answer.json()["type"], "urn:strew:problem:too-many-rows");
    // Nothing is in it at any spacing, so the search for one has to end somewhere.
    let line = json!({ "region": ring(json!([[0, 0], [9, 9], [18, 18]])), "count": 10 });
    fault(
        &daemon.post("/v1/count", &line),
        "a line",
        "count",
        &["10 points"],
    );
}
