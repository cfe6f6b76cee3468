//! `strew config`: defaults < file < environment < flags; unknown and invalid settings are errors.

use std::process::Command;

use crate::support::daemon::strew;

/// Runs `strew config`. Returns the exit code, the settings and the message.
fn config(prepare: impl FnOnce(&mut Command)) -> (Option<i32>, toml::Table, String) {
    let mut command = strew();
    command.arg("config");
    prepare(&mut command);
    let output = command.output().expect("the program runs");
    let text = String::from_utf8(output.stdout).expect("UTF-8");
    let message = String::from_utf8(output.stderr).expect("UTF-8");
    let settings = text.parse().unwrap_or_else(|e| panic!("{e}: {text}"));
    (output.status.code(), settings, message)
}

fn file(text: &str) -> tempfile::NamedTempFile {
    let file = tempfile::NamedTempFile::new().expect("a file");
    std::fs::write(file.path(), text).expect("writable");
    file
}

#[test]
fn the_defaults_are_those_of_the_commented_file() {
    let (code, settings, _) = config(|_| {});
    assert_eq!(code, Some(0));
    let default: toml::Table = strew_config::DEFAULTS.parse().expect("TOML");
    assert_eq!(settings.len(), default.len());
    for (section, table) in &default {
        let table = table.as_table().expect("a section");
        let merged = settings[section].as_table().expect("a section");
        assert_eq!(table.len(), merged.len(), "{section}");
        for (key, value) in table {
            let number = |v: &toml::Value| v.as_float().or(v.as_integer().map(|i| i as f64));
            let same = merged[key] == *value || number(&merged[key]) == number(value);
            assert!(same, "{section}.{key}: {} and {value}", merged[key]);
        }
    }
    // Every setting has a comment.
    let mut explained = false;
    for line in strew_config::DEFAULTS.lines() {
        assert!(
            !line.contains('=') || line.starts_with('#') || explained,
            "{line}"
        );
        explained = line.starts_with('#');
    }
}

#[test]
fn each_layer_overrides_the_one_before() {
    let points = |settings: &toml::Table| settings["limits"]["max_points"].as_integer();
    let file = file("[limits]\nmax_points = 11\nmax_streams = 12\nblock_bytes = 5000\n");
    let given = |command: &mut Command| {
        command.arg("--config").arg(file.path());
    };
    let (_, settings, _) = config(given);
    assert_eq!(points(&settings), Some(11));
    let (_, settings, _) = config(|command| {
        given(command);
        command.env("STREW_LIMITS_MAX_POINTS", "22");
    });
    assert_eq!(points(&settings), Some(22));
    let (_, settings, _) = config(|command| {
        given(command);
        command.env("STREW_LIMITS_MAX_POINTS", "22");
        command.env("STREW_LIMITS_MAX_STREAMS", "23");
        command.args(["--set", "limits.max_points=33"]);
        command.args(["--listen", "127.0.0.1:1"]);
    });
    assert_eq!(points(&settings), Some(33));
    assert_eq!(settings["limits"]["max_streams"].as_integer(), Some(23));
    assert_eq!(settings["limits"]["block_bytes"].as_integer(), Some(5000));
    assert_eq!(settings["server"]["listen"].as_str(), Some("127.0.0.1:1"));
    // The environment may name a file below that of the flag, as in the image; the output is a valid file.
    let (_, settings, _) = config(|command| {
        command.env("STREW_CONFIG", "config/container.toml");
        command.arg("--config").arg(file.path());
    });
    assert_eq!(points(&settings), Some(11));
    assert_eq!(settings["server"]["listen"].as_str(), Some("0.0.0.0:8080"));
    let printed = self::file(&toml::to_string(&settings).expect("TOML"));
    let (_, again, _) = config(|command| {
        command.arg("--config").arg(printed.path());
    });
    assert_eq!(again, settings);
}

