//! Tables of points in space on the command line: made, kept, resumed, shown, measured; refused where they do not belong.

use std::{
    fs,
    path::Path,
    process::{Command, Output, Stdio},
};

use serde_json::Value;
use strew_testkit::{process::Running, wait::until};

use crate::support::{
    command::{assert_says, errors},
    daemon::strew,
};

/// A small job: it takes seconds, and its table is never accepted.
fn forge(folder: &Path, flags: &[&str]) -> Command {
    let mut command = strew();
    command.current_dir(folder);
    command.args(["forge", "--space", "--radius", "3", "-o", "t.strew"]);
    command.args(flags);
    command
}

fn run(folder: &Path, args: &[&str]) -> Output {
    let mut command = strew();
    command.current_dir(folder).args(args);
    command.output().expect("the program runs")
}

#[cfg(unix)]
#[test]
fn interrupted_work_resumes_to_the_same_table() {
    let whole = tempfile::tempdir().expect("a folder");
    let flags = ["--profile", "spaced", "--steps", "1500", "--keep-rejected"];
    let made = forge(whole.path(), &flags).output().expect("it runs");
    let text = errors(&made);
    assert!(made.status.success(), "{text}");
    assert!(text.contains("forging t.strew: 125 blocks, 1"), "{text}");
    let broken = tempfile::tempdir().expect("a folder");
    let folder = broken.path();
    let kept = folder.join("t.strew.checkpoint");
    let often = [
        "--profile",
        "spaced",
        "--steps",
        "1500",
        "--checkpoint-every",
        "0",
    ];
    let child = Running::start(forge(folder, &often).stderr(Stdio::piped()));
    until("a checkpoint is kept", || kept.exists());
    child.signal("INT");
    let stopped = child.end();
    assert_eq!(stopped.status.code(), Some(130), "{}", errors(&stopped));
    assert!(errors(&stopped).contains("the same command resumes from"));
    // Neither a job of the plane nor another one in space uses the checkpoint.
    for other in [
        &["forge", "--radius", "3", "-o", "t.strew"][..],
        &[
            "forge", "--space", "--radius", "3", "--seed", "2", "-o", "t.strew",
        ],
    ] {
        let refused = run(folder, other);
        assert_eq!(refused.status.code(), Some(2));
        assert_says(&refused, "--restart");
    }
    let resumed = forge(folder, &flags).output().expect("it runs");
    assert!(resumed.status.success(), "{}", errors(&resumed));
    assert!(errors(&resumed).contains("resuming at step"));
    let table = |folder: &Path| fs::read(folder.join("t.strew")).expect("written");
    assert_eq!(table(folder), table(whole.path()));
    assert!(!kept.exists(), "a finished job leaves no checkpoint");
}

#[test]
fn a_table_in_space_is_shown_and_measured_and_refused_elsewhere() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let rejected = forge(folder, &["--steps", "3"]).output().expect("it runs");
    assert_eq!(rejected.status.code(), Some(1));
    assert_says(&rejected, "low_power");
    let kept = forge(folder, &["--steps", "3", "--keep-rejected"]);
    assert!({ kept }.output().expect("it runs").status.success());

    let shown = run(folder, &["table", "show", "t.strew"]);
    let text = String::from_utf8_lossy(&shown.stdout).into_owned();
    assert!(
        text.contains("points     in space") && text.contains("125 blocks"),
        "{text}"
    );
    assert!(
        text.contains("ranks      yes") && text.contains("measured   twin"),
        "{text}"
    );
    let verified = run(folder, &["table", "verify", "t.strew"]);
    assert!(String::from_utf8_lossy(&verified.stdout).contains("t.strew: good, points in space"));
    let exported = run(folder, &["table", "export", "t.strew"]);
    assert_eq!(
        exported.stdout,
        fs::read(folder.join("t.strew")).expect("written")
    );

    let measure = ["measure", "--table", "t.strew", "--window-points", "2000"];
    let flags = [
        "--window-seed",
        "5",
        "--window-seed",
        "9",
        "--window-at",
        "-3,40,7",
    ];
    let twin = ["--twin", "43/26"];
    let measured = run(folder, &[&measure[..], &flags, &twin].concat());
    assert!(measured.status.success(), "{}", errors(&measured));
    let document: Value = serde_json::from_slice(&measured.stdout).expect("JSON");
    let subject = |i: usize| document["subjects"][i]["subject"].clone();
    assert_eq!(
        [0, 1, 2].map(subject),
        ["twin 43/26", "window seed 5", "window seed 9"]
    );
    assert_eq!(document["subjects"][0]["points"], 4913);
    for figure in [
        "low_power",
        "delta_min",
        "mean_distance",
        "anisotropy",
        "local_largest",
    ] {
        assert!(
            document["subjects"][1]["figures"][figure].is_number(),
            "{figure}"
        );
    }
    assert_eq!(
        document["shared"]["pairs"].as_array().map(Vec::len),
        Some(1)
    );
    assert_eq!(
        document["thinned"]["sets"].as_array().map(Vec::len),
        Some(12)
    );
    // Another place has other points.
    let flags = ["--window-seed", "5", "--window-at", "90,0,0"];
    let other = run(folder, &[&measure[..], &flags, &twin].concat());
    let other: Value = serde_json::from_slice(&other.stdout).expect("JSON");
    assert_ne!(
        other["subjects"][1]["figures"],
        document["subjects"][1]["figures"]
    );

    for (args, words) in [
        (
            &["table", "export", "--text", "t.strew"][..],
            "t.strew is a table of points in space",
        ),
        (
            &["forge", "mix", "--shares", "1:1", "--table", "t.strew"],
            "t.strew: a table of points in",
        ),
        (
            &["measure", "--table", "t.strew", "--twin", "71/45"],
            "q even",
        ),
        (
            &["measure", "--table", "t.strew", "--window-at", "1,2"],
            "X,Y,Z",
        ),
        (
            &["measure", "--table", "t.strew", "--window-points", "5"],
            "from 1000 to 1000000",
        ),
        (
            &["measure", "--table", "t.strew", "--picture", "p.svg"],
            "--picture",
        ),
        (&["forge", "--space", "--profile", "pink"], "blue, spaced"),
        (&["forge", "--space", "--radius", "23"], "1 to 22"),
        (&["forge", "--space", "--alpha", "1.3"], "1.51"),
    ] {
        let refused = run(folder, args);
        assert_eq!(
            refused.status.code(),
            Some(2),
            "{args:?} {}",
            errors(&refused)
        );
        assert!(
            errors(&refused).contains(words),
            "{args:?} {}",
            errors(&refused)
        );
    }
    assert!(!folder.join("p.svg").exists());
    let mut damaged = fs::read(folder.join("t.strew")).expect("written");
    let middle = damaged.len() / 2;
    damaged[middle] ^= 1;
    fs::write(folder.join("bad.strew"), damaged).expect("writable");
    for args in [
        ["table", "verify", "bad.strew"],
        ["measure", "--table", "bad.strew"],
    ] {
        let refused = run(folder, &args);
        assert_eq!(refused.status.code(), Some(1), "{args:?}");
        assert_says(&refused, "bad.strew");
    }
}
