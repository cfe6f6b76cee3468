//! What is shipped for running the daemon says what the daemon takes: settings and paths that there are.

use std::{collections::BTreeSet, fs, path::Path};

use crate::daemon::strew;

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

fn text(path: &str) -> String {
    fs::read_to_string(Path::new(ROOT).join(path)).unwrap_or_else(|e| panic!("{path}: {e}"))
}

/// Variables of settings in a file: everything that begins like one, without those of the build.
fn variables(text: &str) -> BTreeSet<String> {
    let words = text.split(|c: char| !c.is_ascii_uppercase() && c != '_');
    let settings = words.filter(|w| w.starts_with("STREW_") && w.len() > 6);
    let settings = settings.filter(|w| !w.starts_with("STREW_BUILD_"));
    settings.map(Into::into).collect()
}

#[test]
fn every_setting_that_is_shipped_is_one() {
    let known: toml::Table = strew::config::DEFAULTS.parse().expect("TOML");
    let mut seen = 0;
    for path in [
        "Dockerfile",
        "deploy/Dockerfile.scratch",
        "deploy/compose.yaml",
        "deploy/helm/strew/templates/deployment.yaml",
    ] {
        for variable in variables(&text(path)) {
            seen += 1;
            let is_it = |section: &str, key: &str| {
                variable == format!("STREW_{}_{}", section.to_uppercase(), key.to_uppercase())
            };
            let is_known = known.iter().any(|(section, keys)| {
                let keys = keys.as_table().into_iter().flat_map(|table| table.keys());
                keys.into_iter().any(|key| is_it(section, key))
            });
            assert!(is_known, "{path}: there is no setting {variable}");
        }
    }
    assert!(seen >= 6, "{seen} settings were looked at");
}

#[test]
fn the_images_hold_what_their_sources_need() {
    // What the build is given is all that cargo wants to see.
    let ignored = text(".dockerignore");
    for needed in [
        "Cargo.toml",
        "Cargo.lock",
        "build.rs",
        "src",
        "crates",
        "proto",
        "tables",
        "config",
    ] {
        assert!(
            ignored.lines().any(|line| line == format!("!{needed}")),
            "{needed}"
        );
    }
    for path in ["Dockerfile", "deploy/Dockerfile.scratch"] {
        let text = text(path);
        for part in [
            "HEALTHCHECK",
            "USER 65532",
            "\"probe\", \"--ready\"",
            "org.opencontainers.image.revision",
        ] {
            assert!(text.contains(part), "{path} has no {part}");
        }
    }
    // Its health check is a command that there is.
    let help = strew()
        .args(["probe", "--help"])
        .output()
        .expect("the program runs");
    assert!(help.status.success());
    assert!(String::from_utf8_lossy(&help.stdout).contains("--ready"));
}
