//! Pictures that queries include: their cost is known before they are decoded, and bounded.

use serde_json::{Value, json};
use strew::grpc::proto::{
    Field, FieldPixels, FindNearestRequest, PointSet, Position, field::Shape,
    point_service_client::PointServiceClient, point_set::Amount,
};
use strew_testkit::http1;

use crate::support::{
    daemon::Daemon,
    fields::{base64, gray, wide_tiff},
    grpc, sending,
};

/// A query for a few points in a field of a picture.
fn query(picture: &[u8]) -> Value {
    json!({ "region": { "bbox": [0, 0, 8, 8] }, "spacing": 1, "field": field(picture) })
}

fn field(picture: &[u8]) -> Value {
    json!({ "raster": { "png": base64(picture) } })
}

/// A text answer that is made on the threads for short work.
const TEXT: &str = "/v1/points?bbox=0,0,200,200&spacing=1&format=csv&profile=test";

#[test]
fn queries_take_png_alone_and_others_go_on() {
    let daemon = Daemon::start(&[]);
    assert_eq!(daemon.get(TEXT).status, 200);
    let before = daemon.memory_kib("VmHWM");
    // Each inflates to hundreds of gigabytes; one to 200 MB of a body that would be read at once.
    let long = wide_tiff([64, 16_384], 20 << 20);
    let short = wide_tiff([16, 200], 1 << 20);
    assert!(query(&short).to_string().len() < 4 << 10);
    for picture in [&long, &short] {
        for (path, body, name) in [
            ("/v1/fields", field(picture), "field.raster.png"),
            ("/v1/points:query", query(picture), "field.raster.png"),
        ] {
            let body = body.to_string();
            // The attacker's answer is not read until another client has its own.
            let mut waiting = sending::post(daemon.address(), path, &body).expect("sent");
            assert_eq!(daemon.get(TEXT).status, 200);
            let text = sending::answer(&mut waiting);
            assert!(text.starts_with("HTTP/1.1 400"), "{text}");
            assert!(text.contains(name), "{text}");
            assert!(
                text.contains("it is a TIFF") && text.contains("a PNG"),
                "{text}"
            );
            let shown = format!("a png of {} bytes", picture.len());
            assert!(text.contains(&shown), "{text}");
        }
    }
    let taken = daemon.memory_kib("VmHWM") - before;
    assert!(taken < 32 << 10, "{taken} KiB");
}

#[tokio::test(flavor = "multi_thread")]
async fn messages_take_png_alone() {
    let daemon = Daemon::start(&[]);
    let picture = wide_tiff([16, 200], 1 << 20);
    let mut client = PointServiceClient::new(daemon.channel().await);
    let nearest = |picture: &[u8]| FindNearestRequest {
        at: Some(Position {
            x: 4.0,
            y: 4.0,
            z: None,
        }),
        set: Some(PointSet {
            field: Some(Field {
                shape: Some(Shape::Raster(FieldPixels {
                    png: picture.to_vec().into(),
                    ..FieldPixels::default()
                })),
            }),
            ..grpc::set(Amount::Spacing(1.0)).expect("a set")
        }),
        ..FindNearestRequest::default()
    };
    let refused = client.find_nearest(nearest(&picture)).await;
    let status = refused.expect_err("no PNG");
    assert_eq!(status.code(), tonic::Code::InvalidArgument);
    assert!(status.message().contains("it is a TIFF"), "{status:?}");
    let white = client.find_nearest(nearest(&gray([8, 8], 255))).await;
    assert_eq!(white.expect("points").into_inner().neighbors.len(), 1);
}

#[test]
fn pictures_that_cannot_be_decoded_use_up_the_pixels_of_a_query_as_well() {
    let daemon = Daemon::start(&[]);
    let large = gray([1024, 1024], 200);
    assert_eq!(daemon.post("/v1/points:query", &query(&large)).status, 200);
    let layer = |i: usize| {
        let field = field(&large[..large.len() - 20]);
        json!({ "name": format!("l{i}"), "spacing": 1, "field": field })
    };
    let layers: Vec<Value> = (0..9).map(layer).collect();
    let body = json!({ "region": { "bbox": [0, 0, 8, 8] }, "layers": layers });
    let refused = daemon.post("/v1/points:query", &body);
    assert_eq!(refused.status, 400, "{}", refused.text());
    assert!(refused.text().contains("damaged"), "{}", refused.text());
    assert!(
        refused.text().contains("and 0 in all"),
        "{}",
        refused.text()
    );
}

#[test]
fn fields_of_one_address_do_not_push_out_those_of_another() {
    let daemon = Daemon::start(&["fields.max_sent_bytes=2000000"]);
    let sent = daemon.post("/v1/fields", &field(&gray([512, 512], 255)));
    assert_eq!(sent.status, 200, "{}", sent.text());
    let digest = sent.json()["digest"].as_str().expect("a digest").to_owned();
    let mut last = String::new();
    for shade in 0..40 {
        let body = field(&gray([512, 512], shade)).to_string();
        last = sending::digest(daemon.address(), "/v1/fields", &body);
    }
    let points = |field: &str| {
        let path = format!("/v1/points?bbox=0,0,9,9&spacing=1&profile=test&field={field}");
        http1::get(daemon.address(), &path, &[]).status
    };
    assert_eq!(points(&digest), 200);
    // Any client may name what another has sent.
    assert_eq!(points(&last), 200);
}
