//! `--url`: the answers of a daemon, through the program.

use std::{
    fs,
    io::{Read as _, Write as _},
    net::TcpListener,
    thread,
};

use serde_json::json;
use strew_encode::Encoding;

use super::{output, refused};
use crate::support::{
    command::{errors, run},
    daemon::{Daemon, strew},
    keys::{entry, keys},
};

const QUERY: [&str; 7] = [
    "sample",
    "-q",
    "--chunk",
    "16/3/-2",
    "--spacing",
    "1.5",
    "--seed=7",
];

#[test]
fn a_daemon_answers_what_the_program_would() {
    let daemon = Daemon::built_in();
    let url = daemon.url("");
    for format in ["csv", "json", "f32", "npy", "ndjson", "arrow", "svg"] {
        let here = [&QUERY[..], &["--format", format]].concat();
        let there = [&here[..], &["--url", &url]].concat();
        assert!(output(&there, "") == output(&here, ""), "{format}");
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("points.csv.gz");
    let file = file.to_str().expect("Unicode");
    output(&[&QUERY[..], &["--url", &url, "-o", file]].concat(), "");
    let mut text = String::new();
    let packed = fs::File::open(file).expect("written");
    let mut unpacked = flate2::read::GzDecoder::new(packed);
    unpacked.read_to_string(&mut text).expect("gzip");
    let csv = output(&[&QUERY[..], &["--format", "csv"]].concat(), "");
    assert_eq!(text.into_bytes(), csv);
    let count = ["count", "--bbox", "0,0,1e6,1e6", "--spacing", "1"];
    let there = [&count[..], &["--url", &url]].concat();
    assert_eq!(output(&there, ""), output(&count, ""));
    let body = r#"{ "region": { "circle": { "center": [0, 0], "radius": 9 } }, "format": "csv",
        "layers": [ { "name": "a", "spacing": 2 }, { "name": "b", "density": 1, "clear_of": { "a": 1 } } ] }"#;
    let here = run(&["sample", "-q", "--query", "-"], body);
    let there = run(&["sample", "-q", "--query", "-", "--url", &url], body);
    assert!(
        here.status.success() && here.stdout == there.stdout,
        "{}",
        errors(&there)
    );
}

#[test]
fn layers_and_features_come_whole_in_every_format() {
    let daemon = Daemon::built_in();
    let url = daemon.url("");
    let ring = |x: u32| json!([[[x, 0], [x + 9, 0], [x + 9, 9], [x, 0]]]);
    let feature = |id: &str, x: u32| {
        json!({ "type": "Feature", "properties": { "id": id },
            "geometry": { "type": "Polygon", "coordinates": ring(x) } })
    };
    let queries = [
        // A name that looks like that of a column.
        json!({ "region": { "bbox": [0, 0, 9, 9] }, "layers": [
            { "name": "id", "spacing": 2 }, { "name": "b", "density": 1, "clear_of": { "id": 1 } },
        ] }),
        json!({ "spacing": 1, "features": { "id": "id", "of": {
            "type": "FeatureCollection", "features": [feature("layer", 0), feature("id", 20)],
        } } }),
        json!({ "region": { "bbox": [0, 0, 9, 9] }, "spacing": 2, "summary": false }),
    ];
    for (number, query) in queries.iter().enumerate() {
        for encoding in Encoding::ALL {
            let mut query = query.clone();
            query["format"] = encoding.name().into();
            if !encoding.is_streamed() {
                continue;
            }
            if !encoding.has_summary() && query["summary"] == false {
                continue;
            }
            let there = ["sample", "-q", "--query", "-", "--url", &url];
            let there = run(&there, &query.to_string());
            let said = errors(&there);
            // Not every format can hold every query.
            let is_whole = there.status.success() || said.contains("allowed:");
            assert!(
                is_whole && !said.contains("incomplete"),
                "{number} {}: {said}",
                encoding.name()
            );
            assert!(
                encoding != Encoding::Csv || there.status.success(),
                "{number}: {said}"
            );
        }
    }
}

