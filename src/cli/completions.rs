//! Completion of lines in shells (`strew completions`; the words of parameters, and the names of loaded things), and
//! manual pages (`strew man`).

use std::{
    collections::BTreeSet,
    ffi::OsStr,
    path::{Path, PathBuf},
};

use anyhow::Context as _;
use clap_complete::{
    Shell,
    engine::{ArgValueCompleter, CompletionCandidate, PathCompleter, ValueCompleter as _},
    env::Shells,
};
use strew_encode::Encoding;
use strew_query::{
    Parameter, Shape,
    parameters::{ATTRIBUTES, FIELD, TERRAIN},
};

use super::{Failure, config, output::write};

/// Flags of `strew completions`.
#[derive(Debug, clap::Args)]
pub(super) struct CompletionsArgs {
    /// The shell.
    #[arg(value_name = "SHELL")]
    shell: Shell,
}

/// Flags of `strew man`.
#[derive(Debug, clap::Args)]
pub(super) struct ManArgs {
    /// The folder for the pages, one for each command: strew.1, strew-sample.1, … [default: the page of strew itself on
    /// standard output]
    #[arg(long, value_name = "DIR")]
    out_dir: Option<PathBuf>,
}

/// Prints a script by which a shell runs the program itself to complete a line.
pub(super) fn completions(args: &CompletionsArgs) -> Result<(), Failure> {
    const NAME: &str = "strew";
    let shells = Shells::builtins();
    let shell = shells.completer(&args.shell.to_string());
    let shell = shell.context("this shell has no completions")?;
    let mut script = vec![];
    let written = shell.write_registration("COMPLETE", NAME, NAME, NAME, &mut script);
    written.context("the script cannot be made")?;
    write(None, &script)
}

pub(super) fn man(args: &ManArgs, command: clap::Command) -> Result<(), Failure> {
    let Some(folder) = &args.out_dir else {
        return write(None, &page(command)?);
    };
    // Building puts the names of outer commands before those of inner ones.
    let mut command = command.disable_help_subcommand(true);
    command.build();
    write_pages(folder, &command)
}

fn write_pages(folder: &Path, command: &clap::Command) -> Result<(), Failure> {
    let name = command.get_display_name().unwrap_or(command.get_name());
    let path = folder.join(format!("{name}.1"));
    write(Some(&path), &page(command.clone().name(name.to_owned()))?)?;
    command
        .get_subcommands()
        .filter(|inner| !inner.is_hide_set())
        .try_for_each(|inner| write_pages(folder, inner))
}

fn page(command: clap::Command) -> anyhow::Result<Vec<u8>> {
    let mut page = vec![];
    let written = clap_mangen::Man::new(command).render(&mut page);
    written.context("a manual page cannot be made")?;
    Ok(page)
}

/// Completes the value of a parameter's flag. Without known values it offers nothing, not files.
pub(super) fn completer(parameter: &'static Parameter) -> ArgValueCompleter {
    ArgValueCompleter::new(move |current: &OsStr| {
        let text = current.to_str().unwrap_or_default();
        let mut found = matching(text, &words(parameter), parameter.shape.is_of_names());
        if *parameter == FIELD || *parameter == TERRAIN {
            found.extend(PathCompleter::file().complete(current));
        }
        found
    })
}

/// The words that begin with `text`, or with the last item of a list.
fn matching(text: &str, words: &[String], is_list: bool) -> Vec<CompletionCandidate> {
    let (before, last) = match text.rfind(',').filter(|_| is_list) {
        Some(comma) => text.split_at(comma + 1),
        None => ("", text),
    };
    let is_given = |word: &str| before.split(',').any(|given| given == word);
    let fitting = words
        .iter()
        .filter(|word| word.starts_with(last) && !is_given(word));
    fitting
        .map(|word| CompletionCandidate::new(format!("{before}{word}")))
        .collect()
}

fn words(parameter: &Parameter) -> Vec<String> {
    let owned = |words: &[&str]| words.iter().map(|&word| word.to_owned()).collect();
    match parameter.shape {
        Shape::Switch => owned(&["on", "off"]),
        Shape::Strength { .. } => owned(&["off", "on"]),
        Shape::Choice(words) => owned(words),
        Shape::Format => {
            let all = Encoding::ALL.iter();
            all.map(|encoding| encoding.name().into()).collect()
        }
        _ if *parameter == ATTRIBUTES => attributes(),
        _ => loaded(parameter).unwrap_or_default(),
    }
}

fn attributes() -> Vec<String> {
    let named = ["angle", "scale", "variant", "rank"].map(String::from);
    let uniform = (1..=16).map(|number| format!("u{number}"));
    named.into_iter().chain(uniform).collect()
}

/// The names of the things that the settings of the environment load. Wrong settings have none; the command
/// itself reports them.
fn loaded(parameter: &Parameter) -> Option<Vec<String>> {
    if !["profile", "alpha", "map", "world", "field", "terrain"].contains(&parameter.name) {
        return None;
    }
    let config = config::Args::default().merged(config::Uses::ALL).ok()?;
    let catalog = config::tables(&config).ok()?;
    let of_tables = |name: fn(&strew_catalog::Entry) -> String| -> Vec<String> {
        let names: BTreeSet<String> = catalog.entries().map(|entry| name(entry)).collect();
        names.into_iter().collect()
    };
    Some(match parameter.name {
        "profile" => of_tables(|entry| entry.key.profile.to_string()),
        "alpha" => of_tables(|entry| entry.key.alpha.to_string()),
        "map" => of_tables(|entry| entry.key.size.to_string()),
        "world" => {
            let catalog = config::with_worlds(&config, catalog).ok()?;
            let worlds = catalog.worlds.iter();
            worlds.map(|world| world.name.clone()).collect()
        }
        _ => { catalog.fields().iter() }
            .map(|field| field.name.clone())
            .collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use strew_query::parameters::MAP;

    fn offered(parameter: &'static Parameter, text: &str) -> Vec<String> {
        let found = completer(parameter).complete(OsStr::new(text));
        let text = |found: &CompletionCandidate| found.get_value().to_string_lossy().into_owned();
        found.iter().map(text).collect()
    }

    #[test]
    fn lists_go_on_after_a_comma() {
        assert_eq!(offered(&ATTRIBUTES, "an"), ["angle"]);
        assert_eq!(offered(&ATTRIBUTES, "angle,va"), ["angle,variant"]);
        assert_eq!(offered(&ATTRIBUTES, "angle,an"), [""; 0]);
        assert_eq!(offered(&MAP, "s,"), [""; 0]);
    }

    #[test]
    fn attributes_are_those_that_are_allowed() {
        let Shape::Names { pattern } = ATTRIBUTES.shape else {
            panic!("a list");
        };
        for name in ["angle", "scale", "variant", "rank"] {
            assert!(pattern.contains(name) && attributes().contains(&name.to_owned()));
        }
    }
}
