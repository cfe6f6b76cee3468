//! Every feature of queries: points, attributes, counts, pages and parts are those of REST.

use std::collections::BTreeMap;

use serde::Serialize;
use serde_json::{Value, json};
use strew::grpc::proto::{
    Chunk, Circle, Combined, CountPointsRequest, Encoding, Layer, PointSet, Polygon, Polygons,
    Position, ScaleRange, SplitPointsRequest, StreamPointsRequest,
    point_service_client::PointServiceClient, point_set::Amount, region::Shape,
};
use strew_testkit::http1;

use crate::support::{
    daemon::Daemon,
    grpc::{boxed, collect, normal, ring, shaped},
};

/// A daemon with small blocks, so that a stream has many.
fn daemon() -> Daemon {
    Daemon::start(&["limits.block_bytes=4096"])
}

/// The choices of the attribute `variant`.
fn variants(weights: [(&str, f64); 2]) -> BTreeMap<String, f64> {
    weights.map(|(name, weight)| (name.into(), weight)).into()
}

/// Queries as messages, with the same queries as JSON.
fn queries() -> Vec<(StreamPointsRequest, Value)> {
    let center = Some(Position {
        x: 100.0,
        y: -3.0,
        z: None,
    });
    let circle = |radius| Shape::Circle(Circle { center, radius });
    let outline = [[0.0, 0.0], [40.0, 0.0], [40.0, 30.0], [0.0, 30.0]];
    let hole = [[10.0, 10.0], [20.0, 10.0], [15.0, 20.0]];
    let other = [[50.0, 0.0], [60.0, 0.0], [50.0, 25.0]];
    let polygons = Polygons {
        polygons: vec![
            Polygon {
                rings: vec![ring(&outline), ring(&hole)],
            },
            Polygon {
                rings: vec![ring(&other)],
            },
        ],
    };
    let multi = json!({ "type": "MultiPolygon", "coordinates": [[outline, hole], [other]] });
    let combined = Combined {
        include: vec![
            boxed([0.0, 0.0, 30.0, 30.0]).expect("some"),
            shaped(circle(12.0)).expect("some"),
        ],
        exclude: vec![boxed([5.0, 5.0, 9.0, 9.0]).expect("some")],
    };
    let round = json!({ "circle": { "center": [100, -3], "radius": 12 } });
    let lists = json!({
        "include": [{ "bbox": [0, 0, 30, 30] }, round],
        "exclude": [{ "bbox": [5, 5, 9, 9] }],
    });
    let all = ["angle", "scale", "variant", "rank", "u1", "u16"];
    let trees = Layer {
        name: "trees".into(),
        set: Some(PointSet {
            amount: Some(Amount::Spacing(2.0)),
            seed: Some(1),
            attributes: vec!["angle".into(), "variant".into()],
            variants: variants([("oak", 1.0), ("birch", 0.5)]),
            ..PointSet::default()
        }),
        ..Layer::default()
    };
    let rocks = Layer {
        name: "rocks".into(),
        region: shaped(circle(9.0)),
        clear_of: [("trees".into(), 0.8)].into(),
        set: Some(PointSet {
            amount: Some(Amount::Density(1.5)),
            attributes: vec!["variant".into(), "u2".into()],
            variants: variants([("flint", 2.0), ("oak", 1.0)]),
            ..PointSet::default()
        }),
    };
    vec![
        (
            StreamPointsRequest {
                region: shaped(circle(20.0)),
                set: Some(PointSet {
                    amount: Some(Amount::Count(777)),
                    seed: Some(7),
                    ..PointSet::default()
                }),
                ..StreamPointsRequest::default()
            },
            json!({
                "region": { "circle": { "center": [100, -3], "radius": 20 } },
                "count": 777, "seed": 7,
            }),
        ),
        (
            StreamPointsRequest {
                region: shaped(Shape::Polygons(polygons)),
                set: Some(PointSet {
                    amount: Some(Amount::Density(1.0)),
                    attributes: all.map(Into::into).into(),
                    scale_range: Some(ScaleRange { min: 0.5, max: 2.0 }),
                    variants: variants([("oak", 3.0), ("birch", 1.0)]),
                    warp: Some(0.5),
                    ..PointSet::default()
                }),
                ..StreamPointsRequest::default()
            },
            json!({
                "region": { "polygon": multi }, "density": 1, "attributes": all,
                "scale_range": [0.5, 2], "variants": "oak:3,birch", "warp": 0.5,
            }),
        ),
        (
            StreamPointsRequest {
                region: shaped(Shape::Combined(combined)),
                set: Some(PointSet {
                    amount: Some(Amount::MinDistance(0.5)),
                    keep: Some(0.25),
                    profile: Some("spaced".into()),
                    ..PointSet::default()
                }),
                ..StreamPointsRequest::default()
            },
            json!({
                "region": lists, "min_distance": 0.5, "keep": 0.25, "profile": "spaced",
            }),
        ),
        (
            StreamPointsRequest {
                region: shaped(Shape::Chunk(Chunk {
                    size: 32.0,
                    x: 1 << 20,
                    y: -7,
                })),
                set: Some(PointSet {
                    amount: Some(Amount::Spacing(1.0)),
                    seed: Some(3),
                    ..PointSet::default()
                }),
                offset: 20,
                limit: Some(900),
                ..StreamPointsRequest::default()
            },
            json!({
                "region": { "chunk": { "size": 32, "x": 1 << 20, "y": -7 } },
                "spacing": 1, "seed": 3, "offset": 20, "limit": 900,
            }),
        ),
        (
            StreamPointsRequest {
                region: boxed([80.0, -20.0, 130.0, 20.0]),
                layers: vec![trees, rocks],
                ..StreamPointsRequest::default()
            },
            json!({
                "region": { "bbox": [80, -20, 130, 20] },
                "layers": [
                    {
                        "name": "trees", "spacing": 2, "seed": 1, "attributes": "angle,variant",
                        "variants": "oak,birch:0.5",
                    },
                    {
                        "name": "rocks", "density": 1.5, "clear_of": { "trees": 0.8 },
                        "region": { "circle": { "center": [100, -3], "radius": 9 } },
                        "attributes": "variant,u2", "variants": "flint:2,oak:1",
                    },
                ],
            }),
        ),
    ]
}

