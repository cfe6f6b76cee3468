//! Tables forged on demand: made once, judged, kept, served; cancelled, refused, interrupted and continued.

use std::{
    path::Path,
    time::{Duration, Instant},
};

use serde_json::{Value, json};
use strew::grpc::proto::{ForgeTableRequest, JobState, point_service_client::PointServiceClient};
use strew_testkit::{
    daemon::{Daemon, Launcher},
    http1,
    wait::until,
};
use tonic::{Code, transport::Endpoint};

use crate::support::{
    daemon::{PROGRAM, no_tables},
    keys::{entry, keys},
    problem::assert_fault,
};

/// A table that is made and judged in some ten seconds of one core.
const QUICK: &str = r#"{"profile": "blue", "alpha": "(5-sqrt(3))/2", "map": "r40"}"#;
/// The query for it.
const USED: &str = "/v1/points?bbox=0,0,9,9&spacing=1&profile=blue&map=r40&format=csv";
/// A table that takes long enough to be interrupted.
const LONG: &str = r#"{"profile": "spaced", "alpha": "sqrt(2)", "map": "m"}"#;
/// How long a job may take on a busy machine.
const PATIENCE: Duration = Duration::from_secs(600);

fn start(folder: &Path, settings: &[&str]) -> Daemon {
    let launcher = Launcher::new(PROGRAM)
        .tables(folder)
        .settings(&["forge.allow=anyone", "log.filter=info,strew_access=warn"]);
    launcher.settings(settings).start().expect("ready")
}

fn get(daemon: &Daemon, path: &str) -> http1::Answer {
    http1::get(daemon.address(), path, &[])
}

fn post(daemon: &Daemon, body: &str) -> http1::Answer {
    http1::post(daemon.address(), "/v1/tables", &[], body.as_bytes())
}

fn delete(daemon: &Daemon, path: &str) -> http1::Answer {
    http1::request(daemon.address(), "DELETE", path, &[])
}

/// The job of an answer to a request that is taken.
fn accepted(answer: &http1::Answer) -> String {
    assert_eq!(answer.status, 202, "{}", answer.text());
    let path = answer.header("location").to_owned();
    assert_eq!(
        path,
        format!("/v1/jobs/{}", answer.json()["id"].as_str().expect("an id"))
    );
    path
}

/// Waits until a job is as wanted.
fn until_job(daemon: &Daemon, path: &str, wanted: impl Fn(&Value) -> bool) -> Value {
    let start = Instant::now();
    loop {
        let job = get(daemon, path).json();
        if wanted(&job) {
            return job;
        }
        let is_over = !["queued", "running"].contains(&job["state"].as_str().expect("a text"));
        assert!(!is_over && start.elapsed() < PATIENCE, "{job}");
        std::thread::park_timeout(Duration::from_millis(20));
    }
}

fn sample(daemon: &Daemon, name: &str) -> f64 {
    let text = get(daemon, "/metrics").text().to_owned();
    let line = text
        .lines()
        .find_map(|line| line.strip_prefix(name)?.strip_prefix(' '));
    line.unwrap_or_else(|| panic!("{name}: {text}"))
        .parse()
        .expect("a number")
}

#[test]
fn a_table_is_made_once_judged_kept_and_served() {
    let folder = no_tables();
    let daemon = start(folder.path(), &[]);
    let missing = get(&daemon, USED);
    assert_fault(
        &missing,
        USED,
        "map",
        &["r40", "POST /v1/tables", "ForgeTable"],
    );
    let path = accepted(&post(&daemon, QUICK));
    // The same table requested in other words follows the same job.
    let again = r#"{"alpha": "(10-sqrt(12))/4", "map": "r40"}"#;
    assert_eq!(accepted(&post(&daemon, again)), path);
    let jobs = get(&daemon, "/v1/jobs").json()["jobs"]
        .as_array()
        .expect("a list")
        .len();
    assert_eq!(jobs, 1);
    let job = until_job(&daemon, &path, |job| job["stage"] == "optimizing");
    assert_eq!(
        (&job["state"], &job["blocks"]),
        (&json!("running"), &json!(2601)),
        "{job}"
    );
    assert_eq!(sample(&daemon, "strew_forge_jobs{state=\"running\"}"), 1.0);
    // Its events, to the end.
    let accept = [("accept", "text/event-stream")];
    let events = http1::get(daemon.address(), &path, &accept);
    assert_eq!(events.header("content-type"), "text/event-stream");
    let states: Vec<Value> = events
        .text()
        .lines()
        .filter_map(|line| line.strip_prefix("data: "))
        .map(|data| serde_json::from_str(data).expect("JSON"))
        .collect();
    let with = |name: &str| states.iter().any(|job| !job[name].is_null());
    assert!(with("energy") && with("seconds_left"), "{states:?}");
    let last = states.last().expect("some");
    assert_eq!(last["state"], "finished", "{last}");
    assert_eq!(
        sample(
            &daemon,
            "strew_forge_jobs_ended_total{outcome=\"finished\"}"
        ),
        1.0
    );
    // Used at once, and after a restart.
    let served = |daemon: &Daemon| {
        let answer = get(daemon, USED);
        assert_eq!(answer.status, 200, "{}", answer.text());
        assert_eq!(last["digest"], answer.header("strew-table"));
    };
    served(&daemon);
    let there = post(&daemon, QUICK);
    assert_eq!(
        (there.status, &there.json()["digest"]),
        (200, &last["digest"])
    );
    let file = folder.path().join("blue-5-sqrt3-over-2-r40.strew");
    let table = strew_forge::read_table(&file).expect("a table");
    assert!(
        table
            .provenance()
            .figures
            .iter()
            .any(|figures| !figures.seen)
    );
    drop(daemon);
    let daemon = start(folder.path(), &["forge.allow=off"]);
    served(&daemon);
}

