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
        let is_page = path.contains("/docs");
        let frames = ["frame-ancestors 'none'", "frame-ancestors 'self'"][usize::from(is_page)];
        assert!(policy.contains(frames), "{path}: {policy}");
        assert_eq!(policy.contains("sandbox"), !is_page, "{path}: {policy}");
    }
    let listed = Daemon::start(&["http.cors_origins=https://a.example"]);
    let answer = listed.get("/v1/profiles");
    assert_eq!(answer.header("cross-origin-resource-policy"), "same-origin");
}

#[test]
fn pages_name_a_picture_for_those_who_pass_on_a_link() {
    let public = "https://points.example";
    let known = Daemon::start(&["http.public_url=https://points.example"]);
    for path in ["/", "/how", "/compare", "/walk", "/space"] {
        let page = known.get(path);
        let text = page.text();
        assert!(text.contains("summary_large_image"), "{path}");
        let (_, rest) = text.split_once("og:image\" content=\"").expect("a picture");
        let (address, _) = rest.split_once('"').expect("an end");
        let address = address.replace("&amp;", "&");
        let relative = address.strip_prefix(public).expect("an absolute address");
        let image = known.get(relative);
        assert_eq!(image.status, 200, "{relative}");
        let is_walk = ["/", "/walk"].contains(&path);
        assert_eq!(relative == "/page/walk/preview.jpg", is_walk, "{path}");
        if is_walk {
            assert_eq!(image.header("content-type"), "image/jpeg", "{relative}");
            assert_eq!(size_of_jpeg(&image.body), [1200, 630], "{relative}");
        } else {
            assert_eq!(image.header("content-type"), "image/png", "{relative}");
            let size = [1200_u32, 630].map(u32::to_be_bytes).concat();
            assert_eq!(image.body[16..24], size, "{relative}");
        }
    }
    // Readers of links drop relative addresses, so without a public one there is no picture.
    let unknown = Daemon::start(&[]);
    for path in ["/", "/walk"] {
        let page = unknown.get(path);
        let text = page.text();
        assert!(!text.contains("og:image"), "{path}");
    }
}

#[test]
fn the_small_picture_of_the_forest_is_small() {
    let daemon = Daemon::start(&[]);
    let image = daemon.get("/page/start/walk.jpg");
    assert_eq!(image.header("content-type"), "image/jpeg");
    assert_eq!(size_of_jpeg(&image.body), [480, 252]);
    assert!(image.body.len() <= 15_000, "{}", image.body.len());
}

/// The width and the height of a JPEG, from its baseline frame.
fn size_of_jpeg(bytes: &[u8]) -> [u16; 2] {
    let frame = bytes.windows(2).position(|two| two == [0xFF, 0xC0]);
    let at = frame.expect("a baseline frame") + 5;
    let number = |at: usize| u16::from_be_bytes([bytes[at], bytes[at + 1]]);
    [number(at + 2), number(at)]
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

/// Browsers send a body of plain text without asking first.
#[test]
fn pages_that_are_not_allowed_send_nothing_but_requests_for_reading() {
    const QUERY: &str = "/v1/count";
    const CALL: &str = "/strew.v1.PointService/ListProfiles";
    const BODY: &[u8] = br#"{"region": {"bbox": [0, 0, 9, 9]}, "spacing": 1}"#;
    let closed = Daemon::start(&["http.cors_origins="]);
    let listed = Daemon::start(&["http.cors_origins=https://a.example"]);
    let open = Daemon::start(&[]);
    let post = |daemon: &Daemon, headers: &[(&str, &str)]| {
        http1::post(daemon.address(), QUERY, headers, BODY).status
    };
    let page = ("origin", "https://a.example");
    let other = ("origin", "https://b.example");
    let plain = ("content-type", "text/plain");
    assert_eq!(post(&closed, &[page, plain]), 403);
    assert_eq!(post(&closed, &[("origin", "null"), plain]), 403);
    assert_eq!(post(&listed, &[page, plain]), 200);
    assert_eq!(post(&listed, &[other, plain]), 403);
    assert_eq!(post(&open, &[other, plain]), 200);
    // Its own pages, programs, and pages that a proxy serves under another name.
    let own = closed.url("");
    assert_eq!(post(&closed, &[("origin", own.trim_end_matches('/'))]), 200);
    assert_eq!(post(&closed, &[]), 200);
    assert_eq!(
        post(&closed, &[page, ("sec-fetch-site", "same-origin")]),
        200
    );
    // A request that only reads is answered, and browsers keep the answer from the page.
    let read = http1::get(closed.address(), "/livez", &[page]);
    assert_eq!(
        (read.status, read.header("access-control-allow-origin")),
        (200, "")
    );

    let frame = [0; 5];
    let web = ("content-type", "application/grpc-web+proto");
    let call = |daemon: &Daemon, origin| {
        http1::post(daemon.address(), CALL, &[web, origin], &frame).status
    };
    assert_eq!(call(&closed, page), 403);
    assert_eq!(call(&listed, page), 200);
    let asks = [
        page,
        ("access-control-request-method", "POST"),
        ("access-control-request-headers", "content-type,x-grpc-web"),
    ];
    let allowed = |daemon: &Daemon| {
        let answer = http1::request(daemon.address(), "OPTIONS", CALL, &asks);
        answer.header("access-control-allow-origin").to_owned()
    };
    assert_eq!(allowed(&closed), "");
    assert_eq!(allowed(&listed), page.1);
    assert_eq!(allowed(&open), "*");
}
