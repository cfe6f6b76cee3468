//! The programs of `examples/`, run against the daemon by what they are written for, where it is installed.

use std::{
    io::{BufRead as _, BufReader},
    net::{Shutdown, SocketAddr, TcpListener, TcpStream},
    path::Path,
    process::{Child, Command, Stdio},
};

use crate::support::{
    browser::looking,
    clients,
    daemon::{Daemon, strew},
};

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// The Python of `STREW_TEST_BLENDER`, which has Blender's module.
#[test]
fn blender_installs_the_extension_and_has_an_instance_for_each_point() {
    let Some(python) = std::env::var_os("STREW_TEST_BLENDER") else {
        eprintln!("skipped: STREW_TEST_BLENDER names no Python with bpy");
        return;
    };
    let (daemon, home) = (Daemon::built_in(), tempfile::tempdir().expect("a folder"));
    let run = |arguments: &[&str]| {
        let output = Command::new(&python)
            .args(arguments)
            .current_dir(ROOT)
            .env("BLENDER_USER_RESOURCES", home.path())
            .output()
            .expect("Python runs");
        let errors = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{errors}");
        let printed = String::from_utf8_lossy(&output.stdout);
        printed.lines().last().expect("a line").to_owned()
    };
    let count = |bbox| {
        let count = daemon.get(&format!("/v1/count?bbox={bbox}&spacing=2&seed=7"));
        count.json()["count"].to_string()
    };
    let url = daemon.url("");
    let found = run(&["tests/suite/docs/blender_check.py", "engines/blender", &url]);
    assert_eq!(found, count("0,0,30,20"));
    let found = run(&["examples/blender/scatter.py", "--url", &url]);
    let expected = format!("{} instances of oak, pine, rock", count("0,0,60,40"));
    assert_eq!(found, expected);
}

/// A folder served over HTTP by Python; ends when dropped.
pub struct Folder {
    server: Child,
    pub url: String,
}

impl Folder {
    pub fn serve(folder: &Path) -> Option<Self> {
        let mut server = Command::new(clients::find("python3")?)
            .args(["-u", "-m", "http.server", "0", "--bind", "127.0.0.1"])
            .arg("--directory")
            .arg(folder)
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("Python runs");
        let mut line = String::new();
        BufReader::new(server.stdout.take().expect("piped"))
            .read_line(&mut line)
            .expect("a line");
        let mut words = line.split_whitespace().skip_while(|word| *word != "port");
        let port = words.nth(1).expect("a port");
        let url = format!("http://127.0.0.1:{port}");
        Some(Self { server, url })
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}

#[test]
fn a_forest_of_three_js_grows_around_the_camera() {
    let Some(npm) = clients::find("npm") else {
        return;
    };
    let folder = tempfile::tempdir().expect("a folder");
    for name in ["index.html", "main.js", "package.json", "package-lock.json"] {
        let from = Path::new(ROOT).join("examples/three").join(name);
        std::fs::copy(from, folder.path().join(name)).expect("copied");
    }
    let installed = Command::new(npm)
        .args(["ci", "--silent", "--no-audit", "--no-fund"])
        .current_dir(folder.path())
        .status()
        .expect("npm runs");
    if !installed.success() {
        eprintln!("skipped: npm cannot install three");
        return;
    }
    let package = Path::new(ROOT).join("bindings/js/lib");
    let installed = folder.path().join("node_modules/strew/lib");
    std::fs::create_dir_all(&installed).expect("a folder");
    for file in std::fs::read_dir(package).expect("readable").flatten() {
        if file.path().extension().is_some_and(|end| end == "js") {
            std::fs::copy(file.path(), installed.join(file.file_name())).expect("copied");
        }
    }
    // As the package has it printed when it is built.
    let printed = strew().args(["parameters", "--as", "js"]).output();
    std::fs::write(
        installed.join("parameters.js"),
        printed.expect("it runs").stdout,
    )
    .expect("writable");
    let (Some(files), Some((daemon, browser))) = (Folder::serve(folder.path()), looking(300, 200))
    else {
        return;
    };
    // Far away, where f32 alone would not know one tree from the next; and not far to see, because no GPU draws.
    let page = format!("{}/index.html?x=3e8&y=-7e8&speed=0&far=96", files.url);
    browser.go(&format!("{page}&url={}", daemon.url("")));
    let said = "document.querySelector('#said').textContent";
    let whole = "document.querySelector('#said').dataset.missing === '0'";
    let text = browser.until(&format!("{whole} && / in [1-9]/.test({said}) && {said}"));
    let text = text.as_str().expect("text").replace(',', "");
    let mut numbers = text.split_whitespace().filter_map(|word| word.parse().ok());
    let (drawn, loaded): (u64, u64) = (
        numbers.next().expect("drawn"),
        numbers.next().expect("loaded"),
    );
    assert!(0 < drawn && drawn < loaded, "{text}");
    let errors = browser.errors();
    assert!(
        errors.iter().all(|error| error.contains("favicon")),
        "{errors:?}"
    );
    drop(daemon);
    browser.go(&format!("{page}&url=http://127.0.0.1:1"));
    browser.until(&format!("{said}.includes('does not answer')"));
}

/// The address of a proxy that drops its first connections and hands the others on.
fn unsteady(daemon: SocketAddr) -> SocketAddr {
    let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
    let address = listener.local_addr().expect("bound");
    std::thread::spawn(move || {
        for client in listener.incoming().skip(5).filter_map(Result::ok) {
            let server = TcpStream::connect(daemon).expect("the daemon listens");
            let pair = |stream: &TcpStream| stream.try_clone().expect("a socket");
            for (mut from, mut to) in [(pair(&client), pair(&server)), (server, client)] {
                std::thread::spawn(move || {
                    let _ = std::io::copy(&mut from, &mut to);
                    let _ = to.shutdown(Shutdown::Write);
                });
            }
        }
    });
    address
}

#[test]
fn a_forest_of_godot_has_the_points_of_its_chunks() {
    let Some(godot) = clients::find("godot3-server") else {
        return;
    };
    let (daemon, home) = (Daemon::built_in(), tempfile::tempdir().expect("a folder"));
    let run = |url: &str| {
        Command::new(&godot)
            .arg("--path")
            .arg(Path::new(ROOT).join("examples/godot"))
            .args(["-s", "main.gd"])
            .env("STREW_URL", url)
            .env("HOME", home.path())
            .output()
            .expect("Godot runs")
    };
    let output = run(&daemon.url(""));
    let printed = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{output:?}");
    // The place is (1000, −500) in the plane, in the chunk (31, −16).
    let bbox = [29, -18, 34, -13].map(|edge: i32| (32 * edge).to_string());
    let count = daemon.get(&format!(
        "/v1/count?bbox={}&spacing=2&seed=7",
        bbox.join(",")
    ));
    let words = format!("{} points in 25 chunks", count.json()["count"]);
    assert!(printed.contains(&words), "{printed} and not {words}");
    let output = run("http://127.0.0.1:1");
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stderr).contains("no answer from"));

    // Chunks whose requests failed are requested again.
    let output = run(&format!("http://{}", unsteady(daemon.address())));
    let printed = String::from_utf8_lossy(&output.stdout);
    assert!(String::from_utf8_lossy(&output.stderr).contains("no answer from"));
    assert!(printed.contains(&words), "{printed} and not {words}");
}
