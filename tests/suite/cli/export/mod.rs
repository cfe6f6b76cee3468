//! `strew export`: a world as files. A static server answers with the daemon's bytes, a killed export resumes, and
//! `--check` finds every difference.

mod levels;
mod room;
mod served;

use std::{
    collections::BTreeMap,
    fs,
    net::SocketAddr,
    path::Path,
    process::{Output, Stdio},
    time::SystemTime,
};

use strew_testkit::{http1, process::Running, wait::until};

use super::{printed, settings};
use crate::support::{
    clients,
    command::{errors, run},
    daemon::strew,
    proxy::{Proxy, nginx},
};

const WORLDS: &str = "\
[[worlds.forest.layers]]
name = 'oak'
spacing = 4
seed = 7
attributes = ['angle']
[[worlds.forest.layers]]
name = 'rock'
spacing = 2
clear_of = { oak = 1 }
";

fn export(arguments: &[&str]) -> Output {
    run(&[&["export", "-q"], arguments].concat(), "")
}

fn exported(arguments: &[&str]) {
    printed(&[&["export", "-q"], arguments].concat());
}

/// All files below a folder.
fn tree(root: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut open = vec![root.to_owned()];
    let mut files = BTreeMap::new();
    while let Some(folder) = open.pop() {
        for entry in fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                open.push(path);
            } else {
                let name = path
                    .strip_prefix(root)
                    .expect("inside")
                    .display()
                    .to_string();
                files.insert(name, fs::read(path).expect("readable"));
            }
        }
    }
    files
}

/// nginx over a folder of files, with the settings that the export wrote.
fn serve(root: &Path) -> Option<Proxy> {
    clients::find("nginx")?;
    let server = |address: SocketAddr, folder: &Path| {
        let root = root.display();
        let conf = Path::new(&root.to_string()).join("strew.nginx.conf");
        let include = match conf.exists() {
            true => format!("include {};", conf.display()),
            false => String::new(),
        };
        nginx(
            folder,
            &format!("server {{ listen {address}; root {root}; {include} }}"),
        )
    };
    Some(Proxy::start("nginx", server))
}

/// Starts an export and kills it, with SIGKILL, once a path exists.
fn kill_when(arguments: &[&str], what: &str, there: impl Fn() -> bool) {
    let mut command = strew();
    command
        .args(["export", "-q", "--threads=1"])
        .args(arguments);
    let mut child = command
        .stderr(Stdio::null())
        .spawn()
        .expect("the program runs");
    until(what, || there().then_some(()));
    let _ = child.kill();
    let _ = child.wait();
}

/// The numbers of the chunks that a journal has.
fn finished(journal: &Path) -> Vec<usize> {
    let text = fs::read_to_string(journal).expect("readable");
    let lines = text
        .split_inclusive('\n')
        .filter(|line| line.ends_with('\n'));
    let number = |line: &str| line.split(' ').next()?.parse().ok();
    lines.map(|line| number(line).expect("a number")).collect()
}

const LARGE: [&str; 5] = [
    "--spacing=0.5",
    "--seed=3",
    "--bbox=0,0,1024,1024",
    "--chunk=32",
    "--format=f32",
];

#[test]
fn a_killed_export_goes_on_to_the_same_tree() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = |name: &str| folder.path().join(name);
    let text = |name: &str| path(name).display().to_string();
    let to = |name: &str| [&LARGE.map(String::from)[..], &["-o".into(), text(name)]].concat();
    let flags = to("whole");
    exported(&flags.iter().map(String::as_str).collect::<Vec<_>>());
    let flags = to("broken");
    let flags: Vec<&str> = flags.iter().map(String::as_str).collect();
    let journal = path("broken/.partial/journal");
    kill_when(&flags, "some chunks are there", || {
        fs::metadata(&journal).is_ok_and(|file| file.len() > 3000)
    });
    assert!(
        !path("broken/manifest.json").exists(),
        "it was quicker than the kill"
    );
    let check = export(&["--check", &text("broken")]);
    assert_eq!(check.status.code(), Some(1));
    // Other options neither go on there nor touch it.
    let other = export(&[&flags[..], &["--warp=off"]].concat());
    assert_eq!(other.status.code(), Some(2), "{}", errors(&other));
    let finished = finished(&journal);
    assert!(!finished.is_empty());
    let times = || -> Vec<SystemTime> {
        let chunks = finished.iter().map(|i| {
            let chunk = path(&format!("broken/v1/chunks/32/{}/{}", i / 32, i % 32));
            fs::metadata(chunk)
                .and_then(|file| file.modified())
                .expect("there")
        });
        chunks.collect()
    };
    let before = times();
    exported(&flags);
    assert_eq!(times(), before, "a chunk was made twice");
    let (whole, broken) = (tree(&path("whole")), tree(&path("broken")));
    assert!(whole.keys().eq(broken.keys()) && whole == broken);
    exported(&["--check", &text("broken"), "--all"]);

    // A changed byte, a missing and a foreign file.
    let chunk = path("broken/v1/chunks/32/3/5");
    let mut bytes = fs::read(&chunk).expect("written");
    bytes[9] ^= 1;
    fs::write(&chunk, bytes).expect("writable");
    fs::remove_file(path("broken/v1/chunks/32/4/4")).expect("there");
    fs::write(path("broken/v1/chunks/32/4/99"), "x").expect("writable");
    let check = export(&["--check", &text("broken")]);
    assert_eq!(check.status.code(), Some(1));
    let said = errors(&check);
    for fault in [
        "32/3/5: changed",
        "32/4/4: missing",
        "32/4/99: foreign",
        "3 files differ",
    ] {
        assert!(said.contains(fault), "{said}");
    }
}

