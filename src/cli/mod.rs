//! The command line.

mod completions;
mod compression;
mod config;
mod count;
mod export;
mod failure;
mod fields;
mod flags;
mod forge;
mod key;
mod lists;
mod mask;
mod measure;
mod output;
mod parameters;
mod pattern;
mod point;
mod probe;
mod progress;
mod query;
mod sample;
mod serve;
mod signals;
mod stipple;
mod table;

use std::{ffi::OsString, process::ExitCode};

use clap::{CommandFactory as _, FromArgMatches as _, Parser, Subcommand};
use clap_complete::CompleteEnv;

use crate::rest::Pages;
pub(crate) use failure::{Failure, must_be_within, refuse};

/// The commands of `strew`.
#[derive(Debug, Parser)]
#[command(name = "strew", version, about, max_term_width = 100)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Serve points over REST and gRPC on one port.
    Serve(config::Served),
    /// Write the points of a region to a file or standard output, without a server.
    Sample(sample::Args),
    /// Write a world as a folder of chunks, which any static server can serve.
    Export(export::Args),
    /// Turn a picture into dots.
    Stipple(stipple::Args),
    /// Count the points of a query, exactly, without making them.
    Count(count::CountArgs),
    /// Find a point by its id.
    Point(point::PointArgs),
    /// List the sizes of periodic sets.
    Periods(lists::PeriodsArgs),
    /// Find the points nearest to a place.
    Nearest(point::NearestArgs),
    /// Split a query into parts for parallel readers.
    Split(count::SplitArgs),
    /// Find out whether an arrangement of points occurs in a pattern, how often, and where.
    Arrangement(pattern::ArrangementArgs),
    /// Draw a figure of an AA pattern: its index space, an arrangement, clusters, a neighborhood map.
    #[command(subcommand)]
    Figure(pattern::Figure),
    /// Make a tileable threshold mask for dithering.
    Mask(mask::Args),
    /// Make a table and judge it.
    Forge(forge::Args),
    /// Measure a table, the points of a region, or a file of points.
    Measure(measure::Args),
    /// Inspect, check, export and import tables.
    #[command(subcommand)]
    Table(table::Command),
    /// Make keys for clients.
    #[command(subcommand)]
    Key(key::Command),
    /// Ask a running daemon whether it is ready: exit code 0 if so, 1 if not.
    Probe(probe::Args),
    /// Print the merged settings.
    Config(config::Served),
    /// List the loaded tables: profiles, α, sizes of maps.
    Profiles(config::Args),
    /// List and check worlds: queries that the settings describe by name.
    #[command(subcommand)]
    Worlds(lists::Worlds),
    /// Print the table of parameters as types for programs, or as documentation.
    Parameters(parameters::Args),
    /// Print a script that lets a shell complete commands and flags.
    Completions(completions::CompletionsArgs),
    /// Write manual pages.
    Man(completions::ManArgs),
    /// Print the version, as `--version` does.
    #[command(hide = true)]
    Version,
}

/// The exit code after an interrupt, as shells have it.
const INTERRUPTED: u8 = 130;

pub fn main(pages: fn() -> Pages) -> ExitCode {
    // Shells run the program with COMPLETE=SHELL to complete a line.
    CompleteEnv::with_factory(command).complete();
    let given = command().get_matches_from(joined(&built(), std::env::args_os()));
    let cli = Cli::from_arg_matches(&given).unwrap_or_else(|error| error.exit());
    let done = match cli.command {
        Command::Serve(args) => serve::run(&args, pages),
        Command::Sample(args) => sample::run(&args),
        Command::Export(args) => export::run(&args),
        Command::Stipple(args) => stipple::run(&args),
        Command::Count(args) => count::count(&args),
        Command::Point(args) => point::point(&args),
        Command::Periods(args) => lists::periods(&args),
        Command::Nearest(args) => point::nearest(&args),
        Command::Split(args) => count::split(&args),
        Command::Arrangement(args) => pattern::arrangement(&args),
        Command::Figure(command) => pattern::draw(&command),
        Command::Mask(args) => mask::run(&args),
        Command::Forge(args) => forge::run(&args),
        Command::Measure(args) => measure::run(&args),
        Command::Table(command) => table::run(&command),
        Command::Key(command) => key::run(&command),
        Command::Probe(args) => probe::run(&args),
        Command::Config(args) => config::run(&args),
        Command::Profiles(args) => lists::profiles(&args),
        Command::Worlds(command) => lists::worlds(&command),
        Command::Parameters(args) => parameters::run(&args),
        Command::Completions(args) => completions::completions(&args),
        Command::Man(args) => completions::man(&args, command()),
        Command::Version => output::print(&command().render_version()),
    };
    let (error, code) = match done {
        Ok(()) => return ExitCode::SUCCESS,
        Err(Failure::Usage(error)) => (error, 2),
        Err(Failure::Interrupted(error)) => (error, INTERRUPTED),
        Err(Failure::Other(error)) => (error, 1),
    };
    if error.is::<output::ReaderLeft>() {
        return ExitCode::SUCCESS;
    }
    eprintln!("error: {}", in_full(&error));
    ExitCode::from(code)
}

/// Examples of commands, a line each, which end their long help.
const EXAMPLES: &str = include_str!("examples.txt");

