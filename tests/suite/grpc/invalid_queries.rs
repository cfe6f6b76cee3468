//! Invalid queries: the status names the path of each field at fault and its value.

use std::collections::BTreeMap;

use strew::grpc::proto::{
    Chunk, Circle, Combined, CountPointsRequest, Encoding, FindNearestRequest, GetPointRequest,
    Layer, PointSet, Polygon, Polygons, Position, Region, ScaleRange, SplitPointsRequest,
    StreamPointsRequest, point_service_client::PointServiceClient, point_set::Amount,
    region::Shape,
};

use crate::support::{
    daemon::Daemon,
    grpc::{assert_faults, boxed, ring, set, shaped, square},
};

/// A valid query, of which each case replaces a part.
fn base() -> StreamPointsRequest {
    square(10.0)
}

fn within(region: Option<Region>) -> StreamPointsRequest {
    StreamPointsRequest { region, ..base() }
}

/// (request, the fields at fault, texts of the message).
type Case = (StreamPointsRequest, Vec<&'static str>, Vec<&'static str>);

fn cases() -> Vec<Case> {
    let of = |set| StreamPointsRequest { set, ..base() };
    let dense = |amount| of(set(amount));
    let mut cases = vec![
        (of(None), vec!["set.spacing"], vec!["missing", "one of"]),
        (
            of(Some(PointSet::default())),
            vec!["set.spacing"],
            vec!["missing", "one of"],
        ),
    ];
    for bad in [0.0, f64::NAN, f64::INFINITY, 1e300] {
        cases.push((
            dense(Amount::Density(bad)),
            vec!["set.density"],
            vec!["from 1e-200 to 1e"],
        ));
        cases.push((
            dense(Amount::Spacing(bad)),
            vec!["set.spacing"],
            vec!["from 1e-100 to 1e"],
        ));
    }
    let mut case = |change: &dyn Fn(&mut PointSet), fields: &[_], texts: &[_]| {
        let mut request = base();
        change(request.set.get_or_insert_default());
        cases.push((request, fields.into(), texts.into()));
    };
    case(
        &|s| s.profile = Some("mauve".into()),
        &["set.profile"],
        &["mauve", "test"],
    );
    case(
        &|s| s.profile = Some(String::new()),
        &["set.profile"],
        &["test"],
    );
    case(
        &|s| s.alpha = Some("3/2".into()),
        &["set.alpha"],
        &["3/2", "sqrt(3)"],
    );
    case(
        &|s| s.alpha = Some(String::new()),
        &["set.alpha"],
        &["decimal"],
    );
    case(
        &|s| s.table = Some("abc".into()),
        &["set.table"],
        &["64 hexadecimal"],
    );
    case(
        &|s| s.warp = Some(f64::NAN),
        &["set.warp"],
        &["NaN", "finite"],
    );
    let range = |min, max| Some(ScaleRange { min, max });
    case(
        &|s| s.scale_range = range(0.0, 1.0),
        &["set.scale_range"],
        &["without"],
    );
    case(
        &|s| (s.attributes, s.scale_range) = (vec!["scale".into()], range(2.0, 1.0)),
        &["set.scale_range"],
        &["2.0,1.0"],
    );
    let weighted = |name: &str, weight| {
        let variants = [(name.into(), weight)].into();
        move |s: &mut PointSet| {
            (s.attributes, s.variants) = (vec!["variant".into()], BTreeMap::clone(&variants));
        }
    };
    case(&weighted("an oak", 1.0), &["set.variants"], &["an oak"]);
    case(&weighted("oak", -1.0), &["set.variants"], &["oak:-1.0"]);

    let mut case = |change: &dyn Fn(&mut StreamPointsRequest), fields: &[_], texts: &[_]| {
        let mut request = base();
        change(&mut request);
        cases.push((request, fields.into(), texts.into()));
    };
    case(
        &|r| r.encoding = 9,
        &["encoding"],
        &["9", "ENCODING_F32_LE"],
    );
    case(&|r| r.limit = Some(0), &["limit"], &["from 1"]);
    case(&|r| r.cursor = "0".into(), &["cursor"], &["not a cursor"]);
    let all = |r: &mut StreamPointsRequest| {
        (r.encoding, r.region) = (-1, boxed([5.0, 5.0, 1.0, 1.0]));
        r.set = Some(PointSet {
            amount: Some(Amount::Spacing(0.0)),
            profile: Some("mauve".into()),
            ..PointSet::default()
        });
    };
    let fields = ["encoding", "set.spacing", "region.bbox", "set.profile"];
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
        (boxed([0.0; 4]), "region.bbox", "empty"),
        (circle(0.0), "region.circle", "radius"),
        (circle(f64::NAN), "region.circle", "NaN"),
        (polygons(&[]), "region.polygons", "no polygon"),
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
    cases
        .into_iter()
        .map(|(region, field, text)| (within(region), vec![field], vec![text]))
        .collect()
}

