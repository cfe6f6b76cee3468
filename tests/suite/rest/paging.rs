//! Reading an answer in pieces: pages by limit and cursor, offsets, and the parts of a split.

use serde_json::{Value, json};

use crate::support::{csv::Csv, daemon::Daemon};

/// Queries with and without layers.
fn queries() -> Vec<Value> {
    let region = json!({ "circle": { "center": [4, -3], "radius": 11 } });
    vec![
        json!({ "region": { "bbox": [-7, 1, 12, 15] }, "spacing": 0.6 }),
        json!({ "region": region, "spacing": 0.6, "seed": 8, "keep": 0.7 }),
        // The cursor carries the spacing, which need not be found again.
        json!({ "region": region, "count": 700, "seed": 8 }),
        json!({ "region": region, "layers": [
            { "name": "trees", "count": 90, "seed": 1 },
            { "name": "none", "spacing": 1, "region": { "bbox": [500, 500, 501, 501] } },
            { "name": "bushes", "spacing": 0.9, "clear_of": { "trees": 1.1 } },
            { "name": "rocks", "count": 300, "seed": 2, "profile": "pink" },
        ] }),
    ]
}

fn with(body: &Value, members: &[(&str, Value)]) -> Value {
    let mut body = body.clone();
    for (name, value) in members {
        body[*name] = value.clone();
    }
    body
}

#[test]
fn a_broken_answer_continues_with_its_cursor_and_what_came() {
    let daemon = Daemon::start(&[]);
    let mut bodies = queries();
    let tile = json!({ "periodic": 5000, "spacing": 1, "map": "s" });
    bodies.push(tile);
    for body in bodies {
        let whole = Csv::post(&daemon, &body);
        for (offset, limit) in [(0, 9999), (0, 100), (31, 200)] {
            let window = [("offset", json!(offset)), ("limit", json!(limit))];
            let asked = with(&body, &window);
            let answer = Csv::post(&daemon, &asked);
            let cursor = json!(answer.answer.header("strew-cursor"));
            if cursor == json!("") {
                assert!(whole.points.len() < 2048, "{body}");
                continue;
            }
            for came in [0, 1, 77, answer.points.len() - 1] {
                let rest = answer.points.len() - came;
                let more = [
                    ("cursor", cursor.clone()),
                    ("offset", json!(came)),
                    ("limit", json!(rest)),
                ];
                let rest = Csv::post(&daemon, &with(&body, &more));
                assert_eq!(rest.points, answer.points[came..], "{asked}");
                assert_eq!(
                    rest.answer.header("strew-next"),
                    answer.answer.header("strew-next")
                );
            }
        }
    }
    let asked = json!({ "region": { "bbox": [0, 0, 100, 100] }, "spacing": 1 });
    let cursor = daemon.post("/v1/points:query", &asked);
    let cursor = json!(cursor.header("strew-cursor"));
    let other = with(&asked, &[("cursor", cursor), ("profile", json!("pink"))]);
    let refused = daemon.post("/v1/points:query", &other);
    assert_eq!(refused.status, 400);
    assert!(
        refused.text().contains("another table"),
        "{}",
        refused.text()
    );
}

#[test]
fn an_offset_counts_from_the_beginning_or_from_the_cursor() {
    let daemon = Daemon::start(&[]);
    for body in queries() {
        let whole = Csv::post(&daemon, &body).points;
        let page = Csv::post(&daemon, &with(&body, &[("limit", json!(85))]));
        let cursor = json!(page.answer.header("strew-next"));
        for offset in [0, 1, 7, 200, whole.len() - 1, whole.len(), whole.len() + 1] {
            let asked = with(&body, &[("offset", json!(offset)), ("limit", json!(40))]);
            let start = offset.min(whole.len());
            let end = (offset + 40).min(whole.len());
            assert_eq!(
                Csv::post(&daemon, &asked).points,
                whole[start..end],
                "{asked}"
            );
            let asked = with(&asked, &[("cursor", cursor.clone())]);
            let [start, end] = [offset + 85, offset + 125].map(|v| v.min(whole.len()));
            let table = Csv::post(&daemon, &asked);
            assert_eq!(table.points, whole[start..end], "{asked}");
            let document = daemon.post("/v1/points:query", &asked).json();
            assert_eq!(document["query"]["offset"], start, "{asked}");
        }
        let far = with(&body, &[("offset", json!("18446744073709551615"))]);
        assert_eq!(Csv::post(&daemon, &far).points, []);
    }
}

