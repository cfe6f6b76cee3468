//! A browser that runs, with the driver that tests speak to. It outlives a test, so that the next one need not start
//! another.

use std::{
    net::SocketAddr,
    path::Path,
    process::{Child, Command, Stdio},
};

use serde_json::{Value, json};
use strew_testkit::http1;

use super::engine::Engine;

/// A browser that runs; closed when dropped.
pub struct Session {
    pub engine: Engine,
    driver: Child,
    address: SocketAddr,
    pub id: String,
    /// The process of the browser, which does not end with its driver.
    process: Option<u64>,
    pub folder: tempfile::TempDir,
    /// A shell that ends and removes all of it once this process has ended, which drops nothing that is static.
    guard: Option<Child>,
}

impl Session {
    /// Starts a browser, `program`, by its driver.
    pub fn start(engine: Engine, driver: &Path, program: &Path) -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        std::fs::create_dir_all(folder.path().join("downloads")).expect("a folder");
        let (driver, port) = engine.driver(driver, &folder.path().join("log"));
        let mut session = Self {
            engine,
            driver,
            address: ([127, 0, 0, 1], port).into(),
            id: String::new(),
            process: None,
            folder,
            guard: None,
        };
        let capabilities = engine.capabilities(program, session.folder.path());
        let wanted = json!({ "capabilities": { "alwaysMatch": capabilities } });
        let answer = session.send("POST", "/session", &wanted);
        session.id = answer["sessionId"].as_str().expect("a session").into();
        let process = |name: &str| answer["capabilities"][name].as_u64();
        session.process = process("moz:processID").or_else(|| process("goog:processID"));
        session.guard();
        session
    }

    /// Sends a request to the driver, and returns its value.
    pub fn send(&self, method: &str, path: &str, body: &Value) -> Value {
        let answer = self.ask(method, path, body);
        answer.unwrap_or_else(|error| panic!("{method} {path} {body}: {error}"))
    }

    /// Sends a request to the driver, and returns its value or its error.
    pub fn ask(&self, method: &str, path: &str, body: &Value) -> Result<Value, Value> {
        let response = match method {
            "POST" => http1::open_post(self.address, path, &[], body.to_string().as_bytes()),
            _ => http1::open(self.address, method, path, &[]),
        };
        let status = response.status;
        let bytes = response.body().expect("a whole answer");
        let mut answer: Value = serde_json::from_slice(&bytes).expect("JSON");
        let value = answer["value"].take();
        if status == 200 { Ok(value) } else { Err(value) }
    }

    fn guard(&mut self) {
        let processes = [Some(u64::from(self.driver.id())), self.process];
        let processes = processes.into_iter().flatten().map(|id| id.to_string());
        let mut shell = Command::new("sh");
        shell.args([
            "-c",
            "cat; folder=$1; shift; kill $*; sleep 1; rm -rf $folder",
            "sh",
        ]);
        shell.arg(self.folder.path()).args(processes);
        let shell = shell.stdin(Stdio::piped()).stderr(Stdio::null()).spawn();
        self.guard = Some(shell.expect("a shell"));
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        if let Some(process) = self.process {
            let _ = Command::new("kill").arg(process.to_string()).status();
        }
        let _ = self.driver.kill();
        let _ = self.driver.wait();
        // It finds nothing left to end.
        if let Some(mut guard) = self.guard.take() {
            drop(guard.stdin.take());
            let _ = guard.wait();
        }
    }
}
