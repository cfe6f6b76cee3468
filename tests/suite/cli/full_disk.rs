//! Full disks: the error, the exit code, and no broken file left behind. Tests that mount a small
//! file system are skipped where that is not permitted.

use std::{fs, path::Path, process::Output};

use crate::support::{command::errors, daemon::strew, disk::SmallDisk};

fn sample(output: &Path) -> Output {
    strew()
        .args([
            "sample",
            "--bbox",
            "0,0,2000,2000",
            "--spacing",
            "1",
            "--format",
            "f32",
            "-q",
            "-o",
        ])
        .arg(output)
        .output()
        .expect("the program runs")
}

/// A device that takes nothing.
fn full() -> fs::File {
    let device = fs::File::options().write(true).open("/dev/full");
    device.expect("Linux")
}

#[test]
fn a_full_device_is_reported_as_a_failure() {
    for output in [
        sample(Path::new("/dev/full")),
        strew()
            .args(["sample", "--bbox", "0,0,99,99", "--spacing", "1", "-q"])
            .stdout(full())
            .output()
            .expect("the program runs"),
        strew()
            .arg("config")
            .stdout(full())
            .output()
            .expect("the program runs"),
    ] {
        let text = errors(&output);
        assert_eq!(output.status.code(), Some(1), "{text}");
        assert!(text.contains("No space left on device"), "{text}");
    }
}

#[test]
fn points_that_do_not_fit_leave_no_file() {
    let Some(disk) = SmallDisk::mount("1m") else {
        return;
    };
    let output = sample(&disk.path().join("points.f32"));
    let text = errors(&output);
    assert_eq!(output.status.code(), Some(1), "{text}");
    assert!(
        text.contains("No space left") && text.contains("points.f32"),
        "{text}"
    );
    assert!(disk.names().is_empty(), "{:?}", disk.names());
}

#[test]
fn tables_that_do_not_fit_leave_the_old_ones() {
    let Some(disk) = SmallDisk::mount("1m") else {
        return;
    };
    let forge = |flags: &[&str]| {
        strew()
            .current_dir(disk.path())
            .args(["forge", "--radius", "12", "-o", "t.strew", "--steps", "20"])
            .args(["--checkpoint-every", "0", "--keep-rejected"])
            .args(flags)
            .output()
            .expect("the program runs")
    };
    let first = forge(&["--seed", "1"]);
    assert!(first.status.success(), "{}", errors(&first));
    let table = disk.path().join("t.strew");
    let old = fs::read(&table).expect("written");
    disk.fill();
    let second = forge(&["--seed", "2", "--force"]);
    let text = errors(&second);
    assert_eq!(second.status.code(), Some(1), "{text}");
    assert!(text.contains("no checkpoint is kept"), "{text}");
    assert!(
        text.contains("t.strew") && text.contains("No space left"),
        "{text}"
    );
    assert_eq!(fs::read(&table).expect("still there"), old);
    assert_eq!(disk.names(), [Path::new("t.strew")], "nothing else is left");
}
