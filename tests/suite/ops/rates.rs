//! Rates: each client gets points no faster than it may, and learns when to retry.

use strew::grpc::proto::point_service_client::PointServiceClient;
use strew_testkit::{http1, wait::until};
use tonic::Code;
use tonic_types::StatusExt as _;

use crate::support::{
    daemon::Daemon,
    grpc::square,
    keys::{entry, get_with_key, keys},
    queries::long,
};

/// About 400 points.
const POINTS: &str = "/v1/points?bbox=0,0,20,20&density=1&profile=test&format=csv";
/// So slow that no points return during a test.
const SLOW: &str = "rate.points_per_second=0.01";
const BURST: &str = "rate.burst_points=1000";

fn left(answer: &http1::Answer) -> u64 {
    let text = answer.header("ratelimit");
    let rest = text.strip_prefix("\"points\";r=").expect(text);
    rest.split(';')
        .next()
        .expect("a number")
        .parse()
        .expect("a number")
}

#[test]
fn a_client_above_its_rate_gets_429_and_a_time_to_retry() {
    let daemon = Daemon::start(&[SLOW, BURST]);
    let first = daemon.get(POINTS);
    assert_eq!(first.status, 200);
    let count: u64 = first.header("strew-count").parse().expect("a number");
    assert!((350..450).contains(&count));
    assert_eq!(
        first.header("ratelimit-policy"),
        "\"points\";q=1000;w=100000"
    );
    // The request itself costs one point.
    assert_eq!(left(&first), 1000 - 1 - count);
    // A request that returns no points costs no more than that.
    let head = http1::open(daemon.address(), "HEAD", POINTS, &[]);
    assert_eq!(head.status, 200);
    let tag = first.header("etag");
    let unchanged = http1::get(daemon.address(), POINTS, &[("if-none-match", tag)]);
    assert_eq!(unchanged.status, 304);
    let counted = daemon.get("/v1/count?bbox=0,0,1e4,1e4&density=1&profile=test");
    assert_eq!(left(&counted), 1000 - 4 - count);
    assert_eq!(daemon.get(POINTS).status, 200);
    let refused = daemon.get(POINTS);
    assert_eq!(refused.status, 429, "{}", refused.text());
    let problem = refused.json();
    assert_eq!(problem["type"], "urn:strew:problem:too-fast");
    assert_eq!(
        (&problem["points"], &problem["burst_points"]),
        (&count.into(), &1000.0.into())
    );
    assert_eq!(problem["left"], left(&refused));
    let wait = problem["retry_after_seconds"].as_f64().expect("a number");
    let lacking = (count - left(&refused)) as f64;
    assert!(
        (wait - lacking * 100.0).abs() <= 100.0,
        "{wait} for {lacking}"
    );
    let seconds: f64 = refused.header("retry-after").parse().expect("a number");
    assert_eq!(seconds, wait.ceil());
    // A smaller query still fits; probes are free.
    assert_eq!(
        daemon
            .get("/v1/points?bbox=0,0,5,5&density=1&profile=test")
            .status,
        200
    );
    assert_eq!(daemon.get("/livez").header("ratelimit"), "");
}

#[test]
fn points_that_are_thinned_out_are_charged() {
    let daemon = Daemon::start(&[SLOW, BURST]);
    let thinned = daemon.get(&format!("{POINTS}&keep=0.1"));
    assert_eq!(thinned.status, 200, "{}", thinned.text());
    let count: u64 = thinned.header("strew-count").parse().expect("a number");
    assert!((10..90).contains(&count), "{count}");
    assert!((300..=400).contains(&(999 - left(&thinned))));
    // About ten of a million, and the first of a billion.
    for few in [
        "bbox=0,0,1000,1000&keep=1e-5",
        "bbox=0,0,3e4,3e4&keep=1e-6&limit=50",
    ] {
        let few = format!("/v1/points?{few}&density=1&profile=test&format=csv");
        let refused = daemon.get(&few);
        assert_eq!(refused.status, 429, "{few}: {}", refused.text());
    }
    let near = "/v1/nearest?at=0,0&k=10&density=1&profile=test&keep=0.1";
    let before = left(&daemon.get("/v1/profiles"));
    let found = daemon.get(near);
    assert_eq!(found.status, 200, "{}", found.text());
    assert_eq!(left(&found), before - 1 - 100);
}

#[test]
fn rows_that_are_counted_one_by_one_are_charged() {
    let daemon = Daemon::start(&[SLOW, "rate.burst_points=20000"]);
    let count = "/v1/count?circle=0,0,1e4&density=1&profile=test";
    let first = daemon.get(count);
    assert_eq!(first.status, 200, "{}", first.text());
    assert!((1000..19_000).contains(&left(&first)), "{}", left(&first));
    until("the rate is exceeded", || daemon.get(count).status == 429);
    // A request that is refused for its size costs the request only.
    let before = left(&daemon.get("/v1/profiles"));
    let large = daemon.get("/v1/count?circle=0,0,1e8&density=1&profile=test");
    assert_eq!(large.status, 413, "{}", large.text());
    assert_eq!(left(&large), before - 1);
}

