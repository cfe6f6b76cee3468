//! gRPC has the points of REST, in every encoding.

use serde_json::{Value, json};
use strew::grpc::proto::{
    Ball, Combined, CountPointsRequest, Cube, Cuboid, Encoding, FindNearestRequest,
    GetPointRequest, Layer, PointSet, Polygon, Polygons, Position, Prism, Region,
    SplitPointsRequest, StreamPointsRequest, point_service_client::PointServiceClient,
    point_set::Amount, region::Shape,
};
use tonic::Code;

use crate::support::{
    daemon::Daemon,
    grpc::{assert_faults, collect, ring, shaped},
};

fn set(spacing: f64, seed: u64) -> Option<PointSet> {
    Some(PointSet {
        amount: Some(Amount::Spacing(spacing)),
        seed: Some(seed),
        ..PointSet::default()
    })
}

const fn place(x: f64, y: f64, z: f64) -> Position {
    Position { x, y, z: Some(z) }
}

fn request(shape: Shape) -> StreamPointsRequest {
    StreamPointsRequest {
        region: shaped(shape),
        set: set(0.9, 6),
        ..StreamPointsRequest::default()
    }
}

fn ball() -> Shape {
    Shape::Ball(Ball {
        center: Some(place(1.0, -2.0, 3.0)),
        radius: 4.5,
    })
}

/// Shapes as messages and as regions of a body.
fn shapes() -> Vec<(Shape, Value)> {
    let of_ball = json!({ "ball": { "center": [1, -2, 3], "radius": 4.5 } });
    let cuboid = Shape::Cuboid(Cuboid {
        min_x: -3.0,
        min_y: 2.0,
        min_z: 100.0,
        max_x: 4.0,
        max_y: 9.0,
        max_z: 107.5,
    });
    let bbox = json!({ "bbox": [-3, 2, 100, 4, 9, 107.5] });
    let polygon = Polygon {
        rings: vec![ring(&[[0.0, 0.0], [9.0, 1.0], [2.0, 8.0]])],
    };
    let prism = Shape::Prism(Prism {
        base: Some(Polygons {
            polygons: vec![polygon],
        }),
        bottom: -1.0,
        top: 2.5,
    });
    let base = json!({ "type": "Polygon", "coordinates": [[[0, 0], [9, 1], [2, 8]]] });
    let cube = Shape::Cube(Cube {
        size: 5.0,
        x: 3,
        y: -2,
        z: 1,
    });
    let combined = Shape::Combined(Combined {
        include: vec![
            Region {
                shape: Some(ball()),
            },
            Region {
                shape: Some(cuboid.clone()),
            },
        ],
        exclude: vec![],
    });
    vec![
        (ball(), of_ball.clone()),
        (cuboid, bbox.clone()),
        (
            prism,
            json!({ "prism": { "polygon": base, "bottom": -1, "top": 2.5 } }),
        ),
        (
            cube,
            json!({ "chunk": { "size": 5, "x": 3, "y": -2, "z": 1 } }),
        ),
        (combined, json!({ "include": [of_ball, bbox] })),
    ]
}

#[tokio::test]
async fn volumes_have_the_points_of_rest_in_every_encoding() {
    let daemon = Daemon::built_in();
    let mut client = PointServiceClient::new(daemon.channel().await);
    for (shape, region) in shapes() {
        let body = json!({ "region": region, "spacing": 0.9, "seed": 6 });
        let with = |format: &str| {
            let mut body = body.clone();
            body["format"] = json!(format);
            daemon.post("/v1/space/points", &body)
        };
        let expected = with("json").json();
        let whole = collect(&mut client, request(shape.clone())).await;
        let mut points = vec![];
        for block in &whole.blocks {
            for (i, id) in block.id.iter().enumerate() {
                points.push(json!({ "id": id, "x": block.x[i], "y": block.y[i], "z": block.z[i] }));
            }
        }
        assert!(points.len() > 50);
        assert_eq!(json!(points), expected["points"], "{region}");
        for (encoding, format) in [(Encoding::F64Le, "f64"), (Encoding::F32Le, "f32")] {
            let asked = StreamPointsRequest {
                encoding: encoding.into(),
                ..request(shape.clone())
            };
            let whole = collect(&mut client, asked).await;
            assert_eq!(whole.bytes(), with(format).body, "{region}");
        }
        let count = CountPointsRequest {
            query: Some(request(shape)),
        };
        let counted = client
            .count_points(count)
            .await
            .expect("a count")
            .into_inner();
        assert_eq!(json!(counted.count), expected["count"]);
        let query = counted.query.expect("set");
        assert!(query.cuboid.is_some() && query.bbox.is_none());
    }
}

