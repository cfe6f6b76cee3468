//! `deploy/stack.yaml` in the engine's swarm mode: an update, a rollback and an update that cannot work, under load.

use std::{fs, net::SocketAddr};

use strew_testkit::{http1, wait::until};
use tempfile::TempDir;

use super::{
    docker::{self, IMAGE, command, docker},
    load::Load,
};

const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/deploy/stack.yaml");
const SERVICE: &str = "strew-test_strew";

/// The stack. It and the swarm end when dropped.
struct Stack {
    _folder: TempDir,
}

impl Stack {
    fn deploy() -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let over = folder.path().join("over.yaml");
        let images = format!(
            "version: '3.8'\nservices:\n  strew: {{ image: '{IMAGE}' }}\n  proxy: {{ image: 'haproxy:ci' }}\n"
        );
        fs::write(&over, images).expect("writable");
        docker(&["swarm", "init", "--advertise-addr", "127.0.0.1"]);
        let stack = Self { _folder: folder };
        let over = over.display().to_string();
        let deploy = ["stack", "deploy", "--resolve-image", "never", "-c", FILE];
        docker(&[&deploy[..], &["-c", &over, "strew-test"]].concat());
        stack
    }

    /// The replicas by image and state, such as `strew:ci Running`.
    fn replicas(&self) -> Vec<String> {
        let format = "{{.Image}} {{.CurrentState}}";
        let only = ["-f", "desired-state=running"];
        let listed = docker(&[&["service", "ps", "--format", format, SERVICE], &only[..]].concat());
        let words = |line: &str| line.split(' ').take(2).collect::<Vec<_>>().join(" ");
        listed.lines().map(words).collect()
    }

    /// Waits until three replicas of an image run, and none else.
    fn until_all_run(&self, image: &str) {
        let wanted = vec![format!("{image} Running"); 3];
        until("all replicas run", || self.replicas() == wanted);
    }
}

impl Drop for Stack {
    fn drop(&mut self) {
        if std::thread::panicking() {
            let tasks = command(&["service", "ps", "--no-trunc", SERVICE]);
            eprintln!("{}", String::from_utf8_lossy(&tasks.stdout));
        }
        command(&["stack", "rm", "strew-test"]);
        command(&["swarm", "leave", "--force"]);
    }
}

#[test]
fn updates_and_rollbacks_fail_no_request() {
    if !docker::has(IMAGE) || !docker::has("haproxy:ci") {
        return;
    }
    let stack = Stack::deploy();
    stack.until_all_run(IMAGE);
    let proxy: SocketAddr = "127.0.0.1:8080".parse().expect("an address");
    until("the proxy has found a replica", || {
        let answer = http1::try_open(proxy, "GET", "/readyz", &[], None);
        answer.is_ok_and(|answer| answer.status == 200)
    });
    let update = [
        "service",
        "update",
        "-q",
        "--detach=false",
        "--no-resolve-image",
    ];

    let load = Load::start(proxy);
    docker(&[&update[..], &["--image", "strew:ci-next", SERVICE]].concat());
    stack.until_all_run("strew:ci-next");
    load.finish("an update of the stack");

    let load = Load::start(proxy);
    docker(&["service", "rollback", "-q", "--detach=false", SERVICE]);
    stack.until_all_run(IMAGE);
    load.finish("a rollback of the stack");

    // A daemon that does not start takes no replica's place, and the engine goes back by itself.
    let load = Load::start(proxy);
    let wrong = ["--env-add", "STREW_LIMITS_MAX_POINTS=many", SERVICE];
    command(&[&update[..], &wrong].concat());
    let state = || {
        docker(&[
            "service",
            "inspect",
            "-f",
            "{{.UpdateStatus.State}}",
            SERVICE,
        ])
    };
    until("the update is rolled back", || {
        state() == "rollback_completed"
    });
    stack.until_all_run(IMAGE);
    load.finish("an update that cannot work");
}
