//! One list of queries, asked by REST, gRPC, the command line and the library: points, attributes, echoes, counts,
//! pages and parts are the same.

#[path = "../../queries/library.rs"]
#[expect(dead_code, reason = "the keys are for random queries")]
mod library;
mod single;

use serde::Serialize;
use serde_json::{Value, json};
use strew::grpc::proto::{
    Encoding, ResolvedSet, SplitPointsRequest, StreamPointsRequest,
    point_service_client::PointServiceClient, point_set::Amount,
};
use strew_encode::Output;
use strew_testkit::http1;
use tonic::transport::Channel;

use library::{library, with};

use crate::support::{
    command::{errors, run},
    daemon::{Daemon, no_tables},
    grpc::{Whole, collect, normal},
    messages::query,
};

/// Queries of the plane as bodies of REST.
const PLANE: &str = r#"
{"region": {"circle": {"center": [100, -3], "radius": 20}}, "count": 777, "seed": 7}
{"region": {"polygon": {"type": "MultiPolygon", "coordinates": [[[[0, 0], [40, 0], [40, 30], [0, 30]], [[10, 10],
 [20, 10], [15, 20]]], [[[50, 0], [60, 0], [50, 25]]]]}}, "density": 1, "attributes": ["angle", "scale", "variant",
 "rank", "u1", "u16"], "scale_range": [0.5, 2], "variants": "oak:3,birch", "warp": 0.5}
{"region": {"include": [{"bbox": [0, 0, 30, 30]}, {"circle": {"center": [100, -3], "radius": 12}}],
 "exclude": [{"bbox": [5, 5, 9, 9]}]}, "min_distance": 0.5, "keep": 0.25, "profile": "spaced"}
{"region": {"chunk": {"size": 32, "x": 1048576, "y": -7}}, "spacing": 1, "seed": 3, "offset": 20, "limit": 900}
{"region": {"bbox": [80, -20, 130, 20]}, "layers": [{"name": "trees", "spacing": 2, "seed": 1,
 "attributes": "angle,variant", "variants": "oak,birch:0.5"}, {"name": "rocks", "density": 1.5,
 "clear_of": {"trees": 0.8}, "region": {"circle": {"center": [100, -3], "radius": 9}}, "attributes": "variant,u2",
 "variants": "flint:2,oak:1"}]}
{"region": {"polygon": {"type": "Polygon", "coordinates": [[[0, 0], [20, 3], [4, 17]]]}}, "min_distance": 0.5,
 "warp": "off", "alpha": "sqrt(3)", "map": "s"}
{"periodic": 1500, "map": "s", "spacing": 2, "seed": 7, "keep": 0.4, "attributes": "rank"}
{"region": {"bbox": [0, 0, 50, 40]}, "map": "s", "spacing": 1, "seed": 9, "attributes": "variant",
 "variants": "oak:3,birch", "spread": "even"}
{"region": {"bbox": [0, 0, 50, 40]}, "map": "s", "spacing": 1, "seed": 9, "variants": "oak:3,birch",
 "spread": "even", "only": "birch", "variant_fields": {"birch": "forest"}}
{"region": {"bbox": [0, 0, 40, 40]}, "spacing": 1, "seed": 7, "field": "forest", "lod": 0.5}
{"region": {"bbox": [0, 0, 20, 20]}, "spacing": 1, "terrain": "forest", "heights": [10, 30], "normals": "on",
 "align": 0.5, "attributes": "angle"}
{"region": {"bbox": [0, 0, 20, 10]}, "spacing": 1, "except": ["2:-1", "8:-1"], "settle": 2, "keep": 0.5}
{"region": {"bbox": [-7.5, -3.25, 12, 9]}, "spacing": 1, "profile": "pattern", "alpha": "3-sqrt(2)"}
{"region": {"bbox": [-7.5, -3.25, 12, 9]}, "spacing": 1, "profile": "pattern", "alpha": "183/112", "seed": 5}
"#;

/// Queries of space.
const SPACE: &str = r#"
{"region": {"ball": {"center": [1, -2, 3], "radius": 4.5}}, "spacing": 0.9, "seed": 6}
{"region": {"bbox": [-3, 2, 100, 4, 9, 107.5]}, "density": 2, "attributes": "rotation,rank"}
{"region": {"prism": {"polygon": {"type": "Polygon", "coordinates": [[[0, 0], [9, 1], [2, 8]]]}, "bottom": -1,
 "top": 2.5}}, "min_distance": 0.5, "profile": "spaced", "keep": 0.5}
{"region": {"chunk": {"size": 5, "x": 3, "y": -2, "z": 1}}, "spacing": 0.9, "seed": 6}
{"region": {"include": [{"ball": {"center": [1, -2, 3], "radius": 4.5}}, {"bbox": [-3, 2, 0, 4, 9, 7.5]}],
 "exclude": [{"ball": {"center": [1, -2, 3], "radius": 2}}]}, "spacing": 0.9, "seed": 6, "lod": 0.5}
{"region": {"ball": {"center": [1, -2, 3], "radius": 4.5}}, "layers": [{"name": "stars", "spacing": 2, "seed": 3},
 {"name": "dust", "spacing": 0.7, "seed": 3, "clear_of": {"stars": 0.9}}]}
{"region": {"ball": {"center": [2, 3, -4], "radius": 6}}, "count": 300, "seed": 5}
"#;

