//! `strew export`: a world as files. A static server answers with the daemon's bytes, a killed export resumes, and
//! `--check` finds every difference. Without room it is refused before it begins, or ends with the way to resume.

mod served;

use std::{
    collections::BTreeMap,
    fs,
    net::SocketAddr,
    path::Path,
    process::{Output, Stdio},
    time::SystemTime,
};

use strew_testkit::{process::Running, wait::until};

use super::{printed, refused, settings};
use crate::support::{
    clients,
    command::{assert_says, errors, run},
    daemon::strew,
    disk::SmallDisk,
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
    until(what, there);
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
        fs::metadata(&journal).is_ok_and(|file| file.len() > 3000)
    });
    child.signal("INT");
    let output = child.end();
    assert_eq!(output.status.code(), Some(130));
    assert_says(&output, "resumes there");
}

#[test]
fn a_folder_with_files_of_others_is_refused() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    fs::write(folder.path().join("mine.txt"), "x").expect("writable");
    let full = folder.path().display().to_string();
    let set = [
        "export",
        "--spacing=1",
        "--bbox=0,0,64,64",
        "--chunk=16",
        "-o",
        &full,
    ];
    let message = refused(&set, 2);
    assert!(message.contains("the folder is not empty"), "{message}");
}

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
    let refused = export(&[&LARGE[..], &["-o", &out]].concat());
    let said = errors(&refused);
    assert_eq!(refused.status.code(), Some(1), "{said}");
    assert!(said.contains("the export takes about 3"), "{said}");
    assert!(said.contains("free: choose a smaller box"), "{said}");
    // Nothing is left that would keep a smaller export out.
    exported(&[&SMALL[..], &["-o", &out]].concat());
    exported(&["--check", &out]);
}

#[test]
fn a_folder_goes_on_once_there_is_room() {
    let Some(disk) = SmallDisk::mount("64m") else {
        return;
    };
    let out = disk.path().join("world");
    let text = out.display().to_string();
    let journal = out.join(".partial/journal");
    let flags = [&LARGE[..], &["-o", &text]].concat();
    let mut command = strew();
    command.args(["export", "-q", "--threads=1"]).args(&flags);
    let child = Running::start(command.stderr(Stdio::piped()));
    until("some chunks are there", || {
        // 33 chunks of 32 KiB.
        fs::metadata(&journal).is_ok_and(|file| file.len() > 3000)
    });
    // It must not write on while its disk shrinks.
    child.signal("STOP");
    disk.leave_free(1 << 20);
    child.signal("CONT");
    let output = child.end();
    assert_no_room(&output, "No space left on device");
    assert!(!out.join("manifest.json").exists());
    let before = tree(&out).len();
    assert!(before > 35, "{before}");
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
