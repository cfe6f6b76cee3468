//! Invalid requests: the status names the path of each field at fault and its value.

use strew::grpc::proto::{
    Chunk, Circle, Combined, CountPointsRequest, Encoding, FindNearestRequest, GetPointRequest,
    Layer, Polygon, Polygons, Position, Region, ScaleRange, SplitPointsRequest,
    StreamPointsRequest, Variant, find_nearest_request, get_point_request, layer,
    point_service_client::PointServiceClient, region::Shape, stream_points_request::Amount,
};
use tonic::{Code, Status};
use tonic_types::StatusExt as _;

use crate::support::{
    daemon::Daemon,
    grpc::{boxed, ring, shaped},
};

fn request(region: Option<Region>, amount: Option<Amount>) -> StreamPointsRequest {
    StreamPointsRequest {
        region,
        amount,
        profile: Some("test".into()),
        ..StreamPointsRequest::default()
    }
}

/// A valid query, of which each case replaces a part.
fn base() -> StreamPointsRequest {
    request(boxed([0.0, 0.0, 10.0, 10.0]), Some(Amount::Density(1.0)))
}

/// (request, the fields at fault, texts of the message).
type Case = (StreamPointsRequest, Vec<&'static str>, Vec<&'static str>);

fn cases() -> Vec<Case> {
    let dense = |amount| request(base().region, Some(amount));
    let mut cases = vec![
        (
            request(base().region, None),
            vec!["density"],
            vec!["missing", "spacing"],
        ),
        (
            dense(Amount::MinDistance(0.0)),
            vec!["min_distance"],
            vec!["1e-100"],
        ),
        (dense(Amount::Count(0)), vec!["count"], vec!["from 1"]),
    ];
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e300, 1e-300] {
        cases.push((
            dense(Amount::Density(bad)),
            vec!["density"],
            vec!["1e-200 to 1e200"],
        ));
        cases.push((
            dense(Amount::Spacing(bad)),
            vec!["spacing"],
            vec!["1e-100 to 1e100"],
        ));
    }
    let mut case = |change: &dyn Fn(&mut StreamPointsRequest), fields: &[_], texts: &[_]| {
        let mut request = base();
        change(&mut request);
        cases.push((request, fields.into(), texts.into()));
    };
    case(
        &|r| r.profile = Some("mauve".into()),
        &["profile"],
        &["mauve", "test"],
    );
    case(
        &|r| r.profile = Some(String::new()),
        &["profile"],
        &["test"],
    );
    case(
        &|r| r.alpha = Some("3/2".into()),
        &["alpha"],
        &["3/2", "sqrt(3)"],
    );
    case(&|r| r.alpha = Some(String::new()), &["alpha"], &["decimal"]);
    case(&|r| r.map = Some("xl".into()), &["map"], &["xl"]);
    case(
        &|r| r.table = Some("abc".into()),
        &["table"],
        &["64 hexadecimal"],
    );
    case(&|r| r.warp = Some(3.0), &["warp"], &["3.0"]);
    case(&|r| r.warp = Some(f64::NAN), &["warp"], &["NaN"]);
    case(&|r| r.keep = Some(0.0), &["keep"], &["1e-6 to 1"]);
    case(
        &|r| r.encoding = 9,
        &["encoding"],
        &["9", "ENCODING_F32_LE"],
    );
    case(&|r| r.limit = Some(0), &["limit"], &["from 1"]);
    case(&|r| r.cursor = "0".into(), &["cursor"], &["not a cursor"]);
    case(
        &|r| r.attributes = vec!["size".into()],
        &["attributes"],
        &["size", "angle"],
    );
    case(
        &|r| r.attributes = vec!["variant".into()],
        &["variants"],
        &["missing"],
    );
    let range = |min, max| Some(ScaleRange { min, max });
    case(
        &|r| r.scale_range = range(0.0, 1.0),
        &["scale_range"],
        &["without"],
    );
    let scaled = |r: &mut StreamPointsRequest| {
        (r.attributes, r.scale_range) = (vec!["scale".into()], range(2.0, 1.0));
    };
    case(&scaled, &["scale_range"], &["2.0,1.0"]);
    let varied = |r: &mut StreamPointsRequest| {
        r.attributes = vec!["variant".into()];
        r.variants = vec![Variant {
            name: "an oak".into(),
            weight: None,
        }];
    };
    case(&varied, &["variants"], &["an oak"]);
    let all = |r: &mut StreamPointsRequest| {
        (r.encoding, r.profile) = (-1, Some("mauve".into()));
        (r.region, r.amount) = (boxed([5.0, 5.0, 1.0, 1.0]), Some(Amount::Spacing(0.0)));
    };
    let fields = ["encoding", "region.bbox", "spacing", "profile"];
    case(&all, &fields, &["reversed"]);
    cases
}