/// The answer of REST to a query, in a format.
fn rest(daemon: &Daemon, body: &Value, format: &str) -> Vec<u8> {
    let mut body = body.clone();
    body["format"] = format.into();
    post(daemon, "/v1/points:query", &body)
}

fn post(daemon: &Daemon, path: &str, body: &Value) -> Vec<u8> {
    let json = [("content-type", "application/json")];
    let opened = http1::open_post(daemon.address(), path, &json, body.to_string().as_bytes());
    let status = opened.status;
    let (answer, complete) = opened.finish();
    let text = String::from_utf8_lossy(&answer);
    assert!(status == 200 && complete, "{body}: {text}");
    answer
}

fn document(bytes: &[u8]) -> Value {
    normal(&serde_json::from_slice(bytes).expect("JSON"))
}

/// JSON of what REST leaves out if it is empty.
fn some(value: impl Serialize) -> Value {
    match json!(value) {
        Value::Array(items) if items.is_empty() => Value::Null,
        Value::Object(members) if members.is_empty() => Value::Null,
        value => value,
    }
}

#[tokio::test]
async fn points_attributes_and_echoes_are_those_of_rest() {
    let daemon = daemon();
    let mut client = PointServiceClient::new(daemon.channel().await);
    for (request, body) in queries() {
        let whole = collect(&mut client, request.clone()).await;
        let expected = document(&rest(&daemon, &body, "json"));
        assert!(whole.blocks.len() > 3, "{} blocks", whole.blocks.len());
        let points = normal(&whole.points().into());
        let listed = expected["points"].as_array().expect("a list");
        for (i, (point, expected)) in points
            .as_array()
            .expect("one")
            .iter()
            .zip(listed)
            .enumerate()
        {
            assert_eq!(point, expected, "point {i} of {body}");
        }
        assert_eq!(whole.header.count, listed.len() as u64);
        let next = expected["next"].as_str().unwrap_or_default();
        assert_eq!(whole.summary.next_cursor, next);

        let query = whole.header.query.expect("set");
        assert_eq!(query.region, request.region);
        let echo = &expected["query"];
        let b = query.bbox.expect("set");
        assert_eq!(
            normal(&json!([b.min_x, b.min_y, b.max_x, b.max_y])),
            echo["bbox"]
        );
        assert_eq!(query.offset, request.offset);
        assert_eq!(query.limit, request.limit);
        let digests = match &expected["tables"] {
            Value::Array(tables) => tables.clone(),
            _ => vec![expected["table"].clone()],
        };
        for (i, resolved) in query.sets.iter().enumerate() {
            let echo = match resolved.name.as_str() {
                "" => echo,
                _ => &echo["layers"][i],
            };
            let set = resolved.set.as_ref().expect("set");
            let Some(Amount::Spacing(spacing)) = set.amount else {
                panic!("not the spacing: {resolved:?}");
            };
            let range = set.scale_range.map(|range| json!([range.min, range.max]));
            for (name, value) in [
                ("density", json!(resolved.density)),
                ("least_distance", json!(resolved.least_distance)),
                ("clear_of", some(&resolved.clear_of)),
                ("spacing", json!(spacing)),
                ("profile", json!(set.profile)),
                ("alpha", json!(set.alpha)),
                ("map", json!(set.map)),
                ("seed", json!(set.seed)),
                ("warp", json!(set.warp)),
                ("keep", json!(set.keep)),
                ("attributes", some(&set.attributes)),
                ("scale_range", json!(range)),
                ("variants", some(&set.variants)),
            ] {
                assert_eq!(normal(&value), echo[name], "{name} of {body}");
            }
            let digest = &digests[i];
            assert_eq!(digest["digest"], set.table());
            assert_eq!(normal(&resolved.delta_min.into()), digest["delta_min"]);
            assert_eq!(normal(&resolved.delta_avg.into()), digest["delta_avg"]);
            assert!(resolved.delta_min.is_some());
        }

        let count = CountPointsRequest {
            query: Some(request.clone()),
        };
        let counted = client
            .count_points(count)
            .await
            .expect("a count")
            .into_inner();
        assert_eq!(counted.count, whole.header.count);
        assert_eq!(counted.digits, counted.count.to_string());
        assert_eq!(counted.query, Some(query));
    }
}

