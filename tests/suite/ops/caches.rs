//! Behind real caches, nginx and Varnish with the settings of `deploy/`: what is pinned is made once.

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
    // What a program got first, pages of other origins may read.
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
