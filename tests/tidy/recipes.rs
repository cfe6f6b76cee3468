//! The recipes of ARCHITECTURE.md: what is added often is written in three places at most.
//!
//! Those of parameters are tests of their own (`crates/query/src/recipe.rs`), with an entry that only tests have.

use std::{fs, path::Path};

use strew_testkit::{daemon::Launcher, http1};

use super::sources;

/// The files below one of these paths whose code, without its tests, has a text.
fn places(of: &[&str], text: &str) -> Vec<String> {
    let mut found: Vec<String> = (sources().into_iter())
        .filter(|(path, _)| of.iter().any(|part| path.starts_with(part)))
        .filter(|(path, _)| !path.contains("/tests"))
        .filter(|(_, code)| {
            code.split("#[cfg(test)]")
                .next()
                .is_some_and(|code| code.contains(text))
        })
        .map(|(path, _)| path)
        .collect();
    found.sort();
    found
}

fn read(path: &str) -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(path)).expect("readable")
}

/// Its module, and a line in the list of all.
#[test]
fn a_path_is_one_module() {
    let daemon = Launcher::new(env!("CARGO_BIN_EXE_strew")).start();
    let daemon = daemon.expect("ready");
    let api = http1::get(daemon.address(), "/openapi.json", &[]).json();
    let paths: Vec<&String> = api["paths"].as_object().expect("paths").keys().collect();
    assert!(paths.len() > 40, "{paths:?}");
    for path in paths {
        // Examples and links name paths, too.
        let routed = |file: &String| !file.contains("/api/") && !file.ends_with("problem.rs");
        let mut files = places(&["src/rest"], &format!("\"{path}\""));
        files.retain(routed);
        assert!(files.len() <= 1, "{path}: {files:?}");
    }
}

/// The contract, and a method of its name. (A repeated field needs a limit in `most.rs`, or does not compile.)
#[test]
fn a_call_is_one_method() {
    let contract = read("proto/strew/v1/points.proto");
    let calls: Vec<&str> = (contract.lines())
        .filter_map(|line| line.trim().strip_prefix("rpc ")?.split('(').next())
        .collect();
    assert!(calls.len() >= 10, "{calls:?}");
    for call in calls {
        let words = call
            .chars()
            .fold(String::new(), |name, letter| match letter.is_uppercase() {
                true if name.is_empty() => letter.to_lowercase().collect(),
                true => format!("{name}_{}", letter.to_lowercase()),
                false => name + &letter.to_string(),
            });
        let files = places(&["src"], &format!("fn {words}("));
        assert_eq!(files, ["src/grpc/points.rs"], "{call}");
    }
}

/// Its row, its writer, its arm. (What describes bytes or draws meshes looks at the formats that have them.)
#[test]
fn a_format_is_a_row_a_writer_and_an_arm() {
    for format in ["Ndjson", "Csv", "Npy", "Svg", "Glb", "Usda"] {
        let named = format!("Encoding::{format}");
        let files = places(&["crates", "src"], &named);
        let known = [
            "crates/encode/src/answer.rs",
            "crates/encode/src/legend.rs",
            "src/rest/negotiate.rs",
        ];
        let others: Vec<&String> = (files.iter())
            .filter(|file| !known.contains(&&***file))
            .collect();
        assert!(others.is_empty(), "{format}: {files:?}");
    }
}

/// Its default with its reason, its field with its range, its row in the documentation.
#[test]
fn a_limit_is_a_default_a_field_and_a_row() {
    let (settings, rows) = (read("config/strew.toml"), read("docs/operations.md"));
    let code = read("crates/config/src/limits.rs");
    let limits = settings.split("[limits]").nth(1).expect("a section");
    let limits = limits.split("\n[").next().unwrap_or_default().lines();
    let names: Vec<&str> = limits
        .filter_map(|line| Some(line.split_once(" = ")?.0))
        .collect();
    let names: Vec<&&str> = names.iter().filter(|name| !name.starts_with('#')).collect();
    assert!(names.len() > 6, "{names:?}");
    for name in names {
        assert!(code.contains(&format!("pub {name}:")), "{name}");
        assert!(
            rows.contains(&format!("`limits.{name}`")) || rows.contains(&format!("`{name}`")),
            "{name}"
        );
    }
}