#[tokio::test]
async fn packed_blocks_carry_attribute_columns() {
    let daemon = daemon();
    let mut client = PointServiceClient::new(daemon.channel().await);
    for (request, body) in queries() {
        let of = |encoding: Encoding| StreamPointsRequest {
            encoding: encoding.into(),
            ..request.clone()
        };
        let whole = collect(&mut client, of(Encoding::Points)).await;
        let points = whole.points();
        let number = |point: &Value, name: &str| point[name].as_f64().expect("a number");
        let places: Vec<u8> = points
            .iter()
            .flat_map(|point| ["x", "y"].map(|name| number(point, name)))
            .flat_map(f64::to_le_bytes)
            .collect();
        let wide = collect(&mut client, of(Encoding::F64Le)).await;
        assert!(wide.bytes() == places, "{body}");
        let narrow = collect(&mut client, of(Encoding::F32Le)).await;
        let heads = whole.header.columns;
        if heads.is_empty() {
            assert!(narrow.bytes() == rest(&daemon, &body, "f32"), "{body}");
        }
        let origin = narrow.header.origin.expect("set");
        let corner = whole.header.origin.unwrap_or_default();
        let bytes = narrow.bytes();
        let (values, []) = bytes.as_chunks::<4>() else {
            panic!("in part")
        };
        let near = values
            .iter()
            .map(|bytes| f64::from(f32::from_le_bytes(*bytes)));
        let near: Vec<f64> = near.collect();
        assert_eq!(near.len(), 2 * points.len());
        for (near, point) in near.chunks(2).zip(&points) {
            let x = number(point, "x") + corner.x - origin.x;
            let y = number(point, "y") + corner.y - origin.y;
            assert!((near[0] - x).abs() < 1e-5 && (near[1] - y).abs() < 1e-5);
        }
        for packed in [wide, narrow] {
            assert_eq!(packed.header.columns, heads);
            let mut rest = points.as_slice();
            for block in &packed.blocks {
                assert!(block.x.is_empty() && block.id.is_empty());
                for (name, values) in packed.columns(block) {
                    let expected = rest.iter().map(|point| &point[&name]);
                    assert!(
                        values.iter().eq(expected.take(values.len())),
                        "{name} of {body}"
                    );
                }
                let size =
                    if packed.header.query.as_ref().expect("set").encoding() == Encoding::F32Le {
                        8
                    } else {
                        16
                    };
                rest = &rest[block.data.len() / size..];
            }
            assert!(rest.is_empty());
        }
    }
}

