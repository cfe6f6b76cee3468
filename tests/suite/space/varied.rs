//! Density that varies, levels of detail, exact numbers and points that were taken away: those of the library.

use serde_json::{Value, json};
use strew_core::{
    field::{FieldSpec, Noise},
    server::Stop,
    space::{self, SpaceSet},
};
use strew_testkit::http1;

use super::{lines, set, told, within};
use crate::support::daemon::Daemon;

fn patches() -> FieldSpec {
    let noise = Noise {
        seed: 1,
        wavelength: 9.0,
        octaves: 2,
        range: [0.0, 1.0],
    };
    let glow = FieldSpec::radial([2.0, 3.0, -4.0], [3.0, 12.0], [1.0, 0.0]).expect("valid");
    let noise = FieldSpec::noise(noise).expect("valid");
    FieldSpec::multiply(vec![glow, noise]).expect("valid")
}

fn document() -> Value {
    let glow = json!({ "radial": { "center": [2, 3, -4], "radii": [3, 12] } });
    json!({ "multiply": [glow, { "noise": { "seed": 1, "wavelength": 9, "octaves": 2 } }] })
}

fn ball() -> space::Ball {
    space::Ball::new([2.0, 3.0, -4.0], 11.0).expect("a ball")
}

const BALL: &str = r#"{"ball":{"center":[2,3,-4],"radius":11}}"#;

/// A query about the ball.
fn query(others: Value) -> Value {
    let mut query = others;
    query["region"] = serde_json::from_str(BALL).expect("JSON");
    query["format"] = json!("csv");
    query
}

fn post(daemon: &Daemon, others: Value) -> http1::Answer {
    daemon.post("/v1/space/points", &query(others))
}

fn expected(set: &SpaceSet) -> Vec<(String, [f64; 3])> {
    told(&within(set, ball()).to_vec())
}

#[test]
fn fields_and_levels_are_those_of_the_library() {
    let daemon = Daemon::built_in();
    for (seed, lod) in [(0, 1.0), (5, 1.0), (5, 0.3)] {
        let own = set(0.7, seed).in_field(patches()).lod(lod).expect("a part");
        let others = json!({ "spacing": 0.7, "seed": seed, "lod": lod, "field": document() });
        let answer = post(&daemon, others.clone());
        let expected = expected(&own);
        assert!(expected.len() > 100);
        assert_eq!(answer.header("strew-count"), expected.len().to_string());
        assert_eq!(lines(&answer), expected);
        let split = daemon
            .post("/v1/space/points:split?parts=3", &query(others))
            .json();
        let parts = split["parts"].as_array().expect("a list").iter();
        let parts = parts.flat_map(|part| lines(&daemon.post("/v1/space/points", &part["query"])));
        assert!(parts.eq(expected));
    }
    let flat = json!({ "region": { "bbox": [0, 0, 9, 9] }, "spacing": 1, "field": document() });
    let refused = daemon.post("/v1/points:query", &flat);
    assert_eq!(refused.status, 400);
    assert!(
        refused.text().contains("a place has a z"),
        "{}",
        refused.text()
    );
    let mixed = json!({ "ramp": { "from": [0, 0], "to": [0, 0, 9] } });
    let refused = post(&daemon, json!({ "spacing": 1, "field": mixed }));
    assert!(
        refused.text().contains("field.ramp.to"),
        "{}",
        refused.text()
    );
}

#[test]
fn exact_numbers_are_found_and_resumed() {
    let daemon = Daemon::built_in();
    for field in [Value::Null, document()] {
        let mut others = json!({ "count": 700, "seed": 5 });
        let mut own = set(1.0, 5);
        if !field.is_null() {
            others["field"] = field;
            own = own.in_field(patches());
        }
        let plan = own
            .exactly(700, ball(), 0.0, &Stop::default())
            .expect("a spacing");
        let answer = post(&daemon, others.clone());
        assert_eq!(lines(&answer), told(&plan.to_vec()));
        others["limit"] = json!(300);
        let mut paged = vec![];
        loop {
            let page = post(&daemon, others.clone());
            paged.extend(lines(&page));
            match page.header("strew-next") {
                "" => break,
                next => others["cursor"] = json!(next),
            }
        }
        assert_eq!(paged, told(&plan.to_vec()));
    }
    let layers = json!([
        { "name": "stars", "count": 9, "seed": 5 },
        { "name": "dust", "spacing": 1, "seed": 6, "clear_of": { "stars": 2 } },
    ]);
    let stars = set(1.0, 5)
        .exactly(9, ball(), 0.0, &Stop::default())
        .expect("a spacing");
    let stars = set(stars.placement().spacing.get(), 5);
    let dust = set(1.0, 6).clear_of(&stars, 2.0).expect("in range");
    assert_eq!(
        counted(&daemon, layers),
        9 + within(&dust, ball()).count() as u64
    );
}

/// The number of points of some layers.
fn counted(daemon: &Daemon, layers: Value) -> u64 {
    let region: Value = serde_json::from_str(BALL).expect("JSON");
    let answer = daemon.post(
        "/v1/space/count",
        &json!({ "region": region, "layers": layers }),
    );
    let count = answer.json()["count"].as_u64();
    count.unwrap_or_else(|| panic!("{}", answer.text()))
}

#[test]
fn points_that_were_taken_away_are_left_out() {
    let daemon = Daemon::built_in();
    let own = set(1.2, 5);
    let ids: Vec<_> = within(&own, ball())
        .iter()
        .map(|point| point.id())
        .step_by(3)
        .collect();
    let names: Vec<String> = ids.iter().map(ToString::to_string).collect();
    let sent = daemon
        .post("/v1/except", &json!({ "ids": names[2..] }))
        .json();
    let digest = sent["digest"].as_str().expect("a digest");
    let except = [&names[0], &names[1], digest];
    let answer = post(
        &daemon,
        json!({ "spacing": 1.2, "seed": 5, "except": except }),
    );
    assert_eq!(lines(&answer), expected(&own.clone().without(ids.clone())));
    // Other layers keep clear of them all the same.
    let layers = json!([
        { "name": "rocks", "spacing": 1.2, "seed": 5, "except": names },
        { "name": "dust", "spacing": 0.8, "seed": 6, "clear_of": { "rocks": 0.7 } },
    ]);
    let dust = set(0.8, 6).clear_of(&own, 0.7).expect("in range");
    let left = within(&own.without(ids), ball()).count() + within(&dust, ball()).count();
    assert_eq!(counted(&daemon, layers), left as u64);
}