#[tokio::test(flavor = "multi_thread")]
async fn a_job_that_is_killed_goes_on_and_is_followed_by_grpc() {
    let folder = no_tables();
    let every_step = ["forge.checkpoint_seconds=0"];
    let mut daemon = start(folder.path(), &every_step);
    let path = accepted(&post(&daemon, QUICK));
    until_job(&daemon, &path, |job| job["step"].as_u64() > Some(40));
    daemon.signal("KILL");
    daemon.wait();
    let checkpoint = path.replace("/v1/jobs/", "forge/") + ".checkpoint";
    assert!(folder.path().join(&checkpoint).exists());

    let daemon = start(folder.path(), &every_step);
    let line = daemon.log_line("forging resumes");
    let step = line.split("step=").nth(1).expect("a step");
    let step: u32 = step
        .split_whitespace()
        .next()
        .expect("one")
        .parse()
        .expect("a number");
    assert!(step >= 40, "{line}");
    let channel = Endpoint::from_shared(daemon.url("")).expect("an address");
    let mut client = PointServiceClient::new(channel.connect().await.expect("connected"));
    let request = || ForgeTableRequest {
        map: Some("r40".into()),
        ..ForgeTableRequest::default()
    };
    // A call that is cancelled leaves the job.
    let mut left = client
        .forge_table(request())
        .await
        .expect("followed")
        .into_inner();
    assert!(left.message().await.expect("a message").is_some());
    drop(left);
    let mut states = client
        .forge_table(request())
        .await
        .expect("followed")
        .into_inner();
    let mut last = None;
    while let Some(state) = states.message().await.expect("a message") {
        let job = state.job.expect("a job");
        assert_eq!(format!("/v1/jobs/{}", job.id), path);
        last = Some(job);
    }
    let last = last.expect("some");
    assert_eq!(last.state(), JobState::Finished, "{last:?}");
    let used = tokio::task::spawn_blocking(move || get(&daemon, USED))
        .await
        .expect("no panic");
    assert_eq!(used.header("strew-table"), last.digest);
    // The daemon was killed at once, but what it tells is on the disk.
    let files = std::fs::read_dir(folder.path().join("forge")).expect("a folder");
    assert_eq!(files.count(), 1, "the checkpoint is gone");
    let daemon = start(folder.path(), &[]);
    assert_eq!(get(&daemon, &path).json()["digest"], last.digest);
}

