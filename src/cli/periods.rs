//! `strew periods`: lists the sizes of the periodic sets of a table.

use strew_query::Periods;

use super::{
    Failure, config,
    flags::{Flags, Listed},
    output,
    refusal::Source,
};
use crate::cli::load::Load as _;

/// Flags of `strew periods`.
#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// Print the document of GET /v1/periods instead: the list with its table.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    flags: Flags<Listed>,
    #[command(flatten)]
    settings: config::Args,
}

/// Prints the periods, one a line.
pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let config = args.settings.merged(config::Uses::LOADED)?;
    let found = Periods::of(&args.flags.values(), &config.tables()?);
    let found = found.map_err(|error| Source::Flags.refused(error))?;
    if args.json {
        return output::print_json([found]);
    }
    output::print_json(found.periods)
}
