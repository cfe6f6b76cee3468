//! Where commands write: signals, closed pipes, places that cannot be written, and the formats of files.

use std::{
    fs,
    io::{BufRead as _, BufReader},
    path::Path,
    process::{Command, Stdio},
};

use strew_testkit::{process::Running, wait};

use crate::support::{
    clients,
    command::{Shell, errors, run},
    daemon::{PROGRAM, strew},
};

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("a folder");
    let name = |entry: std::io::Result<fs::DirEntry>| entry.expect("an entry").file_name();
    entries
        .map(|entry| name(entry).to_string_lossy().into_owned())
        .collect()
}

#[test]
fn signals_leave_no_file() {
    let (points, large) = (
        "--bbox=0,0,4e4,4e4 --spacing=1",
        "--bbox=0,0,1999,1999 --spacing=1",
    );
    for (signal, code, line) in [
        ("INT", 130, format!("sample -q {points} -o=x.csv")),
        ("TERM", 143, format!("sample -q {points} -o=x.csv")),
        ("HUP", 129, format!("sample -q {points} -o=x.csv")),
        ("INT", 130, "mask --size=1024 -o=x.npy".into()),
        ("INT", 130, format!("measure {large} -o=x.json")),
    ] {
        let folder = tempfile::tempdir().expect("a folder");
        let mut command = strew();
        command.args(line.split(' '));
        let child = Running::start(command.current_dir(folder.path()));
        let partial = |name: &String| name.ends_with(".partial");
        wait::until("a file is begun", || {
            names(folder.path()).iter().any(partial)
        });
        child.signal(signal);
        assert_eq!(child.end().status.code(), Some(code), "{line}");
        assert_eq!(names(folder.path()), Vec::<String>::new(), "{line}");
    }
}

#[test]
fn a_reader_that_leaves_ends_a_command_quietly() {
    for line in [
        "sample --bbox 0,0,3000,3000 --spacing 1 --format csv -q",
        "sample --bbox 0,0,3000,3000 --spacing 1 --format f32 -q",
        "table export --text --profile spaced --map l",
    ] {
        let mut child = strew()
            .args(line.split(' '))
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the program runs");
        let mut reader = BufReader::new(child.stdout.take().expect("piped"));
        assert!(!reader.fill_buf().expect("readable").is_empty());
        drop(reader);
        let output = child.wait_with_output().expect("it ends");
        assert_eq!(
            (output.status.code(), &*errors(&output)),
            (Some(0), ""),
            "{line}"
        );
    }
}

#[test]
fn places_that_cannot_be_written_are_refused_before_the_work() {
    let shell = Shell::new();
    shell.write("f", "a file");
    fs::create_dir(shell.path("d")).expect("a folder");
    for (path, problem) in [("d", "it is a folder"), ("f/x.csv", "Not a directory")] {
        for command in [
            // This number of points would keep the program at work without end.
            "sample --format csv --bbox 0,0,1e7,1e7 --spacing 1 --set limits.max_points=1000000000000000 -o",
            "measure --bbox 0,0,1000,1000 --spacing 1 --picture",
            "table export --profile spaced --map l -o",
        ] {
            let output = shell.run(&format!("{command} {path}"), "");
            let text = errors(&output);
            assert!(!output.status.success());
            assert!(
                text.contains(&format!("cannot write {path}: {problem}")),
                "{text}"
            );
            assert!(
                !text.contains("partial") && text.lines().count() == 1,
                "{text}"
            );
        }
    }
}

#[test]
fn an_error_is_told_once() {
    let text = errors(&run(&["measure", "--table", "/etc/passwd"], ""));
    assert_eq!(text.matches("is not a Strew table").count(), 1, "{text}");
}

#[test]
fn commands_that_do_not_serve_take_no_address() {
    for command in ["sample", "count", "point", "nearest", "split", "measure"] {
        let help = run(&[command, "--help"], "").stdout;
        assert!(
            !String::from_utf8_lossy(&help).contains("--listen"),
            "{command}"
        );
    }
    let help = run(&["serve", "--help"], "").stdout;
    assert!(String::from_utf8_lossy(&help).contains("--listen"));
}

#[test]
fn files_of_columns_are_read_by_their_readers() {
    let shell = Shell::new();
    let looks = "--bbox 0,0,30,30 --spacing 1 --attributes variant,angle --variants oak:3,birch:1";
    for name in ["t.arrow", "t.feather", "t.arrows", "t.parquet", "t.csv"] {
        shell.output(&format!("sample -q -o {name} {looks}"), "");
    }
    let starts = |name: &str| shell.read(name).starts_with(b"ARROW1");
    assert_eq!(
        ["t.arrow", "t.feather", "t.arrows"].map(starts),
        [true, true, false]
    );
    let Some(mut python) = clients::python("readers of Arrow and Parquet") else {
        return;
    };
    let script = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/tests/suite/cli/table_readers.py"
    );
    let output = python
        .arg(script)
        .arg(shell.path(""))
        .output()
        .expect("Python runs");
    println!("{}", String::from_utf8_lossy(&output.stdout));
    assert!(output.status.success(), "{}", errors(&output));
}

