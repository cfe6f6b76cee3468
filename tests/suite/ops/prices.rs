//! Work that costs much: refused before it is done, charged for what it takes, and done so that clients at other
//! addresses notice little of it. Nothing here is timed: what matters is what is refused, and who is answered first.

use std::{
    io::{Read as _, Write as _},
    net::{Ipv4Addr, TcpStream},
};

use serde_json::{Value, json};
use strew_testkit::{http1, wait::until};

use crate::support::{
    attack,
    daemon::{Daemon, tables},
    metrics,
    queries::{MANY_ROWS, SLOW, long},
    sending,
};

const SMALL: &str = "/v1/points?bbox=0,0,9,9&density=1&profile=test";
const CSV: &str = "/v1/points?bbox=0,0,200,200&spacing=1&profile=test&seed=3&format=csv";

/// A look at it takes some ten microseconds.
fn costly_field() -> Value {
    let noise = |i| json!({ "noise": { "wavelength": 5 + i, "octaves": 8, "seed": i } });
    json!({ "multiply": (0..60).map(noise).collect::<Vec<_>>() })
}

fn post(daemon: &Daemon, path: &str, body: &str) -> TcpStream {
    sending::post(daemon.address(), path, body).expect("sent")
}

fn refused_rows(daemon: &Daemon, body: &Value) {
    let answer = daemon.post("/v1/count", body);
    assert_eq!(answer.status, 413, "{}", answer.text());
    let problem = answer.json();
    assert_eq!(problem["type"], "urn:strew:problem:too-many-rows");
    assert_eq!(problem["limit"], 5_000_000);
}

#[test]
fn what_takes_too_long_to_count_is_refused_before() {
    let daemon = Daemon::start(&[]);
    // 10^6 points, each of which looks at 480 octaves.
    let plain =
        json!({ "region": { "bbox": [0, 0, 1000, 1000] }, "spacing": 1, "profile": "test" });
    let with = |name: &str, value: Value| {
        let mut query = plain.clone();
        query[name] = value;
        query
    };
    assert_eq!(daemon.post("/v1/count", &plain).status, 200);
    refused_rows(&daemon, &with("field", costly_field()));
    let noise = json!({ "noise": { "wavelength": 50, "octaves": 3 } });
    assert_eq!(daemon.post("/v1/count", &with("field", noise)).status, 200);
    // A line that crosses everything, everywhere, so that boxes do not show which part is near.
    let line: Vec<[u32; 2]> = (0..9_999)
        .map(|i| [i * 617 % 1000, i * 367 % 1009])
        .collect();
    let tangled = json!({ "distance": { "distances": [0, 5], "lines": [line] } });
    refused_rows(&daemon, &with("field", tangled));
    let street: Vec<[f64; 2]> = (0..9_999).map(|i| [0.1 * f64::from(i), 500.0]).collect();
    let street = json!({ "distance": { "distances": [0, 5], "lines": [street] } });
    assert_eq!(daemon.post("/v1/count", &with("field", street)).status, 200);
    // Whether a point exists depends on points of all layers before it, and so on.
    let chain = |number: usize| {
        let layers = (0..number).map(|i| {
            let clear: serde_json::Map<_, _> = (0..i).map(|j| (format!("l{j}"), json!(1.5))).collect();
            json!({ "name": format!("l{i}"), "spacing": 1, "seed": i, "profile": "test", "clear_of": clear })
        });
        let layers: Vec<Value> = layers.collect();
        json!({ "region": { "bbox": [0, 0, 40, 40] }, "layers": layers })
    };
    refused_rows(&daemon, &chain(16));
    assert_eq!(daemon.post("/v1/count", &chain(4)).status, 200);
}

