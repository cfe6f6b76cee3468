//! Running the program for a test: a folder of tables, a process, an address.

use std::{
    io::{BufRead as _, BufReader},
    path::{Path, PathBuf},
    process::{Child, ChildStdout, Command, ExitStatus, Stdio},
    time::{Duration, Instant},
};

use strew_core::{Map, Table, table::Figures, table::Provenance};

use crate::raw;

/// Long enough for a busy machine, short enough for an impatient one.
pub const PATIENCE: Duration = Duration::from_secs(30);

/// The profile of the tables that tests make.
pub const PROFILE: &str = "test";

/// The program without any setting of the surroundings.
pub fn strew() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_strew"));
    for (name, _) in std::env::vars_os() {
        if name.to_string_lossy().starts_with("STREW_") {
            command.env_remove(name);
        }
    }
    command
}

/// A table with displacements from a simple generator: no noise profile, but points of all kinds.
pub fn table(alpha: &str, profile: &str) -> Table {
    table_of_radius(alpha, profile, 20)
}

/// The same for a map of another half-width.
pub fn table_of_radius(alpha: &str, profile: &str, radius: u32) -> Table {
    let map = Map::new(alpha.parse().expect("valid"), radius).expect("small");
    let mut state = 1u32;
    let mut next = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state as i32) >> 12
    };
    let blocks = map.intervals() * map.intervals();
    let displacements = (0..blocks).map(|_| [next(), next()]).collect();
    let provenance = Provenance {
        optimizer: "none".into(),
        parameters: vec![("generator".into(), "lcg".into())],
        seed: 1,
        twins: map.twins().take(2).collect(),
        figures: vec![Figures {
            subject: "window".into(),
            seen: false,
            points: 1000,
            values: vec![("delta_min".into(), 0.25)],
        }],
    };
    Table::new(map, profile, displacements, provenance).expect("valid")
}

/// A folder with the test tables: two values of α for [`PROFILE`].
pub fn tables() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    write(folder.path(), "a.strew", &table("(5-sqrt(3))/2", PROFILE));
    write(folder.path(), "b.strew", &table("sqrt(3)", PROFILE));
    folder
}

/// A folder with the tables that the program has built in.
pub fn built_in_tables() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let from = Path::new(env!("CARGO_MANIFEST_DIR")).join("tables");
    for entry in std::fs::read_dir(from).expect("readable") {
        let entry = entry.expect("readable");
        std::fs::copy(entry.path(), folder.path().join(entry.file_name())).expect("copied");
    }
    folder
}

/// Writes a table file.
pub fn write(folder: &Path, name: &str, table: &Table) {
    std::fs::write(folder.join(name), table.to_bytes()).expect("writable");
}

/// Settings of a daemon that logs no more than it must.
fn warnings<'a>(settings: &[&'a str]) -> Vec<&'a str> {
    [settings, &["log.filter=warn"]].concat()
}

/// A running daemon; killed when dropped.
pub struct Daemon {
    child: Child,
    output: BufReader<ChildStdout>,
    address: String,
    tables: tempfile::TempDir,
}

impl Daemon {
    /// Starts one on a free port with the test tables and further settings (`key=value`).
    pub fn start(settings: &[&str]) -> Self {
        Self::with_tables(tables(), settings)
    }

    /// Starts one on a free port with a folder of tables and further settings.
    pub fn with_tables(tables: tempfile::TempDir, settings: &[&str]) -> Self {
        Self::launch(strew(), "127.0.0.1:0", tables, &warnings(settings))
            .unwrap_or_else(|line| panic!("not ready: {line}"))
    }

    /// Starts one with the test tables at an address, if that is free.
    pub fn at(address: &str) -> Option<Self> {
        Self::launch(strew(), address, tables(), &warnings(&[])).ok()
    }

    /// Starts one with the built-in tables at an address, if that is free.
    pub fn built_in_at(address: &str) -> Option<Self> {
        Self::launch(strew(), address, built_in_tables(), &warnings(&[])).ok()
    }

    /// Starts one that logs to a file, or what goes by as one.
    pub fn logging_to(log: Stdio, settings: &[&str]) -> Self {
        let mut command = strew();
        command.stderr(log);
        Self::launch(command, "127.0.0.1:0", tables(), settings)
            .unwrap_or_else(|line| panic!("not ready: {line}"))
    }

