//! The examples of docs/api.md are run against a daemon, and must print what the document shows.
//!
//! An example is a fenced `sh` block that begins with `curl` or `strew`; the block right after it
//! shows its output. There, a line `…` stands for any number of lines, and a line that ends in `…`
//! for a longer one. `UPDATE_GOLDEN=1` writes the current output, shortened in the same places; an
//! empty block is filled.

use std::{path::Path, process::Command};

use crate::support::{
    clients,
    daemon::{Daemon, strew},
};

const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/api.md");
/// The daemon's address in the document.
const ADDRESS: &str = "http://127.0.0.1:8080";
const MORE: &str = "…";

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
    let program = strew();
    let programs = Path::new(program.get_program()).parent().expect("a folder");
    let path = std::env::var_os("PATH").unwrap_or_default();
    let path = [programs.into()]
        .into_iter()
        .chain(std::env::split_paths(&path));
    command.env("PATH", std::env::join_paths(path).expect("a path"));
    for (name, _) in program.get_envs() {
        command.env_remove(name);
    }
    let address = daemon.url("");
    let output = command
        .args(["-ec", &script.replace(ADDRESS, &address)])
        .current_dir(folder)
        .output()
        .expect("sh runs");
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{script}\n{message}");
    let text = String::from_utf8(output.stdout).unwrap_or_else(|e| panic!("{script}\n{e}"));
    let text = text.replace(&address, ADDRESS).replace('\r', "");
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
    if shown.is_empty() {
        return printed.to_vec();
    }
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

#[test]
fn the_examples_print_what_the_document_shows() {
    if clients::find("curl").is_none() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let daemon = Daemon::built_in();
    let text = std::fs::read_to_string(FILE).expect("readable");
    let lines: Vec<String> = text.lines().map(Into::into).collect();
    let mut written: Vec<String> = vec![];
    let mut copied = 0;
    let mut differences = vec![];
    let blocks = blocks(&lines);
    for (i, block) in blocks.iter().enumerate() {
        let script = lines[block.first..block.end].join("\n");
        let is_run = script.starts_with("curl ") || script.starts_with("strew ");
        if block.language != "sh" || !is_run {
            continue;
        }
        let printed = run(&script, &daemon, folder.path());
        let next = blocks.get(i + 1).filter(|next| {
            let between = &lines[block.end + 1..next.first - 1];
            next.language != "sh" && between.iter().all(String::is_empty)
        });
        let Some(next) = next else {
            assert!(printed.is_empty(), "{script}\nprints {printed:?}");
            continue;
        };
        let shown = &lines[next.first..next.end];
        let now = shortened(&printed, shown);
        if now != shown {
            let (now, shown) = (now.join("\n"), shown.join("\n"));
            differences.push(format!("{script}\nprints\n{now}\nand not\n{shown}"));
        }
        written.extend_from_slice(&lines[copied..next.first]);
        written.extend(now);
        copied = next.end;
    }
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        written.extend_from_slice(&lines[copied..]);
        std::fs::write(FILE, written.join("\n") + "\n").expect("writable");
        return;
    }
    let advice = "UPDATE_GOLDEN=1 cargo test --test suite api_examples";
    assert!(
        differences.is_empty(),
        "{advice} accepts:\n\n{}",
        differences.join("\n\n")
    );
}