fn layers() -> Vec<Case> {
    let trees = || Layer {
        name: "trees".into(),
        set: set(Amount::Spacing(2.0)),
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
    let with_warp = StreamPointsRequest {
        set: Some(PointSet {
            warp: Some(1.0),
            ..PointSet::default()
        }),
        ..of(&[trees()])
    };
    vec![
        (of(&vec![trees(); 17]), vec!["layers"], vec!["16"]),
        (with_warp, vec!["set.warp"], vec!["beside layers"]),
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
            with(&|l| l.set = None),
            vec!["layers[1].set.spacing"],
            vec!["missing"],
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
            with(&|l| (l.set, l.clear_of) = (set(Amount::Count(3)), clear("trees", 1.0))),
            vec!["layers[1].set.count"],
            vec!["not with clear_of"],
        ),
    ]
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
        assert_faults(&status, &fields, &texts);
        let query = Some(request);
        let answer = client
            .count_points(CountPointsRequest {
                query: query.clone(),
            })
            .await;
        let within: Vec<String> = fields.iter().map(|f| format!("query.{f}")).collect();
        let within: Vec<&str> = within.iter().map(String::as_str).collect();
        assert_faults(&answer.expect_err("a wrong request"), &within, &texts);
        let answer = client
            .split_points(SplitPointsRequest { query, parts: 2 })
            .await;
        assert_faults(&answer.expect_err("a wrong request"), &within, &texts);
    }
    let fine = StreamPointsRequest {
        encoding: Encoding::Points.into(),
        ..base()
    };
    assert!(client.stream_points(fine).await.is_ok());
}

/// Some faults show only with the tables at hand.
#[tokio::test]
async fn faults_found_in_planning_name_the_wrong_fields() {
    let daemon = Daemon::start(&[]);
    let mut client = PointServiceClient::new(daemon.channel().await);
    let pink = PointSet {
        amount: Some(Amount::MinDistance(1.0)),
        profile: Some("pink".into()),
        ..PointSet::default()
    };
    let without = |set: &PointSet| StreamPointsRequest {
        set: Some(set.clone()),
        ..base()
    };
    let layer = |name: &str, set: Option<&PointSet>| Layer {
        name: name.into(),
        set: set.or(base().set.as_ref()).cloned(),
        ..Layer::default()
    };
    let of = |layers: [Layer; 2]| StreamPointsRequest {
        set: None,
        layers: layers.into(),
        ..base()
    };
    let clear = Layer {
        clear_of: [("a".to_owned(), 1e9)].into(),
        ..layer("b", None)
    };
    for (request, field) in [
        (without(&pink), "set.min_distance"),
        (
            StreamPointsRequest {
                region: boxed([0.0, 0.0, 1e-300, 1e-300]),
                set: set(Amount::Count(1)),
                ..base()
            },
            "set.count",
        ),
        (
            of([layer("a", None), layer("b", Some(&pink))]),
            "layers[1].set.min_distance",
        ),
        (of([layer("a", None), clear]), "layers[1].clear_of"),
    ] {
        let answer = client.stream_points(request.clone()).await;
        assert_faults(&answer.expect_err("wrong"), &[field], &[]);
        let query = Some(request);
        let answer = client.count_points(CountPointsRequest { query }).await;
        let field = format!("query.{field}");
        assert_faults(&answer.expect_err("wrong"), &[&field], &[]);
    }
    let request = GetPointRequest {
        id: "0:0".into(),
        set: Some(pink.clone()),
    };
    let answer = client.get_point(request).await;
    assert_faults(&answer.expect_err("wrong"), &["set.min_distance"], &[]);
    let request = FindNearestRequest {
        at: Some(Position::default()),
        set: Some(pink),
        ..FindNearestRequest::default()
    };
    let answer = client.find_nearest(request).await;
    assert_faults(&answer.expect_err("wrong"), &["set.min_distance"], &[]);
}
