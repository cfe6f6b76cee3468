//! The program itself as a process of its own: when it is ready, what it holds.

use std::{
    env,
    io::{BufRead as _, BufReader},
    net::SocketAddr,
    process::{Child, Command, Stdio},
};

/// A running daemon; killed when dropped.
pub struct Program {
    child: Child,
    pub address: SocketAddr,
}

impl Program {
    /// Starts one on a free port with further settings (`key=value`); gives it when it listens.
    pub fn start(settings: &[&str]) -> Self {
        let mut command = Command::new(env!("CARGO_BIN_EXE_strew"));
        // Settings of whoever runs the bench are not the bench's.
        for (name, _) in env::vars_os() {
            if name.to_string_lossy().starts_with("STREW_") {
                command.env_remove(name);
            }
        }
        command.args([
            "serve",
            "--listen",
            "127.0.0.1:0",
            "--set",
            "log.filter=warn",
        ]);
        for setting in settings {
            command.args(["--set", setting]);
        }
        let mut child = command.stdout(Stdio::piped()).spawn().expect("runs");
        let mut line = String::new();
        let out = child.stdout.take().expect("piped");
        BufReader::new(out).read_line(&mut line).expect("readable");
        let address = line.trim().strip_prefix("listening on http://");
        let address = address.expect("it listens").parse().expect("an address");
        Self { child, address }
    }

    /// Resident memory in MiB, where the system tells it.
    pub fn resident(&self) -> Option<f64> {
        let path = format!("/proc/{}/status", self.child.id());
        let status = std::fs::read_to_string(path).ok()?;
        let line = status.lines().find(|line| line.starts_with("VmRSS:"))?;
        let kilobytes: f64 = line.split_whitespace().nth(1)?.parse().ok()?;
        Some(kilobytes / 1024.0)
    }
}

impl Drop for Program {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
