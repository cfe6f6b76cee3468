//! `strew forge mix`: kinds for a table of one's own, refused flags, an interrupt.

use std::{
    fs,
    path::Path,
    process::{Command, Output, Stdio},
};

use strew_core::Table;
use strew_forge::{labels, read_table, write_table};
use strew_testkit::{process::Running, wait::until};

use crate::support::{
    command::{assert_says, errors},
    daemon::strew,
};

/// A folder with a small table, whose mixes are never accepted.
fn folder() -> (tempfile::TempDir, Table) {
    let folder = tempfile::tempdir().expect("a folder");
    let alpha = "(5-sqrt(3))/2".parse().expect("valid");
    let table = Table::undisplaced(alpha, 12, "mine").expect("small");
    write_table(&folder.path().join("mine.strew"), &table).expect("writable");
    (folder, table)
}

fn mix(folder: &Path, flags: &[&str]) -> Command {
    let mut command = strew();
    command.current_dir(folder);
    command.args(["forge", "mix"]).args(flags);
    command
}

fn run(folder: &Path, flags: &[&str]) -> Output {
    mix(folder, flags).output().expect("the program runs")
}

#[test]
fn labels_are_those_of_the_library_whatever_the_order_of_shares() {
    let (folder, table) = folder();
    let folder = folder.path();
    let flags = ["--table", "mine.strew", "--shares", "3:1"];
    let rejected = run(folder, &flags);
    assert_eq!(rejected.status.code(), Some(1));
    let text = errors(&rejected);
    assert!(
        text.contains("low_power") && text.contains("--keep-rejected"),
        "{text}"
    );
    let kept = run(folder, &[&flags[..], &["--keep-rejected"]].concat());
    assert!(kept.status.success(), "{}", errors(&kept));
    let name = "mine-5-sqrt3-over-2-r12-labels-1-3.strew";
    let made = read_table(&folder.join(name)).expect("written");
    let shares = "1:3".parse().expect("valid");
    let expected = labels(&table, &shares, &()).expect("valid");
    assert_eq!(Some(&made), expected.as_ref());
    let printed = String::from_utf8(kept.stdout).expect("text");
    assert_eq!(printed, format!("{}  {name}\n", made.digest()));
    // An existing file is left alone.
    let again = run(folder, &flags);
    assert_eq!(again.status.code(), Some(2));
    assert_says(&again, "--force");
}

#[test]
fn joint_tables_move_points() {
    let (folder, table) = folder();
    let folder = folder.path();
    let flags = ["--table", "mine.strew", "--shares", "1:1", "--joint"];
    let more = ["--steps", "9", "--keep-rejected", "-o", "joint.strew", "-q"];
    let made = run(folder, &[&flags[..], &more].concat());
    assert!(made.status.success(), "{}", errors(&made));
    let made = read_table(&folder.join("joint.strew")).expect("written");
    assert_ne!(made.displacements(), table.displacements());
    assert_eq!(
        made.mix().map(|mix| mix.shares().to_string()),
        Some("1:1".into())
    );
}

#[cfg(target_os = "linux")]
#[test]
fn an_interrupt_leaves_nothing() {
    let (folder, _) = folder();
    let folder = folder.path();
    let flags = ["--table", "mine.strew", "--shares", "1:1", "--joint"];
    let long = [&flags[..], &["--steps", "10000", "-o", "joint.strew"]].concat();
    let child = Running::start(mix(folder, &long).stderr(Stdio::piped()));
    // A process that catches the signal shows it in its status.
    until("the signal is caught", || {
        let status = fs::read_to_string(format!("/proc/{}/status", child.id())).ok()?;
        let caught = status.lines().find_map(|l| l.strip_prefix("SigCgt:"))?;
        let caught = u64::from_str_radix(caught.trim(), 16).ok()?;
        (caught & 0b10 != 0).then_some(())
    });
    child.signal("INT");
    let output = child.end();
    assert_eq!(output.status.code(), Some(130));
    let text = errors(&output);
    assert!(text.contains("interrupted"), "{text}");
    assert!(!folder.join("joint.strew").exists());
}
