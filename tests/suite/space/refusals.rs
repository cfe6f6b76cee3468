//! Bad input about points in space: errors that name the field, the value and what is allowed.

use serde_json::json;

use crate::support::{daemon::Daemon, problem::assert_fault};

#[test]
fn addresses_with_faults_name_the_field_and_what_is_allowed() {
    let daemon = Daemon::built_in();
    for (path, field, texts) in [
        (
            "points?spacing=1",
            "bbox",
            &["missing", "one of bbox and ball"][..],
        ),
        (
            "points?bbox=0,0,2,2&spacing=1",
            "bbox",
            &["expected 6 numbers, got 4"],
        ),
        (
            "points?bbox=0,0,0,2,2,0&spacing=1",
            "bbox",
            &["empty: min_z and max_z are both 0.0"],
        ),
        (
            "points?bbox=0,0,5,2,2,1&spacing=1",
            "bbox",
            &["reversed: max_z is 1, below the lower bound 5"],
        ),
        (
            "points?bbox=0,0,0,2,nan,1&spacing=1",
            "bbox",
            &["max_y is `nan`"],
        ),
        (
            "points?bbox=0,0,0,1,1,1&ball=0,0,0,1&spacing=1",
            "ball",
            &["bbox is given"],
        ),
        ("points?ball=0,0,0,-1&spacing=1", "ball", &["radius"]),
        (
            "points?bbox=0,0,0,1,1,1&spacing=0",
            "spacing",
            &["out of range"],
        ),
        (
            "points?bbox=0,0,0,1,1,1&count=0",
            "count",
            &["an integer from 1"],
        ),
        (
            "points?bbox=0,0,0,1,1,1&spacing=1&periodic=9",
            "periodic",
            &["not for points in space"],
        ),
        (
            "points?bbox=0,0,0,1,1,1&spacing=1&field=jungle",
            "field",
            &["no such field is loaded"],
        ),
        (
            "points?bbox=0,0,0,9,9,9&spacing=1&except=8:8",
            "except[0]",
            &["no such point"],
        ),
        (
            "points?bbox=0,0,0,9,9,9&spacing=1&except=8:8:8",
            "except[0]",
            &["no such point"],
        ),
        (
            "points?bbox=0,0,0,9,9,9&count=5&except=8:8:-1",
            "count",
            &["not with except"],
        ),
        (
            "points?bbox=0,0,0,1,1,1&spacing=1&profile=pink",
            "profile",
            &["no such profile", "blue (alpha", "spaced (alpha"],
        ),
        ("points?bbox=0,0,0,1,1,1&spacing=1&map=m", "map", &["r16"]),
        (
            "points?bbox=0,0,0,1,1,1&spacing=1&attributes=angle",
            "attributes",
            &["rotation"],
        ),
        (
            "points?bbox=2e12,0,0,2.1e12,1,1&spacing=1",
            "bbox",
            &["min_x", "too far from the origin", "within ±"],
        ),
        (
            "points?bbox=0,0,0,1,1,1&spacing=1&cursor=00",
            "cursor",
            &["not a cursor"],
        ),
        (
            "chunks/0/0/0/0?spacing=1",
            "size",
            &["a finite number above 0"],
        ),
        ("chunks/4/0/0/x?spacing=1", "cz", &["integer"]),
        (
            "chunks/4/0/0/0?spacing=1&bbox=0,0,0,1,1,1",
            "bbox",
            &["not allowed here"],
        ),
        (
            "points/0:0?spacing=1",
            "id",
            &["three integers joined by colons"],
        ),
        (
            "nearest?at=0,0&spacing=1",
            "at",
            &["expected 3 numbers, got 2"],
        ),
        ("nearest?at=0,0,0&k=10001&spacing=1", "k", &["10000"]),
        (
            "nearest?at=0,0,0&radius=50&spacing=1",
            "radius",
            &["too many points"],
        ),
    ] {
        let path = format!("/v1/space/{path}");
        let answer = daemon.get(&path);
        assert_eq!(answer.status, 400, "{path}: {}", answer.text());
        assert_fault(&answer, &path, field, texts);
    }
    let plane = daemon.get("/v1/points?bbox=0,0,0,1,1,1&spacing=1");
    assert_fault(&plane, "plane", "bbox", &["expected 4 numbers, got 6"]);
    let flat = daemon.get("/v1/points?bbox=0,0,1,1&spacing=1&attributes=rotation");
    assert_fault(
        &flat,
        "plane",
        "attributes",
        &["in the plane points have an angle"],
    );
}

#[test]
fn bodies_with_faults_name_the_member() {
    let daemon = Daemon::built_in();
    let circle = json!({ "circle": { "center": [0, 0], "radius": 1 } });
    let ball = json!({ "ball": { "center": [0, 0, 0], "radius": 1 } });
    let polygon = json!({ "type": "Polygon", "coordinates": [[[0, 0], [1, 0], [0, 1], [0, 0]]] });
    for (region, field, text) in [
        (circle.clone(), "region.circle", "a shape of the plane"),
        (json!({ "bbox": [0, 0, 1, 1] }), "region.bbox", "max_z"),
        (
            json!({ "ball": { "center": [0, 0], "radius": 1 } }),
            "region.ball",
            "center",
        ),
        (
            json!({ "prism": { "polygon": polygon, "bottom": 0 } }),
            "region.prism.top",
            "missing",
        ),
        (
            json!({ "prism": { "polygon": polygon, "bottom": 1, "top": 1 } }),
            "region.prism",
            "empty",
        ),
        (
            json!({ "prism": { "polygon": polygon, "bottom": 2, "top": 1 } }),
            "region.prism",
            "top",
        ),
        (
            json!({ "include": [ball, circle] }),
            "region.include[1].circle",
            "a shape of the plane",
        ),
        (json!({ "include": [] }), "region.include", "missing"),
        (
            json!({ "include": [ball], "exclude": [ball] }),
            "region",
            "empty",
        ),
    ] {
        let body = json!({ "region": region, "spacing": 1 });
        for path in [
            "/v1/space/points",
            "/v1/space/count",
            "/v1/space/points:split?parts=2",
        ] {
            let answer = daemon.post(path, &body);
            if region["exclude"].is_array() && answer.status == 200 {
                // What is left of a ball without itself is known when it is counted.
                continue;
            }
            assert_eq!(answer.status, 400, "{body}: {}", answer.text());
            assert_fault(&answer, &body.to_string(), field, &[text]);
        }
    }
    let flat = daemon.post("/v1/points:query", &json!({ "region": ball, "spacing": 1 }));
    assert_fault(&flat, "plane", "region.ball", &["a shape of space"]);
}

#[test]
fn what_costs_too_much_is_refused_before_it_is_counted() {
    let daemon = Daemon::built_in();
    let far = "-1e9,-1e9,-1e9,1e9,1e9,1e9";
    let warped = daemon.get(&format!("/v1/space/count?bbox={far}&spacing=1&seed=1"));
    assert_eq!(warped.status, 413, "{}", warped.text());
    let plain = daemon.get(&format!("/v1/space/count?bbox={far}&spacing=1"));
    assert_eq!(plain.status, 200, "{}", plain.text());
    let many = daemon.get(&format!("/v1/space/points?bbox={far}&spacing=1"));
    assert_eq!(many.status, 413, "{}", many.text());
}
