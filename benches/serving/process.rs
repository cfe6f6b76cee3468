//! The program as a process of its own, and the memory it holds.

use strew_testkit::daemon::{Daemon, Launcher};

/// Starts a daemon on a free port with the built-in tables and further settings (`key=value`).
/// Returns when it listens.
pub fn start(settings: &[&str]) -> Daemon {
    Launcher::new(env!("CARGO_BIN_EXE_strew"))
        .settings(&["log.filter=warn"])
        .settings(settings)
        .start()
        .expect("ready")
}

/// Resident memory in MiB, where the system reports it.
pub fn resident(daemon: &Daemon) -> Option<f64> {
    Some(daemon.memory_kib("VmRSS")? as f64 / 1024.0)
}
