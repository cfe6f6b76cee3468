//! The files in `deploy/` and the Dockerfile name settings, values, commands and metrics that
//! exist.

use std::{collections::BTreeSet, fs, path::Path};

use crate::support::{
    daemon::{Daemon, strew},
    metrics::samples,
};

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

fn text(path: &str) -> String {
    fs::read_to_string(Path::new(ROOT).join(path)).unwrap_or_else(|e| panic!("{path}: {e}"))
}

/// The `STREW_…` variables named in a file, without those of the build.
fn variables(text: &str) -> BTreeSet<String> {
    let words = text.split(|c: char| !c.is_ascii_uppercase() && c != '_');
    let settings = words.filter(|w| w.starts_with("STREW_") && w.len() > 6);
    let settings = settings.filter(|w| !w.starts_with("STREW_BUILD_"));
    settings.map(Into::into).collect()
}

#[test]
fn every_setting_in_the_files_exists() {
    let known: toml::Table = strew_config::DEFAULTS.parse().expect("TOML");
    let mut seen = 0;
    for path in [
        "Dockerfile",
        "deploy/Dockerfile.scratch",
        "deploy/compose.yaml",
        "deploy/stack.yaml",
        "deploy/helm/strew/templates/deployment.yaml",
    ] {
        // STREW_CONFIG names a file.
        let variables = variables(&text(path)).into_iter();
        for variable in variables.filter(|variable| variable != "STREW_CONFIG") {
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
    assert!(seen >= 4, "only {seen} settings were checked");
}

#[test]
fn the_images_get_all_sources_and_a_health_check() {
    // The build context holds everything that cargo reads.
    let ignored = text(".dockerignore");
    for needed in "Cargo.toml Cargo.lock config src crates page".split(' ') {
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
            "container.toml /etc/strew/container.toml",
        ] {
            assert!(text.contains(part), "{path} has no {part}");
        }
    }
    // The health check is an existing command.
    let help = strew()
        .args(["probe", "--help"])
        .output()
        .expect("the program runs");
    assert!(help.status.success());
    assert!(String::from_utf8_lossy(&help.stdout).contains("--ready"));
}

/// The values that the chart's templates use, such as `tables.source`.
fn values_used() -> BTreeSet<String> {
    let folder = Path::new(ROOT).join("deploy/helm/strew/templates");
    let files = fs::read_dir(folder).expect("a folder");
    let mut used = BTreeSet::new();
    for file in files {
        let path = file.expect("a file").path();
        let text = fs::read_to_string(&path).expect("readable");
        for rest in text.split(".Values.").skip(1) {
            let is_of_name = |c: char| c.is_ascii_alphanumeric() || c == '.';
            let name: String = rest.chars().take_while(|&c| is_of_name(c)).collect();
            used.insert(name);
        }
    }
    used
}

#[test]
fn every_value_of_the_chart_is_documented_and_checked() {
    let schema = text("deploy/helm/strew/values.schema.json");
    let schema: serde_json::Value = serde_json::from_str(&schema).expect("JSON");
    let used = values_used();
    for name in &used {
        let mut part = &schema;
        for key in name.split('.') {
            part = &part["properties"][key];
        }
        assert!(part.is_object(), "the schema has no {name}");
    }
    for needed in ["access.keysSecret", "admin.enabled", "tables.source"] {
        assert!(used.contains(needed), "{needed} is not used");
    }
    // In values.yaml, sections begin a line; their keys are indented by two spaces.
    let values = text("deploy/helm/strew/values.yaml");
    let sections = schema["properties"].as_object().expect("sections");
    for (section, of_section) in sections.iter().filter(|(name, _)| *name != "global") {
        let all = format!("\n{values}");
        let (_, rest) = all
            .split_once(&format!("\n{section}:"))
            .unwrap_or_else(|| panic!("values.yaml has no {section}"));
        let end = rest.find('\n').expect("a line");
        let body = rest[end..]
            .split_inclusive('\n')
            .skip(1)
            .take_while(|line| line.starts_with(' ') || line.trim().is_empty());
        let body = format!("\n{}", body.collect::<String>());
        let keys = of_section["properties"].as_object().into_iter().flatten();
        for (key, _) in keys {
            assert!(
                body.contains(&format!("\n  {key}:")),
                "values.yaml has no {section}.{key}"
            );
        }
    }
}

#[test]
fn the_dashboard_alerts_and_autoscaling_use_metrics_that_exist() {
    let dashboard = text("deploy/grafana/strew.json");
    let dashboard: serde_json::Value = serde_json::from_str(&dashboard).expect("JSON");
    let panels = dashboard["panels"].as_array().expect("panels");
    let mut asked: Vec<&str> = panels
        .iter()
        .flat_map(|panel| panel["targets"].as_array().into_iter().flatten())
        .map(|target| target["expr"].as_str().expect("an expression"))
        .collect();
    let alerts = text("deploy/prometheus/alerts.yml");
    asked.extend(
        alerts
            .lines()
            .filter_map(|line| line.split_once("expr: ").map(|(_, e)| e)),
    );
    let scaling = text("deploy/helm/strew/templates/hpa.yaml");
    asked.extend(scaling.lines().filter(|line| line.contains("metric:")));
    assert!(asked.len() > 25);
    let daemon = Daemon::start(&[]);
    daemon.get("/v1/points?bbox=0,0,20,20&density=1&profile=test&format=csv");
    let samples = samples(&daemon);
    let known: Vec<&str> = samples
        .keys()
        .map(|sample| {
            sample
                .split_once('{')
                .map_or(sample.as_str(), |(name, _)| name)
        })
        .collect();
    for expression in asked {
        let words = expression.split(|c: char| !c.is_ascii_alphanumeric() && c != '_');
        let names = words.filter(|w| w.starts_with("strew_") || w.starts_with("process_"));
        let mut some = false;
        for name in names {
            some = true;
            assert!(known.contains(&name), "{name} in {expression}");
        }
        assert!(some, "{expression} names no metric");
    }
}
