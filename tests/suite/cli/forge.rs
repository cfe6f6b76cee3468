//! `strew forge`: interrupted and killed work, rejected tables, target curves.

use std::{
    fs,
    path::Path,
    process::{Command, Output, Stdio},
};

use strew_forge::{Checkpoint, read_table};
use strew_testkit::{process::Running, wait::until};

use crate::support::{
    command::{assert_says, errors},
    daemon::strew,
};

/// A small job: it takes seconds, and its table is never accepted.
fn forge(folder: &Path, flags: &[&str]) -> Command {
    let mut command = strew();
    command.current_dir(folder);
    command.args(["forge", "--radius", "12", "-o", "t.strew"]);
    command.args(flags);
    command
}

fn run(folder: &Path, flags: &[&str]) -> Output {
    forge(folder, flags).output().expect("the program runs")
}

#[test]
fn killed_work_resumes_to_the_same_table() {
    let whole = tempfile::tempdir().expect("a folder");
    let flags = ["--steps", "600", "--keep-rejected"];
    assert!(run(whole.path(), &flags).status.success());
    let broken = tempfile::tempdir().expect("a folder");
    let folder = broken.path();
    let kept = folder.join("t.strew.checkpoint");
    let often = [&flags[..], &["--checkpoint-every", "0"]].concat();
    let mut child = forge(folder, &often)
        .stderr(Stdio::null())
        .spawn()
        .expect("the program runs");
    until("a checkpoint is kept", || kept.exists());
    child.kill().expect("it still runs");
    let status = child.wait().expect("a child");
    assert!(!status.success() && !folder.join("t.strew").exists());

    // Another job neither uses the checkpoint nor touches it.
    let before = fs::read(&kept).expect("kept");
    let other = run(folder, &["--steps", "599", "--keep-rejected"]);
    assert_eq!(other.status.code(), Some(2));
    let text = errors(&other);
    assert!(
        text.contains("another job") && text.contains("--restart"),
        "{text}"
    );
    assert_eq!(fs::read(&kept).expect("kept"), before);

    let again = run(folder, &flags);
    let text = errors(&again);
    assert!(again.status.success(), "{text}");
    assert!(text.contains("resuming at step"), "{text}");
    let table = |folder: &Path| fs::read(folder.join("t.strew")).expect("written");
    assert_eq!(table(folder), table(whole.path()));
    assert!(!kept.exists(), "a finished job leaves no checkpoint");
}

#[cfg(unix)]
#[test]
fn an_interrupt_keeps_a_checkpoint() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let kept = folder.join("t.strew.checkpoint");
    let endless = ["--steps", "1000000", "--checkpoint-every", "0"];
    let child = Running::start(forge(folder, &endless).stderr(Stdio::piped()));
    until("a checkpoint is kept", || kept.exists());
    child.signal("INT");
    let output = child.end();
    assert_eq!(output.status.code(), Some(130));
    let text = errors(&output);
    assert!(text.contains("the same command resumes from"), "{text}");
    assert!(kept.exists() && !folder.join("t.strew").exists());
    // A damaged checkpoint is refused with a message; --restart ignores it.
    fs::write(&kept, "strewck3 and no more").expect("writable");
    let refused = run(folder, &["--steps", "2"]);
    assert_eq!(refused.status.code(), Some(2));
    assert_says(&refused, "damaged");
    let anew = run(folder, &["--steps", "2", "--restart", "--keep-rejected"]);
    assert!(anew.status.success(), "{}", errors(&anew));
    assert!(!kept.exists());
}

#[test]
fn a_rejected_table_can_be_kept_without_repeating_the_work() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let rejected = run(folder, &["--steps", "5"]);
    assert_eq!(rejected.status.code(), Some(1));
    let text = errors(&rejected);
    assert!(
        text.contains("low_power") && text.contains("--keep-rejected"),
        "{text}"
    );
    assert!(!folder.join("t.strew").exists());
    let kept = run(folder, &["--steps", "5", "--keep-rejected"]);
    assert!(kept.status.success());
    assert_says(&kept, "resuming at step 5 of 5");
    // The checkpoint of a rejected job does not block other jobs.
    assert_eq!(
        run(folder, &["--steps", "5", "--force"]).status.code(),
        Some(1)
    );
    let other = run(folder, &["--steps", "6", "--force"]);
    assert_eq!(other.status.code(), Some(1));
    assert_says(&other, "beginning anew");
}