#[test]
fn records_say_what_their_columns_are() {
    let line = "sample --bbox 0,0,3,2 --spacing 1 --format f32 --attributes variant --variants oak:3,birch:1";
    let text = errors(&Shell::new().run(line, ""));
    assert!(
        text.contains(r#"{"name":"variant","type":"f32","names":["birch","oak"]}"#),
        "{text}"
    );
}

#[test]
fn names_that_end_with_gz_and_zst_are_compressed() {
    use std::io::Read as _;
    let shell = Shell::new();
    let query = "sample -q --bbox 0,0,40,40 --spacing 1 --seed 7";
    let plain = shell.output(&format!("{query} --format csv"), "");
    let written = |name: &str| {
        shell.output(&format!("{query} -o {name}"), "");
        shell.read(name)
    };
    let (gzip, zstd) = (written("points.csv.gz"), written("points.csv.zst"));
    let mut unpacked = vec![];
    let mut decoder = flate2::read::GzDecoder::new(&gzip[..]);
    decoder
        .read_to_end(&mut unpacked)
        .expect("a whole gzip file");
    assert_eq!(unpacked, plain);
    let unpacked = zstd::stream::decode_all(&zstd[..]).expect("a whole zstd file");
    assert_eq!(unpacked, plain);
    let words = ["--output ends with .foo"];
    shell.assert_refused(&format!("{query} -o points.foo.gz"), &words);
    let short = shell.run(&format!("{query} -o /dev/full --format csv"), "");
    assert_eq!(short.status.code(), Some(1), "{}", errors(&short));
}

#[test]
fn man_knows_every_command() {
    let folder = tempfile::tempdir().expect("a folder");
    let output = run(
        &["man", "--out-dir", folder.path().to_str().expect("text")],
        "",
    );
    assert!(output.status.success(), "{}", errors(&output));
    let pages = names(folder.path());
    for page in [
        "strew.1",
        "strew-sample.1",
        "strew-figure-index.1",
        "strew-table-show.1",
    ] {
        assert!(pages.iter().any(|name| name == page), "{page}: {pages:?}");
    }
    let page = fs::read_to_string(folder.path().join("strew-sample.1")).expect("a page");
    assert!(
        page.contains("EXTRA") || page.contains("Examples"),
        "{page}"
    );
    let below = folder.path().join("strew.1/pages").display().to_string();
    let refused = run(&["man", "--out-dir", &below], "");
    assert_eq!(refused.status.code(), Some(1));
    assert!(errors(&refused).contains(&below), "{}", errors(&refused));
}

#[test]
fn the_version_is_a_command_as_it_is_a_flag() {
    let [command, flag] = ["version", "--version"].map(|word| run(&[word], ""));
    assert!(command.status.success(), "{}", errors(&command));
    assert_eq!(command.stdout, flag.stdout);
}

#[test]
fn profiles_are_listed() {
    let output = run(&["profiles"], "");
    let list = String::from_utf8_lossy(&output.stdout);
    assert!(
        list.starts_with("profile ") && list.contains("\nblue "),
        "{list}"
    );
    let blue = list
        .lines()
        .find(|line| line.starts_with("blue ") && line.contains(" m "));
    assert!(
        blue.is_some_and(|line| line.contains("16641") && line.contains("1:3:10")),
        "{list}"
    );
}

#[test]
fn folders_of_outputs_are_made() {
    let shell = Shell::new();
    for (line, made) in [
        (
            "sample -q --bbox 0,0,2,2 --spacing 1 -o new/deep/points.csv",
            "new/deep/points.csv",
        ),
        ("man --out-dir pages", "pages/strew.1"),
        ("mask --size 16 -o masks/m.PNG", "masks/m.PNG"),
    ] {
        shell.output(line, "");
        assert!(!shell.read(made).is_empty(), "{made}");
    }
    shell.output("mask --size=16 --bits=16 -o m.npy", "");
    let array = shell.read("m.npy");
    assert_eq!(array.len(), 128 + 2 * 256);
    assert!(array.starts_with(b"\x93NUMPY\x01\x00") && array[..128].ends_with(b"\n"));
    for name in ["m.tif", "m.bmp", "m.npz"] {
        let words = ["no format of masks; allowed: a file whose name ends in .png or .npy"];
        shell.assert_refused(&format!("mask --size 16 -o {name}"), &words);
        assert!(!shell.path(name).exists());
    }
}

#[test]
fn what_is_no_text_is_written_to_a_terminal_only_on_request() {
    let Some(script) = clients::find("script") else {
        return;
    };
    let at_terminal = |arguments: &str| {
        let line = format!("{PROGRAM} {arguments}");
        let mut script = Command::new(&script);
        script
            .args(["-qec", &line, "/dev/null"])
            .stdin(Stdio::null());
        let output = script.output().expect("it runs");
        (
            output.status.code(),
            String::from_utf8_lossy(&output.stdout).into_owned(),
        )
    };
    let sample = "sample -q --bbox 0,0,2,2 --spacing 1 --format";
    for refused in [
        format!("{sample} f64"),
        format!("{sample} parquet"),
        "mask --size 16".into(),
    ] {
        let (code, text) = at_terminal(&refused);
        assert_eq!(code, Some(2), "{refused}: {text}");
        assert!(
            text.contains("is not written to a terminal; allowed: -o FILE"),
            "{text}"
        );
    }
    for taken in [format!("{sample} f64 -o -"), format!("{sample} csv")] {
        assert_eq!(at_terminal(&taken).0, Some(0), "{taken}");
    }
}
