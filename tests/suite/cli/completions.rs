//! The completions that shells offer after Tab: commands, flags and known values. Shells that are missing are skipped.

use std::{
    path::Path,
    process::{Command, Stdio},
};

use crate::support::{
    clients,
    command::{errors, run},
    daemon::{PROGRAM, strew},
};

/// The words that bash offers for the last of `words`.
fn offered_by_bash(words: &[&str]) -> Vec<String> {
    let script = format!(
        "source <(strew completions bash); COMP_WORDS=({}); COMP_CWORD={}; COMP_TYPE=9; \
         COMP_LINE=\"${{COMP_WORDS[*]}}\"; COMP_POINT=${{#COMP_LINE}}; \
         $(complete -p strew | sed 's/.*-F \\([^ ]*\\).*/\\1/') strew \"${{COMP_WORDS[COMP_CWORD]}}\"; \
         printf '%s\\n' \"${{COMPREPLY[@]}}\"",
        words
            .iter()
            .map(|word| format!("'{word}'"))
            .collect::<Vec<_>>()
            .join(" "),
        words.len() - 1,
    );
    shell("bash", &["-c", &script])
}

/// The lines that a shell prints.
fn shell(name: &str, arguments: &[&str]) -> Vec<String> {
    let programs = Path::new(PROGRAM).parent().expect("a folder");
    let path = std::env::var_os("PATH").unwrap_or_default();
    let path = [programs.into()]
        .into_iter()
        .chain(std::env::split_paths(&path));
    let mut command = Command::new(name);
    command.env("PATH", std::env::join_paths(path).expect("a path"));
    for (name, _) in strew().get_envs() {
        command.env_remove(name);
    }
    let output = { &mut command }
        .args(arguments)
        .stdin(Stdio::null())
        .output()
        .expect("the shell runs");
    assert!(output.status.success(), "{}", errors(&output));
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let lines = text.lines().map(|line| line.trim().to_owned());
    lines.filter(|line| !line.is_empty()).collect()
}

/// Command lines, a word that is offered for the last one, and a word that is not.
const OFFERS: [(&[&str], &str, &str); 9] = [
    (&["strew", "sam"], "sample", "serve"),
    (&["strew", "sample", "--min-"], "--min-distance", "--map"),
    (&["strew", "sample", "--format", "ge"], "geojson", "csv"),
    (&["strew", "sample", "--warp", ""], "off", "Cargo.toml"),
    (&["strew", "sample", "--spread", ""], "even", "Cargo.toml"),
    (
        &["strew", "sample", "--attributes", "angle,ra"],
        "angle,rank",
        "angle,scale",
    ),
    (&["strew", "sample", "--map", ""], "m", "Cargo.toml"),
    (&["strew", "count", "--profile", "b"], "blue", "spaced"),
    (&["strew", "sample", "--field", "fo"], "forest", "portrait"),
];

#[test]
fn bash_offers_commands_flags_and_known_values() {
    if clients::find("bash").is_none() {
        return;
    }
    for (words, offered, other) in OFFERS {
        let found = offered_by_bash(words);
        let has = |word: &str| found.iter().any(|found| found == word);
        assert!(has(offered) && !has(other), "{words:?}: {found:?}");
    }
}

#[test]
fn fish_offers_commands_flags_and_known_values() {
    if clients::find("fish").is_none() {
        return;
    }
    for (words, offered, other) in OFFERS {
        let line = words.join(" ");
        let script = format!("strew completions fish | source; complete --do-complete '{line}'");
        let found = shell("fish", &["-c", &script]);
        let has = |word: &str| {
            found
                .iter()
                .any(|found| found.split('\t').next() == Some(word))
        };
        assert!(has(offered) && !has(other), "{words:?}: {found:?}");
    }
}

#[test]
fn worlds_and_profiles_are_those_of_the_settings() {
    let folder = tempfile::tempdir().expect("a folder");
    let world = "{\"spacing\": 2}";
    std::fs::write(folder.path().join("heath.json"), world).expect("writable");
    let mut command = strew();
    command.env("COMPLETE", "fish");
    command.env("STREW_WORLDS_FOLDER", folder.path());
    let output = { &mut command }
        .args(["--", "strew", "sample", "--world", "he"])
        .output()
        .expect("the program runs");
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(text.contains("heath"), "{text} {}", errors(&output));
}

#[test]
fn every_shell_has_a_script() {
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let output = run(&["completions", shell], "");
        let script = String::from_utf8_lossy(&output.stdout);
        assert!(
            output.status.success() && script.contains("COMPLETE"),
            "{shell}: {script}"
        );
    }
}
