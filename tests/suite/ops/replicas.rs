//! Replicas share nothing and answer alike: behind a real proxy, a client that reads pages by
//! cursors loses and repeats no point while one replica is killed and comes back.
//!
//! The proxies are HAProxy and nginx, which `.ci/run` installs; a missing one is skipped with a
//! message.

use std::net::SocketAddr;

use strew_catalog::Catalog;
use strew_encode::{Encoding, Output};
use strew_plan::Planned;
use strew_query::{groups, read_body};
use strew_testkit::{http1, wait::until};

use crate::support::{
    clients,
    daemon::{Daemon, PROFILE, tables},
    metrics::{samples, sum},
    proxy::Proxy,
};

const QUERY: &str = "bbox=-200,-200,200,200&spacing=1&seed=5&profile=test&format=csv";

/// The lines of the library's own answer, without the column names.
fn expected() -> Vec<String> {
    let tables = tables();
    let catalog = Catalog::load(false, Some(tables.path())).expect("valid");
    let body = format!(
        r#"{{"region": {{"bbox": [-200, -200, 200, 200]}}, "spacing": 1, "seed": 5, "profile": "{PROFILE}"}}"#
    );
    let draft = read_body(body.as_bytes(), groups::QUERY).expect("JSON");
    let (query, _) = draft.check(&catalog.into(), 100).expect("valid");
    let settings = strew_config::Layers::new().and_then(strew_config::Layers::finish);
    let limits = settings.expect("valid").limits;
    let planned = Planned::at_once(query, &limits).expect("planned");
    let answer = planned
        .answer(&Output::new(Encoding::Csv), 1 << 16)
        .expect("fits");
    let blocks: Vec<u8> = answer.flat_map(|block| block.expect("encoded")).collect();
    let text = String::from_utf8(blocks).expect("UTF-8");
    text.lines().skip(1).map(Into::into).collect()
}

fn a_replica_may_fail_and_return(program: &str) {
    let expected = expected();
    let mut replicas: Vec<Option<Daemon>> = (0..3).map(|_| Some(Daemon::start(&[]))).collect();
    let addresses: Vec<SocketAddr> = replicas.iter().flatten().map(|r| r.address()).collect();
    let proxy = Proxy::balancer(program, &addresses, None);
    until("the proxy has found a replica", || {
        let opened = http1::open(proxy.address, "GET", "/readyz", &[]);
        opened.status == 200
    });
    let mut points: Vec<String> = vec![];
    let mut cursor = None;
    let page = expected.len().div_ceil(40);
    let mut pages = 0;
    loop {
        match pages {
            // Dropping a daemon kills it (SIGKILL) at once.
            10 => drop(replicas[1].take()),
            // The killed one comes back at its address while another one is stopped (SIGTERM).
            20 => {
                replicas[1] = Some(until("the port is free", || Daemon::at(addresses[1])));
                replicas[0].as_ref().expect("not yet").terminate();
            }
            _ => {}
        }
        let after = cursor
            .as_ref()
            .map_or(String::new(), |c| format!("&cursor={c}"));
        let path = format!("/v1/points?{QUERY}&limit={page}{after}");
        let answer = http1::get(proxy.address, &path, &[]);
        assert_eq!(answer.status, 200, "page {pages}: {}", answer.text());
        points.extend(answer.text().lines().skip(1).map(Into::into));
        pages += 1;
        match answer.header("strew-next") {
            "" => break,
            next => cursor = Some(next.to_owned()),
        }
    }
    assert_eq!(pages, 40);
    assert_eq!(points, expected);
    // The proxy uses the replica that came back.
    let returned = replicas[1].as_ref().expect("back");
    until("the replica that came back answers", || {
        http1::get(proxy.address, &format!("/v1/points?{QUERY}&limit=10"), &[]);
        let labels = ["protocol=\"rest\"", "route=\"/v1/points\""];
        sum(&samples(returned), "strew_requests_total", &labels) > 0.0
    });
}

#[test]
fn behind_haproxy_a_replica_may_fail_and_return() {
    if clients::find("haproxy").is_some() {
        a_replica_may_fail_and_return("haproxy");
    }
}

#[test]
fn behind_nginx_a_replica_may_fail_and_return() {
    if clients::find("nginx").is_some() {
        a_replica_may_fail_and_return("nginx");
    }
}
