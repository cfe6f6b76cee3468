//! Layers: they keep clear of each other, are seamless across chunks, and appear in every format.

use std::io::Cursor;

use arrow_array::{cast::AsArray as _, types::Float64Type};
use arrow_ipc::reader::StreamReader;
use serde_json::{Value, json};
use strew_core::Point;
use strew_encode::Encoding;

use crate::support::{
    csv::{Csv, least_distance, sorted},
    daemon::Daemon,
};

fn forest(region: &Value) -> Value {
    json!({ "region": region, "layers": [
        { "name": "trees", "min_distance": 2, "seed": 1, "attributes": ["angle"] },
        { "name": "bushes", "spacing": 1, "seed": 2, "clear_of": { "trees": 1.5 } },
        { "name": "rocks", "spacing": 0.7, "seed": 3, "profile": "step",
          "attributes": "variant,angle", "variants": "flat,round",
          "clear_of": { "trees": 0.8, "bushes": 0.5 } },
    ] })
}

/// The points of each layer.
fn by_layer(table: &Csv) -> [Vec<Point>; 3] {
    let layers = &table.columns["layer"];
    // Layers follow each other.
    let order = |name: &String| ["trees", "bushes", "rocks"].iter().position(|n| n == name);
    assert!(layers.is_sorted_by_key(order));
    ["trees", "bushes", "rocks"].map(|name| {
        let of = table
            .points
            .iter()
            .zip(layers)
            .filter(|(_, layer)| *layer == name);
        of.map(|(point, _)| *point).collect()
    })
}

fn clearance(a: &[Point], b: &[Point]) -> f64 {
    let distances = a
        .iter()
        .flat_map(|p| b.iter().map(|q| (p.x - q.x).hypot(p.y - q.y)));
    distances.fold(f64::INFINITY, f64::min)
}

#[test]
fn layers_keep_clear_and_lose_no_more_than_they_must() {
    let daemon = Daemon::start(&[]);
    let wide = Csv::post(&daemon, &forest(&json!({ "bbox": [-20, -20, 20, 20] })));
    let [trees, bushes, rocks] = by_layer(&wide);
    assert!(trees.len() > 50 && bushes.len() > 200 && rocks.len() > 300);
    assert!(least_distance(&trees) >= 2.0);
    for (a, b, distance) in [
        (&trees, &bushes, 1.5),
        (&trees, &rocks, 0.8),
        (&bushes, &rocks, 0.5),
    ] {
        assert!(clearance(a, b) >= distance);
    }
    // By brute force, away from the border: exactly the points that are too near are missing.
    let inner = |p: &&Point| p.x.abs() < 15.0 && p.y.abs() < 15.0;
    let free = Csv::get(&daemon, "bbox=-15,-15,15,15&spacing=1&seed=2").points;
    let left: Vec<Point> = free
        .iter()
        .filter(inner)
        .filter(|p| clearance(&[**p], &trees) >= 1.5)
        .copied()
        .collect();
    let bushes: Vec<Point> = bushes.iter().filter(inner).copied().collect();
    assert_eq!(sorted(left), sorted(bushes));
}

#[test]
fn chunks_of_layers_are_seamless() {
    let daemon = Daemon::start(&[]);
    let whole = Csv::post(&daemon, &forest(&json!({ "bbox": [-14, 14, 14, 42] })));
    let mut joined = [vec![], vec![], vec![]];
    for x in -2..2 {
        for y in 2..6 {
            let chunk = json!({ "chunk": { "size": 7, "x": x, "y": y } });
            let table = Csv::post(&daemon, &forest(&chunk));
            let origin = format!("{}.0,{}.0", 7 * x, 7 * y);
            assert_eq!(table.answer.header("strew-origin"), origin);
            for (joined, layer) in joined.iter_mut().zip(by_layer(&table)) {
                joined.extend(layer.into_iter().map(|p| p.id));
            }
        }
    }
    for (mut joined, layer) in joined.into_iter().zip(by_layer(&whole)) {
        let mut expected: Vec<_> = layer.iter().map(|p| p.id).collect();
        expected.sort();
        joined.sort();
        assert_eq!(joined, expected);
    }
}

