//! An engine by its command line, and containers in it.

use std::{
    net::SocketAddr,
    process::{Command, Output},
};

use strew_testkit::{http1, wait::until};

/// The image of the daemon.
pub const IMAGE: &str = "strew:ci";
/// The flags that the daemon's containers run with, everywhere in `deploy/`.
const CONFINED: [&str; 5] = [
    "--read-only",
    "--cap-drop",
    "ALL",
    "--security-opt",
    "no-new-privileges",
];

/// Whether there is an engine with an image. If not, a message says so.
pub fn has(image: &str) -> bool {
    if std::env::var_os("STREW_TEST_DOCKER").is_none() {
        eprintln!("skipped: STREW_TEST_DOCKER names no engine; see .ci/containers");
        return false;
    }
    let known = command(&["image", "inspect", image]).status.success();
    if !known {
        eprintln!("skipped: the engine has no image {image}");
    }
    known
}

/// Runs a command of the engine to its end.
pub fn command(arguments: &[&str]) -> Output {
    let host = std::env::var("STREW_TEST_DOCKER").expect("an engine");
    let output = Command::new("docker")
        .env("DOCKER_HOST", host)
        .args(arguments)
        .output();
    output.expect("docker is installed")
}

/// The output of a command of the engine, which must succeed.
pub fn docker(arguments: &[&str]) -> String {
    let output = command(arguments);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(
        output.status.success(),
        "docker {}: {errors}",
        arguments.join(" ")
    );
    let text = String::from_utf8(output.stdout).expect("UTF-8");
    text.trim_end().to_owned()
}

/// A container. One that the test has started is removed when dropped, and its log is printed if the
/// test panics.
pub struct Container {
    pub id: String,
    /// Whether it belongs to this value.
    is_owned: bool,
}

impl Container {
    /// Starts the daemon, confined, with flags of `docker run`, and settings as variables.
    pub fn daemon(flags: &[&str], settings: &[&str]) -> Self {
        let mut all = CONFINED.to_vec();
        all.extend(flags);
        for setting in settings {
            all.extend(["-e", setting]);
        }
        Self::run(&[&all[..], &[IMAGE]].concat())
    }

    /// Starts a container; the last flags are the image and its command.
    pub fn run(flags: &[&str]) -> Self {
        Self {
            id: docker(&[&["run", "-d"], flags].concat()),
            is_owned: true,
        }
    }

    /// A container that others have started and remove.
    pub fn existing(id: &str) -> Self {
        Self {
            id: id.into(),
            is_owned: false,
        }
    }

    /// A value of what the engine knows about it, as a Go template.
    pub fn inspect(&self, template: &str) -> String {
        docker(&["inspect", "-f", template, &self.id])
    }

    /// Waits until its health check succeeds.
    pub fn until_healthy(&self) {
        until("a container is healthy", || {
            let state = self.inspect("{{.State.Status}} {{.State.Health.Status}}");
            assert!(state.starts_with("running"), "{state}");
            state.ends_with(" healthy")
        });
    }

    /// The daemon's address in the engine's network.
    pub fn address(&self) -> SocketAddr {
        let ip = self.inspect("{{range .NetworkSettings.Networks}}{{.IPAddress}}{{end}}");
        format!("{ip}:8080").parse().expect("an address")
    }

    /// A whole answer.
    pub fn get(&self, path: &str) -> http1::Answer {
        http1::get(self.address(), path, &[])
    }

    /// The process id, for signals that the engine does not take for its user's.
    pub fn pid(&self) -> u32 {
        self.inspect("{{.State.Pid}}").parse().expect("a number")
    }

    /// A line of `/proc/PID/status`, such as `VmRSS`, without its name.
    pub fn status(&self, name: &str) -> String {
        let path = format!("/proc/{}/status", self.pid());
        let text = std::fs::read_to_string(path).expect("running");
        let mut lines = text.lines();
        let line = lines.find_map(|line| line.strip_prefix(name)?.strip_prefix(':'));
        line.expect("a line").trim().to_owned()
    }

    /// The memory that it uses, of what it may use, as the engine shows it: without pages that the kernel can take back.
    pub fn memory(&self) -> String {
        docker(&[
            "stats",
            "--no-stream",
            "--format",
            "{{.MemUsage}}",
            &self.id,
        ])
    }

    /// Standard output and standard error so far.
    pub fn logs(&self) -> (String, String) {
        let output = command(&["logs", &self.id]);
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("UTF-8");
        (text(output.stdout), text(output.stderr))
    }

    /// Waits until it has ended, and returns the exit code.
    pub fn exit_code(&self) -> String {
        docker(&["wait", &self.id])
    }
}

impl Drop for Container {
    fn drop(&mut self) {
        if !self.is_owned {
            return;
        }
        if std::thread::panicking() {
            let (out, errors) = self.logs();
            eprintln!("the log of container {}:\n{out}{errors}", self.id);
        }
        command(&["rm", "-f", "-v", &self.id]);
    }
}
