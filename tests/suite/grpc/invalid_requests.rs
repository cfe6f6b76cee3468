//! Invalid requests: the status names the path of each field at fault and its value.

use serde_json::{Value, json};
use strew::grpc::proto::{
    FindNearestRequest, GetMaskRequest, GetPointRequest, ListPeriodsRequest, SplitPointsRequest,
    StreamPointsRequest, point_service_client::PointServiceClient,
};
use tonic::{Code, Status, transport::Channel};
use tonic_types::StatusExt as _;

use crate::support::{daemon::Daemon, grpc::assert_faults, messages::message, table::rows};

/// Queries, the fields at fault, and words of the message. Members replace those of a query that lacks nothing; layers
/// stand in place of its set.
const QUERIES: &str = r#"
# Sets
{"set": null} | set.spacing | missing | one of
{"set": {}} | set.spacing | missing | one of
{"set": {"density": 0}} | set.density | from 1e-200 to 1e
{"set": {"density": "NaN"}} | set.density | from 1e-200 to 1e
{"set": {"density": "Infinity"}} | set.density | from 1e-200 to 1e
{"set": {"density": 1e300}} | set.density | from 1e-200 to 1e
{"set": {"spacing": 0}} | set.spacing | from 1e-100 to 1e
{"set": {"spacing": "NaN"}} | set.spacing | from 1e-100 to 1e
{"set": {"spacing": "Infinity"}} | set.spacing | from 1e-100 to 1e
{"set": {"spacing": 1e300}} | set.spacing | from 1e-100 to 1e
{"set": {"density": 1, "profile": "mauve"}} | set.profile | mauve | test
{"set": {"density": 1, "profile": ""}} | set.profile | test
{"set": {"density": 1, "alpha": "3/2"}} | set.alpha | 3/2 | sqrt(3)
{"set": {"density": 1, "alpha": ""}} | set.alpha | decimal
{"set": {"density": 1, "table": "abc"}} | set.table | 64 hexadecimal
{"set": {"density": 1, "warp": "NaN"}} | set.warp | NaN | finite
{"set": {"density": 1, "scale_range": {"max": 1}}} | set.scale_range | without
{"set": {"density": 1, "attributes": ["scale"], "scale_range": {"min": 2, "max": 1}}} | set.scale_range | 2.0,1.0
{"set": {"density": 1, "attributes": ["variant"], "variants": {"an oak": 1}}} | set.variants | an oak
{"set": {"density": 1, "attributes": ["variant"], "variants": {"oak": -1}}} | set.variants | oak:-1.0
{"set": {"density": 1, "field": {}}} | set.field
{"set": {"density": 1, "field": {"noise": {"wavelength": -1}}}} | set.field.noise.wavelength
{"encoding": 9} | encoding | 9 | ENCODING_F32_LE
{"limit": 0} | limit | from 1
{"cursor": "0"} | cursor | not a cursor
{"encoding": -1, "region": {"bbox": {"min_x": 5}}, "set": {"spacing": 0, "profile": "mauve"}} | encoding, set.spacing, region.bbox, set.profile | reversed
# Regions
{"region": null} | region | missing
{"region": {}} | region | missing
{"region": {"bbox": {"max_x": "NaN", "max_y": 10}}} | region.bbox | max_x is NaN
{"region": {"bbox": {"min_y": "-Infinity", "max_x": 1, "max_y": 1}}} | region.bbox | min_y is -inf
{"region": {"bbox": {"max_x": 1e300, "max_y": 10}}} | region.bbox | too far
{"region": {"bbox": {}}} | region.bbox | empty
{"region": {"circle": {}}} | region.circle | radius
{"region": {"circle": {"radius": "NaN"}}} | region.circle | NaN
{"region": {"polygons": {}}} | region.polygons | no polygon
{"region": {"polygons": {"polygons": [{}]}}} | region.polygons | no polygon
{"region": {"polygons": {"polygons": [{"rings": [{"positions": [{}, {"x": 1, "y": 1}]}]}]}}} | region.polygons | 3
{"region": {"chunk": {}}} | region.chunk | size
{"region": {"chunk": {"size": 1, "x": "9223372036854775807"}}} | region.chunk | too far
{"region": {"combined": {"exclude": [{"circle": {"radius": 1}}]}}} | region.combined.include | missing
{"region": {"combined": {"include": [{"circle": {"radius": 1}}, {"circle": {"radius": -1}}]}}} | region.combined.include[1].circle | -1.0
{"region": {"combined": {"include": [{"circle": {"radius": 1}}], "exclude": [{}]}}} | region.combined.exclude[0] | missing
# Volumes
{"region": {"cuboid": {"max_x": 1, "max_y": 1}}} | region.cuboid | empty: min_z and max_z
{"region": {"combined": {"include": [{"ball": {"center": {"z": 1}, "radius": 1}}, {"circle": {"radius": 1}}]}}} | region.combined.include[1].circle | plane among volumes
{"region": {"prism": {"top": 1}}} | region.prism | no polygon
{"region": {"ball": {"center": {"z": 1}, "radius": 1}}, "set": {"spacing": 1, "periodic": 100}} | set.periodic | not allowed here
# Layers
{"set": {"warp": 1}, "layers": [{"name": "a", "set": {"spacing": 2}}]} | set.warp | beside layers
{"layers": [{"name": "a", "set": {"spacing": 2}}, {"name": "a", "set": {"spacing": 2}}]} | layers[1].name | a
{"layers": [{"set": {"spacing": 2}}]} | layers[0].name | 1 to 64
{"layers": [{"name": "a"}]} | layers[0].set.spacing | missing
{"layers": [{"name": "a", "set": {"spacing": 2}, "region": {"bbox": {}}}]} | layers[0].region.bbox | empty
{"layers": [{"name": "a", "set": {"spacing": 2}, "region": {}}]} | layers[0].region | missing
{"layers": [{"name": "a", "set": {"spacing": 2}, "clear_of": {"grass": 1}}]} | layers[0].clear_of | grass
{"layers": [{"name": "a", "set": {"spacing": 2}}, {"name": "b", "set": {"spacing": 2}, "clear_of": {"a": 0}}]} | layers[1].clear_of | above 0
{"layers": [{"name": "a", "set": {"spacing": 2}}, {"name": "b", "set": {"count": 3}, "clear_of": {"a": 1}}]} | layers[1].set.count | not with clear_of
{"layers": [{"name": "a", "set": {"spacing": 2, "field": {"noise": {"wavelength": -1}}}}]} | layers[0].set.field.noise.wavelength
# What shows only with the tables at hand
{"set": {"min_distance": 1, "profile": "pink"}} | set.min_distance
{"region": {"bbox": {"max_x": 1e-300, "max_y": 1e-300}}, "set": {"count": 1}} | set.count
{"layers": [{"name": "a", "set": {"min_distance": 1, "profile": "pink"}}]} | layers[0].set.min_distance
{"layers": [{"name": "a", "set": {"spacing": 2}}, {"name": "b", "set": {"spacing": 2}, "clear_of": {"a": 1e9}}]} | layers[1].clear_of
"#;