/// A query, and the paths of its dimension.
struct Case {
    body: Value,
    is_space: bool,
}

fn cases() -> impl Iterator<Item = Case> {
    let read = |text: &'static str, is_space| {
        let bodies = serde_json::Deserializer::from_str(text).into_iter();
        bodies.map(move |body| Case {
            body: body.expect("JSON"),
            is_space,
        })
    };
    read(PLANE, false).chain(read(SPACE, true))
}

impl Case {
    /// The answer of REST to a body; `call` is `points`, `count` or `points:split?parts=N`.
    fn post(&self, daemon: &Daemon, call: &str, body: &Value) -> http1::Answer {
        let path = match (self.is_space, call) {
            (true, _) => format!("/v1/space/{call}"),
            (false, "points") => "/v1/points:query".into(),
            (false, _) => format!("/v1/{call}"),
        };
        let answer = daemon.post(&path, body);
        assert_eq!(
            answer.status,
            200,
            "{body}: {}",
            String::from_utf8_lossy(&answer.body)
        );
        answer
    }

    fn points(&self, daemon: &Daemon, format: &str) -> http1::Answer {
        self.post(
            daemon,
            "points",
            &with(&self.body, &[("format", json!(format))]),
        )
    }

    fn request(&self, encoding: Encoding) -> StreamPointsRequest {
        query(&self.body, encoding.into())
    }

    /// The output of a command that reads the query.
    fn run(&self, command: &[&str], body: &Value) -> Vec<u8> {
        let space = self.is_space.then_some("--space");
        let arguments: Vec<&str> = command
            .iter()
            .copied()
            .chain(["--query=-"])
            .chain(space)
            .collect();
        let output = run(&arguments, &body.to_string());
        assert!(output.status.success(), "{body}: {}", errors(&output));
        output.stdout
    }
}

/// A daemon with small blocks, so that a stream has many.
fn daemon() -> Daemon {
    let settings = ["limits.block_bytes=4096", "server.first_byte_seconds=300"];
    Daemon::with_tables(no_tables(), &settings)
}

async fn client(daemon: &Daemon) -> PointServiceClient<Channel> {
    PointServiceClient::new(daemon.channel().await)
}

/// JSON of what REST leaves out if it is empty.
fn some(value: impl Serialize) -> Value {
    match json!(value) {
        Value::Array(items) if items.is_empty() => Value::Null,
        Value::Object(members) if members.is_empty() => Value::Null,
        value => value,
    }
}

/// Fails unless the set of a message is that of an echo of REST.
fn assert_echoed(resolved: &ResolvedSet, echo: &Value, body: &Value) {
    let set = resolved.set.as_ref().expect("set");
    let Some(Amount::Spacing(spacing)) = set.amount else {
        panic!("not the spacing: {resolved:?}");
    };
    let period = resolved.period.as_ref();
    let period =
        period.map(|own| json!({ "p": own.p, "q": own.q, "points": own.points, "side": own.side }));
    let pair = |pair: &strew::grpc::proto::KindDistance| json!({ "kinds": [pair.one, pair.other], "least_distance": pair.least_distance });
    let pairs: Vec<Value> = resolved.kind_distances.iter().map(pair).collect();
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
        ("lod", json!(set.lod)),
        ("settle", json!(set.settle)),
        ("periodic", json!(set.periodic)),
        ("attributes", some(&set.attributes)),
        ("except", some(&set.except)),
        (
            "scale_range",
            json!(set.scale_range.map(|range| [range.min, range.max])),
        ),
        (
            "heights",
            json!(set.heights.map(|heights| [heights.low, heights.high])),
        ),
        ("align", json!(set.align)),
        ("variants", some(&set.variants)),
        ("spread", json!(set.spread)),
        ("only", json!(set.only)),
        ("kinds", some(&resolved.kinds)),
        ("kind_distances", some(pairs)),
        ("field_digest", json!(resolved.field_digest)),
        ("terrain_digest", json!(resolved.terrain_digest)),
        (
            "variant_field_digests",
            some(&resolved.variant_field_digests),
        ),
        ("period", json!(period)),
    ] {
        assert_eq!(normal(&value), normal(&echo[name]), "{name} of {body}");
    }
}