#[test]
fn an_impossible_target_is_announced_and_reported_as_missed() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let curve = "[[piece]]\nfrom = 0\nto = 0.9\npower = 0\n";
    fs::write(folder.join("curve.toml"), curve).expect("writable");
    let job = [
        "--profile",
        "mine",
        "--target",
        "curve.toml",
        "--steps",
        "3",
    ];
    let missed = run(folder, &job);
    assert_eq!(missed.status.code(), Some(1));
    let text = errors(&missed);
    // 1 − π·0.9² at distance 0.
    let warning = text.find("no point set has exactly this power curve");
    assert!(text.contains("-1.54 at distance 0.00"), "{text}");
    let verdict = text.find("the target is missed: the radial power is");
    assert!(
        warning.expect("warned") < verdict.expect("judged"),
        "{text}"
    );
    assert!(text.contains("--keep-rejected") && !folder.join("t.strew").exists());
    let kept = run(folder, &[&job[..], &["--keep-rejected"]].concat());
    assert!(kept.status.success());
    assert_says(&kept, "the target is missed");
}

#[test]
fn a_table_that_will_be_rejected_is_announced_as_such() {
    let folder = tempfile::tempdir().expect("a folder");
    for (alpha, announced, doubt) in [
        ("sqrt(2)", ": 121 blocks,", "(11 × 11 blocks)"),
        // The map has more intervals, but points lie in 31 − 20 of them only.
        (
            "1.55",
            ": 121 blocks,",
            "(11 × 11 blocks, and the pattern repeats every 40 grid units)",
        ),
    ] {
        let output = run(
            folder.path(),
            &["--alpha", alpha, "--steps", "1", "--force"],
        );
        let text = errors(&output);
        assert!(text.contains(announced), "{text}");
        let warning = text.find(doubt).unwrap_or_else(|| panic!("{text}"));
        let verdict = text.find("the table is rejected").expect("judged");
        assert!(warning < verdict, "{text}");
    }
    let blank = ["--profile", "pattern", "--steps", "1", "--restart"];
    let text = errors(&run(folder.path(), &blank));
    assert!(!text.contains("warning"), "{text}");
}

#[test]
fn bad_curves_are_refused_before_any_work() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    for (text, words) in [
        ("", "0 points"),
        ("0 1\n0.5 much\n", "line 2"),
        ("0 -1\n", "power from 0 to 100"),
        ("nu power\n0 1\n", "line 1"),
        ("[[piece]]\nfrom = 0\nto = 1\n", "neither `power` nor `law`"),
        (
            "[[piece]]\nfrom = 0\nto = 1\npower = 1\n[[piece]]\nfrom = 1.5\nto = 2\npower = 1\n",
            "from = 1.5, a gap",
        ),
        ("[[piece]]\nfrom = 0\nto = 1\npower = 1\nhue = 2\n", "hue"),
    ] {
        fs::write(folder.join("curve"), text).expect("writable");
        let output = run(folder, &["--profile", "mine", "--target", "curve"]);
        assert_eq!(output.status.code(), Some(2), "{text:?}");
        let message = errors(&output);
        assert!(
            message.contains(words) && message.contains("allowed"),
            "{message}"
        );
    }
    let flags = ["--profile", "Not A Name", "--target", "curve"];
    fs::write(folder.join("curve"), "0 1\n").expect("writable");
    let output = run(folder, &flags);
    assert_eq!(output.status.code(), Some(2));
    assert_says(&output, "a-z");
    assert_eq!(fs::read_dir(folder).expect("a folder").count(), 1);
}

/// Kills the forge at some moment and reads the files it left. Files read while it runs are those
/// that a kill at that moment would leave.
#[test]
fn a_forge_that_is_killed_at_any_moment_leaves_whole_files() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let (table, kept) = (folder.join("t.strew"), folder.join("t.strew.checkpoint"));
    let mut seen = 0;
    for round in 0..6 {
        let mut child = strew()
            .current_dir(folder)
            .args(["forge", "--radius", "12", "-o", "t.strew", "--force", "-q"])
            .args([
                "--steps",
                "300",
                "--checkpoint-every",
                "0",
                "--keep-rejected",
            ])
            .stdout(Stdio::null())
            .spawn()
            .expect("the program runs");
        // The last round runs to the end; the others are killed after this many reads.
        let most = [1, 3, 10, 40, 150, u64::MAX][round];
        let mut reads = 0;
        until("the checkpoint was read often enough", || {
            for _ in 0..20 {
                let checkpoint = Checkpoint::read_file(&kept).expect("whole, or not there");
                reads += u64::from(checkpoint.is_some());
                if table.exists() {
                    read_table(&table).expect("whole");
                }
            }
            let is_over = child.try_wait().expect("a child").is_some();
            is_over || reads >= most
        });
        child.kill().expect("killed, or over");
        child.wait().expect("a child");
        seen += reads;
        Checkpoint::read_file(&kept).expect("whole, or not there");
        if table.exists() {
            read_table(&table).expect("whole");
        }
    }
    assert!(seen > 100, "checkpoints were read only {seen} times");
    assert!(table.exists(), "a round ran to the end");
    // Half-written files do not get in the way.
    let loaded = strew().args(["table", "show"]).arg(&table).output();
    assert!(loaded.expect("the program runs").status.success());
}