const SMALL: [&str; 4] = [
    "--spacing=2",
    "--bbox=0,0,64,64",
    "--chunk=32",
    "--format=arrow",
];

#[test]
fn a_folder_that_was_killed_after_its_manifest_is_mended() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let out = folder.path().join("world");
    let text = out.display().to_string();
    let flags = [&SMALL[..], &["-o", &text]].concat();
    exported(&flags);
    let (whole, work) = (tree(&out), out.join(".partial"));
    fs::create_dir(&work).expect("writable");
    fs::write(work.join("journal"), "").expect("writable");
    let lock = fs::File::create(work.join("lock")).expect("writable");
    lock.try_lock().expect("free");
    let output = export(&flags);
    assert_eq!(output.status.code(), Some(2));
    assert!(errors(&output).contains("another process"));
    drop(lock);
    exported(&flags);
    assert!(!work.exists() && tree(&out) == whole);
    exported(&["--check", &text, "--all"]);

    // The bytes of columns depend on a setting, which is named.
    let other = ["--set", "limits.block_bytes=4096"];
    for flags in [&flags[..], &["--check", &text]] {
        let output = export(&[flags, &other].concat());
        assert_eq!(output.status.code(), Some(2));
        let errors = errors(&output);
        assert!(errors.contains("limits.block_bytes"), "{errors}");
    }
}

#[test]
fn an_archive_that_was_killed_in_its_first_member_begins_anew() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = |name: &str| folder.path().join(name).display().to_string();
    let (whole, torn) = (path("whole.zip"), path("torn.zip"));
    exported(&[&SMALL[..], &["--archive", &whole]].concat());
    exported(&["--check", &whole, "--all"]);
    let bytes = fs::read(&whole).expect("written");
    // The options are longer than the last of these.
    for length in [0, 3, 60, 400] {
        fs::write(path("torn.zip.partial"), &bytes[..length]).expect("writable");
        exported(&[&SMALL[..], &["--archive", &torn]].concat());
        assert!(fs::read(&torn).expect("written") == bytes, "{length}");
        fs::remove_file(&torn).expect("there");
    }
    // A file that is no export stays untouched.
    fs::write(path("torn.zip.partial"), "mine").expect("writable");
    let output = export(&[&SMALL[..], &["--archive", &torn]].concat());
    assert_eq!(output.status.code(), Some(2), "{}", errors(&output));
    assert_eq!(fs::read(path("torn.zip.partial")).expect("there"), b"mine");
}

/// A little-endian number of some bytes.
fn number(bytes: &[u8]) -> u64 {
    bytes
        .iter()
        .rev()
        .fold(0, |all, byte| all << 8 | u64::from(*byte))
}

/// Reads a range, as browsers do.
fn range(address: SocketAddr, first: u64, length: u64) -> Vec<u8> {
    let range = format!("bytes={first}-{}", first + length - 1);
    let answer = http1::get(address, "/world.zip", &[("range", &range)]);
    assert_eq!(answer.status, 206);
    answer.body
}

/// The place and the length of the content of the first members of the central directory.
fn first_members(address: SocketAddr, length: u64) -> Vec<(String, u64, u64)> {
    let end = range(address, length - 22, 22);
    assert!(end.starts_with(b"PK\x05\x06"));
    let directory = range(
        address,
        number(&end[16..20]),
        number(&end[12..16]).min(4096),
    );
    let (mut at, mut members) = (0, vec![]);
    for _ in 0..2 {
        let head = &directory[at..];
        let (name, extra) = (number(&head[28..30]), number(&head[30..32]));
        let text = String::from_utf8(head[46..46 + name as usize].to_vec()).expect("UTF-8");
        members.push((
            text,
            number(&head[42..46]) + 30 + name + 8,
            number(&head[20..24]),
        ));
        at += 46 + (name + extra) as usize;
    }
    members
}

