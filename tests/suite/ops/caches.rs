//! Behind real caches, nginx and Varnish with the settings of `deploy/`: a pinned answer is made once.

use strew_testkit::http1::{self, Answer};

use crate::support::{
    clients,
    daemon::Daemon,
    proxy::{Proxy, nginx},
    queries::long,
};

const NGINX: &str = include_str!("../../../deploy/nginx/cache.conf");
const VARNISH: &str = include_str!("../../../deploy/varnish/strew.vcl");
const WORLD: &str = "[worlds.heath]\nspacing = 2\nseed = 3\nprofile = 'test'\n";

/// A program as a cache before a daemon.
fn cache(program: &str, daemon: &Daemon) -> Option<Proxy> {
    clients::find(program)?;
    let replica = daemon.address();
    Some(Proxy::start(program, |address, folder| match program {
        "varnishd" => VARNISH
            .replace("\"strew\"", &format!("\"{}\"", replica.ip()))
            .replace("\"8080\"", &format!("\"{}\"", replica.port())),
        _ => {
            let settings = NGINX
                .replace("/var/cache/nginx", &folder.display().to_string())
                .replace("server strew:8080", &format!("server {replica}"))
                .replace("listen 80", &format!("listen {address}"));
            nginx(folder, &settings)
        }
    }))
}

#[test]
fn behind_nginx_a_pinned_answer_is_made_once_and_its_tag_is_enough() {
    a_pinned_answer_is_made_once_and_its_tag_is_enough("nginx");
}

#[test]
fn behind_varnish_a_pinned_answer_is_made_once_and_its_tag_is_enough() {
    a_pinned_answer_is_made_once_and_its_tag_is_enough("varnishd");
}

fn a_pinned_answer_is_made_once_and_its_tag_is_enough(program: &str) {
    let daemon = Daemon::with_config(WORLD);
    let Some(cache) = cache(program, &daemon) else {
        return;
    };
    let get = |path: &str, headers: &[(&str, &str)]| http1::get(cache.address, path, headers);
    let status = |answer: &Answer| answer.header("x-cache-status").to_owned();
    let world = get("/v1/worlds/heath", &[]);
    let digest = world.json()["digest"].as_str().expect("text").to_owned();
    let chunk = "/v1/worlds/heath/chunks/16/3/-2";
    let path = format!("{chunk}?format=csv&world_digest={digest}");

    let (first, second) = (get(&path, &[]), get(&path, &[]));
    assert_eq!([status(&first), status(&second)], ["MISS", "HIT"]);
    assert!(first.body == second.body && first.body.len() > 100);
    assert!(first.body == http1::get(daemon.address(), &path, &[]).body);
    let kept = "public, max-age=31536000, immutable";
    for answer in [&first, &second] {
        assert_eq!(answer.header("cache-control"), kept);
        assert_eq!(answer.header("etag"), first.header("etag"));
        assert_eq!(answer.header("strew-world"), digest);
    }
    let known = get(&path, &[("if-none-match", first.header("etag"))]);
    assert_eq!((known.status, status(&known).as_str()), (304, "HIT"));
    assert!(known.body.is_empty());
    // Pages of other origins may read an answer that a program requested first.
    let page = get(&path, &[("origin", "https://page.example")]);
    for answer in [&first, &page] {
        assert_eq!(answer.header("access-control-allow-origin"), "*");
    }

    // Codings and formats have entries of their own; the words in which a coding is accepted have none.
    let gzip = |words: &str| get(&path, &[("accept-encoding", words)]);
    let (first, second) = (gzip("gzip, deflate"), gzip("br;q=1.0, gzip;q=0.8"));
    assert_eq!([status(&first), status(&second)], ["MISS", "HIT"]);
    assert_eq!(second.header("content-encoding"), "gzip");
    assert!(first.body == second.body);
    let by_type = |accept: &str| get(chunk, &[("accept", accept)]);
    let (csv, json) = (by_type("text/csv"), by_type("application/json"));
    assert_eq!([status(&csv), status(&json)], ["MISS", "MISS"]);
    assert!(csv.body != json.body);
    // Clients that send a cookie, as browsers do for other programs of a host, share the entries.
    let visitor = get(&path, &[("cookie", "visits=3")]);
    assert_eq!(status(&visitor), "HIT");
    // A digest that is not the world's is refused, and the refusal is not kept.
    let other = format!("{chunk}?world_digest={}", "0".repeat(64));
    for _ in 0..2 {
        let refused = get(&other, &[]);
        assert_eq!((refused.status, status(&refused).as_str()), (409, "MISS"));
    }
    // The number of points of a region is known without its points.
    let head = http1::request(cache.address, "HEAD", &long("f32"), &[]);
    assert!(head.status == 200 && head.header("strew-count").len() > 8);
    assert_eq!(daemon.streams(), 0);
    // A long answer passes, and ends with its reader.
    let mut reader = http1::open(cache.address, "GET", &long("f32"), &[]);
    assert!(reader.skip(1 << 20).expect("bytes") > 0);
    drop(reader);
    daemon.until_no_streams();
    assert_eq!(get("/metrics", &[]).status, 404);
}