#[test]
fn every_format_names_the_layer_of_each_point() {
    let daemon = Daemon::start(&[]);
    let mut body = forest(&json!({ "circle": { "center": [0, 0], "radius": 9 } }));
    let table = Csv::post(&daemon, &body);
    let layers = &table.columns["layer"];
    let angles = &table.columns["angle"];
    assert_eq!(
        table.columns["variant"]
            .iter()
            .filter(|v| v.is_empty())
            .count(),
        {
            let [trees, bushes, _] = by_layer(&table);
            trees.len() + bushes.len()
        }
    );

    body["format"] = json!("json");
    let document = daemon.post("/v1/points:query", &body).json();
    let points = document["points"].as_array().expect("a list");
    assert_eq!(document["count"], points.len());
    assert_eq!(points.len(), layers.len());
    for ((point, layer), angle) in points.iter().zip(layers).zip(angles) {
        assert_eq!(point["layer"], **layer);
        match angle.parse::<f64>() {
            Ok(angle) => assert_eq!(point["angle"], angle),
            Err(_) => assert!(point["angle"].is_null()),
        }
    }
    let echoed: Vec<&Value> = document["query"]["layers"]
        .as_array()
        .expect("a list")
        .iter()
        .collect();
    assert_eq!(echoed.len(), 3);
    assert_eq!(
        echoed[2]["clear_of"],
        json!({ "trees": 0.8, "bushes": 0.5 })
    );
    assert_eq!(document["tables"].as_array().map(Vec::len), Some(3));

    body["format"] = json!("arrow");
    let answer = daemon.post("/v1/points:query", &body);
    let reader = StreamReader::try_new(Cursor::new(answer.body), None).expect("Arrow");
    let mut row = 0;
    for batch in reader {
        let batch = batch.expect("whole");
        let names = batch.column_by_name("layer").expect("a column");
        let names = names.as_dictionary_opt::<arrow_array::types::Int32Type>();
        let x = batch
            .column_by_name("x")
            .expect("a column")
            .as_primitive::<Float64Type>();
        for i in 0..batch.num_rows() {
            assert_eq!(x.value(i), table.points[row].x);
            if let Some(names) = names {
                let values = names.values().as_string::<i32>();
                let key = names.keys().value(i);
                assert_eq!(
                    values.value(usize::try_from(key).expect("from 0 on")),
                    layers[row]
                );
            }
            row += 1;
        }
        assert!(names.is_some(), "{:?}", batch.schema());
    }
    assert_eq!(row, layers.len());
}

#[test]
fn answers_without_points_are_complete_in_every_format() {
    let daemon = Daemon::start(&[]);
    let away = json!({ "circle": { "center": [1e6, 1e6], "radius": 3 } });
    let none = [
        json!({ "region": { "bbox": [0, 0, 1e-9, 1e-9] }, "spacing": 1 }),
        json!({ "region": { "bbox": [0, 0, 9, 9] }, "spacing": 1, "offset": 1_000_000 }),
        json!({ "region": { "circle": { "center": [0, 0], "radius": 1e-12 } }, "spacing": 1,
                "attributes": ["angle", "variant"], "variants": "a,b" }),
        json!({ "region": { "include": [{ "bbox": [0, 0, 9, 9] }],
                            "exclude": [{ "bbox": [-1, -1, 10, 10] }] }, "spacing": 1 }),
        // Layers whose own regions lie elsewhere.
        json!({ "region": { "bbox": [0, 0, 9, 9] }, "layers": [
            { "name": "a", "spacing": 1, "region": away },
            { "name": "b", "spacing": 1, "seed": 4, "region": away, "clear_of": { "a": 2 } },
            { "name": "c", "spacing": 1, "region": { "bbox": [20, 20, 30, 30] } },
        ] }),
    ];
    for body in none {
        for encoding in Encoding::ALL {
            let mut body = body.clone();
            body["format"] = json!(encoding.name());
            let answer = daemon.post("/v1/points:query", &body);
            let shown = String::from_utf8_lossy(&answer.body);
            assert_eq!(answer.status, 200, "{body}: {shown}");
            assert_eq!(answer.header("strew-count"), "0", "{body}");
            match encoding {
                Encoding::Json => assert_eq!(answer.json()["points"], json!([])),
                Encoding::Csv => assert_eq!(answer.text().lines().count(), 1),
                Encoding::F32 | Encoding::F64 => {
                    assert_eq!(answer.header("content-length"), "0");
                    assert!(answer.body.is_empty());
                }
                Encoding::Arrow => {
                    let reader = StreamReader::try_new(Cursor::new(answer.body), None);
                    let rows = reader.expect("Arrow").map(|b| b.expect("whole").num_rows());
                    assert_eq!(rows.sum::<usize>(), 0);
                }
                Encoding::Npy => assert!(answer.body.starts_with(b"\x93NUMPY")),
                Encoding::Png => assert!(answer.body.starts_with(b"\x89PNG")),
                _ => {}
            }
        }
        if body["offset"].is_number() {
            continue;
        }
        let count = daemon.post("/v1/count", &body);
        assert_eq!(count.json()["count"], 0, "{body}");
    }
}

