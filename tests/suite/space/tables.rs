//! Tables in space stand beside those of the plane: in the list of profiles, in folders, and when these are read again.

use std::fs;

use strew_core::space::Table;
use strew_testkit::{daemon::Launcher, wait::until};

use crate::support::daemon::{Daemon, PROGRAM, no_tables};

fn table() -> Table {
    let alpha = "sqrt(3)".parse().expect("a number");
    Table::undisplaced(alpha, 5, "test").expect("a table")
}

#[test]
fn the_lists_of_profiles_are_apart() {
    let daemon = Daemon::built_in();
    let list = daemon.get("/v1/space/profiles").json();
    let profiles = list["profiles"].as_array().expect("a list");
    let named = |p: &serde_json::Value| {
        format!("{} {}", p["profile"].as_str().expect("a name"), p["blocks"])
    };
    let named: Vec<String> = profiles.iter().map(named).collect();
    assert_eq!(named, ["blue 9261", "blue 19683", "spaced 9261"]);
    let flat = daemon.get("/v1/profiles").json();
    let digests = |list: &serde_json::Value| -> Vec<String> {
        let list = list["profiles"].as_array().expect("a list");
        list.iter().map(|p| p["digest"].to_string()).collect()
    };
    assert!(
        digests(&list)
            .iter()
            .all(|digest| !digests(&flat).contains(digest))
    );
    let finer = daemon.get("/v1/space/points?bbox=0,0,0,2,2,2&spacing=1&map=r20");
    assert_eq!(finer.status, 200, "{}", finer.text());
}

#[test]
fn a_folder_may_have_tables_of_both_dimensions_under_one_name() {
    let tables = no_tables();
    fs::write(tables.path().join("a.strew"), table().to_bytes()).expect("written");
    let flat = crate::support::daemon::table("sqrt(3)", "test");
    fs::write(tables.path().join("b.strew"), flat.to_bytes()).expect("written");
    let daemon = Daemon::with_tables(tables, &["tables.preload_bytes=0"]);
    let set = "spacing=1&profile=test&alpha=sqrt(3)";
    let space = daemon.get(&format!("/v1/space/points?bbox=0,0,0,4,4,4&{set}"));
    assert_eq!(space.header("strew-table"), table().digest().to_string());
    let plane = daemon.get(&format!("/v1/points?bbox=0,0,4,4&{set}"));
    assert_eq!(plane.header("strew-table"), flat.digest().to_string());
    // Another table in its place.
    let other =
        Table::undisplaced("sqrt(3)".parse().expect("a number"), 6, "other").expect("a table");
    fs::write(daemon.folder().join("c.strew"), other.to_bytes()).expect("written");
    daemon.signal("HUP");
    let path = "/v1/space/count?bbox=0,0,0,4,4,4&spacing=1&profile=other&alpha=sqrt(3)";
    until("the folder is read", || daemon.get(path).status == 200);
}

#[test]
fn a_damaged_table_is_refused_by_its_name() {
    let tables = no_tables();
    let mut bytes = table().to_bytes();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    fs::write(tables.path().join("damaged.strew"), bytes).expect("written");
    let started = Launcher::new(PROGRAM).tables(tables.path()).start();
    let refused = started.err().expect("it does not start").to_string();
    assert!(refused.contains("damaged.strew"), "{refused}");
}
