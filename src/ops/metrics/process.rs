//! What the system knows of this process, where it is Linux.

use std::fs;

/// A few figures.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Process {
    /// Resident memory in bytes.
    pub(super) memory: Option<u64>,
    /// Processor time in seconds.
    pub(super) cpu: Option<f64>,
    /// Threads.
    pub(super) threads: Option<u64>,
    /// Open files.
    pub(super) files: Option<u64>,
}

/// Ticks a second in `/proc`: the same on every Linux that Rust runs on.
const TICKS: f64 = 100.0;

impl Process {
    /// As of now.
    pub(super) fn now() -> Self {
        let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
        let of = |name: &str| -> Option<u64> {
            let rest = status.lines().find_map(|line| line.strip_prefix(name))?;
            rest.split_whitespace().next()?.parse().ok()
        };
        Self {
            memory: of("VmRSS:").map(|kibibytes| kibibytes * 1024),
            cpu: cpu(),
            threads: of("Threads:"),
            files: fs::read_dir("/proc/self/fd")
                .ok()
                .map(|all| all.count() as u64),
        }
    }
}

fn cpu() -> Option<f64> {
    let stat = fs::read_to_string("/proc/self/stat").ok()?;
    // What stands before may hold blanks: it is the program's name, in parentheses.
    let fields: Vec<&str> = stat.rsplit_once(')')?.1.split_whitespace().collect();
    let ticks = |at: usize| -> Option<f64> { fields.get(at)?.parse().ok() };
    Some((ticks(11)? + ticks(12)?) / TICKS)
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;

    #[test]
    fn the_system_tells() {
        let now = Process::now();
        assert!(now.memory.is_some_and(|bytes| bytes > 1 << 20));
        assert!(now.threads.is_some_and(|threads| threads > 0));
        assert!(now.files.is_some_and(|files| files > 2));
        assert!(now.cpu.is_some());
    }
}
