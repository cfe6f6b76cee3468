//! Starting the daemon as a process of its own.
//!
//! [`Launcher`] starts the program and waits for the line that says where it listens. [`Daemon`] is
//! the running process: it is killed when dropped, and its log is printed if a test panics.

mod output;

use std::{
    ffi::OsStr,
    fmt, io,
    net::SocketAddr,
    path::Path,
    process::{Child, Command, ExitStatus, Stdio},
};

use crate::{
    process::{self, command},
    wait::until,
};
use output::Output;

/// How to start a daemon. By default it listens on a free port of this machine and has the built-in
/// tables and the default settings; its log is kept, see [`Daemon::log`].
pub struct Launcher {
    command: Command,
    listen: String,
    log: Option<Stdio>,
}

impl Launcher {
    /// A launcher of `program`, the path of the built binary.
    pub fn new(program: impl AsRef<OsStr>) -> Self {
        let mut command = command(program);
        command.arg("serve");
        Self {
            command,
            listen: "127.0.0.1:0".into(),
            log: None,
        }
    }

    /// Listens on an address; port 0 takes a free one.
    pub fn listen(mut self, address: impl fmt::Display) -> Self {
        self.listen = address.to_string();
        self
    }

    pub fn tables(mut self, folder: &Path) -> Self {
        self.command.arg("--tables").arg(folder);
        self
    }

    pub fn config(mut self, file: &Path) -> Self {
        self.command.arg("--config").arg(file);
        self
    }

    /// Adds settings, each as `key=value`. The last one of a key wins.
    pub fn settings(mut self, settings: &[&str]) -> Self {
        for setting in settings {
            self.command.args(["--set", setting]);
        }
        self
    }

    /// Sends the log elsewhere instead of keeping it.
    pub fn log_to(mut self, log: impl Into<Stdio>) -> Self {
        self.log = Some(log.into());
        self
    }

    /// Starts the daemon and waits until it listens.
    ///
    /// [`NotReady`] if its first line does not say where it listens.
    pub fn start(mut self) -> Result<Daemon, NotReady> {
        let mut child = self
            .command
            .args(["--listen", &self.listen])
            .stdout(Stdio::piped())
            .stderr(self.log.unwrap_or_else(Stdio::piped))
            .spawn()
            .expect("the program runs");
        let output = Output::of(child.stdout.take().expect("piped"));
        let log = child.stderr.take().map(Output::of);
        let process = Process { child, log };
        let line = output.next("");
        let Some(address) = line.as_deref().and_then(address_in) else {
            return Err(process.not_ready(line, output.is_closed()));
        };
        Ok(Daemon {
            process,
            output,
            address,
        })
    }
}

/// The address in the line `listening on http://ADDRESS`.
fn address_in(line: &str) -> Option<SocketAddr> {
    let (scheme, address) = line.strip_prefix("listening on ")?.split_once("://")?;
    ["http", "https"].contains(&scheme).then_some(())?;
    address.parse().ok()
}

/// Why a daemon does not listen: what it printed first, how it ended, and its log.
pub struct NotReady {
    line: Option<String>,
    status: io::Result<ExitStatus>,
    log: String,
}

impl fmt::Display for NotReady {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { line, status, log } = self;
        let status = { status.as_ref() }.map_or_else(ToString::to_string, ToString::to_string);
        write!(f, "the daemon is not ready: {status}")?;
        if let Some(line) = line {
            write!(f, "; it printed `{line}`")?;
        }
        write!(f, "\n{log}")
    }
}

impl fmt::Debug for NotReady {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

/// A child that does not outlive this value.
struct Process {
    child: Child,
    log: Option<Output>,
}

impl Process {
    fn not_ready(mut self, line: Option<String>, has_ended: bool) -> NotReady {
        // One that printed nothing closed its output, and ends by itself.
        if line.is_some() || !has_ended {
            let _ = self.child.kill();
        }
        NotReady {
            line,
            status: self.child.wait(),
            log: self.closed_log(),
        }
    }

    fn closed_log(&mut self) -> String {
        self.log.as_mut().map_or_else(String::new, |log| {
            log.close();
            log.text()
        })
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
        if std::thread::panicking() {
            let log = self.closed_log();
            if !log.is_empty() {
                eprintln!("the log of daemon {}:\n{log}", self.child.id());
            }
        }
    }
}

/// A running daemon. Dropping it kills it (`SIGKILL`).
pub struct Daemon {
    process: Process,
    output: Output,
    address: SocketAddr,
}

impl Daemon {
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    pub fn url(&self, path: &str) -> String {
        format!("http://{}{path}", self.address)
    }

    pub fn line(&self) -> String {
        self.output.next("").expect("a line on standard output")
    }

    /// Waits for the next line of its log that contains `part`, passing over others.
    pub fn log_line(&self, part: &str) -> String {
        let log = self.process.log.as_ref().expect("the log is kept");
        let line = log.next(part);
        line.unwrap_or_else(|| panic!("no line with `{part}` in the log:\n{}", log.text()))
    }

    /// The log so far.
    pub fn log(&self) -> String {
        let log = self.process.log.as_ref();
        log.expect("the log is kept").text()
    }

    pub fn pid(&self) -> u32 {
        self.process.child.id()
    }

