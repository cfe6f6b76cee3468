//! A daemon on a port of its own that can be killed and started again.

use std::{
    io::{BufRead as _, BufReader},
    net::{SocketAddr, TcpListener},
    path::Path,
    process::{Child, Command, Stdio},
    sync::{
        Mutex,
        atomic::{AtomicU64, Ordering},
    },
    time::{Duration, Instant},
};

use crate::http;

/// A daemon.
pub struct Replica {
    pub address: SocketAddr,
    tables: std::path::PathBuf,
    child: Mutex<Child>,
    /// Odd while it is not there.
    epoch: AtomicU64,
}

impl Replica {
    /// Starts one on a free port.
    pub fn start(tables: &Path) -> Self {
        let free = TcpListener::bind("127.0.0.1:0").expect("a port");
        let address = free.local_addr().expect("bound");
        drop(free);
        Self {
            child: Mutex::new(spawn(address, tables)),
            address,
            tables: tables.into(),
            epoch: AtomicU64::new(0),
        }
    }

    /// Changes whenever it goes and comes; odd while it is not there.
    pub fn epoch(&self) -> u64 {
        self.epoch.load(Ordering::SeqCst)
    }

    /// Sends a signal.
    pub fn signal(&self, signal: &str) {
        let pid = self.child.lock().expect("no panic").id();
        let sent = Command::new("kill")
            .args([signal, &pid.to_string()])
            .status();
        assert!(sent.is_ok_and(|status| status.success()), "kill {signal}");
    }

    /// Ends it by a signal and starts it again.
    pub fn restart(&self, signal: &str) {
        self.epoch.fetch_add(1, Ordering::SeqCst);
        self.signal(signal);
        let mut child = self.child.lock().expect("no panic");
        let _ = child.wait();
        *child = spawn(self.address, &self.tables);
        self.epoch.fetch_add(1, Ordering::SeqCst);
    }

    /// Whether the process is still the one that was started.
    pub fn is_running(&self) -> bool {
        let mut child = self.child.lock().expect("no panic");
        matches!(child.try_wait(), Ok(None))
    }

    /// Resident memory in MiB.
    pub fn memory(&self) -> f64 {
        let pid = self.child.lock().expect("no panic").id();
        let status = std::fs::read_to_string(format!("/proc/{pid}/status")).unwrap_or_default();
        let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
        let kibibytes =
            line.and_then(|line| line.trim().trim_end_matches("kB").trim().parse().ok());
        kibibytes.unwrap_or(0.0) / 1024.0
    }

    /// Answers under way, as it says itself; waits until there are none.
    pub fn streams_at_rest(&self) -> Result<(), String> {
        let start = Instant::now();
        loop {
            let asked = http::ask(self.address, "/readyz", &[], None);
            let body = asked
                .and_then(http::Opened::whole)
                .map_err(|e| e.to_string())?;
            let text = String::from_utf8_lossy(&body).into_owned();
            if text.contains("\"streams\":0") {
                return Ok(());
            }
            if start.elapsed() > Duration::from_secs(30) {
                return Err(format!("30 seconds after the end: {text}"));
            }
            std::thread::park_timeout(Duration::from_millis(50));
        }
    }
}

impl Drop for Replica {
    fn drop(&mut self) {
        let child = self.child.get_mut().expect("no panic");
        let _ = child.kill();
        let _ = child.wait();
    }
}

/// The program, without any setting of the surroundings.
pub fn strew() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_strew"));
    for (name, _) in std::env::vars_os() {
        if name.to_string_lossy().starts_with("STREW_") {
            command.env_remove(name);
        }
    }
    command
}

fn spawn(address: SocketAddr, tables: &Path) -> Child {
    let mut command = strew();
    command
        .args(["serve", "--listen", &address.to_string(), "--tables"])
        .arg(tables)
        // What goes wrong on purpose is told in the log; only what should not is shown.
        .args(["--set", "log.filter=error,strew::ops::reload=off"])
        .args(["--set", "shutdown.drain_seconds=1"])
        .stdout(Stdio::piped());
    let start = Instant::now();
    loop {
        let mut child = command.spawn().expect("the program runs");
        let mut line = String::new();
        let out = child.stdout.take().expect("piped");
        let _ = BufReader::new(out).read_line(&mut line);
        if line.starts_with("listening") {
            return child;
        }
        // The port may be taken for a moment by a client's own end of a connection.
        let _ = child.wait();
        assert!(
            start.elapsed() < Duration::from_secs(30),
            "it does not start"
        );
        std::thread::park_timeout(Duration::from_millis(100));
    }
}