#[test]
fn an_archive_is_read_by_ranges_and_goes_on_after_a_kill() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = |name: &str| folder.path().join(name).display().to_string();
    let (whole, broken) = (path("world.zip"), path("broken.zip"));
    exported(&[&LARGE[..], &["--archive", &whole]].concat());
    let partial = path("broken.zip.partial");
    kill_when(
        &[&LARGE[..], &["--archive", &broken]].concat(),
        "some chunks are there",
        || fs::metadata(&partial).is_ok_and(|file| file.len() > 1 << 20),
    );
    assert!(
        fs::metadata(&broken).is_err(),
        "it was quicker than the kill"
    );
    exported(&[&LARGE[..], &["--archive", &broken]].concat());
    let bytes = fs::read(&whole).expect("written");
    assert!(fs::read(&broken).expect("written") == bytes);
    exported(&["--check", &whole]);

    if let Some(nginx) = serve(folder.path()) {
        let members = first_members(nginx.address, bytes.len() as u64);
        let names: Vec<&str> = members.iter().map(|(name, ..)| name.as_str()).collect();
        assert_eq!(names, ["manifest.json", "index.bin"]);
        let manifest = range(nginx.address, members[0].1, members[0].2);
        let manifest: serde_json::Value = serde_json::from_slice(&manifest).expect("JSON");
        let level = &manifest["export"]["levels"][0];
        assert_eq!(
            (&level["columns"], &level["rows"]),
            (&serde_json::json!([0, 32]), &serde_json::json!([0, 32]))
        );
        // The chunk in column 3 and row 5.
        let entry = range(nginx.address, members[1].1 + 16 * (3 * 32 + 5), 16);
        let chunk = range(nginx.address, number(&entry[..8]), number(&entry[8..12]));
        let sample = run(
            &[
                &["sample", "-q", "--chunk=32/3/5"],
                &LARGE[..2],
                &LARGE[4..],
            ]
            .concat(),
            "",
        );
        assert!(chunk == sample.stdout);
        assert_eq!(number(&entry[12..]), chunk.len() as u64 / 8);
    }
    if let Some(mut python) = clients::python("the standard library") {
        let read = "import sys, zipfile; z = zipfile.ZipFile(sys.argv[1]); assert z.testzip() is None; print(len(z.namelist()))";
        let output = python.args(["-c", read, &whole]).output().expect("it runs");
        let said = String::from_utf8_lossy(&output.stdout).into_owned();
        assert!(
            output.status.success() && said.trim().parse::<u32>().is_ok_and(|n| n > 1024),
            "{said}"
        );
    }

    let mut bytes = bytes;
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    fs::write(&broken, bytes).expect("writable");
    let check = export(&["--check", &broken]);
    assert_eq!(check.status.code(), Some(1));
    assert!(
        errors(&check).contains("missing or unreadable"),
        "{}",
        errors(&check)
    );
}

#[test]
fn an_interrupt_ends_it_in_good_order() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let out = folder.path().join("world");
    // It goes on far longer than the signal takes.
    let mut large = LARGE;
    large[2] = "--bbox=0,0,4096,4096";
    let mut command = strew();
    command
        .args(["export", "-q", "--threads=1", "-o"])
        .arg(&out)
        .args(large);
    let child = Running::start(command.stderr(Stdio::piped()));
    let journal = out.join(".partial/journal");
    until("some chunks are there", || {
        fs::metadata(&journal)
            .is_ok_and(|file| file.len() > 3000)
            .then_some(())
    });
    child.signal("INT");
    let output = child.end();
    assert_eq!(output.status.code(), Some(130));
    assert!(
        errors(&output).contains("resumes there"),
        "{}",
        errors(&output)
    );
}

#[test]
fn wrong_flags_are_refused() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    fs::write(folder.path().join("mine.txt"), "x").expect("writable");
    let full = folder.path().display().to_string();
    let set = ["--spacing=1", "--bbox=0,0,64,64"];
    for (flags, said) in [
        (&["-o", "w"][..], "use --chunk"),
        (&["--chunk=0", "-o", "w"], "--chunk 0: out of range"),
        (&["--chunk=16"], "use --output DIR or --archive FILE"),
        (&["--chunk=16", "-o", &full], "the folder is not empty"),
        (
            &["--chunk=16", "--format=parquet", "-o", "w"],
            "--format parquet",
        ),
        (
            &["--chunk=16", "--compress=none,gz", "-o", "w"],
            "--compress none stands alone",
        ),
        (
            &["--chunk=16", "--compress=zst", "--archive", "w"],
            "--compress zst",
        ),
        (&["--chunk=1e-9", "-o", "w"], "chunks; allowed"),
        (
            &["--chunk=0.01", "-o", "w"],
            "chunks; allowed: at most 10000000",
        ),
        (&["--chunk=16", "--levels=11", "-o", "w"], "--levels"),
        (
            &["--chunk=16", "--levels=9", "--lod=0.01", "-o", "w"],
            "--levels 9: level 7",
        ),
    ] {
        let output = export(&[&set[..], flags].concat());
        assert_eq!(
            output.status.code(),
            Some(2),
            "{flags:?}: {}",
            errors(&output)
        );
        assert!(
            errors(&output).contains(said),
            "{flags:?}: {}",
            errors(&output)
        );
    }
    assert!(!Path::new("w").exists());
}
