//! `strew forge`: makes a table, judges it, writes it; kinds for a table.

mod mix;
mod space;
mod table;
mod work;

use self::work::{Checkpoints, Work};
use super::Failure;

/// Flags of `strew forge`. Equal jobs make equal tables, bit by bit, on every machine.
///
/// At intervals and on an interrupt, the forge writes a checkpoint beside the table, under its name
/// with `.checkpoint` added. The same command resumes from it, to the same table as without the
/// interruption, and removes it when the table is written.
#[derive(Debug, clap::Args)]
#[command(args_conflicts_with_subcommands = true)]
pub(super) struct Args {
    #[command(subcommand)]
    task: Option<Task>,
    #[command(flatten)]
    table: table::TableArgs,
    /// Steps of the optimizer [default: the profile's].
    #[arg(long)]
    steps: Option<u32>,
    #[command(flatten)]
    work: Work,
    #[command(flatten)]
    checkpoints: Checkpoints,
}

/// Other work of the forge.
#[derive(Debug, clap::Subcommand)]
enum Task {
    /// Make kinds for a table: each of its points is of one kind, and each kind is evenly spread.
    Mix(mix::Args),
}

/// Makes the table or kinds.
pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let Args { work, steps, .. } = args;
    match &args.task {
        Some(Task::Mix(args)) => mix::run(args),
        None => table::run(&args.table, *steps, work, &args.checkpoints),
    }
}
