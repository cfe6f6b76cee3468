//! Programs as child processes that end with the test.

use std::{
    ffi::OsStr,
    fs,
    process::{Child, Command, Output},
};

use crate::wait::until;

/// The signals that shells and `nohup` have programs in the background ignore: number and name.
const IGNORED_IN_BACKGROUND: [(u32, &str); 3] = [(1, "HUP"), (2, "INT"), (3, "QUIT")];

/// The program without the `STREW_…` settings of the caller's environment. Signals end it even where
/// the tests run in the background and ignore them: children inherit that, and a test that interrupts
/// one would wait for ever.
pub fn command(program: impl AsRef<OsStr>) -> Command {
    let ignored = ignored("self");
    let mut command = if ignored.is_empty() {
        Command::new(program)
    } else {
        let mut command = Command::new("env");
        command
            .arg(format!("--default-signal={}", ignored.join(",")))
            .arg(program);
        command
    };
    for (name, _) in std::env::vars_os() {
        if name.to_string_lossy().starts_with("STREW_") {
            command.env_remove(name);
        }
    }
    command
}

/// The names of the signals that a process (its id, or `self`) ignores; none where there is no `/proc`.
fn ignored(process: &str) -> Vec<&'static str> {
    let status = fs::read_to_string(format!("/proc/{process}/status")).unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    let is_ignored = |number: u32| mask.unwrap_or_default() >> (number - 1) & 1 == 1;
    let names = IGNORED_IN_BACKGROUND.iter();
    names
        .filter(|(number, _)| is_ignored(*number))
        .map(|(_, name)| *name)
        .collect()
}

/// Sends a signal, such as `INT`, to a process.
pub fn signal(process: u32, name: &str) {
    let sent = Command::new("kill")
        .args(["-s", name, &process.to_string()])
        .status()
        .expect("kill runs");
    assert!(sent.success(), "kill -s {name} {process}");
}

/// A command in progress. It is killed when dropped.
pub struct Running(Option<Child>);

impl Running {
    pub fn start(command: &mut Command) -> Self {
        Self(Some(command.spawn().expect("the program runs")))
    }

    pub fn id(&self) -> u32 {
        self.0.as_ref().expect("running").id()
    }

    /// Sends it a signal, such as `INT`, once it does not ignore this: a [`command`] begins as `env`, which inherits
    /// what the tests ignore.
    pub fn signal(&self, name: &str) {
        let process = self.id().to_string();
        until("a command takes signals", || {
            !ignored(&process).contains(&name)
        });
        signal(self.id(), name);
    }

    /// Waits until it ends, for [`PATIENCE`](crate::wait::PATIENCE) at most. What it still prints
    /// must fit into its pipes.
    pub fn end(mut self) -> Output {
        until("a command ends", || {
            let child = self.0.as_mut().expect("running");
            child.try_wait().expect("a child")
        });
        let child = self.0.take().expect("running");
        child.wait_with_output().expect("a child")
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        if let Some(child) = &mut self.0 {
            let _ = child.kill();
            let _ = child.wait();
        }
    }
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use std::os::unix::process::ExitStatusExt as _;

    use super::*;

    #[test]
    fn an_interrupt_ends_a_child() {
        let running = Running::start(command("sleep").arg("600"));
        running.signal("INT");
        assert_eq!(running.end().status.signal(), Some(2));
    }

    #[test]
    fn an_interrupt_ends_a_child_of_tests_in_the_background() {
        let tests = std::env::current_exe().expect("a path");
        let in_background = "trap '' HUP INT QUIT; exec \"$0\" \"$@\"";
        let mut shell = Command::new("sh");
        shell.args(["-c", in_background]).arg(tests);
        shell.args(["--exact", "process::tests::an_interrupt_ends_a_child"]);
        assert!(Running::start(&mut shell).end().status.success());
    }
}
