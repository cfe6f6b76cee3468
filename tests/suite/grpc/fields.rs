//! Fields over gRPC are those of REST.

use serde_json::json;
use strew::grpc::proto::{
    CountPointsRequest, Field, FieldLine, FieldNoise, FieldPair, FieldParts, FieldPixels,
    FieldPlace, FieldRamp, Layer, ListFieldsRequest, PointSet, StreamPointsRequest, field::Shape,
    point_service_client::PointServiceClient, point_set::Amount,
};

use crate::support::{
    daemon::{Daemon, no_tables},
    fields::{base64, folder, left_half},
    grpc::boxed,
};

fn of(shape: Shape) -> Field {
    Field { shape: Some(shape) }
}

const fn pair(first: f64, second: f64) -> FieldPair {
    FieldPair { first, second }
}

fn set(field: Field) -> PointSet {
    PointSet {
        amount: Some(Amount::Spacing(1.0)),
        seed: Some(7),
        field: Some(field),
        ..PointSet::default()
    }
}

fn counted(set: PointSet) -> CountPointsRequest {
    CountPointsRequest {
        query: Some(StreamPointsRequest {
            region: boxed([0.0, 0.0, 40.0, 40.0]),
            set: Some(set),
            ..StreamPointsRequest::default()
        }),
    }
}

#[tokio::test]
async fn named_and_described_fields_are_those_of_rest() {
    let folder = folder();
    let setting = format!("fields.folder={}", folder.path().display());
    let daemon = Daemon::with_tables(no_tables(), &[&setting]);
    let mut client = PointServiceClient::new(daemon.channel().await);
    let road = strew::grpc::proto::FieldDistance {
        lines: vec![FieldLine {
            vertices: vec![pair(0.0, 0.0), pair(40.0, 40.0)],
        }],
        distances: Some(pair(1.0, 5.0)),
        ..Default::default()
    };
    let mask = FieldPixels {
        png: left_half().into(),
        bbox: Some(strew::grpc::proto::FieldBox {
            min_x: 0.0,
            min_y: 0.0,
            max_x: 40.0,
            max_y: 40.0,
        }),
        ..FieldPixels::default()
    };
    let ramp = FieldRamp {
        from: Some(FieldPlace::default()),
        to: Some(FieldPlace {
            y: 40.0,
            ..FieldPlace::default()
        }),
        shares: Some(pair(1.0, 0.25)),
    };
    let noise = FieldNoise {
        wavelength: 9.0,
        octaves: Some(2),
        ..FieldNoise::default()
    };
    for (message, document) in [
        (of(Shape::Name("left".into())), json!("left")),
        (of(Shape::Constant(0.5)), json!({ "constant": 0.5 })),
        (
            of(Shape::Raster(mask)),
            json!({ "raster": { "png": base64(&left_half()), "bbox": [0, 0, 40, 40] } }),
        ),
        (
            of(Shape::Multiply(FieldParts {
                fields: vec![
                    of(Shape::Distance(road)),
                    of(Shape::Ramp(ramp)),
                    of(Shape::Noise(noise)),
                ],
            })),
            json!({ "multiply": [
                { "distance": { "lines": [[[0, 0], [40, 40]]], "distances": [1, 5] } },
                { "ramp": { "from": [0, 0], "to": [0, 40], "shares": [1, 0.25] } },
                { "noise": { "wavelength": 9, "octaves": 2 } },
            ] }),
        ),
    ] {
        let answer = client
            .count_points(counted(set(message)))
            .await
            .expect("a count")
            .into_inner();
        let body = json!({ "region": { "bbox": [0, 0, 40, 40] }, "spacing": 1, "seed": 7, "field": document });
        let rest = daemon.post("/v1/count", &body).json();
        assert_eq!(rest["count"], answer.count, "{document}");
        let echo = &answer.query.expect("an echo").sets[0];
        assert_eq!(
            rest["query"]["field_digest"],
            *echo.field_digest(),
            "{document}"
        );
        let is_named = echo.set.as_ref().expect("a set").field.is_some();
        assert_eq!(is_named, document.is_string());
    }
}

#[tokio::test]
async fn fields_are_listed_and_their_faults_have_paths() {
    let daemon = Daemon::built_in();
    let mut client = PointServiceClient::new(daemon.channel().await);
    let list = client
        .list_fields(ListFieldsRequest {})
        .await
        .expect("a list")
        .into_inner();
    let found = list.fields.iter().map(|one| (&*one.name, &*one.shape));
    assert_eq!(
        found.collect::<Vec<_>>(),
        [("forest", "multiply"), ("portrait", "max")]
    );
    let noise = of(Shape::Noise(FieldNoise {
        wavelength: -1.0,
        ..FieldNoise::default()
    }));
    let mut request = counted(set(noise.clone()));
    let status = client
        .count_points(request.clone())
        .await
        .expect_err("invalid");
    assert!(
        status
            .message()
            .contains("`query.set.field.noise.wavelength`"),
        "{status:?}"
    );
    let query = request.query.as_mut().expect("a query");
    query.layers = vec![Layer {
        name: "a".into(),
        set: Some(set(noise)),
        ..Layer::default()
    }];
    query.set = None;
    let status = client.count_points(request).await.expect_err("invalid");
    assert!(
        status
            .message()
            .contains("`query.layers[0].set.field.noise.wavelength`"),
        "{status:?}"
    );
    let empty = counted(set(Field { shape: None }));
    let status = client.count_points(empty).await.expect_err("invalid");
    assert!(status.message().contains("`query.set.field`"), "{status:?}");
}
