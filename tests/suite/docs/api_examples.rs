//! The examples of docs/*.md, README.md and examples/README.md run against a daemon and must print what the
//! documents show.
//!
//! An example is a fenced `sh` block that begins with `curl`, `grpcurl`, `jq` or `strew`, and the block right
//! after it shows its output; or a `console` block of `$ `, such a command and its output. In an output a
//! line `…` stands for any number of lines, and a line that ends in `…` for a longer one.
//! `UPDATE_GOLDEN=1` writes the current output, shortened in the same places; an empty block is filled.

use std::{
    path::{Path, PathBuf},
    process::Command,
};

use crate::support::{
    clients,
    daemon::{Daemon, PROGRAM, no_tables, strew},
};

/// The daemon's address in the documents.
const ADDRESS: &str = "127.0.0.1:8080";
const MORE: &str = "…";
/// The languages of commands.
const PROGRAMS: [&str; 2] = ["sh", "python"];

/// A fenced block: the lines of the document between its fences.
struct Block {
    language: String,
    first: usize,
    end: usize,
}

fn blocks(lines: &[String]) -> Vec<Block> {
    let mut blocks = vec![];
    let mut fences = lines.iter().enumerate();
    while let Some((i, line)) = fences.find(|(_, line)| line.starts_with("```")) {
        let (end, _) = fences
            .find(|(_, line)| *line == "```")
            .unwrap_or_else(|| panic!("line {}: the block does not end", i + 1));
        blocks.push(Block {
            language: line[3..].to_owned(),
            first: i + 1,
            end,
        });
    }
    blocks
}

/// The output of an example, with the document's address in place of the daemon's.
fn run(script: &str, daemon: &Daemon, folder: &Path) -> Vec<String> {
    let mut command = Command::new("sh");
    let programs = Path::new(PROGRAM).parent().expect("a folder");
    let path = std::env::var_os("PATH").unwrap_or_default();
    let python = std::env::var_os("STREW_TEST_PYTHON").map(PathBuf::from);
    let python = python.and_then(|python| Some(python.parent()?.to_owned()));
    let path = [programs.into()]
        .into_iter()
        .chain(python)
        .chain(std::env::split_paths(&path));
    command.env("PATH", std::env::join_paths(path).expect("a path"));
    for (name, _) in strew().get_envs() {
        command.env_remove(name);
    }
    let url = daemon.url("");
    let address = url.strip_prefix("http://").expect("no TLS");
    let output = command
        .args(["-ec", &script.replace(ADDRESS, address)])
        .current_dir(folder)
        .output()
        .expect("sh runs");
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{script}\n{message}");
    let text = String::from_utf8(output.stdout).unwrap_or_else(|e| panic!("{script}\n{e}"));
    let text = text.replace(address, ADDRESS).replace('\r', "");
    text.lines().map(unnamed).collect()
}

/// A line with the request id of the document: the daemon makes another one each time.
fn unnamed(line: &str) -> String {
    const BEFORE: &str = "\"request_id\":\"";
    let Some((before, after)) = line.split_once(BEFORE) else {
        return line.into();
    };
    let rest = after.find('"').map_or("", |end| &after[end..]);
    format!("{before}{BEFORE}9c1f0a52e87b63d4{rest}")
}

/// The output, shortened where the document shortens it.
fn shortened(printed: &[String], shown: &[String]) -> Vec<String> {
    let line = |(printed, shown): (&String, &String)| match shown.strip_suffix(MORE) {
        Some(head) if printed.chars().count() > head.chars().count() => {
            let head: String = printed.chars().take(head.chars().count()).collect();
            head + MORE
        }
        _ => printed.clone(),
    };
    let Some(gap) = shown.iter().position(|line| line == MORE) else {
        let more = printed.iter().skip(shown.len()).cloned();
        return printed.iter().zip(shown).map(line).chain(more).collect();
    };
    let (before, after) = (&shown[..gap], &shown[gap + 1..]);
    let tail = printed.len().saturating_sub(after.len()).max(gap);
    let before = printed.iter().zip(before).map(line);
    let after = printed.iter().skip(tail).zip(after).map(line);
    before.chain([MORE.into()]).chain(after).collect()
}

/// An example: its command, and the lines that show its output.
struct Example {
    script: String,
    shown: std::ops::Range<usize>,
}

/// The examples of a document that can be run here.
fn examples(lines: &[String]) -> Vec<Example> {
    let blocks = blocks(lines);
    let mut examples = vec![];
    for (i, block) in blocks.iter().enumerate() {
        if block.language == "console" {
            examples.extend(dialogue(lines, block));
        } else if PROGRAMS.contains(&&*block.language) {
            let next = blocks.get(i + 1).filter(|next| {
                let between = &lines[block.end + 1..next.first - 1];
                !PROGRAMS.contains(&&*next.language) && between.iter().all(String::is_empty)
            });
            let text = lines[block.first..block.end].join("\n");
            examples.push(Example {
                script: match &*block.language {
                    "python" => format!("python3 - <<'END'\n{text}\nEND"),
                    _ => text,
                },
                shown: next.map_or(block.end..block.end, |next| next.first..next.end),
            });
        }
    }
    examples.retain(|example| {
        let program = example.script.split(' ').next().unwrap_or_default();
        match program {
            "python3" => has_packages(&example.script),
            "curl" | "grpcurl" | "jq" => clients::find(program).is_some(),
            other => ["strew", "for", "cat"].contains(&other),
        }
    });
    examples
}

