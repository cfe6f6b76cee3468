//! Files that are not what they should be: pipes and devices in the place of tables and keys.

use std::{path::Path, process::Command, time::Instant};

use strew_testkit::{
    daemon::Launcher,
    wait::{PATIENCE, until},
};

use crate::support::daemon::{Daemon, PROGRAM};

fn pipe(path: &Path) {
    let made = Command::new("mkfifo").arg(path).status();
    assert!(made.expect("mkfifo").success());
}

#[test]
fn pipes_and_devices_among_the_tables_are_refused_and_the_daemon_stops() {
    let mut daemon = Daemon::with_log(&["reload.watch_seconds=0.05", "shutdown.drain_seconds=1"]);
    pipe(&daemon.folder().join("pipe.strew"));
    std::os::unix::fs::symlink("/dev/zero", daemon.folder().join("zero.strew")).expect("a link");
    for file in ["pipe.strew", "zero.strew"] {
        let line = daemon.log_line(file);
        assert!(line.contains("not a regular file"), "{line}");
    }
    std::fs::remove_file(daemon.folder().join("pipe.strew")).expect("removable");
    daemon.signal("HUP");
    daemon.log_line("cause=\"signal\" loaded=0");
    let start = Instant::now();
    daemon.signal("TERM");
    until("it stops", || daemon.ended());
    assert!(start.elapsed() < PATIENCE / 2);
}

#[test]
fn a_pipe_in_the_place_of_keys_or_certificates_is_refused_at_the_start() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("pipe");
    pipe(&file);
    let file = file.display();
    let tls = format!("tls.certificate={file}");
    for settings in [
        vec![format!("access.keys_file={file}")],
        vec![tls, format!("tls.key={file}")],
    ] {
        let settings: Vec<&str> = settings.iter().map(String::as_str).collect();
        let started = Launcher::new(PROGRAM).settings(&settings).start();
        let refused = started.err().expect("refused").to_string();
        for words in ["exit status: 2", "not a regular file"] {
            assert!(refused.contains(words), "no `{words}`: {refused}");
        }
    }
}

#[test]
fn what_is_worth_a_warning_is_logged_at_the_start() {
    let folder = tempfile::tempdir().expect("a folder");
    let keys = folder.path().join("keys.toml");
    let hash = "79423e1215132ebc7c653958bcde70513ee6333acf75951861c0a557eb177698";
    std::fs::write(&keys, format!("[[key]]\nname = 'a'\nhash = '{hash}'\n")).expect("writable");
    let setting = format!("access.keys_file={}", keys.display());
    for (mode, is_open) in [(0o644, true), (0o640, false)] {
        use std::os::unix::fs::PermissionsExt as _;
        let permissions = std::fs::Permissions::from_mode(mode);
        std::fs::set_permissions(&keys, permissions).expect("allowed");
        let daemon = Daemon::with_log(&[&setting]);
        daemon.log_line("serving");
        assert_eq!(daemon.log().contains("can read the keys file"), is_open);
    }
}