/// One request has exact numbers of points in each polygon of a collection, and says which one a point is in.
#[test]
fn features_are_layers_with_numbers_of_their_own() {
    let daemon = Daemon::start(&[]);
    let feature = |i: u32| {
        let [x, y] = [f64::from(i % 20) * 4.0, f64::from(i / 20) * 4.0];
        let ring = json!([
            [x, y],
            [x + 3.0, y],
            [x + 3.0, y + 3.0],
            [x, y + 2.0],
            [x, y]
        ]);
        json!({ "type": "Feature", "properties": { "id": format!("p{i}"), "n": i % 7 },
                "geometry": { "type": "Polygon", "coordinates": [ring] } })
    };
    let features: Vec<Value> = (0..200).map(feature).collect();
    let collection = json!({ "type": "FeatureCollection", "features": features });
    let body =
        json!({ "features": { "of": collection, "id": "id", "count": "n" }, "format": "csv" });
    let table = Csv::post(&daemon, &body);
    let of = |name: &str| {
        table.columns["layer"]
            .iter()
            .filter(|layer| *layer == name)
            .count()
    };
    for i in 0..200 {
        assert_eq!(of(&format!("p{i}")), i % 7);
    }
    let count = json!({ "features": { "of": collection }, "count": 5 });
    let answer = daemon.post("/v1/count", &count);
    let counted: Value = serde_json::from_slice(&answer.body).expect("JSON");
    assert_eq!(counted["count"], 1000, "{counted}");
}

/// The bytes of the head of an answer: what nginx holds in a buffer of 4 kB by default (`proxy_buffer_size`).
fn head_bytes(headers: &std::collections::BTreeMap<String, String>) -> usize {
    let lines = headers
        .iter()
        .map(|(name, value)| name.len() + value.len() + 4);
    lines.sum::<usize>() + "HTTP/1.1 200 OK\r\n\r\n".len()
}

#[test]
fn heads_have_4_kb_at_most_whatever_the_query() {
    let daemon = Daemon::built_in();
    let ring = |x: usize| json!([[[x, 0], [x + 2, 0], [x + 2, 2], [x, 2], [x, 0]]]);
    let features: Vec<Value> = (0..1000)
        .map(|i| {
            json!({ "type": "Feature", "properties": { "name": format!("{i:064}") },
                "geometry": { "type": "Polygon", "coordinates": ring(3 * i) } })
        })
        .collect();
    let features =
        json!({ "id": "name", "of": { "type": "FeatureCollection", "features": features } });
    let profiles = [
        "blue",
        "sharp",
        "spaced",
        "step",
        "green",
        "pink",
        "single-peak",
        "lloyd",
    ];
    let layers: Vec<Value> = (0..16)
        .map(|i| {
            let map = if i % 2 == 1 && i < 6 { "m" } else { "s" };
            json!({ "name": format!("{i:064}"), "spacing": 1, "profile": profiles[i / 2], "map": map })
        })
        .collect();
    let variants: serde_json::Map<_, _> = (0..32).map(|i| (format!("{i:064}"), json!(1))).collect();
    let numbers = (1..=16).map(|i| format!("u{i}"));
    let attributes: Vec<String> = ["variant".to_owned()].into_iter().chain(numbers).collect();
    for (query, tables) in [
        (json!({ "features": features, "spacing": 1 }), 1),
        (
            json!({ "region": { "bbox": [0, 0, 9, 9] }, "layers": layers }),
            9,
        ),
        (
            json!({ "region": { "bbox": [0, 0, 9, 9] }, "spacing": 1, "map": "s", "spread": "even", "limit": 2,
                "variants": variants, "attributes": attributes }),
            1,
        ),
    ] {
        for &encoding in Encoding::ALL {
            let mut query = query.clone();
            query["format"] = encoding.name().into();
            let answer = daemon.post("/v1/points:query", &query);
            // Not every format can hold every query.
            if answer.status != 200 {
                assert_ne!(encoding, Encoding::F32, "{}", answer.text());
                continue;
            }
            let bytes = head_bytes(&answer.headers);
            assert!(
                bytes <= 4096,
                "{}: {bytes} {:?}",
                encoding.name(),
                answer.headers
            );
            let digests: Vec<&str> = answer.header("strew-table").split(", ").collect();
            assert!(digests.len() >= tables, "{digests:?}");
            let different: std::collections::BTreeSet<_> = digests.iter().collect();
            assert_eq!(different.len(), digests.len(), "{digests:?}");
        }
    }
}