    /// Sends a signal, such as `HUP`.
    pub fn signal(&self, name: &str) {
        process::signal(self.pid(), name);
    }

    /// Sends `SIGTERM`.
    pub fn terminate(&self) {
        self.signal("TERM");
    }

    pub fn wait(&mut self) -> ExitStatus {
        until("the daemon ends", || self.ended())
    }

    pub fn ended(&mut self) -> Option<ExitStatus> {
        self.process.child.try_wait().expect("a child")
    }

    /// A figure of `/proc/PID/status` in KiB, such as `VmRSS`; `None` where there is no `/proc`.
    pub fn memory_kib(&self, figure: &str) -> Option<u64> {
        let status = std::fs::read_to_string(format!("/proc/{}/status", self.pid())).ok()?;
        let mut lines = status.lines();
        let value = lines.find_map(|line| line.strip_prefix(figure)?.strip_prefix(':'))?;
        value.trim().strip_suffix(" kB")?.parse().ok()
    }

    /// The processor time used so far, in clock ticks (usually hundredths of a second).
    pub fn cpu_ticks(&self) -> u64 {
        let stat = std::fs::read_to_string(format!("/proc/{}/stat", self.pid()));
        ticks(&stat.expect("Linux")).1
    }

    /// The processor time used so far by the threads whose names begin with `name`, in clock ticks.
    pub fn cpu_ticks_of_threads(&self, name: &str) -> u64 {
        let named = |stat: &String| ticks(stat).0.starts_with(name);
        let of_them = self.threads().filter(named);
        of_them.map(|stat| ticks(&stat).1).sum()
    }

    /// Whether a thread runs, or waits for a processor.
    pub fn is_at_work(&self) -> bool {
        // The state follows the name, which is in parentheses.
        let runs = |stat: String| {
            stat.rsplit_once(") ")
                .is_some_and(|(_, at)| at.starts_with('R'))
        };
        self.threads().any(runs)
    }

    /// The `stat` of each thread. One may have ended meanwhile.
    fn threads(&self) -> impl Iterator<Item = String> {
        let threads = std::fs::read_dir(format!("/proc/{}/task", self.pid())).expect("Linux");
        threads.filter_map(|thread| std::fs::read_to_string(thread.ok()?.path().join("stat")).ok())
    }

    pub fn open_files(&self) -> usize {
        let folder = format!("/proc/{}/fd", self.pid());
        std::fs::read_dir(folder).expect("Linux").count()
    }
}

/// The name of a process or thread and the processor time that it has used, of a `stat` of `/proc`.
fn ticks(stat: &str) -> (&str, u64) {
    // The name, in parentheses, may contain spaces.
    let (start, fields) = stat.rsplit_once(')').expect("a name");
    let (_, name) = start.split_once('(').expect("a name");
    let user_and_system = fields.split_whitespace().skip(11).take(2);
    let ticks = user_and_system.map(|ticks| ticks.parse::<u64>().expect("a number"));
    (name, ticks.sum())
}

#[cfg(all(test, unix))]
mod tests {
    use std::{
        os::unix::fs::PermissionsExt as _,
        sync::{Mutex, PoisonError},
    };

    use super::*;

    /// One test at a time: a program cannot be run while a child of another test, forked just now,
    /// still has its file open for writing.
    static ALONE: Mutex<()> = Mutex::new(());

    fn program(folder: &Path, script: &str) -> std::path::PathBuf {
        let path = folder.join("program");
        std::fs::write(&path, format!("#!/bin/sh\n{script}\n")).expect("writable");
        let executable = std::fs::Permissions::from_mode(0o755);
        std::fs::set_permissions(&path, executable).expect("a mode");
        path
    }

    #[test]
    fn a_daemon_is_ready_once_it_says_where_it_listens() {
        let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
        let folder = tempfile::tempdir().expect("a folder");
        let script = "echo first >&2; echo listening on https://127.0.0.1:81; echo \"$*\"; \
                      echo last >&2; exec sleep 600";
        let mut daemon = Launcher::new(program(folder.path(), script))
            .settings(&["a=1", "b=2"])
            .start()
            .expect("ready");
        assert_eq!(daemon.address().to_string(), "127.0.0.1:81");
        assert_eq!(
            daemon.line(),
            "serve --set a=1 --set b=2 --listen 127.0.0.1:0"
        );
        assert_eq!(daemon.log_line("a"), "last");
        assert_eq!(daemon.log(), "first\nlast\n");
        assert!(daemon.ended().is_none());
        daemon.terminate();
        assert!(!daemon.wait().success());
    }

    #[test]
    fn a_daemon_that_does_not_start_shows_its_status_and_its_log() {
        let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
        let folder = tempfile::tempdir().expect("a folder");
        let not_ready = |script: &str| {
            let started = Launcher::new(program(folder.path(), script)).start();
            started.err().expect("not ready").to_string()
        };
        let text = not_ready("echo the port is taken >&2; exit 3");
        assert!(text.contains("exit status: 3"), "{text}");
        assert!(text.contains("the port is taken"), "{text}");
        let text = not_ready("echo nonsense; exec sleep 600");
        assert!(text.contains("`nonsense`"), "{text}");
    }
}