/// Whether there is a Python with what an example imports.
fn has_packages(script: &str) -> bool {
    let Some(plain) = clients::find("python3") else {
        return false;
    };
    let imports = |line: &&str| line.starts_with("import ") || line.starts_with("from ");
    let imports: Vec<&str> = script.lines().filter(imports).collect();
    let python = std::env::var_os("STREW_TEST_PYTHON").unwrap_or(plain.into());
    let output = Command::new(python)
        .args(["-c", &imports.join("\n")])
        .output();
    let has_all = output.is_ok_and(|output| output.status.success());
    if !has_all {
        eprintln!("skipped: a Python with {}", imports.join(", "));
    }
    has_all
}

/// The commands of a `console` block, which begin with `$ ` and may be continued, with their output.
fn dialogue(lines: &[String], block: &Block) -> Vec<Example> {
    let mut examples: Vec<Example> = vec![];
    let mut is_command = false;
    for (i, line) in lines.iter().enumerate().take(block.end).skip(block.first) {
        if let Some(command) = line.strip_prefix("$ ") {
            let own = command.strip_prefix("cargo run --release -- ");
            examples.push(Example {
                // What it says of a file is no output.
                script: own.map_or(command.into(), |own| format!("strew {own} 2>&1")),
                shown: i + 1..i + 1,
            });
            is_command = true;
        } else if let Some(example) = examples.last_mut() {
            if is_command {
                example.script = format!("{}\n{line}", example.script);
                example.shown = i + 1..i + 1;
            } else {
                example.shown.end = i + 1;
            }
        }
        is_command &= line.ends_with('\\');
    }
    examples
}

/// Fails unless the examples of a document print what it shows.
fn check(name: &str) {
    let folder = tempfile::tempdir().expect("a folder");
    check_in(name, folder.path(), &Daemon::built_in());
}

/// Checks the examples of a file with a folder and a daemon that they find.
fn check_in(name: &str, folder: &Path, daemon: &Daemon) {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(name);
    let text = std::fs::read_to_string(&file).expect("readable");
    let lines: Vec<String> = text.lines().map(Into::into).collect();
    let mut written: Vec<String> = vec![];
    let mut copied = 0;
    let mut differences = vec![];
    for Example { script, shown } in examples(&lines) {
        let printed = run(&script, daemon, folder);
        let now = shortened(&printed, &lines[shown.clone()]);
        if now != lines[shown.clone()] {
            let (now, shown) = (now.join("\n"), lines[shown.clone()].join("\n"));
            differences.push(format!("{script}\nprints\n{now}\nand not\n{shown}"));
        }
        written.extend_from_slice(&lines[copied..shown.start]);
        written.extend(now);
        copied = shown.end;
    }
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        written.extend_from_slice(&lines[copied..]);
        std::fs::write(file, written.join("\n") + "\n").expect("writable");
        return;
    }
    let advice = "UPDATE_GOLDEN=1 cargo test --test suite api_examples";
    assert!(
        differences.is_empty(),
        "{advice} accepts:\n\n{}",
        differences.join("\n\n")
    );
}

#[test]
fn the_api_document_shows_what_its_examples_print() {
    check("docs/api.md");
}

#[test]
fn the_readme_shows_what_its_examples_print() {
    check("README.md");
}

#[test]
fn the_algorithm_shows_what_its_example_prints() {
    check("docs/algorithm.md");
}

#[test]
fn the_examples_of_space_print_what_it_shows() {
    check("docs/space.md");
}

#[test]
fn the_page_for_games_shows_what_its_example_draws() {
    let folder = tempfile::tempdir().expect("a folder");
    check_in("docs/games.md", folder.path(), &Daemon::built_in());
    compare(folder.path(), "trades", &["forest.png"]);
}

/// Most commands of the page need what a test has not; its first example is for everyone.
#[test]
fn the_page_on_operations_begins_with_what_it_prints() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/operations.md");
    let text = std::fs::read_to_string(file).expect("readable");
    let opening = text.lines().take_while(|line| !line.starts_with("## "));
    let lines: Vec<String> = opening.map(Into::into).collect();
    let folder = tempfile::tempdir().expect("a folder");
    let examples = examples(&lines);
    let Some(Example { script, shown }) = examples.first() else {
        return;
    };
    let printed = run(script, &Daemon::built_in(), folder.path());
    assert_eq!(printed, lines[shown.clone()]);
}