    /// Starts one; gives what it said instead if it is not ready.
    fn launch(
        mut command: Command,
        listen: &str,
        tables: tempfile::TempDir,
        settings: &[&str],
    ) -> Result<Self, String> {
        command
            .args(["serve", "--listen", listen, "--tables"])
            .arg(tables.path());
        for setting in settings {
            command.args(["--set", setting]);
        }
        let mut child = command
            .stdout(Stdio::piped())
            .spawn()
            .expect("the program runs");
        let mut line = String::new();
        let mut output = BufReader::new(child.stdout.take().expect("piped"));
        output.read_line(&mut line).expect("readable");
        let address = line
            .trim()
            .strip_prefix("listening on http")
            .map(|rest| rest.trim_start_matches('s').trim_start_matches("://"));
        let Some(address) = address.map(ToOwned::to_owned) else {
            let _ = child.wait();
            return Err(line);
        };
        Ok(Self {
            child,
            output,
            address,
            tables,
        })
    }

    /// The next line on its standard output.
    pub fn line(&mut self) -> String {
        let mut line = String::new();
        self.output.read_line(&mut line).expect("readable");
        line.trim().to_owned()
    }

    /// `host:port`.
    pub fn address(&self) -> &str {
        &self.address
    }

    /// An address of this daemon.
    pub fn url(&self, path: &str) -> String {
        format!("http://{}{path}", self.address)
    }

    /// A whole answer.
    pub fn get(&self, path: &str) -> raw::Answer {
        raw::get(&self.address, path, &[])
    }

    /// A whole answer to a query as a body.
    pub fn post(&self, path: &str, body: &serde_json::Value) -> raw::Answer {
        raw::posted(&self.address, path, &[], body.to_string().as_bytes())
    }

    /// A channel to the gRPC door.
    pub async fn channel(&self) -> tonic::transport::Channel {
        tonic::transport::Endpoint::from_shared(self.url(""))
            .expect("an address")
            .connect()
            .await
            .expect("connected")
    }

    /// Answers under way, as the daemon itself says.
    pub fn streams(&self) -> u64 {
        self.get("/readyz").json()["streams"]
            .as_u64()
            .expect("a number")
    }

    /// The process.
    pub fn pid(&self) -> u32 {
        self.child.id()
    }

    /// A figure of `/proc/PID/status` in KiB, such as `VmRSS`.
    pub fn memory_kib(&self, name: &str) -> u64 {
        let path = PathBuf::from(format!("/proc/{}/status", self.pid()));
        let text = std::fs::read_to_string(path).expect("Linux");
        text.lines()
            .find_map(|line| line.strip_prefix(name)?.strip_prefix(':'))
            .and_then(|rest| rest.trim().trim_end_matches("kB").trim().parse().ok())
            .expect("a figure")
    }

    /// Processor time used so far, in clock ticks (usually hundredths of a second).
    pub fn cpu_ticks(&self) -> u64 {
        let text = std::fs::read_to_string(format!("/proc/{}/stat", self.pid())).expect("Linux");
        let fields: Vec<&str> = text
            .rsplit_once(')')
            .expect("a name")
            .1
            .split_whitespace()
            .collect();
        fields[11..13]
            .iter()
            .map(|ticks| ticks.parse::<u64>().expect("a number"))
            .sum()
    }

    /// The folder of its tables.
    pub fn folder(&self) -> &Path {
        self.tables.path()
    }

    /// Sends SIGTERM.
    pub fn terminate(&self) {
        self.signal("-TERM");
    }

    /// Sends a signal.
    pub fn signal(&self, signal: &str) {
        let sent = Command::new("kill")
            .args([signal, &self.pid().to_string()])
            .status()
            .expect("kill runs");
        assert!(sent.success());
    }

    /// Waits for the end.
    pub fn wait(&mut self) -> ExitStatus {
        until("the daemon ends", || {
            self.child.try_wait().expect("a child")
        })
    }
}

impl Drop for Daemon {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Asks again and again until there is an answer; fails when patience ends.
pub fn until<T>(what: &str, mut ask: impl FnMut() -> Option<T>) -> T {
    let start = Instant::now();
    loop {
        if let Some(answer) = ask() {
            return answer;
        }
        assert!(start.elapsed() < PATIENCE, "waited in vain until {what}");
        std::thread::yield_now();
        std::thread::park_timeout(Duration::from_millis(5));
    }
}