#[test]
fn a_stop_keeps_a_checkpoint_and_a_cancel_keeps_nothing() {
    let folder = no_tables();
    // No checkpoint but at the stop.
    let mut daemon = start(folder.path(), &["forge.checkpoint_seconds=86400"]);
    let path = accepted(&post(&daemon, LONG));
    let job = until_job(&daemon, &path, |job| job["step"].as_u64() > Some(2));
    let id = job["id"].as_str().expect("a text").to_owned();
    daemon.terminate();
    assert!(daemon.wait().success());
    let checkpoint = folder.path().join(format!("forge/{id}.checkpoint"));
    assert!(checkpoint.exists());

    let daemon = start(folder.path(), &[]);
    until_job(&daemon, &path, |job| job["step"].as_u64() > Some(3));
    let answer = delete(&daemon, &path);
    assert_eq!(answer.status, 200, "{}", answer.text());
    until_job(&daemon, &path, |job| job["state"] == "cancelled");
    assert!(!checkpoint.exists());
    assert_eq!(
        sample(
            &daemon,
            "strew_forge_jobs_ended_total{outcome=\"cancelled\"}"
        ),
        1.0
    );
    // One that waits ends at once; the one before it is not touched.
    let path = accepted(&post(&daemon, LONG));
    let waiting = accepted(&post(
        &daemon,
        r#"{"profile": "spaced", "alpha": "sqrt(3)", "map": "m"}"#,
    ));
    assert_eq!(get(&daemon, &waiting).json()["state"], "queued");
    assert_eq!(delete(&daemon, &waiting).json()["state"], "cancelled");
    until_job(&daemon, &path, |job| job["state"] == "running");
    delete(&daemon, &path);
    until_job(&daemon, &path, |job| job["state"] == "cancelled");
    let none = delete(&daemon, "/v1/jobs/0000000000000000");
    assert_eq!(none.json()["type"], "urn:strew:problem:no-such-job");
}

#[test]
fn what_the_judge_rejects_is_not_kept_and_said_with_figures() {
    let folder = no_tables();
    let daemon = start(folder.path(), &[]);
    let request = r#"{"alpha": "sqrt(2)", "map": "r5"}"#;
    let answer = post(&daemon, request);
    let path = accepted(&answer);
    let warning = answer.json()["warning"].to_string();
    assert!(warning.contains("few blocks"), "{warning}");
    let job = until_job(&daemon, &path, |job| job["state"] == "rejected");
    let complaints = job["complaints"].to_string();
    assert!(
        complaints.contains("low_power") && complaints.contains("at most"),
        "{job}"
    );
    let files = std::fs::read_dir(folder.path()).expect("a folder");
    assert_eq!(files.count(), 1, "only the folder of jobs");
    // The verdict stands, also after a restart.
    drop(daemon);
    let daemon = start(folder.path(), &[]);
    let again = post(&daemon, request);
    assert_eq!(
        (again.status, &again.json()["state"]),
        (200, &json!("rejected"))
    );
    assert_eq!(again.json()["complaints"], job["complaints"]);
}