#[tokio::test]
async fn a_broken_stream_resumes_and_pages_make_the_whole() {
    let daemon = daemon();
    let mut client = PointServiceClient::new(daemon.channel().await);
    for (request, mut body) in queries() {
        let expected = collect(&mut client, request.clone()).await.points();
        for encoding in [Encoding::Points, Encoding::F64Le, Encoding::F32Le] {
            let of = |request| StreamPointsRequest {
                encoding: encoding.into(),
                ..request
            };
            let whole = collect(&mut client, of(request.clone())).await;
            let counts = whole.blocks.iter().map(|block| match encoding {
                Encoding::F64Le => block.data.len() / 16,
                Encoding::F32Le => block.data.len() / 8,
                _ => block.id.len(),
            });
            let mut came = 0;
            let counts: Vec<usize> = counts.collect();
            for (i, (block, count)) in whole.blocks.iter().zip(counts).enumerate() {
                came += count;
                // Resume after the first two blocks, at the end of each layer, and at the end.
                let layers = whole
                    .blocks
                    .get(i + 1)
                    .map_or(0, |next| next.layer - block.layer);
                if i > 1 && layers == 0 && came < expected.len() {
                    continue;
                }
                let limit = request.limit.map(|limit| limit - came as u64);
                if limit == Some(0) {
                    continue;
                }
                let rest_of = StreamPointsRequest {
                    cursor: block.cursor.clone(),
                    offset: 0,
                    limit,
                    ..request.clone()
                };
                let rest = collect(&mut client, rest_of).await.points();
                assert!(rest == expected[came..], "block {i} of {body}");
            }
            assert_eq!(came, expected.len());
        }

        // Pages, over gRPC and REST in turn.
        let mut request = StreamPointsRequest {
            limit: Some(300),
            ..request
        };
        body["limit"] = 300.into();
        let mut points = vec![];
        loop {
            let page = collect(&mut client, request.clone()).await;
            points.extend(page.points());
            body["cursor"] = page.summary.next_cursor.into();
            body["offset"] = 0.into();
            if body["cursor"] == "" {
                break;
            }
            let page = document(&rest(&daemon, &body, "json"));
            points.extend(page["points"].as_array().expect("a list").clone());
            request.cursor = page["next"].as_str().unwrap_or_default().into();
            request.offset = 0;
            if request.cursor.is_empty() {
                break;
            }
        }
        let (points, expected) = (normal(&points.into()), normal(&expected.into()));
        let [points, expected] = [&points, &expected].map(|v| v.as_array().expect("a list"));
        assert!(points[..expected.len()] == expected[..], "{body}");
    }
}

#[tokio::test]
async fn the_parts_of_a_split_make_the_whole() {
    let daemon = daemon();
    let mut client = PointServiceClient::new(daemon.channel().await);
    for (request, body) in queries() {
        let expected = collect(&mut client, request.clone()).await.points();
        let asked = SplitPointsRequest {
            query: Some(request),
            parts: 7,
        };
        let split = client
            .split_points(asked)
            .await
            .expect("parts")
            .into_inner();
        assert_eq!((split.count, split.parts.len()), (expected.len() as u64, 7));
        let by_rest = document(&post(&daemon, "/v1/points:split?parts=7", &body));
        let mut points = vec![];
        for (part, by_rest) in split
            .parts
            .into_iter()
            .zip(by_rest["parts"].as_array().expect("a list"))
        {
            let request = part.request.expect("set");
            assert_eq!(by_rest["count"].as_f64(), Some(part.count as f64));
            assert_eq!(by_rest["query"]["cursor"], request.cursor);
            let some = collect(&mut client, request).await.points();
            assert_eq!(some.len() as u64, part.count);
            points.extend(some);
        }
        assert!(points == expected, "{body}");
    }
}
