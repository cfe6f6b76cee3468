//! The invariants listed in ARCHITECTURE.md, checked by searching the sources.

use std::{
    fs,
    path::{Path, PathBuf},
};

#[path = "tidy/circles.rs"]
mod circles;
#[path = "tidy/imports.rs"]
mod imports;
#[path = "tidy/lines.rs"]
mod lines;
#[path = "tidy/page.rs"]
mod page;
#[path = "tidy/recipes.rs"]
mod recipes;
#[path = "tidy/releasing.rs"]
mod releasing;

/// Every source file of the workspace, as (path from the root, text).
fn sources() -> Vec<(String, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folders = [
        "src",
        "page",
        "bindings/python/src",
        "bindings/c/src",
        "bindings/js/lite/src",
        "crates",
        "tests",
        "benches",
        "examples",
        "fuzz/subjects",
        "fuzz/fuzz_targets",
    ];
    let found = folders.map(|folder| files(&root.join(folder), &["rs"]));
    let mut found = found.concat();
    assert!(
        found.len() > 30,
        "the sources are where they are looked for"
    );
    found.retain(|(name, _)| name != "tests/tidy.rs");
    found
}

/// Every file below a folder with one of these endings that is written by hand, as (path from the root, text).
fn files(folder: &Path, endings: &[&str]) -> Vec<(String, String)> {
    let mut open: Vec<PathBuf> = vec![folder.into()];
    let mut found = vec![];
    while let Some(path) = open.pop() {
        // What is built, installed or printed may stand beside the sources.
        if BUILT.iter().any(|built| path.ends_with(built)) {
            continue;
        }
        if path.is_dir() {
            let entries = fs::read_dir(&path).expect("readable");
            open.extend(entries.map(|entry| entry.expect("readable").path()));
            continue;
        }
        let ending = path.extension().unwrap_or_default();
        if endings.iter().any(|other| ending == *other) {
            let name = path
                .strip_prefix(env!("CARGO_MANIFEST_DIR"))
                .expect("inside")
                .to_string_lossy()
                .replace('\\', "/");
            found.push((name, fs::read_to_string(&path).expect("UTF-8")));
        }
    }
    found
}

/// Folders that builds and tools fill.
const BUILT: [&str; 9] = [
    "target",
    "generated",
    "node_modules",
    "dist",
    "embedded",
    "tables/files",
    "lib/parameters.js",
    "lib/parameters.d.ts",
    ".venv",
];

/// Code without its comments.
fn code(text: &str) -> impl Iterator<Item = (usize, &str)> {
    text.lines()
        .enumerate()
        .map(|(i, line)| (i + 1, line.split("//").next().unwrap_or("")))
        .filter(|(_, line)| !line.trim().is_empty())
}

/// Fails if any file under `room` names one of the words in its code.
fn never_names(room: &str, words: &[&str]) {
    for (name, text) in sources().iter().filter(|(name, _)| name.starts_with(room)) {
        for (line, text) in code(text) {
            for word in words {
                assert!(!text.contains(word), "{name}:{line} names `{word}`: {text}");
            }
        }
    }
}

#[test]
fn the_core_knows_no_wire_no_runtime_and_no_files() {
    never_names(
        "crates/core/src",
        &[
            "tokio",
            "axum",
            "tonic",
            "hyper",
            "http::",
            "serde",
            "rayon",
            "std::fs",
            "std::io",
            "std::net",
            "std::thread",
            "std::time",
        ],
    );
}

#[test]
fn the_forge_knows_no_wire_and_no_runtime() {
    never_names(
        "crates/forge/src",
        &["tokio", "axum", "tonic", "hyper", "http::", "std::net"],
    );
}

#[test]
fn what_runs_in_webassembly_reads_no_clock() {
    // There is none: a call would end the program. The command line alone estimates the time of jobs.
    let below = "catalog config encode error forge plan query raster".split(' ');
    let rooms: Vec<_> = below.map(|name| format!("crates/{name}/src/")).collect();
    for (name, text) in sources() {
        if rooms.iter().any(|room| name.starts_with(room)) && !name.ends_with("estimate.rs") {
            for word in ["Instant", "SystemTime", "std::thread"] {
                assert!(
                    !code(&text).any(|(_, line)| line.contains(word)),
                    "{name} names `{word}`"
                );
            }
        }
    }
}