#[test]
fn a_rate_is_charged_for_the_time_that_points_take() {
    let daemon = Daemon::start(&["rate.points_per_second=0.01", "rate.burst_points=1000000"]);
    let left = |answer: &http1::Answer| {
        let text = answer.header("ratelimit");
        let rest = text.strip_prefix("\"points\";r=").expect(text);
        let number = rest.split(';').next().map(str::parse::<u64>);
        number.expect(text).expect(text)
    };
    let plain = json!({
        "region": { "bbox": [0, 0, 60, 60] }, "spacing": 1, "profile": "test", "format": "csv",
    });
    let mut costly = plain.clone();
    costly["terrain"] = costly_field();
    costly["heights"] = json!([0, 10]);
    costly["normals"] = json!("on");
    let first = daemon.post("/v1/points:query", &plain);
    let points: u64 = first.header("strew-count").parse().expect("a number");
    assert_eq!(left(&first), 1_000_000 - 1 - points);
    let second = daemon.post("/v1/points:query", &costly);
    assert_eq!(second.status, 200, "{}", second.text());
    let mut before = left(&first);
    let mut charged = |answer: &http1::Answer| {
        let left = left(answer);
        std::mem::replace(&mut before, left) - left
    };
    // Five looks a point at 480 octaves.
    assert!(charged(&second) > 20 * points, "{points}");
    // A part of a split is sought in a row of many places.
    let wide = json!({ "region": { "bbox": [0, 0, 19, 2] }, "spacing": 9e-4, "profile": "test" });
    assert!(charged(&daemon.post("/v1/points:split?parts=2000", &wide)) >= 80_000);
    // A vertex takes time at any spacing.
    let vertex = |i: u32| {
        let (sin, cos) = (f64::from(i) * std::f64::consts::TAU / 9e3).sin_cos();
        let radius = if i.is_multiple_of(2) { 1.0 } else { 0.3 };
        [radius * cos, radius * sin]
    };
    let ring: Vec<[f64; 2]> = (0..9_000).map(vertex).collect();
    let star = json!({
        "region": { "polygon": { "type": "Polygon", "coordinates": [ring] } },
        "spacing": 1e9, "profile": "test",
    });
    let answer = daemon.post("/v1/count", &star);
    assert_eq!(answer.status, 200, "{}", answer.text());
    assert!(charged(&answer) >= 4_500 + star.to_string().len() as u64 / 50);
    // Bytes are read also if they are refused.
    let answer = daemon.post("/v1/except", &json!({ "ids": ["x".repeat(400_000)] }));
    assert_eq!(answer.status, 400);
    assert!(charged(&answer) >= 8_000);
    let answer = daemon.get("/v1/points?bbox=0,0,2,2&spacing=1&profile=test&format=png&size=4096");
    assert_eq!(answer.status, 200);
    assert!(charged(&answer) >= 4096 * 4096 / 500);
    // The last of a picture is charged a moment after it is sent.
    let _ = charged(
        &until("all is charged", || {
            let answers = [(); 2].map(|()| daemon.get("/v1/except"));
            let [first, second] = answers.each_ref().map(left);
            (first == second + 1).then_some(answers)
        })[1],
    );
    let noise = json!({ "noise": { "wavelength": 50, "octaves": 8 } });
    let answer = daemon.post("/v1/fields", &noise);
    assert!(charged(&answer) <= 1);
    let name = answer.json()["digest"]
        .as_str()
        .expect("a digest")
        .to_owned();
    let answer = daemon.get(&format!("/v1/fields/{name}/chunks/64/0/0"));
    assert_eq!(answer.status, 200, "{}", answer.text());
    assert!(charged(&answer) >= 256 * 256 * 20 / 1000);
}

#[test]
fn streams_of_costly_points_leave_others_their_workers() {
    let daemon = Daemon::start(&["workers.threads=1"]);
    let body = json!({
        "region": { "bbox": [0, 0, 3000, 3000] }, "spacing": 1, "profile": "test", "format": "f32",
        "terrain": costly_field(), "heights": [0, 10], "normals": "on",
    });
    let body = body.to_string();
    let streams: Vec<_> = (0..8)
        .map(|_| post(&daemon, "/v1/points:query", &body))
        .collect();
    let points = || metrics::sum(&metrics::samples(&daemon), "strew_points_total", &[]);
    for mut stream in &streams {
        let mut head = [0; 12];
        stream.read_exact(&mut head).expect("an answer");
        assert_eq!(&head[9..], b"200");
    }
    let readers: Vec<_> = streams
        .iter()
        .map(|stream| {
            let mut stream = stream.try_clone().expect("a handle");
            std::thread::spawn(move || while matches!(stream.read(&mut [0; 1 << 16]), Ok(1..)) {})
        })
        .collect();
    let before = points();
    let answer = daemon.get(CSV);
    assert_eq!(answer.status, 200);
    let own: f64 = answer.header("strew-count").parse().expect("a number");
    // First come, first served would make a block of each stream for every block of the answer.
    let others = points() - before - own;
    assert!(
        others < 8.0 * 8192.0,
        "{others} points of others came first"
    );
    drop(streams);
    drop(daemon);
    for reader in readers {
        reader.join().expect("no panic");
    }
}