#[tokio::test]
async fn messages_have_the_points_and_echoes_of_rest() {
    let daemon = daemon();
    let mut client = client(&daemon).await;
    let mut blocks = 0;
    for case in cases() {
        let body = &case.body;
        let expected = case.points(&daemon, "json").json();
        let whole = collect(&mut client, case.request(Encoding::Points)).await;
        blocks += whole.blocks.len();
        let points = whole.points();
        assert_eq!(
            normal(&json!(points)),
            normal(&expected["points"]),
            "{body}"
        );
        assert!(points.len() > 50, "{body}");
        let next = expected["next"].as_str().unwrap_or_default();
        assert_eq!(whole.summary.next_cursor, next);
        assert_eq!(whole.header.algorithm, strew_core::ALGORITHM_VERSION);

        let query = whole.header.query.as_ref().expect("set");
        let echo = &expected["query"];
        let bbox = match (&query.bbox, &query.cuboid) {
            (Some(b), None) => json!([b.min_x, b.min_y, b.max_x, b.max_y]),
            (None, Some(b)) => json!([b.min_x, b.min_y, b.min_z, b.max_x, b.max_y, b.max_z]),
            both => panic!("{both:?}"),
        };
        assert_eq!(bbox, echo["bbox"], "{body}");
        let request = case.request(Encoding::Points);
        assert_eq!((query.offset, query.limit), (request.offset, request.limit));
        assert!(query.region == request.region || body["periodic"].is_number());
        let tables = match &expected["tables"] {
            Value::Array(tables) => tables.clone(),
            _ => vec![expected["table"].clone()],
        };
        for (i, resolved) in query.sets.iter().enumerate() {
            let layers = &echo["layers"];
            assert_echoed(
                resolved,
                if layers.is_array() { &layers[i] } else { echo },
                body,
            );
            let set = resolved.set.as_ref().expect("set");
            assert_eq!(tables[i]["digest"], set.table(), "{body}");
            let deltas =
                [resolved.delta_min, resolved.delta_avg].map(|delta| normal(&json!(delta)));
            assert_eq!(
                deltas,
                ["delta_min", "delta_avg"].map(|name| normal(&tables[i][name]))
            );
        }
        let counted = client
            .count_points(request)
            .await
            .expect("a count")
            .into_inner();
        assert_eq!(
            (counted.count, counted.query.as_ref()),
            (whole.header.count, Some(query))
        );
        assert_eq!(counted.digits, counted.count.to_string());
        // A body of REST has no window to count in.
        if body["offset"].is_null() {
            let by_rest = case.post(&daemon, "count", body).json();
            assert_eq!(by_rest["count"], whole.header.count);
        }
    }
    assert!(blocks > 80, "{blocks}");
}

#[tokio::test]
async fn packed_blocks_have_the_bytes_of_rest_and_columns_of_attributes() {
    let daemon = daemon();
    let mut client = client(&daemon).await;
    for case in cases() {
        let body = &case.body;
        let whole = collect(&mut client, case.request(Encoding::Points)).await;
        let points = whole.points();
        let axes = if case.is_space {
            &["x", "y", "z"][..]
        } else {
            &["x", "y"]
        };
        let places = points
            .iter()
            .flat_map(|point| axes.iter().map(|axis| point[axis].as_f64()));
        let places: Vec<f64> = places.map(|place| place.expect("a number")).collect();
        for (encoding, format, size) in [(Encoding::F64Le, "f64", 8), (Encoding::F32Le, "f32", 4)] {
            let packed = collect(&mut client, case.request(encoding)).await;
            // Layers and values beside the place are apart here, and follow it there.
            if packed.header.columns.is_empty() && body["layers"].is_null() {
                assert!(
                    packed.bytes() == case.points(&daemon, format).body,
                    "{format} of {body}"
                );
            }
            let bytes = packed.bytes();
            let read = bytes.chunks(size).map(|number| match number.try_into() {
                Ok(number) => f64::from_le_bytes(number),
                Err(_) => f32::from_le_bytes(number.try_into().expect("four bytes")).into(),
            });
            let read: Vec<f64> = read.collect();
            let corner =
                |whole: &Whole| whole.header.origin.map_or([0.0; 3], |p| [p.x, p.y, p.z()]);
            let [own, origin] = [&whole, &packed].map(corner);
            assert_eq!(read.len(), places.len(), "{body}");
            for (i, (read, place)) in read.iter().zip(&places).enumerate() {
                let axis = i % axes.len();
                let moved = place + own[axis] - origin[axis];
                assert!((read - moved).abs() < 1e-5, "{body}: {read} {moved}");
            }
            assert_eq!(packed.header.columns, whole.header.columns);
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
                rest = &rest[block.data.len() / (size * axes.len())..];
            }
            assert!(rest.is_empty());
        }
    }
}

