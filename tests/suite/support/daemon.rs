//! The daemon under test, with a folder of tables of its own.

use std::{
    net::SocketAddr,
    ops::{Deref, DerefMut},
    path::Path,
    process::{Command, Stdio},
    time::{Duration, Instant},
};

use strew_core::Table;
use strew_testkit::{
    daemon::{self, Launcher, NotReady},
    http1, process,
    tables::{random, write},
    wait::until,
};
use tempfile::TempDir;

/// The profile of the tables that tests make.
pub const PROFILE: &str = "test";

/// The path of the program.
pub const PROGRAM: &str = env!("CARGO_BIN_EXE_strew");

/// The program without the settings of the caller's environment.
pub fn strew() -> Command {
    process::command(PROGRAM)
}

/// A table with random displacements.
pub fn table(alpha: &str, profile: &str) -> Table {
    random(alpha, profile, 20)
}

/// Another table for the queries of [`table`].
pub fn other_table(alpha: &str, profile: &str) -> Table {
    let table = table(alpha, profile);
    let mut displacements = table.displacements().to_vec();
    displacements.reverse();
    let (map, provenance) = (table.map().clone(), table.provenance().clone());
    Table::new(map, profile, displacements, provenance).expect("valid")
}

/// A folder with the test tables: two values of α for [`PROFILE`].
pub fn tables() -> TempDir {
    let folder = no_tables();
    write(folder.path(), "a.strew", &table("(5-sqrt(3))/2", PROFILE));
    write(folder.path(), "b.strew", &table("sqrt(3)", PROFILE));
    folder
}

/// An empty folder: the daemon has its built-in tables only.
pub fn no_tables() -> TempDir {
    tempfile::tempdir().expect("a temporary folder")
}

/// A running daemon; killed when dropped. Its log holds warnings unless a test wants more, and is
/// printed if the test panics.
pub struct Daemon {
    process: daemon::Daemon,
    tables: TempDir,
}

impl Daemon {
    /// Starts one with the test tables and further settings (`key=value`).
    pub fn start(settings: &[&str]) -> Self {
        Self::with_tables(tables(), settings)
    }

    /// Starts one with the built-in tables only, that takes its time: labels are made slowly beside other tests.
    pub fn built_in() -> Self {
        Self::with_tables(no_tables(), &["server.first_byte_seconds=300"])
    }

    /// Starts one with a folder of tables and further settings.
    pub fn with_tables(tables: TempDir, settings: &[&str]) -> Self {
        Self::launch(quiet().settings(settings), tables).expect("ready")
    }

    /// Starts one with the test tables and a file of settings.
    pub fn with_config(text: &str) -> Self {
        let folder = tables();
        let file = folder.path().join("strew.toml");
        std::fs::write(&file, text).expect("writable");
        Self::launch(quiet().config(&file), folder).expect("ready")
    }

    /// Starts one with the test tables and the default log.
    pub fn with_log(settings: &[&str]) -> Self {
        Self::launch(Launcher::new(PROGRAM).settings(settings), tables()).expect("ready")
    }

    /// Starts one with the test tables that logs to a file.
    pub fn logging_to(log: impl Into<Stdio>, settings: &[&str]) -> Self {
        let launcher = Launcher::new(PROGRAM).settings(settings).log_to(log);
        Self::launch(launcher, tables()).expect("ready")
    }

    /// Starts one with the test tables at an address, if that is free.
    pub fn at(address: SocketAddr) -> Option<Self> {
        Self::launch(quiet().listen(address), tables()).ok()
    }

    /// Starts one with the built-in tables at an address, if that is free.
    pub fn built_in_at(address: SocketAddr) -> Option<Self> {
        Self::launch(quiet().listen(address), no_tables()).ok()
    }

    /// Starts one that serves TLS with the files of a folder: `server.pem` with `server.key`, and
    /// `clients.pem`, if it exists, for certificates of clients.
    pub fn with_tls(folder: &Path, settings: &[&str]) -> Self {
        let file = |setting: &str, name: &str| format!("{setting}={}", folder.join(name).display());
        let mut all = vec![
            file("tls.certificate", "server.pem"),
            file("tls.key", "server.key"),
        ];
        if folder.join("clients.pem").exists() {
            all.push(file("tls.client_ca", "clients.pem"));
        }
        all.extend(settings.iter().map(ToString::to_string));
        Self::start(&all.iter().map(String::as_str).collect::<Vec<_>>())
    }

    fn launch(launcher: Launcher, tables: TempDir) -> Result<Self, NotReady> {
        let process = launcher.tables(tables.path()).start()?;
        Ok(Self { process, tables })
    }

    /// A whole answer.
    pub fn get(&self, path: &str) -> http1::Answer {
        http1::get(self.address(), path, &[])
    }

    /// A whole answer to a JSON body.
    pub fn post(&self, path: &str, body: &serde_json::Value) -> http1::Answer {
        http1::post(self.address(), path, &[], body.to_string().as_bytes())
    }

    /// A gRPC channel.
    pub async fn channel(&self) -> tonic::transport::Channel {
        tonic::transport::Endpoint::from_shared(self.url(""))
            .expect("an address")
            .connect()
            .await
            .expect("connected")
    }

    /// The number of streams in progress, as `/readyz` reports it.
    pub fn streams(&self) -> u64 {
        self.get("/readyz").json()["streams"]
            .as_u64()
            .expect("a number")
    }

    /// Waits until no stream is in progress.
    pub fn until_no_streams(&self) {
        until("no stream is left", || self.streams() == 0);
    }

    /// A figure of `/proc/PID/status` in KiB, such as `VmRSS`.
    pub fn memory_kib(&self, figure: &str) -> u64 {
        self.process.memory_kib(figure).expect("Linux")
    }

    /// The processor time used over the next `time`, in clock ticks.
    pub fn cpu_ticks_over(&self, time: Duration) -> u64 {
        let before = self.cpu_ticks();
        let start = Instant::now();
        while let Some(left) = time.checked_sub(start.elapsed()) {
            std::thread::park_timeout(left);
        }
        self.cpu_ticks() - before
    }

    /// The folder of its tables.
    pub fn folder(&self) -> &Path {
        self.tables.path()
    }
}

/// A launcher of a daemon that logs warnings only.
fn quiet() -> Launcher {
    Launcher::new(PROGRAM).settings(&["log.filter=warn"])
}

impl Deref for Daemon {
    type Target = daemon::Daemon;

    fn deref(&self) -> &Self::Target {
        &self.process
    }
}

impl DerefMut for Daemon {
    fn deref_mut(&mut self) -> &mut Self::Target {
        &mut self.process
    }
}
