//! What a daemon says about itself, and that it starts with whatever tables there are.

use std::process::Stdio;

use crate::{
    daemon::{Daemon, PROFILE, strew, table, table_of_radius, tables, write},
    raw,
};

#[test]
fn it_lives_is_ready_and_lists_its_profiles() {
    let daemon = Daemon::start(&[]);
    assert_eq!(daemon.get("/livez").status, 200);
    let ready = daemon.get("/readyz");
    assert_eq!((ready.status, &ready.json()["ready"]), (200, &true.into()));

    let profiles = daemon.get("/v1/profiles").json();
    let listed: Vec<_> = profiles["profiles"]
        .as_array()
        .expect("a list")
        .iter()
        .filter(|profile| profile["profile"] == PROFILE)
        .collect();
    assert_eq!(listed.len(), 2);
    let expected = table("(5-sqrt(3))/2", PROFILE);
    let first = listed[0];
    assert_eq!(first["alpha"], "(5-sqrt(3))/2");
    assert_eq!(first["radius"], 20);
    assert_eq!(first["intervals"], 27);
    assert_eq!(first["blocks"], 729);
    assert_eq!(first["bytes"], expected.to_bytes().len());
    assert_eq!(first["digest"], expected.digest().to_string());
    assert_eq!(first["provenance"]["parameters"]["generator"], "lcg");
    let figures = &first["provenance"]["figures"][0];
    assert_eq!(figures["values"]["delta_min"], 0.25);
}

#[test]
fn unknown_paths_and_methods_are_problems() {
    let daemon = Daemon::start(&[]);
    for path in [
        "/page/none.js",
        "/v1",
        "/v2/points",
        "/v1/points/",
        "/strew.v1.Nothing/X",
    ] {
        let answer = daemon.get(path);
        assert_eq!(answer.status, 404, "{path}");
        assert_eq!(answer.header("content-type"), "application/problem+json");
        assert!(answer.text().contains(path), "{path}: {}", answer.text());
    }
    for path in ["/v1/points", "/v1/profiles", "/livez", "/readyz"] {
        for method in ["POST", "DELETE", "OPTIONS"] {
            let answer = raw::request(daemon.address(), method, path, &[]);
            assert_eq!(answer.status, 405, "{method} {path}");
            let allow = answer.header("allow").replace(' ', "");
            assert_eq!(allow, "GET,HEAD", "{method} {path}");
            assert_eq!(answer.header("content-type"), "application/problem+json");
            assert!(answer.text().contains(method));
        }
    }
    let grpc = [("content-type", "application/grpc")];
    let answer = raw::request(daemon.address(), "POST", "/strew.v1.Nothing/X", &grpc);
    assert_eq!((answer.status, answer.header("grpc-status")), (200, "12"));
}

#[test]
fn it_starts_without_any_table_and_says_so() {
    let empty = tempfile::tempdir().expect("a folder");
    let daemon = Daemon::with_tables(empty, &["tables.embedded=false"]);
    assert_eq!(daemon.get("/readyz").json()["tables"], 0);
    let answer = daemon.get("/v1/points?bbox=0,0,1,1&density=1");
    assert_eq!(answer.status, 400);
    assert!(
        answer.text().contains("no table is loaded"),
        "{}",
        answer.text()
    );
}

#[test]
fn a_table_of_the_folder_replaces_a_built_in_one_and_answers_by_default() {
    let folder = tables();
    let mine = table_of_radius("(5-sqrt(3))/2", "blue", 49);
    write(folder.path(), "mine.strew", &mine);
    let other_size = table("(5-sqrt(3))/2", "blue");
    write(folder.path(), "other-size.strew", &other_size);
    std::fs::write(folder.path().join("notes.txt"), "no table").expect("writable");
    let daemon = Daemon::with_tables(folder, &[]);
    let answer = daemon.get("/v1/points?bbox=0,0,9,9&spacing=0.5");
    assert_eq!(answer.status, 200, "{}", answer.text());
    assert_eq!(answer.header("strew-table"), mine.digest().to_string());
    let query = &answer.json()["query"];
    assert_eq!(
        (&query["density"], &query["spacing"]),
        (&4.0.into(), &0.5.into())
    );
    assert_eq!(
        (&query["profile"], &query["seed"]),
        (&"blue".into(), &0.into())
    );
    let answer = daemon.get("/v1/points?bbox=0,0,9,9&spacing=0.5&map=r20");
    assert_eq!(
        answer.header("strew-table"),
        other_size.digest().to_string()
    );
    assert_eq!(answer.json()["query"]["map"], "r20");
    let answer = daemon.get("/v1/points?bbox=0,0,9,9&spacing=0.5&map=q");
    assert!(
        answer.text().contains("allowed: r20, s"),
        "{}",
        answer.text()
    );
}

/// Starts a daemon that must not start; gives its exit code and what it says.
fn refused(arguments: &[&str]) -> (Option<i32>, String) {
    let output = strew()
        .args(["serve", "--listen", "127.0.0.1:0"])
        .args(arguments)
        .stdin(Stdio::null())
        .output()
        .expect("the program runs");
    assert!(output.stdout.is_empty(), "nothing is announced");
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    (output.status.code(), text)
}

#[test]
fn bad_tables_are_named_at_the_start() {
    let folder = tables();
    let path = folder.path().to_str().expect("Unicode").to_owned();
    let damaged = folder.path().join("damaged.strew");
    let mut bytes = table("3/2", PROFILE).to_bytes();
    bytes[100] ^= 1;
    std::fs::write(&damaged, bytes).expect("writable");
    let (code, text) = refused(&["--tables", &path]);
    assert_eq!(code, Some(2), "{text}");
    assert!(
        text.contains("damaged.strew") && text.contains("digest"),
        "{text}"
    );

    std::fs::remove_file(&damaged).expect("there");
    write(folder.path(), "again.strew", &table("sqrt(3)", PROFILE));
    let (code, text) = refused(&["--tables", &path]);
    assert_eq!(code, Some(2), "{text}");
    for part in ["again.strew", "b.strew", PROFILE, "sqrt(3)"] {
        assert!(text.contains(part), "{text}");
    }

    let (code, text) = refused(&["--tables", "/nowhere/at/all"]);
    assert_eq!(code, Some(2), "{text}");
    assert!(text.contains("/nowhere/at/all"), "{text}");
}

#[test]
fn a_port_in_use_is_said_to_be() {
    let daemon = Daemon::start(&[]);
    let (code, text) = refused(&["--listen", daemon.address()]);
    assert_eq!(code, Some(2), "clap refuses a flag given twice: {text}");
    let output = strew()
        .args(["serve", "--listen", daemon.address()])
        .output()
        .expect("the program runs");
    let text = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{text}");
    assert!(
        text.contains(daemon.address()) && text.contains("in use"),
        "{text}"
    );
}