#[test]
fn what_cannot_be_made_is_refused_before_the_work() {
    let folder = no_tables();
    let daemon = start(folder.path(), &[]);
    for (body, field, texts) in [
        (
            r#"{"alpha": "3/2"}"#,
            "alpha",
            ["repeats every 4", "no fraction"],
        ),
        (r#"{"alpha": "1.05"}"#, "alpha", ["below 1.1", "1 block"]),
        (
            r#"{"alpha": "1"}"#,
            "alpha",
            ["out of range", "between 1.1 and 2"],
        ),
        (r#"{"alpha": "x"}"#, "alpha", ["`x`", "between 1.1 and 2"]),
        (r#"{"map": "l"}"#, "map", ["R = 200", "1 to 100"]),
        (r#"{"map": "r0"}"#, "map", ["R = 0", "1 to 100"]),
        (r#"{"map": "big"}"#, "map", ["big", "R from 1"]),
        (
            r#"{"profile": "mauve", "map": "r40"}"#,
            "profile",
            ["mauve", "blue"],
        ),
        (
            r#"{"profile": "pattern", "alpha": "1.7"}"#,
            "profile",
            ["needs no table", "pattern"],
        ),
        (
            r#"{"profile": "mine", "target": "x"}"#,
            "target",
            ["x", "frequency"],
        ),
        (
            r#"{"profile": "blue", "alpha": "1.7123", "target": "0 0\n1 1"}"#,
            "profile",
            ["blue", "name"],
        ),
        (r#"{"alfa": "1.5"}"#, "body", ["alfa", "profile"]),
        ("[", "body", ["EOF", "JSON"]),
    ] {
        assert_fault(&post(&daemon, body), body, field, &texts);
    }
    assert_eq!(get(&daemon, "/v1/jobs").json()["jobs"], json!([]));
}

#[test]
fn only_those_who_may_have_tables_made_and_only_so_many() {
    let [admin, plain, small] = ["a", "b", "c"].map(|name| name.repeat(43));
    let entries = [
        entry("admin", &admin, "admin = true"),
        entry("plain", &plain, ""),
        entry("small", &small, "max_jobs = 1"),
    ]
    .concat();
    let send = |daemon: &Daemon, key: &str, method: &str, path: &str, body: &str| {
        let headers = [("x-api-key", key)];
        match method {
            "POST" => http1::post(daemon.address(), path, &headers, body.as_bytes()),
            _ => http1::request(daemon.address(), method, path, &headers),
        }
    };
    let folder = no_tables();
    let daemon = start(folder.path(), &[&keys(&entries), "forge.allow=off"]);
    for (method, path) in [("POST", "/v1/tables"), ("GET", "/v1/jobs/x")] {
        let answer = send(&daemon, &admin, method, path, LONG);
        assert_eq!(answer.status, 403, "{path}: {}", answer.text());
        assert!(answer.text().contains("forge.allow"), "{}", answer.text());
    }
    drop(daemon);
    let daemon = start(folder.path(), &[&keys(&entries), "forge.allow=admin"]);
    let answer = send(&daemon, &plain, "POST", "/v1/tables", LONG);
    assert_eq!(answer.json()["type"], "urn:strew:problem:not-allowed");
    assert!(answer.text().contains("admin = true"), "{}", answer.text());
    let path = accepted(&send(&daemon, &admin, "POST", "/v1/tables", LONG));
    assert_eq!(send(&daemon, &admin, "DELETE", &path, "").status, 200);
    until("it is cancelled", || {
        let job = send(&daemon, &admin, "GET", &path, "").json();
        (job["state"] == "cancelled").then_some(())
    });
    drop(daemon);

    let limits = ["forge.max_jobs_per_client=2", "forge.max_queued=2"];
    let daemon = start(
        folder.path(),
        &[&[keys(&entries).as_str()], &limits[..]].concat(),
    );
    let of = |alpha: &str| format!(r#"{{"profile": "spaced", "alpha": "{alpha}", "map": "m"}}"#);
    let first = accepted(&send(&daemon, &small, "POST", "/v1/tables", &of("1.41421")));
    let over = send(&daemon, &small, "POST", "/v1/tables", &of("1.51421"));
    assert_eq!(over.status, 429, "{}", over.text());
    assert_eq!(over.json()["type"], "urn:strew:problem:too-many-jobs");
    assert_eq!(over.json()["limit"], 1);
    // A repeated request for a table starts no second job, and clients cannot cancel jobs of others.
    assert_eq!(
        accepted(&send(&daemon, &plain, "POST", "/v1/tables", &of("1.41421"))),
        first
    );
    assert_eq!(send(&daemon, &plain, "DELETE", &first, "").status, 403);
    let second = accepted(&send(&daemon, &plain, "POST", "/v1/tables", &of("1.51421")));
    accepted(&send(&daemon, &plain, "POST", "/v1/tables", &of("1.61421")));
    let full = send(&daemon, &admin, "POST", "/v1/tables", &of("1.71421"));
    assert_eq!(
        (full.status, full.header("retry-after")),
        (503, "1"),
        "{}",
        full.text()
    );
    assert_eq!(send(&daemon, &admin, "DELETE", &second, "").status, 200);
    accepted(&send(&daemon, &admin, "POST", "/v1/tables", &of("1.71421")));
    let jobs = send(&daemon, &admin, "GET", "/v1/jobs", "").json();
    let jobs = jobs["jobs"].as_array().expect("a list").iter();
    assert_eq!(jobs.filter(|job| job["state"] == "queued").count(), 2);
}

#[tokio::test]
async fn grpc_refuses_with_the_same_words() {
    let folder = no_tables();
    let daemon = start(folder.path(), &[]);
    let channel = Endpoint::from_shared(daemon.url("")).expect("an address");
    let mut client = PointServiceClient::new(channel.connect().await.expect("connected"));
    let request = ForgeTableRequest {
        alpha: Some("3/2".into()),
        ..ForgeTableRequest::default()
    };
    let status = client.forge_table(request).await.expect_err("refused");
    assert_eq!(status.code(), Code::InvalidArgument);
    assert!(status.message().contains("repeats every 4"), "{status:?}");
    let off = start(folder.path(), &["forge.allow=off"]);
    let channel = Endpoint::from_shared(off.url("")).expect("an address");
    let mut client = PointServiceClient::new(channel.connect().await.expect("connected"));
    let refused = client.forge_table(ForgeTableRequest::default()).await;
    assert_eq!(refused.expect_err("refused").code(), Code::PermissionDenied);
}

#[test]
fn a_forge_without_a_folder_is_a_fault_of_the_settings() {
    let launcher = Launcher::new(PROGRAM)
        .settings(&["forge.allow=anyone", "log.filter=info,strew_access=warn"]);
    let refused = launcher.start().err().expect("refused").to_string();
    assert!(
        refused.contains("forge.allow needs tables.folder"),
        "{refused}"
    );
}