#[test]
fn the_page_for_gis_shows_what_its_examples_print_and_draw() {
    let folder = tempfile::tempdir().expect("a folder");
    check_in("docs/gis.md", folder.path(), &Daemon::built_in());
    compare(folder.path(), "trades", &["districts.png"]);
}

#[test]
fn the_page_for_rendering_shows_what_its_examples_print_and_draw() {
    let folder = tempfile::tempdir().expect("a folder");
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs");
    std::os::unix::fs::symlink(docs, folder.path().join("docs")).expect("writable");
    check_in("docs/rendering.md", folder.path(), &Daemon::built_in());
    compare(folder.path(), "fields", &["hills.png"]);
}

#[test]
fn the_page_of_samples_shows_what_its_examples_print() {
    check("examples/README.md");
}

#[test]
fn the_page_on_fields_shows_what_its_examples_print_and_draw() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder = tempfile::tempdir().expect("a folder");
    let copied = folder.path().join("docs/fields");
    std::fs::create_dir_all(&copied).expect("writable");
    for entry in std::fs::read_dir(root.join("docs/fields")).expect("readable") {
        let path = entry.expect("readable").path();
        std::fs::copy(&path, copied.join(path.file_name().expect("a file"))).expect("copied");
    }
    let setting = format!("fields.folder={}", copied.display());
    let daemon = Daemon::with_tables(no_tables(), &[&setting]);
    check_in("docs/fields.md", folder.path(), &daemon);
    let names = ["valley.png", "woods.png", "clearing.png", "hills.png"];
    compare(folder.path(), "fields", &names);
}

/// A daemon with the worlds and lists of the pages.
fn with_worlds() -> Daemon {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let settings = ["worlds", "except"].map(|name| {
        let folder = root.join("docs").join(name);
        format!("{name}.folder={}", folder.display())
    });
    Daemon::with_tables(no_tables(), &settings.each_ref().map(String::as_str))
}

#[test]
fn the_page_on_worlds_shows_what_its_examples_print() {
    let folder = tempfile::tempdir().expect("a folder");
    check_in("docs/worlds.md", folder.path(), &with_worlds());
}

#[test]
fn the_page_on_exports_shows_what_its_examples_print() {
    let folder = tempfile::tempdir().expect("a folder");
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs");
    std::os::unix::fs::symlink(docs, folder.path().join("docs")).expect("writable");
    check_in("docs/export.md", folder.path(), &with_worlds());
}

#[test]
fn the_page_on_kinds_shows_what_its_examples_print_and_draw() {
    let folder = tempfile::tempdir().expect("a folder");
    let daemon = Daemon::built_in();
    check_in("docs/kinds.md", folder.path(), &daemon);
    compare(
        folder.path(),
        "kinds",
        &["chance.png", "even.png", "river.png"],
    );
}

#[test]
fn the_page_on_periods_shows_what_its_examples_print_and_draw() {
    let folder = tempfile::tempdir().expect("a folder");
    check_in("docs/periodic.md", folder.path(), &Daemon::built_in());
    compare(folder.path(), "periodic", &["spectrum.svg"]);
    let [by_command, by_daemon] =
        ["mask.png", "served.png"].map(|name| std::fs::read(folder.path().join(name)));
    assert!(by_command.is_ok() && by_command.ok() == by_daemon.ok());
}

/// Compares pictures that examples drew with those of the page.
fn compare(folder: &Path, page: &str, names: &[&str]) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for name in names {
        let drawn = std::fs::read(folder.join(name));
        let kept = root.join("docs/pictures").join(page).join(name);
        let is_picture =
            |drawn: &Vec<u8>| drawn.starts_with(b"\x89PNG") || drawn.starts_with(b"<svg");
        assert!(
            drawn.as_ref().map_or(true, is_picture),
            "{name} is no picture"
        );
        match drawn {
            Ok(drawn) if std::env::var_os("UPDATE_GOLDEN").is_some() => {
                std::fs::write(kept, drawn).expect("writable");
            }
            Ok(drawn) => assert!(
                std::fs::read(kept).is_ok_and(|kept| kept == drawn),
                "{name}"
            ),
            // Its example takes a program that is not installed.
            Err(_) => {}
        }
    }
}

#[test]
fn the_page_on_patterns_shows_what_its_examples_print_and_draw() {
    let folder = tempfile::tempdir().expect("a folder");
    check_in("docs/pattern.md", folder.path(), &Daemon::built_in());
    let kept = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/pictures/pattern");
    for name in ["index.svg", "arrangement.svg", "clusters.svg", "map.svg"] {
        let drawn = std::fs::read(folder.path().join(name)).expect("drawn");
        if std::env::var_os("UPDATE_GOLDEN").is_some() {
            std::fs::write(kept.join(name), drawn).expect("writable");
        } else {
            assert!(
                std::fs::read(kept.join(name)).is_ok_and(|kept| kept == drawn),
                "{name}"
            );
        }
    }
}
