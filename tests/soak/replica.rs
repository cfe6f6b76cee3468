//! A daemon that can be killed and started again at its address.

use std::{
    net::SocketAddr,
    path::{Path, PathBuf},
    process::{Command, Stdio},
    sync::{
        Mutex, MutexGuard,
        atomic::{AtomicU64, Ordering},
    },
    time::{Duration, Instant},
};

use strew_testkit::{
    daemon::{Daemon, Launcher, NotReady},
    http1, process,
    wait::until,
};

const PROGRAM: &str = env!("CARGO_BIN_EXE_strew");

/// How long the last streams may take to end.
const AT_REST: Duration = Duration::from_secs(30);

/// A daemon.
pub struct Replica {
    pub address: SocketAddr,
    tables: PathBuf,
    daemon: Mutex<Daemon>,
    /// Odd while the daemon is down.
    epoch: AtomicU64,
}

impl Replica {
    /// Starts one on a free port.
    pub fn start(tables: &Path) -> Self {
        let any_port = SocketAddr::from(([127, 0, 0, 1], 0));
        let daemon = launch(any_port, tables, &[]).expect("ready");
        Self {
            address: daemon.address(),
            tables: tables.into(),
            daemon: Mutex::new(daemon),
            epoch: AtomicU64::new(0),
        }
    }

    fn daemon(&self) -> MutexGuard<'_, Daemon> {
        self.daemon.lock().expect("no panic")
    }

    /// A number that grows whenever the daemon goes down or comes back; odd while it is down.
    pub fn epoch(&self) -> u64 {
        self.epoch.load(Ordering::SeqCst)
    }

    /// Sends a signal.
    pub fn signal(&self, signal: &str) {
        self.daemon().signal(signal);
    }

    /// Ends the daemon with a signal and starts it again.
    pub fn restart(&self, signal: &str) {
        self.epoch.fetch_add(1, Ordering::SeqCst);
        let mut daemon = self.daemon();
        daemon.signal(signal);
        daemon.wait();
        // A client's end of a connection may hold the port for a moment.
        *daemon = until("the daemon is back", || {
            launch(self.address, &self.tables, &[]).ok()
        });
        self.epoch.fetch_add(1, Ordering::SeqCst);
    }

    /// Whether the process that was started last is still running.
    pub fn is_running(&self) -> bool {
        self.daemon().ended().is_none()
    }

    /// Resident memory in MiB.
    pub fn memory(&self) -> f64 {
        self.daemon().memory_kib("VmRSS").unwrap_or(0) as f64 / 1024.0
    }

    /// Waits until the daemon reports no stream in progress.
    pub fn streams_at_rest(&self) -> Result<(), String> {
        let start = Instant::now();
        loop {
            let opened = http1::try_open(self.address, "GET", "/readyz", &[], None);
            let body = opened.and_then(http1::Response::body);
            let body = body.map_err(|e| e.to_string())?;
            let text = String::from_utf8_lossy(&body);
            if text.contains("\"streams\":0") {
                return Ok(());
            }
            if start.elapsed() > AT_REST {
                return Err(format!("{AT_REST:?} after the end: {text}"));
            }
            std::thread::park_timeout(Duration::from_millis(50));
        }
    }
}

/// The program without the settings of the caller's environment.
pub fn strew() -> Command {
    process::command(PROGRAM)
}

pub fn launch(address: SocketAddr, tables: &Path, settings: &[&str]) -> Result<Daemon, NotReady> {
    let common = [
        // Faults are injected all the time: only errors are worth reading, and damaged tables
        // are none.
        "log.filter=error,strew::ops::reload=off",
        "shutdown.drain_seconds=1",
    ];
    Launcher::new(PROGRAM)
        .listen(address)
        .tables(tables)
        .settings(&[&common, settings].concat())
        .log_to(Stdio::inherit())
        .start()
}