#[tokio::test]
async fn pages_parts_and_broken_streams_make_the_whole() {
    let daemon = daemon();
    let mut client = client(&daemon).await;
    for case in cases() {
        let body = &case.body;
        let request = case.request(Encoding::Points);
        let whole = collect(&mut client, request.clone()).await;
        let expected = normal(&whole.points().into());
        let expected = expected.as_array().expect("a list");
        // Resumed after the first two blocks, and at the end of each layer.
        let mut came = 0;
        for (i, block) in whole.blocks.iter().enumerate() {
            came += block.id.len();
            let is_last = whole
                .blocks
                .get(i + 1)
                .is_none_or(|next| next.layer != block.layer);
            let limit = request.limit.map(|limit| limit - came as u64);
            // The last block of a layer in space, and that of a period, have none.
            let is_over = limit == Some(0) || (is_last && block.cursor.is_empty());
            if (i > 1 && !is_last) || is_over {
                continue;
            }
            let rest = StreamPointsRequest {
                cursor: block.cursor.clone(),
                offset: 0,
                limit,
                ..request.clone()
            };
            let rest = normal(&collect(&mut client, rest).await.points().into());
            assert_eq!(
                rest.as_array().expect("a list"),
                &expected[came..],
                "block {i} of {body}"
            );
        }
        // Pages, over gRPC and REST in turn.
        let (mut asked, mut points, mut is_call) =
            (with(&case.body, &[("limit", json!(300))]), vec![], true);
        loop {
            is_call = !is_call;
            let (page, next) = if is_call {
                let page = collect(&mut client, query(&asked, Encoding::Points.into())).await;
                (page.points(), page.summary.next_cursor)
            } else {
                let page = case.post(&daemon, "points", &asked).json();
                let next = page["next"].as_str().unwrap_or_default().to_owned();
                (page["points"].as_array().expect("a list").clone(), next)
            };
            points.extend(page);
            if next.is_empty() {
                break;
            }
            (asked["cursor"], asked["offset"]) = (json!(next), json!(0));
        }
        let paged = normal(&points.into());
        let paged = paged.as_array().expect("a list");
        assert_eq!(&paged[..expected.len()], &expected[..], "{body}");
        // Parts.
        let split = SplitPointsRequest {
            request: Some(request),
            parts: 7,
        };
        let split = client
            .split_points(split)
            .await
            .expect("parts")
            .into_inner();
        assert_eq!((split.count, split.parts.len()), (expected.len() as u64, 7));
        let by_rest = case.post(&daemon, "points:split?parts=7", body).json();
        let mut points = vec![];
        for (i, part) in split.parts.into_iter().enumerate() {
            let request = part.request.expect("set");
            let rest = &by_rest["parts"][i];
            assert_eq!(
                (&rest["count"], &rest["query"]["cursor"]),
                (&json!(part.count), &json!(request.cursor))
            );
            let some = collect(&mut client, request).await.points();
            assert_eq!(some.len() as u64, part.count);
            points.extend(some);
        }
        assert_eq!(normal(&points.into()).as_array(), Some(expected), "{body}");
    }
}

/// Whether a query needs tables alone: this library has neither the fields of a daemon nor the mixes that it makes.
fn is_of_library(body: &Value) -> bool {
    let known = |set: &strew_query::Set| {
        set.kinds.is_none() && library().ready.contains_key(&set.entry.key.to_string())
    };
    let query = library().query(body);
    query.is_ok_and(|query| query.sets.iter().all(known))
}

#[test]
fn commands_and_the_library_have_the_bytes_of_rest() {
    let daemon = daemon();
    let mut compared = 0;
    for case in cases() {
        let csv = case.points(&daemon, "csv").body;
        assert!(
            case.run(&["sample", "--format=csv"], &case.body) == csv,
            "{}",
            case.body
        );
        if case.body["offset"].is_null() {
            let count = case.post(&daemon, "count", &case.body).body;
            assert!(
                case.run(&["count", "--json"], &case.body) == count,
                "{}",
                case.body
            );
        }
        if !case.is_space && is_of_library(&case.body) {
            compared += 1;
            let planned = library().planned(&case.body).expect("valid");
            let output = Output {
                relative_to: planned.query.region.corner,
                ..Output::new(strew_encode::Encoding::Csv)
            };
            let answer = planned.answer(&output, 1 << 14).expect("fits");
            let blocks: Vec<_> = answer
                .map(|block| block.expect("written").to_vec())
                .collect();
            assert!(blocks.concat() == csv, "{}", case.body);
        }
    }
    assert!(compared > 5, "{compared}");
}
