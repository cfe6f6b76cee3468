//! Full disks: the error, the exit code, and no broken file left behind. Tests that mount a small
//! file system are skipped where that is not permitted.

use std::{
    fs,
    path::{Path, PathBuf},
    process::{Command, Output, Stdio},
};

use crate::support::{command::errors, daemon::strew};

/// A small disk.
struct SmallDisk {
    folder: tempfile::TempDir,
}

impl SmallDisk {
    /// Mounts a file system of 1 MiB, if this process may.
    fn mount() -> Option<Self> {
        let folder = tempfile::tempdir().expect("a folder");
        let mounted = Command::new("mount")
            .args(["-t", "tmpfs", "-o", "size=1m", "strew-test"])
            .arg(folder.path())
            .stderr(Stdio::null())
            .status();
        mounted
            .is_ok_and(|status| status.success())
            .then_some(Self { folder })
    }

    fn path(&self) -> &Path {
        self.folder.path()
    }

    /// Fills the disk to the last byte.
    fn fill(&self) {
        let mut piece = 1 << 20;
        let mut filler = vec![];
        while piece > 0 {
            filler.resize(filler.len() + piece, 0);
            if fs::write(self.path().join("filler"), &filler).is_err() {
                filler.truncate(filler.len() - piece);
                piece /= 2;
            }
        }
    }

    /// The names of all files except the filler.
    fn names(&self) -> Vec<PathBuf> {
        let entries = fs::read_dir(self.path()).expect("a folder");
        let names = entries.map(|entry| entry.expect("an entry").file_name().into());
        names
            .filter(|name: &PathBuf| name != Path::new("filler"))
            .collect()
    }
}

impl Drop for SmallDisk {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg(self.path()).status();
    }
}

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

#[test]
fn a_full_device_is_reported_as_a_failure() {
    for output in [
        sample(Path::new("/dev/full")),
        strew()
            .args(["sample", "--bbox", "0,0,99,99", "--spacing", "1", "-q"])
            .stdout(
                fs::File::options()
                    .write(true)
                    .open("/dev/full")
                    .expect("Linux"),
            )
            .output()
            .expect("the program runs"),
        strew()
            .arg("config")
            .stdout(
                fs::File::options()
                    .write(true)
                    .open("/dev/full")
                    .expect("Linux"),
            )
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
    let Some(disk) = SmallDisk::mount() else {
        println!("skipped: this process may not mount a small file system");
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
    let Some(disk) = SmallDisk::mount() else {
        println!("skipped: this process may not mount a small file system");
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