fn command() -> clap::Command {
    Cli::command().mut_subcommands(|command| {
        let name = command.get_name();
        let own = EXAMPLES
            .lines()
            .filter(|line| line.split(' ').nth(1) == Some(name));
        let text: String = own.map(|line| format!("\n  {line}")).collect();
        match text.is_empty() {
            true => command,
            false => command.after_long_help(format!("Examples:{text}")),
        }
    })
}

/// The commands, whose flags know what they take.
fn built() -> clap::Command {
    let mut command = command();
    command.build();
    command
}

/// Arguments in which values that begin with a minus, as half of all ids do, are joined to their options: clap takes
/// them for flags. What may be a flag by mistake, --word or -w, stays one.
fn joined(mut command: &clap::Command, given: impl IntoIterator<Item = OsString>) -> Vec<OsString> {
    let mut all: Vec<OsString> = vec![];
    let mut open = false;
    for argument in given {
        let text = argument.to_string_lossy();
        let is_value = match text.as_bytes() {
            [b'-'] | [b'-', b'-', ..] => false,
            [b'-', letter] => !letter.is_ascii_alphabetic(),
            [b'-', ..] => true,
            _ => false,
        };
        if let Some(option) = all.last_mut().filter(|_| open && is_value) {
            option.push("=");
            option.push(&argument);
            open = false;
            continue;
        }
        let takes = |name: &str| {
            let is_it = |arg: &&clap::Arg| {
                arg.get_long_and_visible_aliases()
                    .is_some_and(|all| all.contains(&name))
                    || arg.get_all_aliases().is_some_and(|all| all.contains(&name))
            };
            let range = command.get_arguments().find(is_it)?.get_num_args()?;
            Some(range.min_values() > 0)
        };
        open = text.strip_prefix("--").and_then(takes) == Some(true);
        command = command.find_subcommand(&argument).unwrap_or(command);
        all.push(argument);
    }
    all
}

/// The text of an error and of its causes, each once.
fn in_full(error: &anyhow::Error) -> String {
    error.chain().fold(String::new(), |text, cause| {
        let cause = cause.to_string();
        if text.is_empty() {
            cause
        } else if text.contains(&cause) {
            text
        } else {
            format!("{text}: {cause}")
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The options of a command and of those in it, with the words that lead there.
    fn options(command: &clap::Command, words: &[String], all: &mut Vec<(Vec<String>, String)>) {
        for arg in command.get_arguments() {
            let takes = arg
                .get_num_args()
                .is_some_and(|range| range.min_values() > 0);
            if let (Some(long), true) = (arg.get_long(), takes) {
                all.push((words.to_vec(), format!("--{long}")));
            }
        }
        for inner in command.get_subcommands() {
            options(inner, &[words, &[inner.get_name().into()]].concat(), all);
        }
    }

    #[test]
    fn the_value_of_any_option_may_begin_with_a_minus() {
        let (command, mut all) = (built(), vec![]);
        options(&command, &["strew".into()], &mut all);
        assert!(all.len() > 100, "{}", all.len());
        for (words, option) in all {
            let with = |value: &str| -> Vec<OsString> {
                let line = words.iter().map(String::as_str).chain([&*option, value]);
                let joined = joined(&command, line.map(OsString::from));
                joined[words.len()..].to_vec()
            };
            for value in ["-1:-4", "-1,-1,0,0", "-0.5", "-.5", "-7", "-oak", "-3=10"] {
                assert_eq!(with(value), [&*format!("{option}={value}")], "{words:?}");
            }
            // A forgotten value is found out by the flag in its place.
            for flag in ["--spacing", "-q", "--", "-"] {
                assert_eq!(with(flag), [&*option, flag], "{words:?}");
            }
        }
        let line = [
            "sample",
            "--bbox=-1,-1,0,0",
            "--except",
            "-1:-4",
            "--spacing",
            "1",
        ];
        let line = ["strew"].iter().chain(&line).map(OsString::from);
        assert!(Cli::try_parse_from(joined(&command, line)).is_ok());
    }

    /// The words of a line; quotes hold one together, and what follows > or | is not ours.
    fn words(line: &str) -> Vec<String> {
        let line = line.split(['>', '|']).next().unwrap_or_default();
        let parts = line.split('"').enumerate();
        let words = parts.flat_map(|(i, part)| match i % 2 {
            1 => vec![part.to_owned()],
            _ => part.split_whitespace().map(Into::into).collect(),
        });
        words.collect()
    }

    #[test]
    fn every_command_has_examples_that_it_accepts() {
        let commands = command();
        let shown = commands
            .get_subcommands()
            .filter(|command| !command.is_hide_set());
        for command in shown {
            let help = command.get_after_long_help().map(ToString::to_string);
            let help = help.unwrap_or_else(|| panic!("{} has no examples", command.get_name()));
            for line in help.lines().skip(1) {
                let given = joined(&built(), words(line).into_iter().map(OsString::from));
                let taken = built().try_get_matches_from(given);
                let taken = taken.unwrap_or_else(|error| panic!("{line}: {error}"));
                assert_eq!(taken.subcommand_name(), Some(command.get_name()), "{line}");
            }
        }
    }
}