fn regions() -> Vec<Case> {
    let fine = || boxed([0.0, 0.0, 1.0, 1.0]).expect("some");
    let polygons = |vertices: &[&[[f64; 2]]]| {
        let rings = vertices.iter().map(|vertices| ring(vertices)).collect();
        shaped(Shape::Polygons(Polygons {
            polygons: vec![Polygon { rings }],
        }))
    };
    let circle = |radius| {
        shaped(Shape::Circle(Circle {
            center: None,
            radius,
        }))
    };
    let chunk = |size, x| shaped(Shape::Chunk(Chunk { size, x, y: 0 }));
    let combined = |include, exclude| shaped(Shape::Combined(Combined { include, exclude }));
    let deep = (0..10).fold(fine(), |inner, _| {
        combined(vec![inner], vec![]).expect("some")
    });
    // Long paths are shortened like everything that is echoed.
    let deepest = format!("region.combined{}", ".include[0].combined".repeat(8));
    let deepest = format!("{}…", &deepest[..120]);
    let cases: Vec<(_, &'static str, &'static str)> = vec![
        (None, "region", "missing"),
        (Some(Region { shape: None }), "region", "missing"),
        (
            boxed([0.0, 0.0, f64::NAN, 10.0]),
            "region.bbox",
            "max_x is NaN",
        ),
        (
            boxed([0.0, f64::NEG_INFINITY, 1.0, 1.0]),
            "region.bbox",
            "min_y is -inf",
        ),
        (boxed([0.0, 0.0, 1e300, 10.0]), "region.bbox", "too far"),
        (boxed([10.0, 0.0, 0.0, 10.0]), "region.bbox", "reversed"),
        (boxed([0.0, 0.0, 0.0, 10.0]), "region.bbox", "empty"),
        (boxed([0.0; 4]), "region.bbox", "empty"),
        (circle(0.0), "region.circle", "radius"),
        (circle(f64::NAN), "region.circle", "NaN"),
        (polygons(&[]), "region.polygons", "ring"),
        (polygons(&[&[[0.0; 2], [1.0; 2]]]), "region.polygons", "3"),
        (
            shaped(Shape::Polygons(Polygons::default())),
            "region.polygons",
            "no polygon",
        ),
        (chunk(0.0, 0), "region.chunk", "size"),
        (chunk(1.0, i64::MAX), "region.chunk", "too far"),
        (
            combined(vec![], vec![fine()]),
            "region.combined.include",
            "missing",
        ),
        (
            combined(vec![fine(), circle(-1.0).expect("some")], vec![]),
            "region.combined.include[1].circle",
            "-1.0",
        ),
        (
            combined(vec![fine()], vec![Region { shape: None }]),
            "region.combined.exclude[0]",
            "missing",
        ),
        (Some(deep), deepest.leak(), "8 levels"),
    ];
    let amount = base().amount;
    cases
        .into_iter()
        .map(|(region, field, text)| (request(region, amount), vec![field], vec![text]))
        .collect()
}

fn layers() -> Vec<Case> {
    let trees = || Layer {
        name: "trees".into(),
        amount: Some(layer::Amount::Spacing(2.0)),
        profile: Some("test".into()),
        ..Layer::default()
    };
    let of = |layers: &[Layer]| StreamPointsRequest {
        region: base().region,
        layers: layers.into(),
        ..StreamPointsRequest::default()
    };
    let with = |change: &dyn Fn(&mut Layer)| {
        let mut rocks = Layer {
            name: "rocks".into(),
            ..trees()
        };
        change(&mut rocks);
        of(&[trees(), rocks])
    };
    let clear = |name: &str, distance| [(name.to_owned(), distance)].into();
    let amount = |amount| move |layer: &mut Layer| layer.amount = amount;
    let with_seed = StreamPointsRequest {
        seed: Some(3),
        ..of(&[trees()])
    };
    vec![
        (of(&vec![trees(); 17]), vec!["layers"], vec!["16"]),
        (with_seed, vec!["seed"], vec!["beside layers"]),
        (
            of(&[trees(), trees()]),
            vec!["layers[1].name"],
            vec!["trees"],
        ),
        (
            with(&|l| l.name = String::new()),
            vec!["layers[1].name"],
            vec!["1 to 64"],
        ),
        (
            with(&amount(None)),
            vec!["layers[1].density"],
            vec!["missing"],
        ),
        (
            with(&amount(Some(layer::Amount::Spacing(-1.0)))),
            vec!["layers[1].spacing"],
            vec!["-1.0"],
        ),
        (
            with(&|l| l.profile = Some("x".into())),
            vec!["layers[1].profile"],
            vec!["x"],
        ),
        (
            with(&|l| l.region = boxed([1.0; 4])),
            vec!["layers[1].region.bbox"],
            vec!["empty"],
        ),
        (
            with(&|l| l.region = Some(Region::default())),
            vec!["layers[1].region"],
            vec!["missing"],
        ),
        (
            with(&|l| l.clear_of = clear("grass", 1.0)),
            vec!["layers[1].clear_of"],
            vec!["grass"],
        ),
        (
            with(&|l| l.clear_of = clear("trees", 0.0)),
            vec!["layers[1].clear_of"],
            vec!["above 0"],
        ),
        (
            with(&|l| l.clear_of = clear("rocks", 1.0)),
            vec!["layers[1].clear_of"],
            vec!["earlier"],
        ),
    ]
}

