//! When the machine does not do as it should: full disks, folders that are none, taken ports, bad
//! settings. What is said, the exit code, and that nothing broken is left behind.

use std::{
    fs,
    path::{Path, PathBuf},
    process::{Command, Output, Stdio},
};

use strew_forge::{Checkpoint, read_table};

use crate::daemon::{strew, tables, until};

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// A disk that is full but for some bytes.
struct SmallDisk {
    folder: tempfile::TempDir,
}

impl SmallDisk {
    /// A file system of a megabyte, if this process may mount one.
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

    /// Leaves no room at all.
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

    /// The names there are, but for the filler.
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
fn a_full_device_is_told_and_is_no_success() {
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
        let text = said(&output);
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
    let text = said(&output);
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
    assert!(first.status.success(), "{}", said(&first));
    let table = disk.path().join("t.strew");
    let old = fs::read(&table).expect("written");
    disk.fill();
    let second = forge(&["--seed", "2", "--force"]);
    let text = said(&second);
    assert_eq!(second.status.code(), Some(1), "{text}");
    assert!(text.contains("no checkpoint is kept"), "{text}");
    assert!(
        text.contains("t.strew") && text.contains("No space left"),
        "{text}"
    );
    assert_eq!(fs::read(&table).expect("still there"), old);
    assert_eq!(disk.names(), [Path::new("t.strew")], "nothing else is left");
}

/// Kills the forge at some moment and reads what it left; what another reads meanwhile is what a kill
/// at that very moment would leave.
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
        // Some rounds go on to the end, and others end sooner or later.
        let most = [1, 3, 10, 40, 150, u64::MAX][round];
        let mut reads = 0;
        until("it was read often enough", || {
            for _ in 0..20 {
                let checkpoint = Checkpoint::read_file(&kept).expect("whole, or not there");
                reads += u64::from(checkpoint.is_some());
                if table.exists() {
                    read_table(&table).expect("whole");
                }
            }
            let is_over = child.try_wait().expect("a child").is_some();
            (is_over || reads >= most).then_some(())
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
    assert!(table.exists(), "some round went on to the end");
    // Whatever was left half written is in nobody's way.
    let loaded = strew().args(["table", "show"]).arg(&table).output();
    assert!(loaded.expect("the program runs").status.success());
}

fn serve(flags: &[&str]) -> Output {
    let tables = tables();
    strew()
        .args(["serve", "--tables"])
        .arg(tables.path())
        .args(flags)
        .output()
        .expect("the program runs")
}

#[test]
fn a_daemon_that_cannot_start_says_why_and_with_what_code() {
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
        let output = serve_with(&flags);
        let text = said(&output);
        assert_eq!(output.status.code(), Some(code), "{flags:?}: {text}");
        assert!(output.stdout.is_empty(), "{flags:?}");
        for word in words {
            assert!(text.contains(word), "{flags:?}: no `{word}`: {text}");
        }
    }
}

/// Flags may replace the folder of tables.
fn serve_with(flags: &[&str]) -> Output {
    if flags.contains(&"--tables") {
        let mut command = strew();
        return command
            .arg("serve")
            .args(flags)
            .output()
            .expect("the program runs");
    }
    serve(flags)
}

#[test]
fn nothing_is_timed_by_a_clock_that_can_jump() {
    fn look(folder: &Path, found: &mut Vec<PathBuf>) {
        for entry in fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                look(&path, found);
            } else if fs::read_to_string(&path).is_ok_and(|text| text.contains("SystemTime")) {
                found.push(path);
            }
        }
    }
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut found = vec![];
    look(&source, &mut found);
    // Deadlines, intervals and ages are measured with `Instant`, which only goes forward. The time of
    // day is told in metrics and spans, and compared with that of files by one who expects it to jump.
    found.retain(|path| {
        let known = [
            "ops/metrics/mod.rs",
            "ops/reload/look.rs",
            "ops/spans/answered.rs",
        ];
        !known.iter().any(|known| path.ends_with(known))
    });
    assert!(found.is_empty(), "{found:?}");
}