/// The names of the crates below the program, and those of their dependencies as their manifests list them.
fn crates() -> Vec<(String, Vec<String>)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("crates");
    let mut found = vec![];
    for entry in fs::read_dir(folder).expect("readable") {
        let path = entry.expect("readable").path();
        let Ok(manifest) = fs::read_to_string(path.join("Cargo.toml")) else {
            continue;
        };
        let mut section = "";
        let mut names = vec![];
        for line in manifest.lines() {
            if line.starts_with('[') {
                section = line;
            } else if section.ends_with("dependencies]")
                && section != "[dev-dependencies]"
                && let Some((name, _)) = line.split_once('=')
            {
                names.push(name.trim().to_owned());
            }
        }
        let name = path.file_name().expect("a folder").to_string_lossy();
        found.push((name.into_owned(), names));
    }
    assert!(found.len() > 10, "the crates are where they are looked for");
    found
}

#[test]
fn no_crate_below_the_program_knows_a_protocol_and_only_the_service_has_a_runtime() {
    for (name, dependencies) in crates() {
        for dependency in &dependencies {
            // The contract, of which only the program knows.
            assert_ne!(dependency, "strew-proto", "{name} depends on it");
            if name == "proto" {
                continue;
            }
            let is_protocol = ["axum", "tonic", "hyper", "http", "tower", "prost", "strew"];
            assert!(
                !is_protocol.contains(&dependency.as_str()),
                "{name} depends on {dependency}"
            );
            assert!(
                name == "service" || !dependency.starts_with("tokio"),
                "{name} depends on {dependency}"
            );
        }
    }
}

#[test]
fn the_protocols_do_not_know_each_other() {
    never_names("src/rest", &["crate::grpc", "tonic"]);
    never_names("src/grpc", &["crate::rest"]);
}

#[test]
fn nothing_that_a_client_sends_reaches_the_file_system() {
    for room in ["src/rest", "src/grpc", "crates/query/src"] {
        never_names(
            room,
            &["std::fs", "fs::", "std::path", "PathBuf", "std::process"],
        );
    }
}

#[test]
fn unsafe_code_stands_only_where_it_is_explained() {
    for (name, text) in sources() {
        let is_foreign = name == "bindings/python/src/arrow.rs"
            || name.starts_with("bindings/c/src/")
            || name == "src/ops/trim.rs";
        if is_foreign || name.starts_with("crates/core/src/kernel/") {
            continue;
        }
        // The names of exported functions are no memory.
        let exports = name == "bindings/js/lite/src/lib.rs";
        for (line, text) in code(&text) {
            if exports && text.trim() == "#[unsafe(no_mangle)]" {
                continue;
            }
            // Policies for browsers have `unsafe-inline`.
            let words = text.split(|c: char| !c.is_alphanumeric() && c != '_' && c != '-');
            assert!(
                !words.clone().any(|w| w == "unsafe"),
                "{name}:{line} is unsafe: {text}"
            );
        }
    }
}

#[test]
fn files_hold_one_idea_and_say_what_it_is() {
    for (name, text) in sources() {
        assert!(
            text.lines().count() <= 500,
            "{name} has more than 500 lines"
        );
        assert!(
            text.starts_with("//!"),
            "{name} does not begin by saying what it is for"
        );
        let stem = Path::new(&name)
            .file_stem()
            .expect("named")
            .to_string_lossy();
        let vague = ["utils", "util", "helpers", "helper", "common", "misc"];
        assert!(
            !vague.contains(&stem.as_ref()),
            "{name} has a name that says nothing"
        );
        for marker in ["TODO", "FIXME", "XXX"] {
            assert!(!text.contains(marker), "{name} has a {marker}");
        }
    }
}

#[test]
fn libraries_print_nothing() {
    for room in [
        "crates/core/src",
        "crates/forge/src",
        "crates/catalog/src",
        "crates/encode/src",
        "crates/plan/src",
        "crates/query/src",
        "crates/service/src",
        "src/rest",
        "src/grpc",
    ] {
        never_names(room, &["println!", "eprintln!", "print!(", "dbg!"]);
    }
}

#[test]
fn no_files_import_each_other_in_a_circle() {
    let crates = crates()
        .into_iter()
        .map(|(name, _)| format!("crates/{name}/src"));
    let folders: Vec<String> = crates.chain(["src".to_owned()]).collect();
    circles::check(&folders, &sources());
}

#[test]
fn every_part_of_a_release_and_every_published_crate_is_listed() {
    let folders: Vec<String> = crates().into_iter().map(|(name, _)| name).collect();
    releasing::check(&folders);
}
