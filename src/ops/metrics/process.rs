//! Figures of this process, on Linux.

use std::fs;

/// A few figures.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Process {
    /// Resident memory in bytes.
    pub(super) memory: Option<f64>,
    /// Processor time in seconds.
    pub(super) cpu: Option<f64>,
    /// Threads.
    pub(super) threads: Option<f64>,
    /// Open files.
    pub(super) files: Option<f64>,
}

/// Ticks per second in `/proc`, on every Linux that Rust supports.
const TICKS: f64 = 100.0;

impl Process {
    /// As of now.
    pub(super) fn now() -> Self {
        let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
        Self {
            memory: of(&status, MEMORY).map(|kibibytes| kibibytes * 1024.0),
            cpu: cpu(),
            threads: of(&status, "Threads:"),
            files: fs::read_dir("/proc/self/fd")
                .ok()
                .map(|all| all.count() as f64),
        }
    }
}

/// Resident memory in bytes; 0 where it is not known.
pub(in crate::ops) fn resident() -> u64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    of(&status, MEMORY).map_or(0, |kibibytes| kibibytes as u64 * 1024)
}

/// The line of resident memory, in KiB.
const MEMORY: &str = "VmRSS:";

/// The number in a line of the status.
fn of(status: &str, name: &str) -> Option<f64> {
    let rest = status.lines().find_map(|line| line.strip_prefix(name))?;
    rest.split_whitespace().next()?.parse().ok()
}

fn cpu() -> Option<f64> {
    let stat = fs::read_to_string("/proc/self/stat").ok()?;
    // The name of the program comes first, in parentheses, and may hold blanks.
    let fields: Vec<&str> = stat.rsplit_once(')')?.1.split_whitespace().collect();
    let ticks = |at: usize| -> Option<f64> { fields.get(at)?.parse().ok() };
    Some((ticks(11)? + ticks(12)?) / TICKS)
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;

    #[test]
    fn figures_are_read() {
        let now = Process::now();
        assert!(now.memory.is_some_and(|bytes| bytes > 1e6));
        assert!(now.threads.is_some_and(|threads| threads > 0.0));
        assert!(now.files.is_some_and(|files| files > 2.0));
        assert!(now.cpu.is_some());
    }
}
