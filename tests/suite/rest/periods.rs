//! Periodic sets: one exact period that tiles, by REST, gRPC and the command line.

use serde_json::{Value, json};
use strew::grpc::proto::{
    GetMaskRequest, ListPeriodsRequest, point_service_client::PointServiceClient,
};

use crate::support::{command, csv::Csv, daemon::Daemon};

/// The smallest period of the smallest default map, with a side of 142.
const TILE: &str = "periodic=5000&map=s&spacing=2&seed=7";

/// The least distance between two points whose coordinates are taken modulo a side.
fn least_distance(points: &[[f64; 2]], side: f64) -> f64 {
    let mut least = f64::INFINITY;
    for (i, a) in points.iter().enumerate() {
        for b in &points[..i] {
            let d = [0, 1].map(|i| (a[i] - b[i]) - side * ((a[i] - b[i]) / side).round());
            least = least.min(d[0] * d[0] + d[1] * d[1]);
        }
    }
    least.sqrt()
}

#[test]
fn a_period_tiles_and_says_what_it_is() {
    let daemon = Daemon::built_in();
    let whole = Csv::get(&daemon, TILE);
    assert_eq!(whole.points.len(), 5041);
    let places: Vec<[f64; 2]> = whole.points.iter().map(|p| [p.x, p.y]).collect();
    assert!(places.iter().flatten().all(|v| (0.0..142.0).contains(v)));
    let count = daemon.get(&format!("/v1/count?{TILE}")).json();
    assert_eq!(count["count"], 5041);
    let query = &count["query"];
    let period = json!({ "p": 183, "q": 112, "points": 5041, "side": 142.0 });
    assert_eq!(query["period"], period);
    assert_eq!(query["periodic"], 5000);
    assert_eq!(query["bbox"], json!([0.0, 0.0, 142.0, 142.0]));
    // Formats without a query say it in the head, the command line in its words.
    let told: Value = serde_json::from_str(whole.answer.header("strew-period")).expect("JSON");
    assert_eq!(told, period);
    let plain = daemon.get("/v1/points?bbox=0,0,9,9&spacing=1");
    assert_eq!(plain.header("strew-period"), "");
    let args = "sample --periodic 5000 --map s --spacing 2 --seed 7 --format csv --output -";
    let said = command::errors(&command::run(&args.split(' ').collect::<Vec<_>>(), ""));
    assert!(
        said.contains("map s, period 183/112 of 5041 points and side 142, "),
        "{said}"
    );
    // Across the seam points keep the distance that is guaranteed.
    let promised = query["least_distance"].as_f64().expect("a number");
    let least = least_distance(&places, 142.0);
    assert!(promised > 1.0 && promised <= least, "{promised} {least}");
    // A density leads to the same side.
    let dense = Csv::get(&daemon, &TILE.replace("spacing=2", "density=0.25"));
    assert_eq!(dense.points, whole.points);
    // As JSON, in a body.
    let body = json!({ "periodic": 5000, "map": "s", "spacing": 2, "seed": 7 });
    let posted = daemon.post("/v1/points:query", &body).json();
    assert_eq!(posted["query"]["period"], period);
    assert_eq!(posted["points"].as_array().map(Vec::len), Some(5041));
}

#[test]
fn pages_parts_and_formats_agree_with_the_whole() {
    let daemon = Daemon::built_in();
    for more in [
        "",
        "&keep=0.4",
        "&variants=oak:3,birch:1&spread=even&only=birch",
    ] {
        let query = format!("{TILE}{more}&attributes=angle,rank");
        let whole = Csv::get(&daemon, &query);
        let part = Csv::get(&daemon, &format!("{query}&offset=500&limit=100"));
        assert_eq!(part.points, whole.points[500..600]);
        assert_eq!(part.columns["rank"], whole.columns["rank"][500..600]);
        let cursor = part.answer.header("strew-next").to_owned();
        let rest = Csv::get(&daemon, &format!("{query}&cursor={cursor}"));
        assert_eq!(rest.points, whole.points[600..]);
        let mut body = json!({
            "periodic": 5000, "map": "s", "spacing": 2, "seed": 7, "attributes": ["angle", "rank"]
        });
        if more.contains("keep") {
            body["keep"] = json!(0.4);
        }
        if more.contains("only") {
            body["variants"] = json!({ "oak": 3, "birch": 1 });
            body["spread"] = json!("even");
            body["only"] = json!("birch");
        }
        let split = daemon.post("/v1/points:split?parts=4", &body).json();
        let parts = split["parts"].as_array().expect("a list").clone();
        assert_eq!(parts.len(), 4);
        let points = parts
            .iter()
            .flat_map(|part| Csv::post(&daemon, &part["query"]).points);
        assert_eq!(points.collect::<Vec<_>>(), whole.points);
    }
    // Packed, with offsets from the corner of the period.
    let whole = Csv::get(&daemon, TILE);
    let packed = daemon.get(&format!("/v1/points?{TILE}&format=f64"));
    let numbers = packed
        .body
        .as_chunks::<8>()
        .0
        .iter()
        .map(|v| f64::from_le_bytes(*v));
    let places = whole.points.iter().flat_map(|p| [p.x, p.y]);
    assert!(numbers.eq(places));
    let near = daemon.get(&format!("/v1/points?{TILE}&format=f32"));
    assert_eq!(near.header("strew-origin"), "0.0,0.0");
    assert_eq!(near.body.len(), 8 * 5041);
    for format in ["png&size=64", "svg", "arrow", "npy", "ply", "geojson"] {
        let answer = daemon.get(&format!("/v1/points?{TILE}&format={format}"));
        assert_eq!(answer.status, 200, "{format}");
    }
}

