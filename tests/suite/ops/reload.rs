//! Tables that change while the daemon runs: good ones are served, bad ones refused, and streams
//! end with the table they began with.

use std::{fs, path::Path};

use strew_core::Table;
use strew_testkit::{
    http1,
    tables::{random, write},
    wait::until,
};

use crate::support::daemon::{Daemon, PROFILE, other_table, table};

const ALPHA: &str = "(5-sqrt(3))/2";
const POINTS: &str = "/v1/points?bbox=0,0,50,50&density=1&profile=test&format=f64";

/// Replaces a file atomically.
fn replace(folder: &Path, name: &str, bytes: &[u8]) {
    let new = folder.join(format!("{name}.new"));
    fs::write(&new, bytes).expect("writable");
    fs::rename(new, folder.join(name)).expect("renamed");
}

/// Puts a table in the place of the first one.
fn put(daemon: &Daemon, table: &Table) {
    replace(daemon.folder(), "a.strew", &table.to_bytes());
}

/// A daemon that reloads its tables only on a signal.
fn unwatched() -> Daemon {
    Daemon::start(&["reload.watch_seconds=0"])
}

fn digest(daemon: &Daemon) -> String {
    daemon.get(POINTS).header("strew-table").to_owned()
}

fn until_served(daemon: &Daemon, table: &Table) {
    let wanted = table.digest().to_string();
    until("the table is served", || digest(daemon) == wanted);
}

fn has_profile(daemon: &Daemon, profile: &str) -> bool {
    let path = format!("/v1/count?bbox=0,0,5,5&density=1&profile={profile}");
    daemon.get(&path).status == 200
}

#[test]
fn a_signal_applies_new_changed_and_removed_tables() {
    let daemon = unwatched();
    let before = daemon.get(POINTS);
    assert!(!has_profile(&daemon, "added"));
    put(&daemon, &other_table(ALPHA, PROFILE));
    write(daemon.folder(), "c.strew", &table(ALPHA, "added"));
    fs::remove_file(daemon.folder().join("b.strew")).expect("removable");
    assert_eq!(digest(&daemon), before.header("strew-table"));
    daemon.signal("HUP");
    until_served(&daemon, &other_table(ALPHA, PROFILE));
    assert!(has_profile(&daemon, "added"));
    assert!(has_profile(&daemon, "blue"), "built-in tables stay");
    let gone = daemon.get(&format!("{POINTS}&alpha=sqrt(3)"));
    assert_eq!(gone.status, 400, "{}", gone.text());
    let after = daemon.get(POINTS);
    assert_ne!(after.body, before.body);
    assert_ne!(after.header("etag"), before.header("etag"));
    // And back: nothing is left of the table in between.
    put(&daemon, &table(ALPHA, PROFILE));
    daemon.signal("HUP");
    until_served(&daemon, &table(ALPHA, PROFILE));
    assert_eq!(daemon.get(POINTS).body, before.body);
}

#[test]
fn a_change_of_the_folder_is_noticed() {
    let daemon = Daemon::start(&["reload.watch_seconds=0.05"]);
    let first = digest(&daemon);
    put(&daemon, &other_table(ALPHA, PROFILE));
    until_served(&daemon, &other_table(ALPHA, PROFILE));
    assert_ne!(digest(&daemon), first);
    // A file overrides a built-in table for as long as it exists.
    let built_in = |daemon: &Daemon| {
        let answer = daemon.get("/v1/points?bbox=0,0,5,5&density=1&map=s");
        answer.header("strew-table").to_owned()
    };
    let shipped = built_in(&daemon);
    let of_blue = random(ALPHA, "blue", 49);
    write(daemon.folder(), "blue.strew", &of_blue);
    let wanted = of_blue.digest().to_string();
    until("it is replaced", || built_in(&daemon) == wanted);
    fs::remove_file(daemon.folder().join("blue.strew")).expect("removable");
    until("it is back", || built_in(&daemon) == shipped);
}