#[test]
fn behind_nginx_large_answers_are_not_kept_and_their_slow_readers_hold_up_none() {
    large_answers_are_not_kept_and_their_slow_readers_hold_up_none("nginx", "MISS");
}

#[test]
fn behind_varnish_large_answers_are_not_kept_and_their_slow_readers_hold_up_none() {
    // They go straight through.
    large_answers_are_not_kept_and_their_slow_readers_hold_up_none("varnishd", "");
}

fn large_answers_are_not_kept_and_their_slow_readers_hold_up_none(program: &str, status: &str) {
    let daemon = Daemon::with_config(WORLD);
    let Some(cache) = cache(program, &daemon) else {
        return;
    };
    // 17 million points, many times as long as what the cache may hold of answers that it does not keep.
    let address = |column: i32| format!("/v1/worlds/heath/chunks/8192/{column}/0?format=f32");
    let slow = (0..2).map(|k| http1::open(cache.address, "GET", &address(k), &[]));
    let mut slow: Vec<http1::Response> = slow.collect();
    for reader in &mut slow {
        assert_eq!(reader.status, 200);
        assert!(reader.skip(1 << 20).expect("bytes") > 0);
    }
    // A little over a million points, and 65,000.
    for side in [2048, 512] {
        let path = format!("/v1/worlds/heath/chunks/{side}/1/1?format=f32");
        let direct = http1::get(daemon.address(), &path, &[]);
        assert_eq!(
            direct.header("strew-count").len(),
            if side == 2048 { 7 } else { 5 }
        );
        let keyed = http1::get(cache.address, &path, &[("x-api-key", "any")]);
        assert!(keyed.body == direct.body, "side {side}");
        if side == 2048 {
            for _ in 0..2 {
                let answer = http1::get(cache.address, &path, &[]);
                assert_eq!(answer.header("x-cache-status"), status);
                assert!(answer.body == direct.body);
                assert_eq!(answer.header("etag"), direct.header("etag"));
            }
            let tag = direct.header("etag");
            let known = http1::get(cache.address, &path, &[("if-none-match", tag)]);
            assert_eq!(known.status, 304);
        }
    }
    // Slow answers go on, and end with their readers.
    for reader in &mut slow {
        let mut left = 24 << 20;
        while left > 0 {
            let read = reader.skip(left).expect("the answer goes on");
            assert!(read > 0);
            left -= read;
        }
    }
    drop(slow);
    daemon.until_no_streams();
}

#[test]
fn behind_nginx_whatever_the_daemon_takes_passes() {
    whatever_the_daemon_takes_passes("nginx");
}

#[test]
fn behind_varnish_whatever_the_daemon_takes_passes() {
    whatever_the_daemon_takes_passes("varnishd");
}

fn whatever_the_daemon_takes_passes(program: &str) {
    let daemon = Daemon::with_config(WORLD);
    let Some(cache) = cache(program, &daemon) else {
        return;
    };
    // Addresses of 3 to 60 kB: polygons with many corners.
    for corners in [200, 1100, 4000] {
        let corner = |k: i32| {
            let angle = std::f64::consts::TAU * f64::from(k) / f64::from(corners);
            format!("{:.3},{:.3}", 100.0 * angle.cos(), 100.0 * angle.sin())
        };
        let polygon = (0..corners).map(corner).collect::<Vec<_>>().join(",");
        let path = format!("/v1/count?spacing=9&profile=test&polygon={polygon}");
        for expected in ["MISS", "HIT"] {
            let counted = http1::get(cache.address, &path, &[]);
            assert_eq!(counted.status, 200, "{corners}: {}", counted.text());
            assert_eq!(counted.header("x-cache-status"), expected);
        }
    }
    // A body almost as long as the daemon takes, and an answer whose head stays within 4 kB.
    let json = [("content-type", "application/json")];
    let layer = |k: i32| {
        let kinds = (0..16).map(|j| format!(r#""a-kind-of-plant-{k}-{j}": 1"#));
        let kinds = kinds.collect::<Vec<_>>().join(",");
        format!(
            r#"{{"name": "l{k}", "spacing": 4, "profile": "test", "variants": {{{kinds}}}, "attributes": ["variant"]}}"#
        )
    };
    let layers = (0..8).map(layer).collect::<Vec<_>>().join(",");
    let mut body =
        format!(r#"{{"region": {{"bbox": [0, 0, 9, 9]}}, "format": "npy", "layers": [{layers}]}}"#);
    body += &" ".repeat((4 << 20) - body.len() - 1);
    let [direct, passed] = [daemon.address(), cache.address]
        .map(|to| http1::post(to, "/v1/points:query", &json, body.as_bytes()));
    assert_eq!(direct.status, 200, "{}", direct.text());
    let head: usize = direct.headers.iter().map(|(n, v)| n.len() + v.len()).sum();
    assert!(head <= 4096, "{head}");
    assert_eq!(passed.status, 200);
    assert!(passed.body == direct.body);
}