#[test]
fn names_are_those_of_the_daemon_and_its_refusals_are_shown() {
    let daemon = Daemon::with_config("[worlds.heath]\nspacing = 2\nseed = 3\n");
    let url = daemon.url("");
    let chunk = ["sample", "-q", "--chunk", "16/0/0", "--format", "csv"];
    let heath = output(
        &[&chunk[..], &["--world", "heath", "--url", &url]].concat(),
        "",
    );
    let known = output(
        &[&chunk[..], &["--spacing", "2", "--seed", "3"]].concat(),
        "",
    );
    assert_eq!(heath, known);
    let error = refused(
        &[&chunk[..], &["--world", "heat", "--url", &url]].concat(),
        2,
    );
    assert!(
        error.contains("status 400: The query is not valid"),
        "{error}"
    );
    assert!(error.contains("did you mean `heath`?"), "{error}");
    // Flags that no server could accept are refused before anything is sent.
    let nowhere = ["--url", "http://127.0.0.1:1"];
    for (flags, expected) in [
        (["--spacing", "-1"], "--spacing -1"),
        (
            ["--field", "a/mask.png"],
            "--field a/mask.png: a file of this machine",
        ),
        (
            ["--terrain", "a/hills.png"],
            "--terrain a/hills.png: a file of this machine",
        ),
    ] {
        let all = [&chunk[..4], &["--density", "1"][..0], &flags, &nowhere].concat();
        let error = refused(&all, 2);
        assert!(error.contains(expected), "{error}");
    }
    let error = refused(&[&chunk[..], &["--spacing", "1", "--insecure"]].concat(), 2);
    assert!(error.contains("--insecure: there is no --url"), "{error}");
    let parquet = [
        &chunk[..4],
        &["--spacing", "1", "--format", "parquet"],
        &nowhere,
    ]
    .concat();
    assert!(refused(&parquet, 2).contains("parquet"));
    let error = refused(&[&chunk[..], &["--spacing", "1"], &nowhere].concat(), 1);
    assert!(error.contains("http://127.0.0.1:1"), "{error}");
}

#[test]
fn a_body_that_is_refused_early_shows_why() {
    let daemon = Daemon::start(&["limits.max_body_bytes=65536"]);
    let turn = |i: i32| (f64::from(i) * std::f64::consts::TAU / 50_000.0).sin_cos();
    let vertices: Vec<[f64; 2]> = (0..50_000)
        .chain([0])
        .map(turn)
        .map(|(x, y)| [x, y])
        .collect();
    let body = serde_json::json!({
        "region": { "polygon": { "type": "Polygon", "coordinates": [vertices] } }, "spacing": 1,
    });
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("query.json");
    fs::write(&file, body.to_string()).expect("writable");
    let file = file.to_str().expect("Unicode");
    let url = daemon.url("");
    let error = refused(&["count", "--query", file, "--url", &url], 2);
    assert!(error.contains("status 413"), "{error}");
}

#[test]
fn a_key_opens_what_is_behind_one() {
    let key = "a-key-of-alice";
    let daemon = Daemon::start(&[&keys(&entry("alice", key, ""))]);
    let url = daemon.url("");
    let all = [&QUERY[..], &["--format", "csv", "--url", &url]].concat();
    let error = refused(&all, 1);
    assert!(error.contains("status 401: A key is needed"), "{error}");
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("key");
    fs::write(&file, format!("{key}\n")).expect("writable");
    let file = file.to_str().expect("Unicode");
    let by_file = output(&[&all[..], &["--key-file", file]].concat(), "");
    let by_variable = strew().args(&all).env("STREW_API_KEY", key).output();
    assert_eq!(by_variable.expect("it runs").stdout, by_file);
    assert!(by_file.len() > 1000);
}

#[test]
fn an_answer_that_is_cut_leaves_no_file() {
    let server = TcpListener::bind("127.0.0.1:0").expect("a port");
    let url = format!("http://{}", server.local_addr().expect("an address"));
    let served = thread::spawn(move || {
        let (mut stream, _) = server.accept().expect("a client");
        let mut part = [0; 4096];
        let _ = stream.read(&mut part);
        let head = "HTTP/1.1 200 OK\r\nstrew-count: 9\r\ntransfer-encoding: chunked\r\n\r\n";
        let body = "9\r\nid,x,y\n1:\r\n5\r\n2,3";
        stream
            .write_all(format!("{head}{body}").as_bytes())
            .expect("writable");
        drop(stream);
        // Another server than a daemon.
        let (mut stream, _) = server.accept().expect("a client");
        let _ = stream.read(&mut part);
        let page = "HTTP/1.1 200 OK\r\ncontent-type: text/html\r\ncontent-length: 3\r\n\r\n<p>";
        stream.write_all(page.as_bytes()).expect("writable");
    });
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("points.csv");
    let file = file.to_str().expect("Unicode");
    let error = refused(&[&QUERY[..], &["--url", &url, "-o", file]].concat(), 1);
    assert!(error.contains("the answer broke off"), "{error}");
    let error = refused(&[&QUERY[..], &["--url", &url, "-o", file]].concat(), 1);
    assert!(error.contains("no header strew-count"), "{error}");
    let left = fs::read_dir(folder.path()).expect("a folder").count();
    assert_eq!(left, 0);
    served.join().expect("served");
}

