//! The image: confined, in little and much memory, healthy soon, with a log that programs read, stopped in good order.

use std::{fs, io::Read as _, time::Instant};

use serde_json::Value;
use strew_testkit::http1;

use super::docker::{self, Container, IMAGE, docker};

const POINTS: &str = "/v1/points?bbox=0,0,10,10&spacing=1&format=csv";
/// Some 40 MB, more than sockets hold.
const LONG: &str = "/v1/points?bbox=0,0,2200,2200&spacing=1&format=f32";

#[test]
fn it_runs_confined_and_answers_on_a_published_port() {
    if !docker::has(IMAGE) {
        return;
    }
    let container = Container::daemon(&["-m", "256m", "-p", "127.0.0.1::8080"], &[]);
    container.until_healthy();
    // All four ids: real, effective, saved, of the file system.
    assert_eq!(container.status("Uid"), ["65532"; 4].join("\t"));
    assert_eq!(container.status("Gid"), ["65532"; 4].join("\t"));
    for sets in ["CapInh", "CapPrm", "CapEff", "CapBnd", "CapAmb"] {
        assert_eq!(container.status(sets), "0000000000000000", "{sets}");
    }
    assert_eq!(container.status("NoNewPrivs"), "1");
    assert_eq!(container.inspect("{{.HostConfig.ReadonlyRootfs}}"), "true");
    let direct = container.get(POINTS);
    let count: usize = direct.header("strew-count").parse().expect("a number");
    assert_eq!(direct.text().lines().count(), count + 1);
    let published = docker(&["port", &container.id, "8080"]);
    let answer = http1::get(published.parse().expect("an address"), POINTS, &[]);
    assert_eq!(answer.body, direct.body);
}

#[test]
fn it_is_known_to_be_healthy_a_second_after_it_serves() {
    if !docker::has(IMAGE) {
        return;
    }
    let begun = Instant::now();
    let container = Container::daemon(&[], &[]);
    container.until_healthy();
    let healthy = begun.elapsed();
    // The first check comes after one interval, and none precedes it.
    let health = container.inspect("{{json .Config.Healthcheck}}");
    assert!(health.contains("\"Interval\":1000000000,"), "{health}");
    let checks = container.inspect("{{range .State.Health.Log}}{{.End}} {{.ExitCode}}\n{{end}}");
    let started = container.inspect("{{.State.StartedAt}}");
    println!("healthy {healthy:?} after `docker run`: started {started}, checks\n{checks}");
    println!("idle: {}", container.memory());
}

#[test]
fn limits_fit_the_memory_and_threads_the_processors_of_the_container() {
    if !docker::has(IMAGE) {
        return;
    }
    for mebibytes in [64, 256, 1024_u64] {
        let memory = format!("{mebibytes}m");
        let flags = ["-m", &memory, "--memory-swap", &memory, "--cpus", "1"];
        let container = Container::daemon(&flags, &["STREW_LOG_FORMAT=json"]);
        container.until_healthy();
        let answer = container.get("/v1/points?bbox=0,0,300,300&spacing=1&warp=1&format=csv");
        assert_eq!(answer.status, 200);
        let (_, log) = container.logs();
        let lines: Vec<Value> = log
            .lines()
            .map(|line| serde_json::from_str(line).unwrap_or_else(|e| panic!("{e}: {line}")))
            .collect();
        let line = |start: &str| {
            let is_it = |line: &&Value| {
                let message = line["message"].as_str();
                message.is_some_and(|message| message.starts_with(start))
            };
            lines.iter().find(is_it).unwrap_or_else(|| panic!("{log}"))
        };
        let fitted = line("limits are lowered to fit the memory: limits.max_bytes_in_flight = ");
        assert_eq!(fitted["memory"], mebibytes << 20, "{fitted}");
        let of = fitted["of"].as_str().expect("a text");
        assert!(of.starts_with("the container (cgroup v"), "{of}");
        assert_eq!(line("serving")["threads"], 1);
        assert!(fitted["most"].as_u64() <= Some(mebibytes << 20), "{fitted}");
        println!(
            "{memory}: {fitted}; resident: {}",
            container.status("VmRSS")
        );
        assert_eq!(container.inspect("{{.State.OOMKilled}}"), "false");
    }
}

#[test]
fn its_log_is_json_on_standard_output() {
    if !docker::has(IMAGE) {
        return;
    }
    let settings = ["STREW_LOG_FORMAT=json", "STREW_LOG_OUTPUT=stdout"];
    let container = Container::daemon(&[], &settings);
    container.until_healthy();
    container.get(POINTS);
    docker(&["stop", &container.id]);
    let (log, errors) = container.logs();
    assert_eq!(errors, "");
    let lines: Vec<Value> = log
        .lines()
        .map(|line| serde_json::from_str(line).unwrap_or_else(|e| panic!("{e}: {line}")))
        .collect();
    let has = |message: &str| lines.iter().any(|line| line["message"] == message);
    assert!(has("serving") && has("answered") && has("stopped"), "{log}");
}

#[test]
fn a_stop_drains() {
    if !docker::has(IMAGE) {
        return;
    }
    let container = Container::daemon(&[], &["STREW_SHUTDOWN_DRAIN_SECONDS=60"]);
    container.until_healthy();
    let address = container.address();
    let mut answer = http1::open(address, "GET", LONG, &[]);
    let count: usize = answer.header("strew-count").parse().expect("a number");
    answer.read_exact(&mut [0; 8]).expect("a point");
    std::thread::scope(|scope| {
        let stopped = scope.spawn(|| docker(&["stop", "-t", "90", &container.id]));
        let (rest, is_complete) = answer.finish();
        assert!(is_complete);
        assert_eq!(rest.len() + 8, 8 * count);
        stopped.join().expect("stopped");
    });
    assert_eq!(container.exit_code(), "0");
}

#[test]
fn it_is_small_and_its_digest_is_that_of_its_content() {
    // Only where `.ci/containers` made the image of the static program, twice.
    let Ok(digests) = std::env::var("STREW_TEST_DIGESTS") else {
        eprintln!("skipped: STREW_TEST_DIGESTS names no digests");
        return;
    };
    let digests: Vec<&str> = digests.lines().collect();
    assert_eq!(digests.len(), 2);
    assert_eq!(digests[0], digests[1]);
    assert_eq!(docker(&["inspect", "-f", "{{.Id}}", IMAGE]), digests[0]);
    let size: u64 = docker(&["inspect", "-f", "{{.Size}}", IMAGE])
        .parse()
        .expect("a number");
    println!("{} {size} bytes", digests[0]);
    assert!(size <= 36_000_000, "{size} bytes");
    // Nothing but the program is in it.
    let folder = tempfile::tempdir().expect("a folder");
    let archive = folder.path().join("image.tar");
    docker(&["create", "--name", "strew-files", IMAGE]);
    docker(&[
        "export",
        "-o",
        &archive.display().to_string(),
        "strew-files",
    ]);
    docker(&["rm", "strew-files"]);
    let bytes = fs::read(archive).expect("an archive");
    assert!(bytes.len() as u64 <= size + 100_000, "{}", bytes.len());
}
