//! Every format carries the same points, and they are the library's.

use strew_core::{Plan, Point, PointSet, Region};

use crate::{
    daemon::{Daemon, PROFILE, table},
    raw,
};

/// A region that is not a square, off the origin, partly negative.
const QUERY: &str = "/v1/points?bbox=-3.5,1,40,33.25&density=7&profile=test&seed=5";

pub fn plan() -> Plan {
    let set = PointSet::new(table("(5-sqrt(3))/2", PROFILE)).seed(5);
    let region = Region::new([-3.5, 1.0], [40.0, 33.25]).expect("a box");
    let set = set.density(7.0).expect("positive");
    set.within(region).expect("near")
}

pub fn points(plan: &Plan) -> Vec<Point> {
    let mut points = vec![Point::default(); usize::try_from(plan.count()).expect("few")];
    plan.blocks_points().fill(&mut points);
    points
}

/// Fails at the first difference.
pub fn same(got: &[Point], expected: &[Point]) {
    for (i, (got, expected)) in got.iter().zip(expected).enumerate() {
        assert_eq!(got, expected, "point {i}");
    }
    assert_eq!(got.len(), expected.len());
}

/// Blocks so small that there are many.
fn daemon() -> Daemon {
    Daemon::start(&["limits.block_bytes=4096"])
}

fn check_headers(answer: &raw::Answer, plan: &Plan, content_type: &str) {
    assert_eq!(answer.status, 200);
    assert_eq!(answer.header("content-type"), content_type);
    assert_eq!(answer.header("strew-count"), plan.count().to_string());
    let digest = plan.table().digest().to_string();
    assert_eq!(answer.header("strew-table"), digest);
    let version = strew_core::ALGORITHM_VERSION.to_string();
    assert_eq!(answer.header("strew-algorithm"), version);
}

fn point_of(value: &serde_json::Value) -> Point {
    Point {
        id: value["id"]
            .as_str()
            .expect("a text")
            .parse()
            .expect("an id"),
        x: value["x"].as_f64().expect("a number"),
        y: value["y"].as_f64().expect("a number"),
    }
}

#[test]
fn json_is_one_document_that_echoes_the_query() {
    let (daemon, plan) = (daemon(), plan());
    for path in [QUERY.to_owned(), format!("{QUERY}&format=json")] {
        let answer = daemon.get(&path);
        check_headers(&answer, &plan, "application/json");
        let document = answer.json();
        let query = &document["query"];
        assert_eq!(query["bbox"], serde_json::json!([-3.5, 1.0, 40.0, 33.25]));
        assert_eq!(query["density"], 7.0);
        assert_eq!(query["spacing"], plan.placement().spacing.get());
        assert_eq!(query["alpha"], "(5-sqrt(3))/2");
        assert_eq!(query["profile"], PROFILE);
        assert_eq!(query["seed"], 5);
        assert_eq!(query["format"], "json");
        assert_eq!(document["table"]["digest"], answer.header("strew-table"));
        assert_eq!(document["count"], plan.count() as u64);
        let list = document["points"].as_array().expect("a list");
        let got: Vec<Point> = list.iter().map(point_of).collect();
        same(&got, &points(&plan));
    }
}

#[test]
fn ndjson_ends_with_a_summary() {
    let (daemon, plan) = (daemon(), plan());
    let answer = daemon.get(&format!("{QUERY}&format=ndjson"));
    check_headers(&answer, &plan, "application/x-ndjson");
    let mut lines: Vec<serde_json::Value> = answer
        .text()
        .lines()
        .map(|line| serde_json::from_str(line).expect("a document"))
        .collect();
    let summary = lines.pop().expect("a summary");
    assert_eq!(summary["summary"]["count"], plan.count() as u64);
    assert_eq!(summary["summary"]["query"]["seed"], 5);
    let got: Vec<Point> = lines.iter().map(point_of).collect();
    same(&got, &points(&plan));
}

#[test]
fn csv_has_a_header_and_exact_numbers() {
    let (daemon, plan) = (daemon(), plan());
    let answer = daemon.get(&format!("{QUERY}&format=csv"));
    check_headers(&answer, &plan, "text/csv; charset=utf-8; header=present");
    let mut lines = answer.text().lines();
    assert_eq!(lines.next(), Some("id,x,y"));
    let got: Vec<Point> = lines
        .map(|line| {
            let parts: Vec<&str> = line.split(',').collect();
            let number = |text: &str| text.parse::<f64>().expect("a number");
            Point {
                id: parts[0].parse().expect("an id"),
                x: number(parts[1]),
                y: number(parts[2]),
            }
        })
        .collect();
    same(&got, &points(&plan));
}

