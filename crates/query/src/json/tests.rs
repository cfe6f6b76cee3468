//! Bodies read, written and refused.

use serde_json::{Value as Json, json};

use strew_error::Faults;

use super::*;
use crate::Value;

fn read(body: &Json) -> Checked<Draft> {
    read_body(body.to_string().as_bytes(), groups::QUERY)
}

/// All faults of a body, as `field: detail`.
fn faults(body: &str) -> Vec<String> {
    faults_of(body, groups::QUERY)
}

fn faults_of(body: &str, groups: &'static [Group]) -> Vec<String> {
    let draft = read_body(body.as_bytes(), groups);
    let read = draft.and_then(|draft| {
        let mut found = draft.values.read();
        let mut add = |faults: &Faults| {
            found = match std::mem::replace(&mut found, Ok(())) {
                Ok(()) => Err(faults.clone()),
                Err(others) => Err(others.and(faults.clone())),
            };
        };
        let _ = draft.region.as_ref().map_err(&mut add);
        let _ = draft.layers.as_ref().map_err(&mut add);
        for layer in draft.layers.iter().flatten() {
            let _ = layer.values.read().map_err(|faults| add(&faults));
            let _ = layer.name.as_ref().map_err(&mut add);
            let _ = layer.region.as_ref().map_err(&mut add);
            let _ = layer.clear_of.as_ref().map_err(&mut add);
        }
        found
    });
    let faults = read.err().map(|faults| faults.as_slice().to_vec());
    let told = |fault: &Fault| format!("{}: {}", fault.field, fault.detail);
    faults.unwrap_or_default().iter().map(told).collect()
}

#[test]
fn what_is_written_reads_back_the_same() {
    for body in [
        json!({ "region": { "bbox": [0.1, -2.3, 4.0, 5e9] }, "density": 0.1 }),
        json!({
            "region": { "include": [
                { "circle": { "center": [0.3, 1.1], "radius": 2.7 } },
                { "polygon": { "type": "Polygon", "coordinates": [
                    [[0, 0], [9, 0], [0, 9], [0, 0]], [[1, 1], [2, 1], [1, 2], [1, 1]],
                ]}},
            ], "exclude": [{ "chunk": { "size": 0.7, "x": -3, "y": 4 } }] },
            "count": 5, "seed": u64::MAX, "warp": "on", "keep": 0.3, "profile": "spaced",
            "alpha": "sqrt(3)", "map": "s", "attributes": ["scale", "variant"],
            "scale_range": [0.8, 1.2], "variants": "oak:3,birch:0.1", "offset": 3,
            "limit": 4, "cursor": "01", "format": "csv", "decimals": 2, "size": 64,
        }),
        json!({ "region": { "bbox": [0, 0, 4, 4] }, "layers": [
            { "name": "trees", "min_distance": 2.1, "table": "00" },
            { "name": "rocks", "spacing": 0.7, "region": { "bbox": [0, 0, 2, 2] },
              "clear_of": { "trees": 0.9 } },
        ]}),
    ] {
        let draft = read(&body).expect("an object");
        assert_eq!(draft.values.read(), Ok(()), "{body}");
        let written = Json::Object(draft.to_body());
        let again = read(&written).expect("an object");
        let values = |draft: &Draft| -> Vec<(&str, Value)> {
            let mut values: Vec<_> = (draft.values.given())
                .map(|(parameter, value)| (parameter.name, value.clone()))
                .collect();
            values.sort_by_key(|(name, _)| *name);
            values
        };
        assert_eq!(values(&again), values(&draft), "{written}");
        assert_eq!(again.region, draft.region, "{written}");
        assert_eq!(again.layers.is_ok(), draft.layers.is_ok(), "{written}");
        assert_eq!(Json::Object(again.to_body()), written);
    }
}

#[test]
fn every_parameter_of_a_query_is_a_member() {
    for parameter in crate::of(groups::QUERY) {
        let value = parameter.shape.read(parameter.example).expect("valid");
        let body = json!({ parameter.name: value });
        let draft = read(&body).expect("an object");
        let given: Vec<_> = draft.values.given().collect();
        assert_eq!(given, [(parameter, &value)], "{}", parameter.name);
    }
}