/// Other calls, their requests, the fields at fault, and words of the message.
const CALLS: &str = r#"
CountPoints | {} | region, set.spacing | missing
SplitPoints | {"parts": 2} | request | missing
SplitPoints | {"parts": 0, "request": {"region": {"circle": {"radius": 9}}, "set": {"spacing": 1}}} | parts | 1 to 10000
SplitPoints | {"parts": 10001, "request": {"region": {"circle": {"radius": 9}}, "set": {"spacing": 1}}} | parts | 1 to 10000
FindNearest | {} | at, set.spacing
FindNearest | {"set": {"spacing": 1}} | at
FindNearest | {"at": {"x": "NaN"}, "set": {"spacing": 1}} | at
FindNearest | {"at": {"x": 1e300}, "set": {"spacing": 1}} | at
FindNearest | {"at": {}, "set": {"spacing": 1}, "k": 0} | k
FindNearest | {"at": {}, "set": {"spacing": 1}, "k": 10001} | k
FindNearest | {"at": {}, "set": {"spacing": 1}, "radius": -1} | radius
FindNearest | {"at": {}, "set": {"spacing": 1}, "radius": 1e9} | radius
FindNearest | {"at": {}, "set": {"count": 3}} | set.count, set.spacing
FindNearest | {"at": {}, "set": {"min_distance": 1, "profile": "pink"}} | set.min_distance
GetPoint | {"set": {"spacing": 1}} | id | colon
GetPoint | {"set": {"spacing": 1}, "id": "1"} | id | colon
GetPoint | {"set": {"spacing": 1}, "id": "1:x"} | id | colon
GetPoint | {"set": {"spacing": 1, "warp": -1}, "id": "0:0"} | set.warp | -1.0
GetPoint | {"set": {"min_distance": 1, "profile": "pink"}, "id": "0:0"} | set.min_distance
ListPeriods | {"most": 0} | most
GetMask | {"size": 8} | size | 16 to 512
"#;

/// A query with the members of a case.
fn query(members: &Value) -> StreamPointsRequest {
    let square = json!({ "bbox": { "max_x": 10, "max_y": 10 } });
    let mut query = json!({ "region": square, "set": { "density": 1 } });
    if members.get("layers").is_some() {
        query["set"].take();
    }
    for (name, value) in members.as_object().expect("an object") {
        query[name] = value.clone();
    }
    message(&query)
}