/// A server that sends these answers, one to each connection.
fn serving(answers: Vec<String>) -> (String, thread::JoinHandle<()>) {
    let server = TcpListener::bind("127.0.0.1:0").expect("a port");
    let url = format!("http://{}", server.local_addr().expect("an address"));
    let served = thread::spawn(move || {
        for answer in answers {
            let (mut stream, _) = server.accept().expect("a client");
            let _ = stream.read(&mut [0; 4096]);
            stream.write_all(answer.as_bytes()).expect("writable");
        }
    });
    (url, served)
}

#[test]
fn what_a_server_says_does_not_reach_the_terminal_raw() {
    let evil = "\u{1b}[2J\u{9b}1m\u{202e}";
    // No header holds ASCII controls.
    let raw = format!("HTTP/1.1 200 OK\r\nstrew-count: {evil}\r\ncontent-length: 0\r\n\r\n");
    let odd = "\u{9b}1m\u{202e}";
    let head = format!(
        "HTTP/1.1 200 OK\r\nstrew-count: 0\r\nstrew-next: a{odd}\r\nstrew-origin: {odd}\r\n\
         strew-columns: {odd}\r\nstrew-warning: {odd}\r\ncontent-length: 7\r\n\r\nid,x,y\n"
    );
    let count = format!("HTTP/1.1 200 OK\r\nstrew-count: 1{odd}\r\ncontent-length: 0\r\n\r\n");
    let coded = format!("HTTP/1.1 200 OK\r\ncontent-encoding: {odd}\r\ncontent-length: 0\r\n\r\n");
    let problem = serde_json::json!({ "title": evil, "detail": format!("a\nb{evil}") }).to_string();
    let (problem, length) = (&problem, problem.len());
    let problem = format!("HTTP/1.1 400 No\r\ncontent-length: {length}\r\n\r\n{problem}");
    let plain = format!(
        "HTTP/1.1 503 No\r\ncontent-length: {}\r\n\r\n{evil}",
        evil.len()
    );
    let codes = [
        (head, 0, "\\u{9b}1m"),
        (count, 1, "\\u{9b}1m"),
        (coded, 1, "\\u{9b}1m"),
        (raw, 1, "not HTTP"),
        (problem, 2, "\\u{1b}[2J"),
        (plain, 1, "\\u{1b}[2J"),
    ];
    let (url, served) = serving(codes.iter().map(|(answer, ..)| answer.clone()).collect());
    for (answer, code, part) in &codes {
        let flags = [
            "sample",
            "--chunk",
            "16/3/-2",
            "--spacing",
            "1.5",
            "--format",
            "csv",
        ];
        let output = run(&[&flags[..], &["--url", &url]].concat(), "");
        let text = errors(&output);
        assert_eq!(output.status.code(), Some(*code), "{answer}: {text}");
        let is_odd = |c: char| c.is_control() && c != '\n' || c == '\u{202e}';
        assert!(!text.contains(is_odd), "{text:?}");
        assert!(text.contains(part), "{text}");
    }
    served.join().expect("served");
}

#[test]
fn an_answer_with_other_points_than_promised_leaves_no_file() {
    let answer = |count: &str, more: &str, body: &str| {
        let length = body.len();
        format!(
            "HTTP/1.1 200 OK\r\nstrew-count: {count}\r\n{more}content-length: {length}\r\n\r\n{body}"
        )
    };
    let (url, served) = serving(vec![
        answer("2", "", "id,x,y\n1:2,3,4\n"),
        answer("2", "", "12345678"),
        answer("two", "", "id,x,y\n"),
        answer("1", "content-encoding: gzip\r\n", "id,x,y\n1:2,3,4\n"),
        answer("1", "content-encoding: identity\r\n", "id,x,y\n1:2,3,4\n"),
    ]);
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("points");
    let file = file.to_str().expect("Unicode");
    for (format, problem) in [
        ("csv", "holds 1 points, and its header strew-count says 2"),
        (
            "f32",
            "holds 8 bytes, 8 a point, and its header strew-count says 2",
        ),
        ("csv", "strew-count: two; allowed: a number"),
        ("csv", "coded as gzip"),
    ] {
        let flags = ["--format", format, "--url", &url, "-o", file];
        let error = refused(&[&QUERY[..], &flags].concat(), 1);
        assert!(error.contains(problem), "{error}");
        assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 0);
    }
    let flags = ["--format", "csv", "--url", &url, "-o", file];
    output(&[&QUERY[..], &flags].concat(), "");
    served.join().expect("served");
}
