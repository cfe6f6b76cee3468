//! Clients generated from the OpenAPI document: one is used against the daemon.

use std::path::Path;

use crate::support::{clients, daemon::Daemon};

#[test]
fn a_generated_python_client_asks_everything() {
    let Some(mut generator) = clients::python("openapi-python-client") else {
        return;
    };
    let is_there = clients::python("openapi-python-client").is_some_and(|mut python| {
        let version = python
            .args(["-m", "openapi_python_client", "--version"])
            .output();
        version.is_ok_and(|output| output.status.success())
    });
    if !is_there {
        eprintln!("skipped: openapi-python-client is not installed");
        return;
    }
    let daemon = Daemon::start(&[]);
    let folder = tempfile::tempdir().expect("a temporary folder");
    let document = folder.path().join("openapi.json");
    std::fs::write(&document, daemon.get("/openapi.json").body).expect("writable");
    let output = generator
        .args(["-m", "openapi_python_client", "generate", "--meta", "none"])
        .args(["--path".as_ref(), document.as_os_str()])
        .args([
            "--output-path".as_ref(),
            folder.path().join("strew_client").as_os_str(),
        ])
        .output()
        .expect("Python runs");
    let report = String::from_utf8_lossy(&output.stdout);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{report}\n{errors}");
    // It reads no pictures; everything else it does.
    let warnings: Vec<&str> = report
        .lines()
        .filter(|line| line.contains("WARNING"))
        .collect();
    assert!(
        warnings.iter().all(|line| {
            ["spectrum.svg", "/v1/fields/{name}/chunks"]
                .iter()
                .any(|picture| line.contains(picture))
        }),
        "{report}"
    );
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/suite/docs/generated_client.py");
    let output = clients::python("as above")
        .expect("as above")
        .arg(script)
        .arg(daemon.url(""))
        .env("PYTHONPATH", folder.path())
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .output()
        .expect("Python runs");
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{errors}");
    assert_eq!(output.stdout.trim_ascii(), b"used");
}
