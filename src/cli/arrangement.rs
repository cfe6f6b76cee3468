//! `strew arrangement`: finds out whether a set of offsets occurs in a pattern, how often, and where.
//!
//! The flags are the parameters of GET /v1/pattern/arrangements, and so are the answers.

use strew_error::Error;
use strew_plan::Placed;
use strew_service::pattern::{ArrangementQuery, Listing};

use super::{
    Failure, config,
    flags::{Arranged, Flags},
    output::{self, Output},
    refusal::Source,
};
use crate::cli::load::Load as _;

/// Flags of `strew arrangement`.
#[derive(Debug, clap::Args)]
pub(super) struct Args {
    #[command(flatten)]
    flags: Flags<Arranged>,
    #[command(flatten)]
    settings: config::Args,
}

/// Prints the facts, or the occurrences.
pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let refused = |error: Error| Source::Flags.refused(error);
    let config = args.settings.merged(config::Uses::LISTS)?;
    let query =
        ArrangementQuery::check(&args.flags.values(), &config.tables()?).map_err(refused)?;
    let facts = query.facts();
    let Some(list) = query.list else {
        return output::print_json([facts]);
    };
    let places = query
        .set
        .clone()
        .map(Placed::at_once)
        .transpose()
        .map_err(refused)?;
    let listing = Listing::new(&query, places, config.limits.max_points).map_err(refused)?;
    let cursor = listing.cursor();
    let mut output = Output::open(None)?;
    for block in listing.text(list, &facts) {
        output.write(&block.map_err(refused)?)?;
    }
    output.finish()?;
    if let Some(cursor) = cursor {
        eprintln!("the rest: --cursor {cursor}");
    }
    Ok(())
}
