//! The API's description against the daemon, by a fuzzer that reads it (schemathesis): nothing it
//! thinks of is a 5xx, and every answer is one that the description tells.

use std::{process::Command, time::Instant};

use crate::support::daemon::Daemon;

/// What no description can know: which tables are loaded, and that parameters exclude each other.
const NOT_TOLD: &str = "positive_data_acceptance";

/// The folder of hooks that put queries in order, so that answers with points are looked at, too.
const HOOKS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/suite/docs");

#[test]
fn a_fuzzer_finds_no_breach_of_contract() {
    let Ok(python) = std::env::var("STREW_TEST_PYTHON") else {
        eprintln!("skipped: STREW_TEST_PYTHON names no Python with schemathesis");
        return;
    };
    let fuzzer = || {
        let mut command = Command::new(&python);
        command.args(["-m", "schemathesis.cli"]);
        command
    };
    if !fuzzer()
        .arg("--version")
        .output()
        .is_ok_and(|output| output.status.success())
    {
        eprintln!("skipped: schemathesis is not installed");
        return;
    }
    let daemon = Daemon::start(&["limits.max_points=100000"]);
    let folder = tempfile::tempdir().expect("a temporary folder");
    let start = Instant::now();
    for in_order in [false, true] {
        let mut command = fuzzer();
        if in_order {
            command
                .env("SCHEMATHESIS_HOOKS", "api_contract")
                .env("PYTHONPATH", HOOKS)
                .env("PYTHONDONTWRITEBYTECODE", "1");
        }
        let mode = if in_order { "positive" } else { "all" };
        let output = command
            .args(["run", &daemon.url("/openapi.json"), "--no-color"])
            .args(["--checks", "all", "--exclude-checks", NOT_TOLD])
            .args(["--mode", mode, "--max-examples", "25"])
            .args(["--seed", "1", "--generation-deterministic"])
            .args(["--request-timeout", "10"])
            // It keeps notes where it runs.
            .current_dir(folder.path())
            .output()
            .expect("Python runs");
        let report = String::from_utf8_lossy(&output.stdout);
        let errors = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{report}\n{errors}");
    }
    eprintln!("fuzzed for {:?}", start.elapsed());
    assert_eq!(daemon.get("/livez").status, 200);
}
