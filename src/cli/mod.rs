//! The command line.

mod arrangement;
mod candidates;
mod client;
mod completions;
mod compression;
mod config;
mod count;
mod examples;
mod export;
mod failure;
mod fields;
mod figure;
mod flags;
mod forge;
mod key;
mod load;
mod mask;
mod measure;
mod output;
mod parameters;
mod periods;
mod point;
mod probe;
mod profiles;
mod progress;
mod query;
mod refusal;
mod remote;
mod sample;
mod serve;
mod signals;
mod split;
mod stipple;
mod strata;
mod table;
mod threads;
mod watcher;
mod worlds;

use std::process::ExitCode;

use clap::{CommandFactory as _, Parser, Subcommand};
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
    #[command(after_long_help = examples::SERVE)]
    Serve(config::Served),
    /// Write the points of a region to a file or standard output, without a server.
    #[command(after_long_help = examples::SAMPLE)]
    Sample(sample::Args),
    /// Write a world as files of chunks, which any static server can serve, or as one archive.
    #[command(after_long_help = examples::EXPORT)]
    Export(export::Args),
    /// Turn a picture into dots.
    #[command(after_long_help = examples::STIPPLE)]
    Stipple(stipple::Args),
    /// Count the points of a query, exactly, without making them.
    #[command(after_long_help = examples::COUNT)]
    Count(count::Args),
    /// Find a point by its id.
    #[command(after_long_help = examples::POINT)]
    Point(point::PointArgs),
    /// List the sizes of periodic sets.
    #[command(after_long_help = examples::PERIODS)]
    Periods(periods::Args),
    /// Find the points nearest to a place.
    #[command(after_long_help = examples::NEAREST)]
    Nearest(point::NearestArgs),
    /// Split a query into parts for parallel readers.
    #[command(after_long_help = examples::SPLIT)]
    Split(split::Args),
    /// Find out whether an arrangement of points occurs in a pattern, how often, and where.
    #[command(after_long_help = examples::ARRANGEMENT)]
    Arrangement(arrangement::Args),
    /// Draw a figure of an AA pattern: its index space, an arrangement, clusters, a neighborhood map.
    #[command(subcommand, after_long_help = examples::FIGURE)]
    Figure(figure::Command),
    /// Make a tileable threshold mask for dithering.
    #[command(after_long_help = examples::MASK)]
    Mask(mask::Args),
    /// Make a table and judge it.
    #[command(after_long_help = examples::FORGE)]
    Forge(forge::Args),
    /// Measure a table, the points of a region, or a file of points.
    #[command(after_long_help = examples::MEASURE)]
    Measure(measure::Args),
    /// Inspect, check, export and import tables.
    #[command(subcommand, after_long_help = examples::TABLE)]
    Table(table::Command),
    /// Make keys for clients.
    #[command(subcommand, after_long_help = examples::KEY)]
    Key(key::Command),
    /// Ask a running daemon whether it is ready: exit code 0 if so, 1 if not.
    #[command(after_long_help = examples::PROBE)]
    Probe(probe::Args),
    /// Print the merged settings.
    #[command(after_long_help = examples::CONFIG)]
    Config(config::Served),
    /// List the loaded tables: profiles, α, sizes of maps.
    #[command(after_long_help = examples::PROFILES)]
    Profiles(config::Args),
    /// List and check worlds: queries that the settings describe by name.
    #[command(subcommand, after_long_help = examples::WORLDS)]
    Worlds(worlds::Command),
    /// Print the table of parameters as types for programs, or as documentation.
    #[command(after_long_help = examples::PARAMETERS)]
    Parameters(parameters::Args),
    /// Print a script that lets a shell complete commands and flags.
    #[command(after_long_help = examples::COMPLETIONS)]
    Completions(completions::CompletionsArgs),
    /// Write manual pages.
    #[command(after_long_help = examples::MAN)]
    Man(completions::ManArgs),
    /// Print the version, as `--version` does.
    #[command(hide = true)]
    Version,
}

/// The exit code after an interrupt, as shells have it.
const INTERRUPTED: u8 = 130;

/// Runs the program, whose daemon serves these pages.
#[must_use]
pub fn main(pages: fn() -> Pages) -> ExitCode {
    // Shells run the program with COMPLETE=SHELL to complete a line.
    CompleteEnv::with_factory(Cli::command).complete();
    let done = match Cli::parse().command {
        Command::Serve(args) => serve::run(&args, pages),
        Command::Sample(args) => sample::run(&args),
        Command::Export(args) => export::run(&args),
        Command::Stipple(args) => stipple::run(&args),
        Command::Count(args) => count::run(&args),
        Command::Point(args) => point::point(&args),
        Command::Periods(args) => periods::run(&args),
        Command::Nearest(args) => point::nearest(&args),
        Command::Split(args) => split::run(&args),
        Command::Arrangement(args) => arrangement::run(&args),
        Command::Figure(command) => figure::run(&command),
        Command::Mask(args) => mask::run(&args),
        Command::Forge(args) => forge::run(&args),
        Command::Measure(args) => measure::run(&args),
        Command::Table(command) => table::run(&command),
        Command::Key(command) => key::run(&command),
        Command::Probe(args) => probe::run(&args),
        Command::Config(args) => config::run(&args),
        Command::Profiles(args) => profiles::run(&args),
        Command::Worlds(command) => worlds::run(&command),
        Command::Parameters(args) => parameters::run(&args),
        Command::Completions(args) => completions::completions(&args),
        Command::Man(args) => completions::man(&args, Cli::command()),
        Command::Version => output::print(&Cli::command().render_version()),
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
