//! `deploy/compose.yaml`: three replicas behind HAProxy, watched by Prometheus, under load while replicas are killed,
//! the image is replaced and tables are exchanged.

use std::{
    fs::{self, Permissions},
    net::SocketAddr,
    os::unix::fs::PermissionsExt as _,
    path::Path,
};

use strew_core::Table;
use strew_testkit::{http1, process, tables::write, wait::until};
use tempfile::TempDir;

use super::{
    docker::{self, Container, IMAGE, command, docker},
    load::Load,
};
use crate::support::daemon::{PROFILE, other_table, table};

const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/deploy/compose.yaml");
const ALPHA: &str = "(5-sqrt(3))/2";
const POINTS: &str = "/v1/points?bbox=0,0,20,20&spacing=1&profile=test&format=csv";

/// The containers of the file, with local images. They are removed when dropped.
struct Project {
    folder: TempDir,
}

impl Project {
    fn start() -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let tables = folder.path().join("tables");
        fs::create_dir(&tables).expect("a folder");
        readable(folder.path());
        readable(&tables);
        put(&tables, &table(ALPHA, PROFILE));
        let project = Self { folder };
        project.images(IMAGE);
        project.compose(&["up", "-d", "--no-build", "strew", "proxy", "prometheus"]);
        project
    }

    /// The folder that replicas mount.
    fn tables(&self) -> std::path::PathBuf {
        self.folder.path().join("tables")
    }

    /// Names local images in an override file.
    fn images(&self, image: &str) {
        let tables = self.tables();
        let text = format!(
            "services:\n  strew:\n    image: {image}\n    volumes: ['{}:/tables:ro']\n  \
             proxy: {{ image: 'haproxy:ci' }}\n  prometheus: {{ image: 'prometheus:ci' }}\n",
            tables.display()
        );
        fs::write(self.folder.path().join("over.yaml"), text).expect("writable");
    }

    fn compose(&self, arguments: &[&str]) -> String {
        let over = self.folder.path().join("over.yaml").display().to_string();
        let files = ["compose", "-p", "strew-test", "-f", FILE, "-f", &over];
        docker(&[&files[..], arguments].concat())
    }

    fn replicas(&self) -> Vec<Container> {
        let ids = self.compose(&["ps", "-q", "strew"]);
        ids.lines().map(Container::existing).collect()
    }
}

impl Drop for Project {
    fn drop(&mut self) {
        let over = self.folder.path().join("over.yaml").display().to_string();
        let files = ["compose", "-p", "strew-test", "-f", FILE, "-f", &over];
        if std::thread::panicking() {
            let logs = command(&[&files[..], &["logs", "--tail", "40"]].concat());
            eprintln!("{}", String::from_utf8_lossy(&logs.stdout));
        }
        command(&[&files[..], &["down", "-v", "-t", "0"]].concat());
    }
}

/// Lets the user of the image read a folder or a file.
fn readable(path: &Path) {
    fs::set_permissions(path, Permissions::from_mode(0o755)).expect("ours");
}

/// Writes a table of a folder, as a whole.
fn put(tables: &Path, table: &Table) {
    write(tables, "new", table);
    readable(&tables.join("new"));
    fs::rename(tables.join("new"), tables.join("a.strew")).expect("renamed");
}

/// Waits until a replica has made points: the proxy uses it.
fn until_used(replica: &Container) {
    until("the proxy uses a replica", || {
        let answer = http1::try_open(replica.address(), "GET", "/metrics", &[], None).ok()?;
        let text = String::from_utf8(answer.body().ok()?).expect("UTF-8");
        let mut points = text
            .lines()
            .filter(|line| line.starts_with("strew_points_total"));
        points.any(|line| !line.ends_with(" 0")).then_some(())
    });
}

#[test]
fn the_file_serves_while_replicas_are_killed_and_replaced() {
    let has_images = [IMAGE, "haproxy:ci", "prometheus:ci"]
        .into_iter()
        .all(docker::has);
    if !has_images {
        return;
    }
    if !command(&["compose", "version"]).status.success() {
        eprintln!("skipped: docker has no plugin compose");
        return;
    }
    let project = Project::start();
    let proxy: SocketAddr = "127.0.0.1:8080".parse().expect("an address");
    until("the proxy has found a replica", || {
        let answer = http1::try_open(proxy, "GET", "/readyz", &[], None);
        answer.is_ok_and(|answer| answer.status == 200)
    });
    assert_eq!(project.replicas().len(), 3);
    let prometheus = "127.0.0.1:9090".parse().expect("an address");
    until("Prometheus watches three replicas", || {
        let path = "/api/v1/query?query=sum(up{job=\"strew\"})".replace('"', "%22");
        let answer = http1::try_open(prometheus, "GET", &path, &[], None).ok()?;
        let text = String::from_utf8(answer.body().ok()?).expect("UTF-8");
        text.contains(",\"3\"]").then_some(())
    });

    let load = Load::start(proxy);
    for replica in project.replicas() {
        until_used(&replica);
        // By the system: the engine would not start a container again that its user kills.
        process::signal(replica.pid(), "KILL");
        until("the engine has started it again", || {
            replica.inspect("{{.RestartCount}} {{.State.Status}}") == "1 running"
        });
        replica.until_healthy();
        until_used(&replica);
    }
    load.finish_after_kills("three replicas killed one after another");

    // As the comment in the file says.
    let load = Load::start(proxy);
    let old = project.replicas();
    project.images("strew:ci-next");
    let more = ["up", "-d", "--no-build", "--no-recreate", "--no-deps"];
    project.compose(&[&more[..], &["--scale", "strew=6", "--wait", "strew"]].concat());
    let old: Vec<&str> = old.iter().map(|replica| &*replica.id).collect();
    docker(&[&["stop"], &old[..]].concat());
    docker(&[&["rm"], &old[..]].concat());
    let new = project.replicas();
    assert_eq!(new.len(), 3);
    for replica in &new {
        assert_eq!(replica.inspect("{{.Config.Image}}"), "strew:ci-next");
        until_used(replica);
        println!("a busy replica: {}", replica.memory());
    }
    load.finish("the image replaced");

    tables_are_exchanged(&project, proxy, &new);
}

/// Every replica serves a new table of the folder after SIGHUP; a request that pins the old one never gets another.
fn tables_are_exchanged(project: &Project, proxy: SocketAddr, replicas: &[Container]) {
    let before = http1::get(proxy, POINTS, &[]);
    let old = before.header("strew-table").to_owned();
    let pinned = format!("{POINTS}&table={old}");
    let look = || {
        let answer = http1::get(proxy, &pinned, &[]);
        match answer.status {
            200 => assert_eq!(answer.body, before.body),
            status => assert_eq!(status, 409, "{}", answer.text()),
        }
        answer.status
    };
    assert_eq!(look(), 200);
    put(&project.tables(), &other_table(ALPHA, PROFILE));
    for replica in replicas {
        process::signal(replica.pid(), "HUP");
        look();
        until("a replica serves the new table", || {
            look();
            replica.get(POINTS).header("strew-table") != old
        });
    }
    assert_eq!(look(), 409);
    let after = http1::get(proxy, POINTS, &[]);
    assert_eq!(after.status, 200);
    assert_ne!(after.body, before.body);
}