/// Fails unless a status names exactly these fields, and its message contains these texts.
fn check(status: &Status, fields: &[&str], texts: &[&str]) {
    assert_eq!(status.code(), Code::InvalidArgument, "{status:?}");
    let details = status.get_error_details();
    let info = details.error_info().expect("details");
    assert_eq!(
        (info.reason.as_str(), info.domain.as_str()),
        ("INVALID_QUERY", "strew")
    );
    let violations = &details.bad_request().expect("details").field_violations;
    let named: Vec<&str> = violations.iter().map(|v| v.field.as_str()).collect();
    assert_eq!(named, fields, "{status:?}");
    for text in texts.iter().chain(fields) {
        let message = status.message();
        assert!(message.contains(text), "no `{text}`: {message}");
    }
}

#[tokio::test]
async fn faults_name_the_wrong_fields() {
    let daemon = Daemon::start(&[]);
    let mut client = PointServiceClient::new(daemon.channel().await);
    for (request, fields, texts) in [cases(), regions(), layers()].concat() {
        let answer = client.stream_points(request.clone()).await;
        let status = answer
            .err()
            .unwrap_or_else(|| panic!("accepted: {request:?}"));
        check(&status, &fields, &texts);
        let query = Some(request);
        let answer = client
            .count_points(CountPointsRequest {
                query: query.clone(),
            })
            .await;
        let within: Vec<String> = fields.iter().map(|f| format!("query.{f}")).collect();
        let within: Vec<&str> = within.iter().map(String::as_str).collect();
        check(&answer.expect_err("a wrong request"), &within, &texts);
        let answer = client
            .split_points(SplitPointsRequest { query, parts: 2 })
            .await;
        check(&answer.expect_err("a wrong request"), &within, &texts);
    }
    let fine = StreamPointsRequest {
        encoding: Encoding::Points.into(),
        ..base()
    };
    assert!(client.stream_points(fine).await.is_ok());
}

#[tokio::test]
async fn fields_besides_the_query_are_checked_too() {
    let daemon = Daemon::start(&[]);
    let mut client = PointServiceClient::new(daemon.channel().await);
    let answer = client
        .count_points(CountPointsRequest { query: None })
        .await;
    check(&answer.expect_err("no query"), &["query"], &["missing"]);
    let answer = client
        .split_points(SplitPointsRequest {
            query: None,
            parts: 2,
        })
        .await;
    check(&answer.expect_err("no query"), &["query"], &["missing"]);
    for parts in [0, 10_001] {
        let request = SplitPointsRequest {
            query: Some(base()),
            parts,
        };
        let answer = client.split_points(request).await;
        check(&answer.expect_err("a number"), &["parts"], &["1 to 10000"]);
    }
    let corners: Vec<[f64; 2]> = (0..1000)
        .map(|i| [f64::from(i), f64::from(i * i)])
        .collect();
    let rings = vec![ring(&corners)];
    let polygons = Polygons {
        polygons: vec![Polygon { rings }],
    };
    let query = Some(request(shaped(Shape::Polygons(polygons)), base().amount));
    let answer = client
        .split_points(SplitPointsRequest {
            query,
            parts: 10_000,
        })
        .await;
    check(&answer.expect_err("too large"), &["parts"], &["1 to 2"]);

    let at = Some(Position { x: 1.0, y: 2.0 });
    let spacing = Some(find_nearest_request::Amount::Spacing(1.0));
    let near = || FindNearestRequest {
        at,
        amount: spacing,
        ..FindNearestRequest::default()
    };
    let far = Some(Position { x: 1e300, y: 0.0 });
    let nan = Some(Position {
        x: f64::NAN,
        y: 0.0,
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
        (FindNearestRequest::default(), vec!["at", "density"]),
    ] {
        let answer = client.find_nearest(request).await;
        check(&answer.expect_err("wrong"), &fields, &[]);
    }
    let spacing = Some(get_point_request::Amount::Spacing(1.0));
    let point = |id: &str| GetPointRequest {
        id: id.into(),
        amount: spacing,
        ..GetPointRequest::default()
    };
    for id in ["", "1", "1:x"] {
        check(
            &client.get_point(point(id)).await.expect_err("no id"),
            &["id"],
            &["colon"],
        );
    }
    let wrong = GetPointRequest {
        warp: Some(-1.0),
        ..point("0:0")
    };
    check(
        &client.get_point(wrong).await.expect_err("a warp"),
        &["warp"],
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
    let query = Some(request(circle, base().amount));
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