#[test]
fn points_of_a_period_are_found_by_their_ids() {
    let daemon = Daemon::built_in();
    let whole = Csv::get(&daemon, &format!("{TILE}&attributes=rank"));
    for i in [0, 1234, 5040] {
        let id = whole.points[i].id;
        let found = daemon
            .get(&format!("/v1/points/{id}?{TILE}&attributes=rank"))
            .json();
        assert_eq!(found["point"]["x"], whole.points[i].x);
        assert_eq!(found["point"]["rank"].to_string(), whole.columns["rank"][i]);
        assert_eq!(found["query"]["period"]["side"], 142.0);
    }
    assert_eq!(daemon.get(&format!("/v1/points/-3:5?{TILE}")).status, 404);
}

#[test]
fn fields_are_looked_at_within_the_period() {
    let daemon = Daemon::built_in();
    // A disk around the corner of the period, whose four quarters repeat.
    let quarter = |x: i32, y: i32| json!({ "radial": { "center": [x, y], "radii": [40, 40.001] } });
    let field =
        json!({ "max": [quarter(0, 0), quarter(142, 0), quarter(0, 142), quarter(142, 142)] });
    let body = json!({
        "periodic": 5000, "map": "s", "spacing": 2, "seed": 7, "field": field, "format": "csv"
    });
    let answer = daemon.post("/v1/points:query", &body);
    let csv = Csv::of(answer);
    let whole = Csv::get(&daemon, TILE);
    let inside = |p: &&strew_core::Point| {
        let d = [p.x, p.y].map(|v| v.min(142.0 - v));
        d[0].hypot(d[1]) < 40.0
    };
    let expected: Vec<_> = whole.points.iter().filter(inside).copied().collect();
    assert_eq!(csv.points, expected);
}

#[test]
fn too_many_points_of_a_part_are_not_looked_at() {
    let daemon = Daemon::built_in();
    let many = daemon.get("/v1/count?periodic=4000000000&spacing=1&keep=0.5");
    assert_eq!(many.status, 413, "{}", many.text());
    let whole = daemon.get("/v1/count?periodic=4000000000&spacing=1").json();
    assert!(whole["count"].as_u64() >= Some(4_000_000_000));
}

#[tokio::test(flavor = "multi_thread")]
async fn lists_of_periods_agree() {
    let daemon = Daemon::built_in();
    let listed = daemon.get("/v1/periods?map=s&periodic=6000&most=3").json();
    let sizes: Vec<u64> = (listed["periods"].as_array().expect("a list").iter())
        .map(|period| period["points"].as_u64().expect("a number"))
        .collect();
    assert_eq!(sizes, [9409, 15129, 22201]);
    assert_eq!(listed["most_points"], 1u64 << 32);
    assert_eq!(
        listed["periods"][0],
        json!({ "p": 250, "q": 153, "points": 9409, "side": 97.0 })
    );
    let mut client = PointServiceClient::new(daemon.channel().await);
    let request = ListPeriodsRequest {
        map: Some("s".into()),
        periodic: Some(6000),
        most: Some(3),
        ..ListPeriodsRequest::default()
    };
    let called = client
        .list_periods(request)
        .await
        .expect("a list")
        .into_inner();
    let points: Vec<u64> = called.periods.iter().map(|period| period.points).collect();
    assert_eq!(points, sizes);
    let run = |arguments: &str| {
        let output = command::run(&arguments.split_whitespace().collect::<Vec<_>>(), "");
        assert!(output.status.success(), "{}", command::errors(&output));
        String::from_utf8_lossy(&output.stdout).into_owned()
    };
    let lines = run("periods --map s --periodic 6000 --most 3");
    let first: Value = serde_json::from_str(lines.lines().next().expect("a line")).expect("JSON");
    assert_eq!(first, listed["periods"][0]);
}

#[test]
fn masks_are_those_of_the_command_line() {
    let daemon = Daemon::built_in();
    let mask = daemon.get("/v1/mask.png?size=32&seed=7&map=s&bits=16");
    assert_eq!(mask.header("content-type"), "image/png");
    let args = "mask --size 32 --seed 7 --map s --bits 16 --output -";
    let made = command::run(&args.split(" ").collect::<Vec<_>>(), "");
    assert!(made.status.success(), "{}", command::errors(&made));
    assert_eq!(mask.body, made.stdout);
    let spectrum = daemon.get("/v1/mask/spectrum.svg?size=32&seed=7&map=s");
    assert!(spectrum.text().starts_with("<svg"), "{}", spectrum.text());
}

#[tokio::test]
async fn masks_are_the_same_over_grpc() {
    let daemon = Daemon::built_in();
    let mut client = PointServiceClient::new(daemon.channel().await);
    let request = GetMaskRequest {
        size: Some(32),
        seed: Some(7),
        map: Some("s".into()),
        ..GetMaskRequest::default()
    };
    let answer = client.get_mask(request).await.expect("a mask");
    let mask = daemon.get("/v1/mask.png?size=32&seed=7&map=s");
    assert_eq!(answer.into_inner().png, mask.body);
}