#[test]
fn a_bad_file_is_refused_and_the_table_before_serves_on() {
    let daemon = unwatched();
    let before = daemon.get(POINTS);
    let good = table(ALPHA, PROFILE).to_bytes();
    let mut flipped = good.clone();
    flipped[good.len() / 2] ^= 1;
    let damages: [(&str, &[u8]); 4] = [
        ("flipped", &flipped),
        ("short", &good[..good.len() - 1]),
        ("empty", b""),
        ("foreign", b"# no table at all\n"),
    ];
    for (name, bytes) in damages {
        replace(daemon.folder(), "a.strew", bytes);
        // A second table for the same queries is refused, too.
        write(daemon.folder(), "z.strew", &table("sqrt(3)", PROFILE));
        // A good table shows when the folder has been read.
        write(daemon.folder(), "good.strew", &table(ALPHA, name));
        daemon.signal("HUP");
        until("the good one is served", || has_profile(&daemon, name));
        let after = daemon.get(POINTS);
        assert_eq!(after.status, 200, "{name}");
        assert_eq!(
            after.header("strew-table"),
            before.header("strew-table"),
            "{name}"
        );
        assert_eq!(after.body, before.body, "{name}");
        assert_eq!(daemon.get(&format!("{POINTS}&alpha=sqrt(3)")).status, 200);
    }
    // A folder that cannot be read removes no table.
    let hidden = daemon.folder().with_extension("hidden");
    fs::rename(daemon.folder(), &hidden).expect("renamed");
    daemon.signal("HUP");
    fs::rename(&hidden, daemon.folder()).expect("renamed");
    put(&daemon, &other_table(ALPHA, PROFILE));
    daemon.signal("HUP");
    until_served(&daemon, &other_table(ALPHA, PROFILE));
    assert!(has_profile(&daemon, "foreign"));
}

#[test]
fn a_stream_ends_with_the_table_it_began_with() {
    let daemon = unwatched();
    let path = "/v1/points?bbox=0,0,2000,2000&density=1&profile=test&format=f64";
    let whole = daemon.get(path);
    assert_eq!(
        whole.body.len(),
        16 * whole.header("strew-count").parse::<usize>().expect("n")
    );
    let reader = http1::open(daemon.address(), "GET", path, &[]);
    assert_eq!(reader.status, 200);
    put(&daemon, &other_table(ALPHA, PROFILE));
    daemon.signal("HUP");
    until_served(&daemon, &other_table(ALPHA, PROFILE));
    let (body, complete) = reader.finish();
    assert!(complete);
    assert!(body == whole.body, "the stream changed");
    assert!(
        daemon.get(path).body != whole.body,
        "a new answer is the old one"
    );
}

#[test]
fn a_pin_of_a_replaced_table_is_a_conflict() {
    let daemon = unwatched();
    let first = daemon.get(&format!("{POINTS}&limit=10"));
    let (pinned, cursor) = (first.header("strew-table"), first.header("strew-next"));
    put(&daemon, &other_table(ALPHA, PROFILE));
    daemon.signal("HUP");
    until_served(&daemon, &other_table(ALPHA, PROFILE));
    let refused = daemon.get(&format!("{POINTS}&table={pinned}"));
    assert_eq!(refused.status, 409, "{}", refused.text());
    let problem = refused.json();
    assert_eq!(problem["pinned"], pinned);
    assert_eq!(
        problem["loaded"],
        other_table(ALPHA, PROFILE).digest().to_string()
    );
    let loaded = format!("{POINTS}&table={}", other_table(ALPHA, PROFILE).digest());
    assert_eq!(daemon.get(&loaded).status, 200);
    // A cursor belongs to its table.
    let stale = daemon.get(&format!("{POINTS}&cursor={cursor}"));
    assert_eq!(stale.status, 400, "{}", stale.text());
    assert!(stale.text().contains("cursor"), "{}", stale.text());
}
