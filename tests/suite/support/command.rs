//! The program's commands, run to their end.

use std::{
    io::Write as _,
    process::{Output, Stdio},
};

use super::daemon::strew;

/// Runs a command; `input` is its standard input.
pub fn run(arguments: &[&str], input: &str) -> Output {
    let mut child = strew()
        .args(arguments)
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