#[test]
fn long_work_of_one_address_gives_way_to_that_of_another() {
    let daemon = Daemon::start(&[
        "workers.threads=1",
        MANY_ROWS,
        "server.first_byte_seconds=3600",
    ]);
    let long = [(); 3].map(|()| post(&daemon, "/v1/count", SLOW));
    let longer = "/v1/count?circle=0,0,3000&spacing=1&profile=test&warp=1&seed=2";
    assert_eq!(daemon.get(longer).status, 200);
    for stream in &long {
        stream.set_nonblocking(true).expect("a socket");
        let mut stream: &TcpStream = stream;
        let error = stream.read(&mut [0; 1]).expect_err("no answer yet");
        assert_eq!(error.kind(), std::io::ErrorKind::WouldBlock);
    }
}

#[test]
fn kinds_are_made_for_who_waits_and_an_address_has_a_few_at_once() {
    let folder = tables();
    let path = folder.path().join("mixes");
    let daemon = Daemon::with_tables(folder, &["server.first_byte_seconds=300"]);
    let query = |shares: &str| {
        format!("/v1/points?bbox=0,0,9,9&spacing=1&spread=even&variants={shares}&map=m&format=csv")
    };
    // Four of nine are made or wait to be made; then their clients leave.
    let waiting: Vec<_> = (1..=9)
        .map(|i| query(&format!("oak:{},fir:500", 300 + i)))
        .map(|path| attack::get(daemon.address(), &path, "").expect("sent"))
        .collect();
    for stream in &waiting {
        stream.set_nonblocking(true).expect("a socket");
    }
    until("one is refused", || {
        waiting.iter().find_map(|mut stream| {
            let mut head = [0; 12];
            stream.read_exact(&mut head).ok()?;
            (&head[9..] == b"429").then_some(())
        })
    });
    let made = || std::fs::read_dir(&path).map_or(0, Iterator::count);
    let before = made();
    drop(waiting);
    // Another address does not wait for work that no client wants any more.
    let answer = daemon.get(&query("oak:1,fir:5"));
    assert_eq!(answer.status, 200, "{}", answer.text());
    // Its own, and at most one that was nearly made.
    let made = made() - before;
    assert!(
        (1..=2).contains(&made),
        "{made} mixes were made after {before}"
    );
}

#[test]
fn four_addresses_leave_places_for_a_fifth() {
    let daemon = Daemon::start(&[
        "limits.max_streams=16",
        "per_address.max_streams=4",
        "limits.max_requests=16",
        "per_address.max_requests=8",
    ]);
    let addresses = [2, 3, 4, 5].map(|last| Ipv4Addr::new(127, 0, 0, last));
    // Bodies that do not come to their end take no place.
    let head = "POST /v1/points:query HTTP/1.1\r\nhost: localhost\r\ncontent-length: 100\r\n\r\n{";
    let arriving: Vec<TcpStream> = addresses
        .iter()
        .flat_map(|&from| [from; 7])
        .map(|from| {
            let mut stream = attack::connect_from(from, daemon.address()).expect("connected");
            stream.write_all(head.as_bytes()).expect("sent");
            stream
        })
        .collect();
    assert_eq!(daemon.get(SMALL).status, 200);
    drop(arriving);
    until("they are gone", || daemon.open_files() < 40);
    let mut open = vec![];
    for from in addresses.iter().flat_map(|&from| [from; 4]) {
        let mut stream = attack::connect_from(from, daemon.address()).expect("connected");
        let path = long("f32");
        write!(stream, "GET {path} HTTP/1.1\r\nhost: localhost\r\n\r\n").expect("sent");
        let mut head = [0; 12];
        stream.read_exact(&mut head).expect("an answer");
        open.push((stream, String::from_utf8_lossy(&head[9..]).into_owned()));
    }
    let number = |status: &str| open.iter().filter(|(_, own)| own == status).count();
    // 4, 4, 4 and half of the rest.
    assert_eq!((number("200"), number("429")), (14, 2));
    assert_eq!(daemon.get(CSV).status, 200);
}
