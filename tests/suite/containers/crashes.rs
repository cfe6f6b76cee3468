//! A daemon that is killed, by a signal or by the kernel for want of memory, keeps what it has promised: tables that
//! were made, and jobs that were accepted.

use std::{
    fs::{self, Permissions},
    os::unix::fs::PermissionsExt as _,
    time::Instant,
};

use serde_json::Value;
use strew_testkit::{http1, process, wait::PATIENCE};

use super::docker::{self, Container, IMAGE, docker};

/// A table that is made and judged in some ten seconds of one core.
const QUICK: &str = r#"{"profile": "blue", "alpha": "(5-sqrt(3))/2", "map": "r40"}"#;
const USED: &str = "/v1/points?bbox=0,0,9,9&spacing=1&profile=blue&map=r40&format=csv";
/// A table whose making takes some 100 MB, and a while.
const LARGE: &str = r#"{"profile": "spaced", "alpha": "sqrt(2)", "map": "m"}"#;

fn begin(container: &Container, table: &str) -> String {
    let answer = http1::post(container.address(), "/v1/tables", &[], table.as_bytes());
    assert_eq!(answer.status, 202, "{}", answer.text());
    answer.header("location").to_owned()
}

/// Waits for a state of a job, longer than tests wait otherwise: tables take their time.
fn until_job(container: &Container, job: &str, is_wanted: impl Fn(&Value) -> bool) {
    let start = Instant::now();
    loop {
        let state = container.get(job).json();
        if is_wanted(&state) {
            return;
        }
        let is_over = !["queued", "running"].contains(&state["state"].as_str().unwrap_or_default());
        assert!(!is_over && start.elapsed() < 4 * PATIENCE, "{state}");
        std::thread::park_timeout(std::time::Duration::from_millis(50));
    }
}

#[test]
fn tables_and_jobs_outlive_a_kill_and_a_lack_of_memory() {
    if !docker::has(IMAGE) {
        return;
    }
    let tables = tempfile::tempdir().expect("a folder");
    fs::set_permissions(tables.path(), Permissions::from_mode(0o777)).expect("ours");
    let volume = format!("{}:/tables", tables.path().display());
    let flags = ["-v", &volume, "-m", "1g", "--memory-swap", "1g"];
    let settings = [
        "STREW_TABLES_FOLDER=/tables",
        "STREW_FORGE_ALLOW=anyone",
        "STREW_FORGE_CHECKPOINT_SECONDS=1",
        // Without this, the limits would leave room for the job.
        "STREW_LIMITS_MEMORY_BYTES=100000000000",
    ];
    let container = Container::daemon(&flags, &settings);
    container.until_healthy();
    let quick = begin(&container, QUICK);
    until_job(&container, &quick, |job| job["state"] == "finished");
    let before = container.get(USED);
    assert_eq!(before.status, 200, "{}", before.text());

    let large = begin(&container, LARGE);
    until_job(&container, &large, |job| job["stage"] == "optimizing");
    process::signal(container.pid(), "KILL");
    assert_eq!(container.exit_code(), "137");
    docker(&["start", &container.id]);
    container.until_healthy();
    assert_eq!(container.get(USED).body, before.body);
    until_job(&container, &large, |job| job["state"] == "running");

    // The kernel ends it: there is less memory than the job takes.
    docker(&["stop", &container.id]);
    let little = ["update", "-m", "64m", "--memory-swap", "64m", &container.id];
    docker(&little);
    docker(&["start", &container.id]);
    assert_eq!(container.exit_code(), "137");
    assert_eq!(container.inspect("{{.State.OOMKilled}}"), "true");
    let much = ["update", "-m", "1g", "--memory-swap", "1g", &container.id];
    docker(&much);
    docker(&["start", &container.id]);
    container.until_healthy();
    assert_eq!(container.get(USED).body, before.body);
    until_job(&container, &large, |job| job["state"] == "running");
    let deleted = http1::request(container.address(), "DELETE", &large, &[]);
    assert!(deleted.status < 300, "{}", deleted.text());
}
