//! The commands: `sample`, `count`, `point`, `nearest` and `split` against the answers of REST, `export` beside the
//! daemon, reference systems, features and classes of maps, `figure` and `arrangement`, `forge` with interruptions, `config` and its layers, `probe` as health checks
//! run it, what wrong flags and full disks lead to.

mod completions;
mod config;
mod export;
mod features;
mod fields;
mod forge;
mod full_disk;
mod geo;
mod invalid_flags;
mod mix;
mod outputs;
mod patterns;
mod probe;
mod queries;
mod space_tables;
mod worlds;

use std::fs;

use crate::support::command::{errors, run};

/// Standard output of a command that must succeed; `input` is its standard input.
fn output(arguments: &[&str], input: &str) -> Vec<u8> {
    let output = run(arguments, input);
    let message = errors(&output);
    assert!(output.status.success(), "{arguments:?}: {message}");
    output.stdout
}

/// The text that a command prints, which must succeed.
fn printed(arguments: &[&str]) -> String {
    String::from_utf8(output(arguments, "")).expect("UTF-8")
}

/// The message of a command that must fail with this code.
fn refused(arguments: &[&str], code: i32) -> String {
    let output = run(arguments, "");
    let message = errors(&output);
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {message}");
    message
}

/// A folder with a file of settings, and the path of the file.
fn settings(text: &str) -> (tempfile::TempDir, String) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("strew.toml");
    fs::write(&file, text).expect("writable");
    let file = file.display().to_string();
    (folder, file)
}