#[test]
fn faults_name_the_member_by_its_path() {
    for (body, expected) in [
        ("[]", "body: must be an object"),
        (r#"{"seed": "x"}"#, "seed: must be an integer"),
        (
            r#"{"seed": 1, "seed": 2}"#,
            "body: the member `seed` appears twice",
        ),
        (r#"{"sed": 1}"#, "sed: unknown member; did you mean `seed`?"),
        (
            r#"{"bbox": [0, 0, 1, 1]}"#,
            r#"bbox: belongs in `region`: {"region": {"bbox": …}}"#,
        ),
        (
            r#"{"warp": true}"#,
            r#"warp: must be "off", "on" or a number"#,
        ),
        (
            r#"{"attributes": "u1", "scale_range": [1]}"#,
            "scale_range: expected 2 numbers, got 1",
        ),
        (
            r#"{"variants": {"oak": 1, "oak": 2}}"#,
            "variants: the member `oak` appears twice",
        ),
        (r#"{"region": 3}"#, "region: must be an object"),
        (r#"{"region": {}}"#, "region: has no shape"),
        (
            r#"{"region": {"bbox": [0, 0, 1]}}"#,
            "region.bbox: invalid length 3, expected an array of length 4",
        ),
        (
            r#"{"region": {"bbox": [0, 0, 1, 1], "chunk": {}}}"#,
            "region: has several shapes: bbox, chunk",
        ),
        (
            r#"{"region": {"circel": {}}}"#,
            "region.circel: unknown member; did you mean `circle`?",
        ),
        (
            r#"{"region": {"circle": {"center": [0, 0], "r": 1}}}"#,
            "region.circle: r: unknown field `r`, expected `center` or `radius`",
        ),
        (
            r#"{"region": {"circle": {"center": [0, 0], "radius": 1, "radius": 2}}}"#,
            "region.circle: duplicate field `radius`",
        ),
        (
            r#"{"region": {"chunk": {"size": 1, "x": 0.5, "y": 0}}}"#,
            "region.chunk: x: invalid type: floating point `0.5`, expected an integer",
        ),
        (r#"{"layers": 3}"#, "layers: must be an array"),
        (r#"{"layers": []}"#, "layers: empty"),
        (r#"{"layers": [3]}"#, "layers[0]: must be an object"),
        (
            r#"{"layers": [{"name": 3}]}"#,
            "layers[0].name: must be text",
        ),
        (
            r#"{"layers": [{"name": "a", "clear_of": {"a": "x"}}]}"#,
            "layers[0].clear_of: the value of `a` must be a number",
        ),
        (
            r#"{"layers": [{"name": "a", "limit": 3}]}"#,
            "layers[0].limit: unknown member",
        ),
    ] {
        assert_eq!(faults(body), [expected], "{body}");
    }
    assert!(faults("{")[0].starts_with("body: not JSON: EOF"));
}

#[test]
fn parameters_of_the_plane_are_known_in_space() {
    let body = r#"{"periodic": 2, "sed": 1, "layers": [{"name": "a", "periodic": 9, "limit": 3}]}"#;
    let expected = [
        "periodic: not for points in space",
        "sed: unknown member; did you mean `seed`?",
        "layers[0].periodic: not for points in space",
        "layers[0].limit: unknown member",
    ];
    assert_eq!(faults_of(body, groups::SPACE_QUERY), expected);
}

#[test]
fn lists_report_each_region_and_stop_in_time() {
    let bad = |count: usize| {
        format!(
            r#"{{"region": {{"include": [{}1]}}}}"#,
            "1,".repeat(count - 1)
        )
    };
    let draft = read_body(bad(1000).as_bytes(), groups::QUERY).expect("an object");
    let region = draft.region.expect("read").expect("given");
    let crate::ShapeDraft::Combined(include, _) = region.shape else {
        panic!("not combined");
    };
    assert_eq!(include.len(), 1000);
    assert!(include.iter().all(Result::is_err));
    assert_eq!(
        faults(&bad(100_000)),
        ["region.include: 100000 regions, more than 1000"]
    );
    let deep = (0..9).fold(r#"{"bbox": [0, 0, 1, 1]}"#.to_owned(), |inner, _| {
        format!(r#"{{"include": [{inner}]}}"#)
    });
    let draft = read_body(format!(r#"{{"region": {deep}}}"#).as_bytes(), groups::QUERY);
    let region = draft.expect("an object").region;
    assert!(format!("{region:?}").contains("nested too deeply"));
}

#[test]
fn nulls_are_no_values() {
    assert_eq!(
        faults(r#"{"region": null, "seed": null, "layers": null}"#),
        [
            "seed: must be an integer; leave the member out for its default",
            "region: must be an object",
            "layers: must be an array",
        ]
    );
}
