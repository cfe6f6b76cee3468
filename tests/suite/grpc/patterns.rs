//! Arrangements, clusters and maps by gRPC are those of REST.

use serde_json::{Value, json};
use strew::grpc::proto::{
    ArrangementRequest, Block, ClustersRequest, GridBox, GridOffset, ListOccurrencesResponse,
    MapRequest, PointSet, list_occurrences_response::Message,
    point_service_client::PointServiceClient, point_set::Amount,
};
use tonic::Code;

use crate::support::daemon::Daemon;

fn request(set: PointSet) -> ArrangementRequest {
    ArrangementRequest {
        set: Some(set),
        offsets: vec![GridOffset { x: 2, y: 1 }, GridOffset { x: 3, y: 3 }],
        grid: Some(GridBox {
            min_x: -90,
            min_y: -80,
            max_x: 100,
            max_y: 70,
        }),
        ..ArrangementRequest::default()
    }
}

#[tokio::test]
async fn occurrences_are_those_of_rest() {
    let daemon = Daemon::start(&[]);
    let mut client = PointServiceClient::new(daemon.channel().await);
    for (amount, parameters) in [(None, ""), (Some(Amount::Spacing(0.5)), "&spacing=0.5")] {
        let set = PointSet {
            amount,
            alpha: Some("sqrt(3)".into()),
            seed: Some(4),
            ..PointSet::default()
        };
        let address = format!(
            "/v1/pattern/arrangements?alpha=sqrt(3)&seed=4&offsets=2,1+3,3&grid=-90,-80,100,70&list=json{parameters}"
        );
        let rest = daemon.get(&address).json();
        let mut stream = client
            .list_occurrences(request(set.clone()))
            .await
            .expect("a stream")
            .into_inner();
        let (mut listed, mut ends) = (vec![], 0);
        while let Some(ListOccurrencesResponse { message }) = stream.message().await.expect("whole")
        {
            match message.expect("one") {
                Message::Header(header) => {
                    assert_eq!(json!(header.listed), rest["listed"]);
                    let facts = header.arrangement.expect("set");
                    assert_eq!(json!(facts.density), rest["arrangement"]["density"]);
                    assert_eq!(json!(facts.area), rest["arrangement"]["area"]);
                    assert_eq!(facts.count, rest["arrangement"]["count"].to_string());
                }
                Message::Block(block) => listed.extend(block.occurrences.into_iter().map(|one| {
                    let at = one.at.expect("set");
                    let mut written = json!({ "at": [at.x, at.y] });
                    if !one.places.is_empty() {
                        let places: Vec<&[f64]> = one.places.chunks(2).collect();
                        written["places"] = json!(places);
                    }
                    written
                })),
                Message::Summary(_) => ends += 1,
            }
        }
        assert_eq!(ends, 1);
        assert_eq!(Value::Array(listed), rest["occurrences"]);
        let found = client.get_arrangement(request(set)).await;
        if parameters.is_empty() {
            assert!(found.expect("an answer").into_inner().exists);
        }
    }
}

#[tokio::test]
async fn clusters_and_maps_are_those_of_rest() {
    let daemon = Daemon::start(&[]);
    let mut client = PointServiceClient::new(daemon.channel().await);
    let rest = daemon
        .get("/v1/pattern/clusters?alpha=1.3&distance=3&most=9")
        .json();
    let request = ClustersRequest {
        alpha: "1.3".into(),
        distance: Some(3.0),
        most: Some(9),
        up_to_symmetry: false,
    };
    let found = client.get_clusters(request).await.expect("an answer");
    let found = found.into_inner();
    assert_eq!(json!(found.larger_share), rest["larger_share"]);
    assert_eq!(json!(found.classes), rest["classes"]);
    let shapes = found.shapes.iter().map(|shape| {
        let points = shape.points.iter().map(|point| [point.x, point.y]);
        json!({
            "points": points.collect::<Vec<_>>(), "class": shape.class, "density": shape.density,
            "share_of_points": shape.share_of_points,
        })
    });
    assert_eq!(Value::Array(shapes.collect()), rest["shapes"]);
    let rest = daemon
        .get("/v1/pattern/map?radius=9&refined=20&block=1,2")
        .json();
    let request = MapRequest {
        radius: Some(9),
        refined: Some(20),
        block: Some(Block { column: 1, row: 2 }),
        ..MapRequest::default()
    };
    let map = client
        .get_map(request)
        .await
        .expect("an answer")
        .into_inner();
    assert_eq!(json!(map.starts), rest["starts"]);
    assert_eq!(json!(map.parents), rest["refined"]["parents"]);
    assert_eq!(json!(map.interval_counts), rest["interval_counts"]);
    let neighbors = map.neighbors.iter().map(|place| [place.x, place.y]);
    assert_eq!(
        json!(neighbors.collect::<Vec<_>>()),
        rest["neighbors"]["offsets"]
    );
}

#[tokio::test]
async fn wrong_requests_name_their_fields() {
    let daemon = Daemon::start(&[]);
    let mut client = PointServiceClient::new(daemon.channel().await);
    let of_alpha = |alpha: &str| {
        request(PointSet {
            alpha: Some(alpha.into()),
            ..PointSet::default()
        })
    };
    let mut nothing = request(PointSet::default());
    nothing.offsets.clear();
    let mut far = request(PointSet::default());
    far.offsets[0].x = 1 << 53;
    for (request, field) in [
        (of_alpha("1"), "set.alpha"),
        (of_alpha("2"), "set.alpha"),
        (nothing, "offsets"),
        (far, "offsets"),
        (
            request(PointSet {
                keep: Some(0.5),
                ..PointSet::default()
            }),
            "set.keep",
        ),
    ] {
        let status = client.get_arrangement(request).await.expect_err(field);
        assert_eq!(status.code(), Code::InvalidArgument, "{status}");
        assert!(status.message().contains(&format!("`{field}`")), "{status}");
    }
    let mut everywhere = request(PointSet::default());
    everywhere.grid = None;
    let status = client
        .list_occurrences(everywhere)
        .await
        .expect_err("no box");
    assert!(status.message().contains("`grid`: missing"), "{status}");
    let huge = MapRequest {
        radius: Some(1_000_000),
        ..MapRequest::default()
    };
    let status = client.get_map(huge).await.expect_err("too large");
    assert!(status.message().contains("from 0 to 1024"), "{status}");
    let clusters = ClustersRequest {
        alpha: "2".into(),
        ..ClustersRequest::default()
    };
    let status = client.get_clusters(clusters).await.expect_err("no pattern");
    assert!(status.message().contains("`alpha`"), "{status}");
}
