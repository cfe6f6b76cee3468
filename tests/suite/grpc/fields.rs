//! Fields over gRPC are those of REST.

use serde_json::{Value, json};
use strew::grpc::proto::{
    ListFieldsRequest, StreamPointsRequest, point_service_client::PointServiceClient,
};

use crate::support::{
    daemon::{Daemon, no_tables},
    fields::{base64, folder, left_half},
    messages::{message, region},
    table::rows,
};

/// Fields as messages and as documents; `PNG` is a picture.
const FIELDS: &str = r#"
{"name": "left"} | "left"
{"constant": 0.5} | {"constant": 0.5}
{"raster": {"png": "PNG", "bbox": {"max_x": 40, "max_y": 40}}} | {"raster": {"png": "PNG", "bbox": [0, 0, 40, 40]}}
{"distance": {"lines": [{"vertices": [{}, {"first": 40, "second": 40}]}], "distances": {"first": 1, "second": 5}}} | {"distance": {"lines": [[[0, 0], [40, 40]]], "distances": [1, 5]}}
{"ramp": {"from": {}, "to": {"y": 40}, "shares": {"first": 1, "second": 0.25}}} | {"ramp": {"from": [0, 0], "to": [0, 40], "shares": [1, 0.25]}}
{"multiply": {"fields": [{"constant": 0.5}, {"noise": {"wavelength": 9, "octaves": 2}}]}} | {"multiply": [{"constant": 0.5}, {"noise": {"wavelength": 9, "octaves": 2}}]}
"#;

/// Fields of space.
const IN_SPACE: &str = r#"
{"multiply": {"fields": [{"constant": 0.5}, {"noise": {"seed": 1, "wavelength": 9}}]}} | {"multiply": [{"constant": 0.5}, {"noise": {"seed": 1, "wavelength": 9}}]}
{"radial": {"center": {"x": 2, "y": 3, "z": -4}, "radii": {"first": 3, "second": 12}}} | {"radial": {"center": [2, 3, -4], "radii": [3, 12]}}
"#;

#[tokio::test]
async fn named_and_described_fields_are_those_of_rest() {
    let folder = folder();
    let setting = format!("fields.folder={}", folder.path().display());
    let daemon = Daemon::with_tables(no_tables(), &[&setting]);
    let mut client = PointServiceClient::new(daemon.channel().await);
    let square = json!({ "bbox": [0, 0, 40, 40] });
    let ball = json!({ "ball": { "center": [2, 3, -4], "radius": 11 } });
    let plane = rows(FIELDS).map(|row| (row, "/v1/count", &square));
    let space = rows(IN_SPACE).map(|row| (row, "/v1/space/count", &ball));
    for (row, path, place) in plane.chain(space) {
        let read = |text: &str| -> Value {
            serde_json::from_str(&text.replace("PNG", &base64(&left_half()))).expect("JSON")
        };
        let (field, document) = (read(row[0]), read(row[1]));
        let set = json!({ "spacing": 1, "seed": 7, "field": field });
        let request = json!({ "region": region(place), "set": set });
        let answer = client.count_points(message::<StreamPointsRequest>(&request));
        let answer = answer.await.expect("a count").into_inner();
        let body = json!({ "region": place, "spacing": 1, "seed": 7, "field": document });
        let rest = daemon.post(path, &body).json();
        assert_eq!(rest["count"], answer.count, "{document}");
        assert!(answer.count > 0, "{document}");
        let echo = &answer.query.expect("an echo").sets[0];
        let digest = &rest["query"]["field_digest"];
        assert_eq!(digest, echo.field_digest(), "{document}");
        let is_named = echo.set.as_ref().expect("a set").field.is_some();
        assert_eq!(is_named, document.is_string());
    }
    let list = client.list_fields(ListFieldsRequest {}).await;
    let list = list.expect("a list").into_inner().fields;
    let found = list.iter().map(|one| json!([one.name, one.shape]));
    let by_rest = daemon.get("/v1/fields").json()["fields"].clone();
    let by_rest = by_rest.as_array().expect("a list").iter();
    assert!(found.eq(by_rest.map(|one| json!([one["name"], one["shape"]]))));
    assert_eq!(list.len(), 4);
}
