//! Invalid requests: fields besides those of queries, and what is refused for its size.

use strew::grpc::proto::{
    Circle, CountPointsRequest, FindNearestRequest, GetPointRequest, Polygon, Polygons, Position,
    SplitPointsRequest, StreamPointsRequest, point_service_client::PointServiceClient,
    point_set::Amount, region::Shape,
};
use tonic::Code;
use tonic_types::StatusExt as _;

use crate::support::{
    daemon::Daemon,
    grpc::{assert_faults, ring, set, shaped, square},
};

#[tokio::test]
async fn fields_besides_the_query_are_checked_too() {
    let daemon = Daemon::start(&[]);
    let mut client = PointServiceClient::new(daemon.channel().await);
    let answer = client
        .count_points(CountPointsRequest { query: None })
        .await;
    assert_faults(&answer.expect_err("no query"), &["query"], &["missing"]);
    let answer = client
        .split_points(SplitPointsRequest {
            query: None,
            parts: 2,
        })
        .await;
    assert_faults(&answer.expect_err("no query"), &["query"], &["missing"]);
    for parts in [0, 10_001] {
        let request = SplitPointsRequest {
            query: Some(square(10.0)),
            parts,
        };
        let answer = client.split_points(request).await;
        assert_faults(&answer.expect_err("a number"), &["parts"], &["1 to 10000"]);
    }
    let corners: Vec<[f64; 2]> = (0..1000)
        .map(|i| [f64::from(i), f64::from(i * i)])
        .collect();
    let rings = vec![ring(&corners)];
    let polygons = Polygons {
        polygons: vec![Polygon { rings }],
    };
    let query = Some(StreamPointsRequest {
        region: shaped(Shape::Polygons(polygons)),
        ..square(10.0)
    });
    let answer = client
        .split_points(SplitPointsRequest {
            query,
            parts: 10_000,
        })
        .await;
    assert_faults(&answer.expect_err("too large"), &["parts"], &["1 to 2"]);

    let at = Some(Position {
        x: 1.0,
        y: 2.0,
        z: None,
    });
    let near = || FindNearestRequest {
        at,
        set: set(Amount::Spacing(1.0)),
        ..FindNearestRequest::default()
    };
    let far = Some(Position {
        x: 1e300,
        y: 0.0,
        z: None,
    });
    let nan = Some(Position {
        x: f64::NAN,
        y: 0.0,
        z: None,
    });
    for (request, fields) in [
        (FindNearestRequest { at: None, ..near() }, vec!["at"]),
        (FindNearestRequest { at: nan, ..near() }, vec!["at"]),
        (FindNearestRequest { at: far, ..near() }, vec!["at"]),
        (
            FindNearestRequest {
                k: Some(0),
                ..near()
            },
            vec!["k"],
        ),
        (
            FindNearestRequest {
                k: Some(10_001),
                ..near()
            },
            vec!["k"],
        ),
        (
            FindNearestRequest {
                radius: Some(-1.0),
                ..near()
            },
            vec!["radius"],
        ),
        (
            FindNearestRequest {
                radius: Some(1e9),
                ..near()
            },
            vec!["radius"],
        ),
        (FindNearestRequest::default(), vec!["at", "set.spacing"]),
        (
            FindNearestRequest {
                set: set(Amount::Count(3)),
                ..near()
            },
            vec!["set.count", "set.spacing"],
        ),
    ] {
        let answer = client.find_nearest(request).await;
        assert_faults(&answer.expect_err("wrong"), &fields, &[]);
    }
    let point = |id: &str| GetPointRequest {
        id: id.into(),
        set: set(Amount::Spacing(1.0)),
    };
    for id in ["", "1", "1:x"] {
        assert_faults(
            &client.get_point(point(id)).await.expect_err("no id"),
            &["id"],
            &["colon"],
        );
    }
    let mut wrong = point("0:0");
    wrong.set.get_or_insert_default().warp = Some(-1.0);
    assert_faults(
        &client.get_point(wrong).await.expect_err("a warp"),
        &["set.warp"],
        &["-1.0"],
    );
    let status = client
        .get_point(point("1:0"))
        .await
        .expect_err("nothing is there");
    assert_eq!(status.code(), Code::NotFound, "{status:?}");
    let info = status.get_details_error_info().expect("details");
    assert_eq!(info.reason, "NO_SUCH_POINT");
}

#[tokio::test]
async fn too_many_rows_are_a_quota_failure() {
    let daemon = Daemon::start(&["limits.max_rows=1000"]);
    let mut client = PointServiceClient::new(daemon.channel().await);
    let circle = shaped(Shape::Circle(Circle {
        center: None,
        radius: 1000.0,
    }));
    let query = Some(StreamPointsRequest {
        region: circle,
        ..square(10.0)
    });
    let status = client.count_points(CountPointsRequest { query }).await;
    let status = status.expect_err("too many");
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
