//! Starting: which tables the daemon serves, what it reports about itself, why it refuses to start,
//! and what it warns of.

use std::{
    fs,
    process::{Output, Stdio},
};

use strew_testkit::{
    daemon::Launcher,
    tables::{random, write},
};

use crate::support::{
    command::errors,
    daemon::{Daemon, PROFILE, PROGRAM, no_tables, strew, table, tables},
    keys::{entry, keys},
};

#[test]
fn a_daemon_is_live_and_ready_and_lists_its_profiles() {
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
    assert_eq!(first["provenance"]["parameters"]["generator"], "splitmix64");
    let figures = &first["provenance"]["figures"][0];
    assert_eq!(figures["values"]["delta_min"], 0.25);
}

#[test]
fn a_daemon_starts_without_any_table_and_reports_it() {
    let daemon = Daemon::with_tables(no_tables(), &["tables.embedded=false"]);
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
    let mine = random("(5-sqrt(3))/2", "blue", 100);
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

/// Starts a daemon that must refuse to start. Returns its exit code and message.
fn refused(arguments: &[&str]) -> (Option<i32>, String) {
    let output = strew()
        .args(["serve", "--listen", "127.0.0.1:0"])
        .args(arguments)
        .stdin(Stdio::null())
        .output()
        .expect("the program runs");
    assert!(output.stdout.is_empty(), "it announced an address");
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    (output.status.code(), text)
}

#[test]
fn bad_tables_are_named() {
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

#[cfg(not(feature = "otlp"))]
#[test]
fn a_collector_is_refused_with_the_name_of_the_missing_feature() {
    let (code, text) = refused(&["--set", "telemetry.otlp_endpoint=http://127.0.0.1:4317"]);
    assert_eq!(code, Some(2), "{text}");
    for part in [
        "telemetry.otlp_endpoint",
        "http://127.0.0.1:4317",
        "--features otlp",
    ] {
        assert!(text.contains(part), "{text}");
    }
}

#[test]
fn a_port_in_use_is_reported() {
    let daemon = Daemon::start(&[]);
    let address = daemon.address().to_string();
    let (code, text) = refused(&["--listen", &address]);
    assert_eq!(code, Some(2), "clap refuses a flag given twice: {text}");
    let output = strew()
        .args(["serve", "--listen", &address])
        .output()
        .expect("the program runs");
    let text = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{text}");
    assert!(text.contains(&address) && text.contains("in use"), "{text}");
}

/// Runs `strew serve`, with the test tables unless the flags name others.
fn serve(flags: &[&str]) -> Output {
    let tables = tables();
    let mut command = strew();
    command.arg("serve").args(flags);
    if !flags.contains(&"--tables") {
        command.arg("--tables").arg(tables.path());
    }
    command.output().expect("the program runs")
}

#[test]
fn a_daemon_that_cannot_start_reports_why() {
    let taken = std::net::TcpListener::bind("127.0.0.1:0").expect("a port");
    let address = taken.local_addr().expect("an address").to_string();
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("file");
    fs::write(&file, "no folder").expect("writable");
    let bad = folder.path().join("bad.strew");
    fs::write(&bad, "no table").expect("writable");
    let [file, folder] = [file.as_path(), folder.path()].map(|path| path.display().to_string());
    let free = ["--listen", "127.0.0.1:0"];
    let set = |setting: &'static str| [&free[..], &["--set", setting]].concat();
    let cases: [(Vec<&str>, i32, &[&str]); 8] = [
        (vec!["--listen", &address], 1, &["port is in use", &address]),
        (
            vec!["--listen", "192.0.2.1:80"],
            1,
            &["cannot listen on 192.0.2.1:80"],
        ),
        (vec!["--listen", "nowhere"], 2, &["listen"]),
        ([&free[..], &["--tables", &file]].concat(), 2, &[&file]),
        (
            [&free[..], &["--tables", "/nowhere"]].concat(),
            2,
            &["/nowhere"],
        ),
        (
            [&free[..], &["--tables", &folder]].concat(),
            2,
            &["bad.strew"],
        ),
        (set("limits.max_points=0"), 2, &["limits.max_points = 0"]),
        (
            set("limits.max_bytes_in_flight=1"),
            2,
            &["limits.max_bytes_in_flight = 1"],
        ),
    ];
    for (flags, code, words) in cases {
        let output = serve(&flags);
        let text = errors(&output);
        assert_eq!(output.status.code(), Some(code), "{flags:?}: {text}");
        assert!(output.stdout.is_empty(), "{flags:?}");
        for word in words {
            assert!(text.contains(word), "{flags:?}: no `{word}`: {text}");
        }
    }
}

/// The log of a daemon up to the line that announces that it serves.
fn first_log(listen: &str, settings: &[&str]) -> String {
    let folder = tables();
    let daemon = Launcher::new(PROGRAM)
        .listen(listen)
        .tables(folder.path())
        .settings(settings)
        .start()
        .expect("ready");
    daemon.log_line("serving");
    daemon.log()
}

#[test]
fn a_daemon_that_other_machines_can_reach_warns() {
    let wide = "0.0.0.0:0";
    let log = first_log(wide, &[]);
    assert!(
        log.contains("WARN") && log.contains("beyond this machine"),
        "{log}"
    );
    assert!(
        log.contains("without keys") && log.contains("access.keys_file"),
        "{log}"
    );
    // Over plain HTTP, keys can be read on the way.
    let log = first_log(wide, &[&keys(&entry("a", "secret", ""))]);
    assert!(log.contains("take the keys"), "{log}");
    let log = first_log("127.0.0.1:0", &[]);
    assert!(!log.contains("WARN"), "{log}");
}
