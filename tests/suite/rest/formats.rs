//! Every format carries the library's points.

use strew_core::{Plan, Point};
use strew_testkit::http1;

use crate::support::{
    daemon::{Daemon, PROFILE},
    library::{QUERY, assert_same, plan, points},
};

/// A daemon with small blocks, so that an answer has many.
fn daemon() -> Daemon {
    Daemon::start(&["limits.block_bytes=4096"])
}

fn check_headers(answer: &http1::Answer, plan: &Plan, content_type: &str) {
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
        assert_same(&got, &points(&plan));
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
    assert_same(&got, &points(&plan));
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
    assert_same(&got, &points(&plan));
}

#[test]
fn numbers_have_the_requested_decimals() {
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
        "no decimal point without decimals"
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
        let answer = http1::get(daemon.address(), QUERY, &accept);
        check_headers(&answer, &plan, &media_type);
        assert_eq!(&answer.body, bytes, "{format}");
    }
}

#[test]
fn the_format_parameter_wins_over_accept_and_head_has_no_body() {
    let (daemon, plan) = (daemon(), plan());
    let accept = [("accept", "text/csv")];
    let answer = http1::get(daemon.address(), QUERY, &accept);
    check_headers(&answer, &plan, "text/csv; charset=utf-8; header=present");
    let named = format!("{QUERY}&format=ndjson");
    let answer = http1::get(daemon.address(), &named, &accept);
    check_headers(&answer, &plan, "application/x-ndjson");
    // A named format overrides an `Accept` header that nothing satisfies.
    let odd = [("accept", "text/html")];
    assert_eq!(http1::get(daemon.address(), &named, &odd).status, 200);
    let head = http1::request(daemon.address(), "HEAD", QUERY, &[]);
    check_headers(&head, &plan, "application/json");
}

#[test]
fn explicit_defaults_and_other_spellings_change_nothing() {
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
fn decimals_take_no_point_out_of_its_box() {
    let daemon = Daemon::built_in();
    let chunk = "/v1/chunks/64/3/-2?spacing=0.5&decimals=1&format=";
    let space = "/v1/space/chunks/8/1/-2/3?spacing=0.5&decimals=1&format=";
    for (path, axes, least, end) in [
        (chunk, 2, 0.0, 64.0),
        (
            "/v1/points?bbox=-64,-64,0,0&spacing=0.5&decimals=0&format=",
            2,
            -64.0,
            0.0,
        ),
        (
            "/v1/points?bbox=0.04,0.04,9.96,9.96&spacing=0.1&decimals=1&format=",
            2,
            0.04,
            9.96,
        ),
        (space, 3, 0.0, 8.0),
    ] {
        let csv = daemon.get(&format!("{path}csv"));
        assert_eq!(csv.status, 200, "{}", csv.text());
        let rows: Vec<Vec<f64>> = csv
            .text()
            .lines()
            .skip(1)
            .map(|line| {
                line.split(',')
                    .skip(1)
                    .map(|n| n.parse().expect("a number"))
                    .collect()
            })
            .collect();
        assert_eq!(rows.len().to_string(), csv.header("strew-count"));
        let outside = |at: &f64| !(least..end).contains(at);
        assert!(
            !rows.iter().any(|row| row[..axes].iter().any(outside)),
            "{path}"
        );
        let document = daemon.get(&format!("{path}json")).json();
        let geojson = daemon.get(&format!("{path}geojson")).json();
        let (points, features) = (&document["points"], &geojson["features"]);
        for (i, row) in rows.iter().enumerate() {
            for (axis, name) in ["x", "y", "z"].into_iter().take(axes).enumerate() {
                assert_eq!(points[i][name], row[axis], "{path}");
                assert_eq!(
                    features[i]["geometry"]["coordinates"][axis], row[axis],
                    "{path}"
                );
            }
        }
    }
}

#[test]
fn integers_are_read_and_written_so_that_programs_with_floats_keep_them() {
    let daemon = Daemon::built_in();
    let ask = |body: &str| http1::post(daemon.address(), "/v1/points:query", &[], body.as_bytes());
    let query = |more: &str| {
        let region = r#""region":{"chunk":{"size":8,"x":3.0,"y":-2e0}},"spacing":1"#;
        format!("{{{region},{more}}}")
    };
    let points = |answer: &http1::Answer| {
        assert_eq!(answer.status, 200, "{}", answer.text());
        answer.json()["points"].clone()
    };
    let plain = points(&ask(&query(r#""seed":7,"limit":2,"decimals":3"#)));
    assert_eq!(
        points(&ask(&query(r#""seed":7.0,"limit":2.0,"decimals":3.0"#))),
        plain
    );
    let address = daemon.get("/v1/chunks/8/3.0/-2?spacing=1&seed=7.0&limit=2e0&decimals=3");
    assert_eq!(points(&address), plain);
    let layers = r#"{"region":{"bbox":[0,0,9,9]},"limit":2.0,"layers":[{"name":"a","spacing":1,"seed":7.0,"settle":0.0}]}"#;
    assert_eq!(ask(layers).status, 200, "{}", ask(layers).text());
    for wrong in [
        r#""seed":7.5"#,
        r#""limit":0.5"#,
        r#""seed":1e20"#,
        r#""seed":true"#,
    ] {
        assert_eq!(ask(&query(wrong)).status, 400, "{wrong}");
    }
    // 2^53 + 1, which JSON.parse would round.
    let long = ask(&query(r#""seed":9007199254740993,"limit":2"#)).json();
    assert_eq!(long["query"]["seed"], "9007199254740993");
    let again = ask(&query(&format!(
        r#""seed":{},"limit":2"#,
        long["query"]["seed"]
    )))
    .json();
    assert_eq!(again, long);
    let count = daemon
        .get("/v1/count?bbox=-5e8,-5e8,5e8,5e8&spacing=1&map=s")
        .json();
    let text = count["count"].as_str().expect("text");
    assert!(text.len() >= 18, "{text}");
}