#[test]
fn the_parts_of_a_split_make_the_whole() {
    let daemon = Daemon::start(&[]);
    for body in queries() {
        let cut = with(&body, &[("offset", json!(20)), ("limit", json!(250))]);
        for body in [body, cut] {
            let whole = Csv::post(&daemon, &body).points;
            // A part for each point only where places are found without counting rows.
            let most = if body.get("keep").is_some() || body.get("layers").is_some() {
                100
            } else {
                10_000
            };
            for parts in [1, 3, 10, most] {
                let split = daemon.post(&format!("/v1/points:split?parts={parts}"), &body);
                assert_eq!(split.status, 200, "{}", split.text());
                let split = split.json();
                assert_eq!(split["count"], whole.len());
                let split = split["parts"].as_array().expect("a list").clone();
                assert_eq!(split.len(), parts.min(whole.len()));
                // Thousands of parts would be thousands of requests.
                if parts >= 100 {
                    continue;
                }
                let mut read = vec![];
                for part in split {
                    let table = Csv::post(&daemon, &part["query"]);
                    assert_eq!(part["count"], table.points.len());
                    assert!(table.points.len().abs_diff(whole.len() / parts) <= 1);
                    read.extend(table.points);
                }
                assert_eq!(read, whole, "{body}");
            }
        }
    }
    let nothing = json!({ "region": { "bbox": [0, 0, 1e-6, 1e-6] }, "spacing": 1 });
    let split = daemon.post("/v1/points:split?parts=3", &nothing).json();
    assert_eq!(split, json!({ "count": 0, "parts": [] }));
}

#[test]
fn cursors_of_other_queries_and_damaged_ones_are_refused() {
    let daemon = Daemon::start(&[]);
    let queries = queries();
    let mut cursors = vec![];
    for body in &queries {
        let page = Csv::post(&daemon, &with(body, &[("limit", json!(3))]));
        cursors.push(page.answer.header("strew-next").to_owned());
    }
    let refused = |body: &Value, cursor: &str, detail: &str| {
        let asked = with(body, &[("cursor", json!(cursor))]);
        let answer = daemon.post("/v1/points:query", &asked);
        assert_eq!(answer.status, 400, "{asked}");
        let problem = answer.json();
        let error = &problem["errors"][0];
        assert_eq!(error["field"], "cursor", "{problem}");
        assert!(
            error["detail"].as_str().is_some_and(|d| d.contains(detail)),
            "{problem}"
        );
    };
    for (i, body) in queries.iter().enumerate() {
        let own = &cursors[i];
        for other in cursors.iter().filter(|other| *other != own) {
            refused(body, other, "another query");
        }
        let end = own.len() - 1;
        for at in [2, 20, end / 2, end] {
            let mut damaged = own.clone().into_bytes();
            damaged[at] = if damaged[at] == b'1' { b'2' } else { b'1' };
            refused(
                body,
                std::str::from_utf8(&damaged).expect("digits"),
                "another query",
            );
        }
        refused(body, &own[..end], "not a cursor");
        refused(body, &own[2..], "not a cursor");
        refused(body, "next", "not a cursor");
        refused(body, "", "not a cursor");
    }
    // A cursor depends neither on the format nor on the method.
    let page = Csv::get(&daemon, "bbox=-7,1,12,15&spacing=0.6&limit=3");
    let cursor = page.answer.header("strew-next");
    let rest = Csv::post(&daemon, &with(&queries[0], &[("cursor", json!(cursor))]));
    assert_eq!(rest.points, Csv::post(&daemon, &queries[0]).points[3..]);
}