#[test]
fn points_come_back_with_time() {
    let daemon = Daemon::start(&["rate.points_per_second=2000", "rate.burst_points=450"]);
    until("the rate is exceeded", || daemon.get(POINTS).status == 429);
    until("there are points again", || {
        daemon.get(POINTS).status == 200
    });
}

#[test]
fn a_query_above_the_burst_is_answered_once_and_paid_back() {
    let daemon = Daemon::start(&[SLOW, "rate.burst_points=100"]);
    let first = daemon.get(POINTS);
    assert_eq!(first.status, 200, "{}", first.text());
    let debt = daemon.get("/v1/points?bbox=0,0,2,2&density=1");
    assert_eq!(debt.status, 429, "{}", debt.text());
    assert_eq!(debt.json()["left"], 0);
    let daemon = Daemon::start(&["rate.points_per_second=1000", "rate.burst_points=100"]);
    assert_eq!(daemon.get(POINTS).status, 200);
    until("the debt is paid back", || daemon.get(POINTS).status == 200);
}

#[tokio::test(flavor = "multi_thread")]
async fn grpc_returns_a_retry_delay() {
    let daemon = Daemon::start(&[SLOW, BURST]);
    let mut client = PointServiceClient::new(daemon.channel().await);
    for _ in 0..2 {
        client.stream_points(square(20.0)).await.expect("points");
    }
    let status = client
        .stream_points(square(20.0))
        .await
        .expect_err("too fast");
    assert_eq!(status.code(), Code::ResourceExhausted, "{status:?}");
    let details = status.get_error_details();
    let info = details.error_info().expect("details");
    assert_eq!(info.reason, "TOO_FAST");
    assert_eq!(info.metadata["burst_points"], "1000");
    let wait = details
        .retry_info()
        .expect("details")
        .retry_delay
        .expect("a time");
    assert!((1000..100_000).contains(&wait.as_secs()), "{wait:?}");
    // REST and gRPC share the rate.
    assert_eq!(daemon.get(POINTS).status, 429);
}

#[test]
fn a_key_has_a_rate_of_its_own() {
    let fast = entry("fast", "f", "points_per_second = 1e9");
    let slow = entry("slow", "s", "points_per_second = 0.01\nburst_points = 500");
    let daemon = Daemon::start(&[&keys(&[fast, slow].concat())]);
    let statuses = |key: &str| [0; 4].map(|_| get_with_key(&daemon, POINTS, key).status);
    assert_eq!(statuses("s"), [200, 429, 429, 429]);
    assert_eq!(statuses("f"), [200; 4]);
    // Keys without a rate have the default one, each for itself.
    let entries = [entry("a", "a", ""), entry("b", "b", "")].concat();
    let daemon = Daemon::start(&[&keys(&entries), SLOW, "rate.burst_points=500"]);
    let statuses = |key: &str| [0; 2].map(|_| get_with_key(&daemon, POINTS, key).status);
    assert_eq!(statuses("a"), [200, 429]);
    assert_eq!(statuses("b"), [200, 429]);
}

#[test]
fn clients_behind_a_trusted_proxy_have_rates_of_their_own() {
    let from = |daemon: &Daemon, client: &str| {
        http1::get(daemon.address(), POINTS, &[("x-forwarded-for", client)]).status
    };
    let burst = "rate.burst_points=500";
    let daemon = Daemon::start(&[SLOW, burst, "access.trusted_proxies=127.0.0.0/8"]);
    assert_eq!(from(&daemon, "192.0.2.1"), 200);
    assert_eq!(from(&daemon, "192.0.2.1"), 429);
    assert_eq!(from(&daemon, "192.0.2.2"), 200);
    // The proxy appends to what a client sends itself.
    assert_eq!(from(&daemon, "198.51.100.7, 192.0.2.2"), 429);
    let alone = Daemon::start(&[SLOW, burst]);
    assert_eq!(from(&alone, "192.0.2.1"), 200);
    assert_eq!(from(&alone, "192.0.2.2"), 429);
}

#[test]
fn clients_that_a_proxy_does_not_know_share_the_limits_of_one() {
    let settings = [
        "access.trusted_proxies=127.0.0.1",
        "per_address.max_streams=1",
    ];
    let daemon = Daemon::start(&settings);
    let path = long("f32");
    let open = |client: &str| {
        let headers = [("x-forwarded-for", client)];
        http1::open(daemon.address(), "GET", &path, &headers)
    };
    let first = open("198.51.100.1, unknown");
    assert_eq!(first.status, 200);
    for client in ["unknown", "198.51.100.2, _hidden", ""] {
        assert_eq!(open(client).status, 429, "{client}");
    }
    assert_eq!(open("198.51.100.1").status, 200);
}
