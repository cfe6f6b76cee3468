//! Exports without room: refused before they begin, or ended while they write, with the missing bytes and how to
//! resume.

use std::{
    fs,
    process::{Command, Output, Stdio},
};

use strew_testkit::{process::Running, wait::until};

use super::{LARGE, SMALL, export, exported, tree};
use crate::support::{
    command::errors,
    daemon::{PROGRAM, strew},
    disk::SmallDisk,
};

/// Whether an error names the cause, how far it came, and what to do.
fn assert_no_room(output: &Output, cause: &str) {
    let said = errors(output);
    assert_eq!(output.status.code(), Some(1), "{said}");
    for words in [
        cause,
        "of 1024 chunks exist",
        "the same command resumes there",
    ] {
        assert!(said.contains(words), "no `{words}`: {said}");
    }
}

#[test]
fn what_does_not_fit_is_refused_before_it_begins() {
    let Some(disk) = SmallDisk::mount("1m") else {
        return;
    };
    let out = disk.path().join("world").display().to_string();
    for to in ["-o", "--archive"] {
        let refused = export(&[&LARGE[..], &[to, &out]].concat());
        let said = errors(&refused);
        assert_eq!(refused.status.code(), Some(1), "{said}");
        assert!(said.contains("the export takes about 3"), "{said}");
        assert!(said.contains("free: choose a smaller box"), "{said}");
        // Nothing is left that would keep a smaller export out.
        exported(&[&SMALL[..], &[to, &out]].concat());
        exported(&["--check", &out]);
        let _ = fs::remove_dir_all(&out);
    }
}

#[test]
fn a_folder_goes_on_once_there_is_room() {
    // 33 chunks of 32 KiB.
    goes_on_once_there_is_room("-o", ".partial/journal", 3000);
}

#[test]
fn an_archive_goes_on_once_there_is_room() {
    goes_on_once_there_is_room("--archive", "", 1 << 20);
}

/// Fills the disk while an export runs, once a file of its has some length.
fn goes_on_once_there_is_room(to: &str, growing: &str, length: u64) {
    let Some(disk) = SmallDisk::mount("64m") else {
        return;
    };
    let out = disk.path().join("world");
    let text = out.display().to_string();
    let growing = match growing {
        "" => out.with_extension("partial"),
        name => out.join(name),
    };
    let flags = [&LARGE[..], &[to, &text]].concat();
    let mut command = strew();
    command.args(["export", "-q", "--threads=1"]).args(&flags);
    let child = Running::start(command.stderr(Stdio::piped()));
    until("some chunks are there", || {
        (fs::metadata(&growing).ok()?.len() > length).then_some(())
    });
    // It must not write on while its disk shrinks.
    child.signal("STOP");
    disk.leave_free(1 << 20);
    child.signal("CONT");
    let output = child.end();
    assert_no_room(&output, "No space left on device");
    assert!(!out.join("manifest.json").exists() && !out.is_file());
    if out.is_dir() {
        let before = tree(&out).len();
        assert!(before > 35, "{before}");
    }
    // There is still none, whether it is known before the first byte or not.
    let again = export(&flags);
    let said = errors(&again);
    assert_eq!(again.status.code(), Some(1), "{said}");
    assert!(
        said.contains("make room, and the same command resumes there"),
        "{said}"
    );
    assert!(!said.contains("choose"), "{said}");
    disk.resize("64m");
    exported(&flags);
    exported(&["--check", &text]);
}

#[test]
fn what_is_no_file_is_not_read() {
    // It has zeros without end.
    for flags in [
        &[&SMALL[..], &["--archive", "/dev/full"]].concat()[..],
        &["--check", "/dev/full"],
    ] {
        let refused = export(flags);
        let said = errors(&refused);
        assert!(!refused.status.success());
        assert!(
            said.contains("/dev/full") && said.contains("regular file"),
            "{said}"
        );
    }
}

#[test]
fn an_archive_goes_on_once_its_file_may_be_longer() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("world.zip").display().to_string();
    let flags = [&LARGE[..], &["--archive", &path]].concat();
    // At most 1 or 2 MiB, depending on the shell; a write beyond that fails, as on a full disk.
    let limited = "trap '' XFSZ; ulimit -f 2048; exec \"$@\"";
    let output = Command::new("sh")
        .args(["-c", limited, "sh", PROGRAM, "export", "-q"])
        .args(&flags)
        .output()
        .expect("a shell");
    assert_no_room(&output, "File too large");
    exported(&flags);
    exported(&["--check", &path]);
}
