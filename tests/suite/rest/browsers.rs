//! Headers for browsers: security policies and cross-origin requests.

use strew_testkit::http1;

use crate::support::daemon::Daemon;

const POINTS: &str = "/v1/points?bbox=0,0,10,10&density=1&profile=test&format=";

#[test]
fn every_answer_has_security_headers() {
    let daemon = Daemon::start(&[]);
    for (path, status) in [
        ("/docs", 200),
        ("/page/docs/docs.js", 200),
        ("/openapi.json", 200),
        ("/livez", 200),
        ("/v1/profiles", 200),
        ("/v1/profiles/test/spectrum.svg", 200),
        ("/v1/points?bbox=0,0,5,5&density=1&format=svg", 200),
        ("/v1/points?bbox=0,0,5,5", 400),
        ("/nothing", 404),
    ] {
        let answer = daemon.get(path);
        assert_eq!(answer.status, status, "{path}");
        assert_eq!(answer.header("x-content-type-options"), "nosniff", "{path}");
        assert_eq!(answer.header("referrer-policy"), "no-referrer", "{path}");
        let resource = answer.header("cross-origin-resource-policy");
        assert_eq!(resource, "cross-origin", "{path}");
        let policy = answer.header("content-security-policy");
        assert!(policy.contains("default-src 'none'"), "{path}: {policy}");
        assert!(
            policy.contains("frame-ancestors 'none'"),
            "{path}: {policy}"
        );
        let is_page = path.contains("/docs");
        assert_eq!(policy.contains("sandbox"), !is_page, "{path}: {policy}");
    }
    let listed = Daemon::start(&["http.cors_origins=https://a.example"]);
    let answer = listed.get("/v1/profiles");
    assert_eq!(answer.header("cross-origin-resource-policy"), "same-origin");
}

#[test]
fn pages_name_a_picture_for_those_who_pass_on_a_link() {
    let unknown = Daemon::start(&[]);
    let known = Daemon::start(&["http.public_url=https://points.example"]);
    for path in ["/", "/compare", "/tile", "/walk"] {
        let picture = |daemon: &Daemon| {
            let page = daemon.get(path);
            let (_, rest) = page
                .text()
                .split_once("og:image\" content=\"")
                .expect("a picture");
            let (address, _) = rest.split_once('"').expect("an end");
            address.replace("&amp;", "&")
        };
        let relative = picture(&unknown);
        assert_eq!(picture(&known), format!("https://points.example{relative}"));
        let image = unknown.get(&relative);
        assert_eq!(image.status, 200, "{relative}");
        assert_eq!(image.header("content-type"), "image/png", "{relative}");
        let size = [1200_u32, 630].map(u32::to_be_bytes).concat();
        assert_eq!(image.body[16..24], size, "{relative}");
    }
}

#[test]
fn any_origin_may_send_requests_and_read_all_headers() {
    let daemon = Daemon::start(&[]);
    let origin = ("origin", "https://page.example");
    for path in [
        format!("{POINTS}csv"),
        "/v1/points".into(),
        "/nothing".into(),
    ] {
        let answer = http1::get(daemon.address(), &path, &[origin]);
        assert_eq!(answer.header("access-control-allow-origin"), "*", "{path}");
        assert_eq!(answer.header("access-control-expose-headers"), "*");
        assert_eq!(answer.header("access-control-allow-credentials"), "");
        let asks = [
            origin,
            ("access-control-request-method", "GET"),
            ("access-control-request-headers", "if-none-match"),
        ];
        let allowed = http1::request(daemon.address(), "OPTIONS", &path, &asks);
        assert_eq!(allowed.status, 204, "{path}");
        assert_eq!(allowed.header("access-control-allow-origin"), "*");
        let methods = allowed.header("access-control-allow-methods");
        assert!(methods.contains("GET") && methods.contains("POST"));
        assert_eq!(
            allowed.header("access-control-allow-headers"),
            "*, authorization"
        );
    }
    // A cache may keep the answer to a request without an origin for a page.
    let plain = daemon.get("/livez");
    assert_eq!(plain.header("access-control-allow-origin"), "*");
}

#[test]
fn allowed_origins_can_be_listed_or_none() {
    let daemon = Daemon::start(&["http.cors_origins=https://a.example https://b.example"]);
    let ask = |daemon: &Daemon, origin| {
        let answer = http1::get(daemon.address(), "/livez", &[("origin", origin)]);
        assert_eq!(answer.status, 200);
        answer.header("access-control-allow-origin").to_owned()
    };
    assert_eq!(ask(&daemon, "https://b.example"), "https://b.example");
    assert_eq!(ask(&daemon, "https://c.example"), "");
    assert!(daemon.get("/livez").header("vary").contains("origin"));
    let closed = Daemon::start(&["http.cors_origins="]);
    assert_eq!(ask(&closed, "https://a.example"), "");
}
