//! `/v1/profiles/{name}`: curves, targets and pictures.

use crate::support::daemon::Daemon;

#[test]
fn a_profile_has_curves_a_target_and_a_picture() {
    let daemon = Daemon::start(&[]);
    let answer = daemon.get("/v1/profiles/blue?alpha=sqrt(3)&map=s");
    assert_eq!(answer.status, 200, "{}", answer.text());
    let document = answer.json();
    assert_eq!(document["table"]["alpha"], "sqrt(3)");
    let rings = document["measured"]["radial"]["values"]
        .as_array()
        .expect("rings");
    let power = |ring: &serde_json::Value| ring[1].as_f64().expect("a number");
    assert!(
        rings.len() > 100 && power(&rings[10]) < 0.01,
        "blue noise has no low power"
    );
    let target = &document["target"];
    assert_eq!(target["bounds"][0]["figure"], "low_power");
    assert_eq!(target["bounds"][0]["side"], "at most");
    assert!(target["statement"].is_string() && target["curve"].is_null());
    let step = daemon.get("/v1/profiles/step").json();
    let curve = step["target"]["curve"]["values"].as_array().expect("drawn");
    assert!(
        curve.len() > 1
            && curve
                .iter()
                .all(|p| p.as_array().is_some_and(|p| p.len() == 2))
    );
    let picture = daemon.get("/v1/profiles/blue/spectrum.svg");
    assert_eq!(picture.header("content-type"), "image/svg+xml");
    assert!(picture.text().starts_with("<svg"));
    assert_eq!(daemon.get("/v1/profiles/mauve").status, 404);
    let wrong = daemon.get("/v1/profiles/blue?seed=1&map=xl");
    assert_eq!(wrong.status, 400);
    assert!(
        wrong.text().contains("`seed`") && wrong.text().contains("`map`"),
        "{}",
        wrong.text()
    );
}
