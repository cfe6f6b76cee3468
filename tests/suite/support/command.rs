//! The program's commands, run to their end.

use std::{
    fs,
    io::Write as _,
    path::PathBuf,
    process::{Command, Output, Stdio},
};

use tempfile::TempDir;

use super::daemon::strew;

/// Runs a command; `input` is its standard input.
pub fn run(arguments: &[&str], input: &str) -> Output {
    ended(strew().args(arguments), input)
}

fn ended(command: &mut Command, input: &str) -> Output {
    let mut child = command
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program runs");
    // A command that does not read its input may have ended already.
    let _ = child
        .stdin
        .take()
        .expect("piped")
        .write_all(input.as_bytes());
    child.wait_with_output().expect("it ends")
}

/// The output of a command on standard error.
pub fn errors(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Fails unless a command says some words on standard error.
#[track_caller]
pub fn assert_says(output: &Output, words: &str) {
    let text = errors(output);
    assert!(text.contains(words), "no `{words}`: {text}");
}

/// A folder in which commands run as lines of a shell do: words between spaces or
/// in quotes, files by their names.
pub struct Shell(TempDir);

impl Shell {
    /// One with an empty folder.
    pub fn new() -> Self {
        Self::of(tempfile::tempdir().expect("a folder"))
    }

    /// One with a folder that has files.
    pub fn of(folder: TempDir) -> Self {
        Self(folder)
    }

    /// The path of a file.
    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Writes a file.
    pub fn write(&self, name: &str, text: impl AsRef<[u8]>) {
        fs::write(self.path(name), text).expect("writable");
    }

    /// The bytes of a file.
    pub fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).expect("written")
    }

    /// Runs a command with its standard input.
    pub fn run(&self, line: &str, input: &str) -> Output {
        let parts = line.split('\'').enumerate();
        let words = parts.flat_map(|(i, part)| match i % 2 {
            0 => part.split_whitespace().collect(),
            _ => vec![part],
        });
        ended(strew().args(words).current_dir(&self.0), input)
    }

    /// Standard output of a command that must succeed.
    pub fn output(&self, line: &str, input: &str) -> Vec<u8> {
        let output = self.run(line, input);
        assert!(output.status.success(), "{line}: {}", errors(&output));
        output.stdout
    }

    /// The text that a command prints, which must succeed.
    pub fn printed(&self, line: &str) -> String {
        String::from_utf8(self.output(line, "")).expect("UTF-8")
    }

    /// Fails unless a command is refused with these words.
    pub fn assert_refused(&self, line: &str, words: &[&str]) {
        let output = self.run(line, "");
        let message = errors(&output);
        assert_eq!(output.status.code(), Some(2), "{line}: {message}");
        for word in words {
            assert!(message.contains(word), "{line}: no `{word}`: {message}");
        }
    }
}