/// Cases that are too large to be written down.
fn large() -> [(StreamPointsRequest, String, Vec<&'static str>); 2] {
    let mut nested = json!({ "circle": { "radius": 1 } });
    for _ in 0..10 {
        nested = json!({ "combined": { "include": [nested] } });
    }
    // Long paths are shortened like everything that is echoed.
    let deepest = format!("region.combined{}", ".include[0].combined".repeat(8));
    let layers = vec![json!({ "name": "a", "set": { "spacing": 2 } }); 17];
    [
        (
            query(&json!({ "region": nested })),
            format!("{}…", &deepest[..120]),
            vec!["8 levels"],
        ),
        (
            query(&json!({ "layers": layers })),
            "layers".into(),
            vec!["16"],
        ),
    ]
}

#[tokio::test]
async fn faults_of_queries_have_paths() {
    let daemon = Daemon::start(&[]);
    let mut client = PointServiceClient::new(daemon.channel().await);
    let read = |row: Vec<&'static str>| {
        let members = serde_json::from_str(row[0]).expect("JSON");
        (query(&members), row[1].to_owned(), row[2..].to_vec())
    };
    for (request, fields, texts) in rows(QUERIES).map(read).chain(large()) {
        let fields: Vec<&str> = fields.split(", ").collect();
        let within: Vec<String> = fields
            .iter()
            .map(|field| format!("request.{field}"))
            .collect();
        let within: Vec<&str> = within.iter().map(String::as_str).collect();
        let refused =
            |status: Option<Status>| status.unwrap_or_else(|| panic!("accepted: {request:?}"));
        let status = refused(client.stream_points(request.clone()).await.err());
        assert_faults(&status, &fields, &texts);
        let status = refused(client.count_points(request.clone()).await.err());
        assert_faults(&status, &fields, &texts);
        let split = SplitPointsRequest {
            request: Some(request.clone()),
            parts: 2,
        };
        let status = refused(client.split_points(split).await.err());
        assert_faults(&status, &within, &texts);
    }
    assert!(client.stream_points(query(&json!({}))).await.is_ok());
}

/// The status of a call that is refused.
async fn refused(client: &mut PointServiceClient<Channel>, call: &str, request: &Value) -> Status {
    let status = match call {
        "CountPoints" => client
            .count_points(message::<StreamPointsRequest>(request))
            .await
            .err(),
        "SplitPoints" => client
            .split_points(message::<SplitPointsRequest>(request))
            .await
            .err(),
        "FindNearest" => client
            .find_nearest(message::<FindNearestRequest>(request))
            .await
            .err(),
        "GetPoint" => client
            .get_point(message::<GetPointRequest>(request))
            .await
            .err(),
        "ListPeriods" => client
            .list_periods(message::<ListPeriodsRequest>(request))
            .await
            .err(),
        _ => client
            .get_mask(message::<GetMaskRequest>(request))
            .await
            .err(),
    };
    status.unwrap_or_else(|| panic!("accepted: {request}"))
}

#[tokio::test]
async fn fields_besides_the_query_are_checked_too() {
    let daemon = Daemon::start(&[]);
    let mut client = PointServiceClient::new(daemon.channel().await);
    for row in rows(CALLS) {
        let request = serde_json::from_str(row[1]).expect("JSON");
        let status = refused(&mut client, row[0], &request).await;
        let fields: Vec<&str> = row[2].split(", ").collect();
        assert_faults(&status, &fields, &row[3..]);
    }
    // Each part would repeat the region.
    let corners: Value = (0..1000).map(|i| json!({ "x": i, "y": i * i })).collect();
    let polygon = json!({ "polygons": [{ "rings": [{ "positions": corners }] }] });
    let request = json!({ "region": { "polygons": polygon }, "set": { "spacing": 1 } });
    let request = json!({ "request": request, "parts": 10_000 });
    let status = refused(&mut client, "SplitPoints", &request).await;
    assert_faults(&status, &["parts"], &["1 to 2"]);
}

#[tokio::test]
async fn too_many_rows_are_a_quota_failure() {
    let daemon = Daemon::start(&["limits.max_rows=1000"]);
    let mut client = PointServiceClient::new(daemon.channel().await);
    let request = json!({ "region": { "circle": { "radius": 1000 } }, "set": { "spacing": 1 } });
    let status = refused(&mut client, "CountPoints", &request).await;
    assert_eq!(status.code(), Code::ResourceExhausted, "{status:?}");
    let details = status.get_error_details();
    let info = details.error_info().expect("details");
    assert_eq!(
        (&*info.reason, &*info.metadata["limit"]),
        ("TOO_MANY_ROWS", "1000")
    );
    let quota = &details.quota_failure().expect("details").violations[0];
    assert_eq!(quota.subject, "limits.max_rows");
}