#[test]
fn decimals_are_as_many_as_asked_for() {
    let (daemon, plan) = (daemon(), plan());
    let fixed = |value: f64| {
        let text = format!("{value:.3}");
        if text == "-0.000" {
            "0.000".into()
        } else {
            text
        }
    };
    let expected: Vec<String> = points(&plan)
        .iter()
        .map(|p| format!("{},{},{}", p.id, fixed(p.x), fixed(p.y)))
        .collect();
    let csv = daemon.get(&format!("{QUERY}&format=csv&decimals=3"));
    let lines: Vec<&str> = csv.text().lines().skip(1).collect();
    assert_eq!(lines, expected);
    let json = daemon.get(&format!("{QUERY}&decimals=0"));
    assert_eq!(json.json()["query"]["decimals"], 0);
    assert!(
        json.text().contains("\"x\":-3,"),
        "no point of zero decimals"
    );
}

#[test]
fn packed_formats_are_the_librarys_numbers() {
    let (daemon, plan) = (daemon(), plan());
    let f64s: Vec<u8> = points(&plan)
        .iter()
        .flat_map(|p| [p.x, p.y])
        .flat_map(f64::to_le_bytes)
        .collect();
    let mut pairs = vec![[0f32; 2]; usize::try_from(plan.count()).expect("few")];
    plan.blocks_f32().fill(&mut pairs);
    let f32s: Vec<u8> = pairs
        .iter()
        .flatten()
        .flat_map(|v| v.to_le_bytes())
        .collect();
    for (format, bytes, origin) in [("f64", &f64s, ""), ("f32", &f32s, "-3.5,1.0")] {
        let answer = daemon.get(&format!("{QUERY}&format={format}"));
        check_headers(&answer, &plan, "application/octet-stream");
        assert_eq!(answer.header("content-length"), bytes.len().to_string());
        assert_eq!(answer.header("strew-origin"), origin);
        assert_eq!(&answer.body, bytes, "{format}");

        let media_type = format!("application/vnd.strew.{format}");
        let accept = [("accept", media_type.as_str())];
        let answer = raw::get(daemon.address(), QUERY, &accept);
        check_headers(&answer, &plan, &media_type);
        assert_eq!(&answer.body, bytes, "{format}");
    }
}

#[test]
fn the_format_parameter_wins_over_accept_and_head_has_no_body() {
    let (daemon, plan) = (daemon(), plan());
    let accept = [("accept", "text/csv")];
    let answer = raw::get(daemon.address(), QUERY, &accept);
    check_headers(&answer, &plan, "text/csv; charset=utf-8; header=present");
    let named = format!("{QUERY}&format=ndjson");
    let answer = raw::get(daemon.address(), &named, &accept);
    check_headers(&answer, &plan, "application/x-ndjson");
    // A named format needs no acceptable one.
    let odd = [("accept", "text/html")];
    assert_eq!(raw::get(daemon.address(), &named, &odd).status, 200);
    let head = raw::request(daemon.address(), "HEAD", QUERY, &[]);
    check_headers(&head, &plan, "application/json");
}

#[test]
fn defaults_and_spellings_do_not_matter() {
    let daemon = Daemon::start(&[]);
    let plain = daemon.get(&format!("{QUERY}&format=f64"));
    let spacing = plan().placement().spacing.get();
    for path in [
        "/v1/points?seed=5&format=f64&profile=test&density=7.0&bbox=-3.5,1.0,4e1,33.25".to_owned(),
        format!(
            "/v1/points?bbox=-3.5%2C1%2C40%2C33.25&spacing={spacing}&profile=test&seed=5&format=f64"
        ),
        format!("{QUERY}&format=f64&alpha=(5-sqrt(3))/2"),
        format!("{QUERY}&format=f64&alpha=%285-sqrt%2812%29%2F2%29%2F2"),
    ] {
        let answer = daemon.get(&path);
        assert_eq!(answer.status, 200, "{path}: {}", answer.text());
        assert_eq!(answer.body, plain.body, "{path}");
    }
}

#[test]
fn a_region_without_points_is_a_whole_answer() {
    let daemon = Daemon::start(&[]);
    let path = "/v1/points?bbox=0,0,1e-9,1e-9&density=1&profile=test";
    let json = daemon.get(&format!("{path}&seed=3"));
    assert_eq!(json.json()["count"], 0);
    assert_eq!(json.json()["points"].as_array().map(Vec::len), Some(0));
    assert_eq!(
        daemon.get(&format!("{path}&seed=3&format=csv")).text(),
        "id,x,y\n"
    );
    for format in ["f32", "f64"] {
        let answer = daemon.get(&format!("{path}&seed=3&format={format}"));
        assert_eq!(answer.header("content-length"), "0");
        assert_eq!(answer.header("strew-count"), "0");
        assert!(answer.body.is_empty());
    }
}

#[test]
fn a_profile_has_its_curves_and_its_picture() {
    let daemon = daemon();
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