#[tokio::test]
async fn cursors_parts_and_layers_go_on_where_they_ended() {
    let daemon = Daemon::built_in();
    let mut client = PointServiceClient::new(daemon.channel().await);
    let layer = |name: &str, spacing, clear: &[(&str, f64)]| Layer {
        name: name.into(),
        set: set(spacing, 3),
        clear_of: clear
            .iter()
            .map(|(name, d)| ((*name).to_owned(), *d))
            .collect(),
        ..Layer::default()
    };
    let asked = StreamPointsRequest {
        set: None,
        layers: vec![
            layer("stars", 2.0, &[]),
            layer("dust", 0.7, &[("stars", 0.9)]),
        ],
        ..request(ball())
    };
    let whole = collect(&mut client, asked.clone()).await;
    let ids = |whole: &crate::support::grpc::Whole| -> Vec<String> {
        whole
            .blocks
            .iter()
            .flat_map(|block| block.id.clone())
            .collect()
    };
    let all = ids(&whole);
    let mut paged = vec![];
    let mut cursor = String::new();
    loop {
        let page = StreamPointsRequest {
            limit: Some(100),
            cursor,
            ..asked.clone()
        };
        let part = collect(&mut client, page).await;
        paged.extend(ids(&part));
        cursor = part.summary.next_cursor;
        if cursor.is_empty() {
            break;
        }
    }
    assert_eq!(paged, all);
    let split = SplitPointsRequest {
        query: Some(asked),
        parts: 3,
    };
    let mut parted = vec![];
    for part in client
        .split_points(split)
        .await
        .expect("parts")
        .into_inner()
        .parts
    {
        parted.extend(ids(&collect(&mut client, part.request.expect("set")).await));
    }
    assert_eq!(parted, all);
}

#[tokio::test]
async fn single_points_and_neighbors_have_a_third_coordinate() {
    let daemon = Daemon::built_in();
    let mut client = PointServiceClient::new(daemon.channel().await);
    let own = super::set(0.9, 6);
    let near = FindNearestRequest {
        at: Some(place(5.0, 6.0, 7.0)),
        k: Some(4),
        radius: None,
        set: set(0.9, 6),
    };
    let found = client
        .find_nearest(near)
        .await
        .expect("neighbors")
        .into_inner()
        .neighbors;
    let expected = own.nearest([5.0, 6.0, 7.0], 4).expect("near");
    assert_eq!(found.len(), 4);
    for (told, expected) in found.iter().zip(&expected) {
        assert_eq!(told.id, expected.point.id.to_string());
        assert_eq!(
            (told.z, told.distance),
            (Some(expected.point.z), Some(expected.distance))
        );
        let request = GetPointRequest {
            id: told.id.clone(),
            set: set(0.9, 6),
        };
        let single = client
            .get_point(request)
            .await
            .expect("a point")
            .into_inner();
        assert_eq!(single.point.expect("set").z, told.z);
    }
}

#[tokio::test]
async fn bad_requests_name_the_field() {
    let daemon = Daemon::built_in();
    let mut client = PointServiceClient::new(daemon.channel().await);
    let flat = Region {
        shape: Some(Shape::Circle(strew::grpc::proto::Circle {
            center: None,
            radius: 1.0,
        })),
    };
    let empty = Cuboid {
        max_x: 1.0,
        max_y: 1.0,
        ..Cuboid::default()
    };
    let mixed = Combined {
        include: vec![
            Region {
                shape: Some(ball()),
            },
            flat,
        ],
        exclude: vec![],
    };
    let prism = Prism {
        base: None,
        bottom: 0.0,
        top: 1.0,
    };
    for (shape, field, text) in [
        (
            Shape::Cuboid(empty),
            "region.cuboid",
            "empty: min_z and max_z",
        ),
        (
            Shape::Combined(mixed),
            "region.combined.include[1].circle",
            "plane among volumes",
        ),
        (Shape::Prism(prism), "region.prism", "no polygon"),
    ] {
        let status = client
            .stream_points(request(shape))
            .await
            .expect_err("refused");
        assert_eq!(status.code(), Code::InvalidArgument);
        assert_faults(&status, &[field], &[text]);
    }
    let periodic = StreamPointsRequest {
        set: Some(PointSet {
            amount: Some(Amount::Spacing(1.0)),
            periodic: Some(100),
            ..PointSet::default()
        }),
        ..request(ball())
    };
    let status = client.stream_points(periodic).await.expect_err("refused");
    assert_faults(&status, &["set.periodic"], &["not allowed here"]);
}
