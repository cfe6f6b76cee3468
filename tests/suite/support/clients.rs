//! Clients and proxies that tests use where they are installed. Where one is missing, a message says
//! so and the test is skipped.

use std::{
    path::{Path, PathBuf},
    process::Command,
};

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

/// What a script of Python reads of a file; `None` if what it needs is not installed.
pub fn read_by(script: &str, format: &str, file: &Path) -> Option<String> {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join(script);
    let output = python(&format!("a reader of {format}"))?
        .args([&script, Path::new(format), file])
        .output()
        .expect("Python runs");
    let message = String::from_utf8_lossy(&output.stderr);
    if output.status.code() == Some(77) {
        eprintln!("skipped: {format}: {}", message.trim());
        return None;
    }
    assert!(output.status.success(), "{format}: {message}");
    Some(String::from_utf8(output.stdout).expect("UTF-8"))
}
