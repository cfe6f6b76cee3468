//! The invariants listed in ARCHITECTURE.md, checked by searching the sources.

use std::{
    fs,
    path::{Path, PathBuf},
};

#[path = "tidy/circles.rs"]
mod circles;
#[path = "tidy/imports.rs"]
mod imports;

/// Every source file of the workspace, as (path from the root, text).
fn sources() -> Vec<(String, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut open: Vec<PathBuf> = [
        "src",
        "build",
        "bindings/python/src",
        "bindings/c/src",
        "crates",
        "tests",
        "benches",
        "examples",
        "fuzz/subjects",
        "fuzz/fuzz_targets",
        "build.rs",
    ]
    .map(|d| root.join(d))
    .to_vec();
    let mut found = Vec::new();
    while let Some(path) = open.pop() {
        if path.is_dir() {
            let entries = fs::read_dir(&path).expect("readable");
            open.extend(entries.map(|entry| entry.expect("readable").path()));
        } else if path.extension().is_some_and(|e| e == "rs") {
            let name = path
                .strip_prefix(root)
                .expect("inside")
                .to_string_lossy()
                .replace('\\', "/");
            found.push((name, fs::read_to_string(&path).expect("UTF-8")));
        }
    }
    assert!(
        found.len() > 30,
        "the sources are where they are looked for"
    );
    found.retain(|(name, _)| name != "tests/tidy.rs");
    found
}

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
fn the_service_knows_no_protocol_and_the_protocols_not_each_other() {
    never_names(
        "src/service",
        &["axum", "tonic", "http::", "crate::rest", "crate::grpc"],
    );
    never_names(
        "src/access",
        &[
            "axum",
            "tonic",
            "http::",
            "crate::rest",
            "crate::grpc",
            "crate::service",
        ],
    );
    never_names("src/rest", &["crate::grpc", "tonic"]);
    never_names("src/grpc", &["crate::rest", "axum"]);
}

#[test]
fn nothing_that_a_client_sends_reaches_the_file_system() {
    for room in ["src/rest", "src/grpc", "src/service/query"] {
        never_names(
            room,
            &["std::fs", "fs::", "std::path", "PathBuf", "std::process"],
        );
    }
}

#[test]
fn unsafe_code_stands_only_in_the_kernel() {
    for (name, text) in sources() {
        let is_foreign =
            name == "bindings/python/src/arrow.rs" || name.starts_with("bindings/c/src/");
        if is_foreign || name.starts_with("crates/core/src/sample/kernel/") {
            continue;
        }
        for (line, text) in code(&text) {
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
        "src/service",
        "src/rest",
        "src/grpc",
    ] {
        never_names(room, &["println!", "eprintln!", "print!(", "dbg!"]);
    }
}

#[test]
fn files_import_each_other_in_known_circles_only() {
    circles::check(&["crates/core/src", "crates/forge/src", "src"], &sources());
}

#[test]
fn every_file_of_the_pages_is_served_and_every_import_leads_to_one() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/rest");
    let served = fs::read_to_string(root.join("page.rs")).expect("UTF-8");
    let folder = root.join("page");
    let names = files_below(&folder);
    for name in &names {
        let text = fs::read_to_string(folder.join(name)).expect("UTF-8");
        let lines = text.lines().count();
        let is_own = !name.starts_with("vendor/");
        assert!(lines <= 500 || !is_own, "{name} has more than 500 lines");
        let kind = if name.ends_with(".html") { "page/" } else { "" };
        assert!(
            served.contains(&format!("\"{kind}{name}\"")),
            "{name} is not served"
        );
        let beside = Path::new(name).parent().expect("a file");
        for (word, from) in [
            ("from \"./", beside.to_owned()),
            ("from \"../", beside.join("..")),
            ("\"/page/", PathBuf::new()),
        ] {
            for piece in text.split(word).skip(1) {
                let part = piece.split('"').next().unwrap_or_default();
                let leads_to = folder.join(&from).join(part);
                assert!(leads_to.is_file(), "{name} names {part}");
            }
        }
    }
}

/// The files below a folder, as paths relative to it.
fn files_below(folder: &Path) -> Vec<String> {
    let mut found = vec![];
    for entry in fs::read_dir(folder).expect("readable") {
        let path = entry.expect("readable").path();
        let name = path.file_name().expect("a name").to_string_lossy();
        if path.is_dir() {
            let below = files_below(&path);
            found.extend(below.iter().map(|inner| format!("{name}/{inner}")));
        } else {
            found.push(name.into_owned());
        }
    }
    found
}
