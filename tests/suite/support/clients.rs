//! Clients and proxies that tests use where they are installed. Where one is missing, a message says
//! so and the test is skipped.

use std::{path::PathBuf, process::Command};

/// The path of a program in `PATH`.
pub fn find(program: &str) -> Option<PathBuf> {
    let path = std::env::var_os("PATH")?;
    let found = std::env::split_paths(&path)
        .map(|folder| folder.join(program))
        .find(|file| file.is_file());
    if found.is_none() {
        eprintln!("skipped: {program} is not installed");
    }
    found
}

/// The Python of `STREW_TEST_PYTHON`, which tests of `package` use.
pub fn python(package: &str) -> Option<Command> {
    let python = std::env::var_os("STREW_TEST_PYTHON");
    if python.is_none() {
        eprintln!("skipped: STREW_TEST_PYTHON names no Python with {package}");
    }
    python.map(Command::new)
}