#[test]
fn errors_name_the_setting_and_its_source() {
    let refused = |prepare: &dyn Fn(&mut Command), texts: &[&str]| {
        let (code, settings, message) = config(prepare);
        assert_eq!(code, Some(2), "{message}");
        assert!(settings.is_empty());
        for text in texts {
            assert!(message.contains(text), "no `{text}`: {message}");
        }
    };
    let files: &[(&str, &[&str])] = &[
        (
            "[limits]\nmax_point = 1",
            &["limits.max_point", "did you mean `limits.max_points`"],
        ),
        (
            "[limit]\nmax_points = 1",
            &[":1: ", "`limit`; did you mean `limits`"],
        ),
        ("colour = 1", &["colour", "`strew config` prints all"]),
        // All faults, each with its line.
        (
            "[server]\nnope = 1\n\n[limits]\nmax_points = true\n",
            &[
                ":2: there is no setting `server.nope`",
                ":5: `limits.max_points` is true",
            ],
        ),
        (
            "[limits]\nmax_points = \"many\"",
            &["limits.max_points", "many", "a number"],
        ),
        ("limits = 3", &["limits", "a section"]),
        ("[limits]\nmax_points = 1.5", &["max_points"]),
        ("[limits]\nmax_points = -1", &["max_points"]),
        (
            "[limits]\nmax_points = 0\nblock_bytes = 1",
            &["limits.max_points = 0", "limits.block_bytes = 1", "4096"],
        ),
        (
            "[server]\nlisten = \"nowhere\"",
            &[
                "error: the settings are not valid: server.listen: \"nowhere\"",
                "alone (8080)\n",
            ],
        ),
        (
            "[http]\ncors_origins = \"https://a.example http//typo\"",
            &["http.cors_origins", "\"http//typo\" is not an origin"],
        ),
        (
            "[http]\ncors_origins = \"https://a.example/page\"",
            &["\"https://a.example/page\" is not an origin"],
        ),
        (
            "[http]\npublic_url = \"https://a.example/strew/\"",
            &[
                "http.public_url = \"https://a.example/strew/\"",
                "without a path",
            ],
        ),
        ("[log]\nfilter = \"info,=x=\"", &["log.filter"]),
        ("[log]\nfilter = \"warning\"", &["log.filter", "warning"]),
        ("[shutdown]\ndrain_seconds = nan", &["shutdown.drain"]),
        ("[limits\n", &["TOML", "line 1"]),
    ];
    for (text, expected) in files {
        let file = file(text);
        let give = |command: &mut Command| {
            command.arg("--config").arg(file.path());
        };
        refused(&give, expected);
    }
    let missing = |command: &mut Command| {
        command.args(["--config", "/nowhere/strew.toml"]);
    };
    refused(&missing, &["/nowhere/strew.toml"]);
    for (name, value, texts) in [
        (
            "STREW_LIMITS_MAX_POINT",
            "1",
            ["STREW_LIMITS_MAX_POINT", "STREW_LIMITS_MAX_POINTS"],
        ),
        (
            "STREW_LIMITS_MAX_POINTS",
            "many",
            ["STREW_LIMITS_MAX_POINTS", "a number"],
        ),
        (
            "STREW_TABLES_EMBEDDED",
            "maybe",
            ["tables.embedded", "true or false"],
        ),
    ] {
        let give = |command: &mut Command| {
            command.env(name, value);
        };
        refused(&give, &texts);
    }
    for (flag, texts) in [
        (
            "limits.max_pints=1",
            ["limits.max_pints", "did you mean `limits.max_points`"],
        ),
        ("limits.max_points", ["key=value", "limits.max_points"]),
        ("limits.max_points=x", ["limits.max_points", "a number"]),
    ] {
        let give = |command: &mut Command| {
            command.args(["--set", flag]);
        };
        refused(&give, &texts);
    }
}

#[cfg(target_os = "linux")]
#[test]
fn only_regular_files_of_a_bounded_size_are_read() {
    let folder = tempfile::tempdir().expect("a folder");
    let pipe = folder.path().join("pipe");
    let made = Command::new("mkfifo").arg(&pipe).status();
    assert!(made.expect("mkfifo").success());
    let sparse = folder.path().join("sparse.toml");
    let long = std::fs::File::create(&sparse).expect("writable");
    long.set_len(1 << 30).expect("a sparse file");
    for (path, problem) in [
        (
            std::path::Path::new("/dev/zero"),
            "it is not a regular file",
        ),
        (&pipe, "it is not a regular file"),
        (folder.path(), "it is not a regular file"),
        (&sparse, "it has more than 16777216 bytes"),
    ] {
        let (code, _, message) = config(|command| {
            command.arg("--config").arg(path);
        });
        assert_eq!(code, Some(2), "{message}");
        assert!(message.contains(problem), "{message}");
        assert!(message.contains(&path.display().to_string()), "{message}");
    }
}
