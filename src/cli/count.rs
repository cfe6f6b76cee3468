//! `strew count`: the number of points of a query, exactly, without making them; and `strew split`: its parts, each a
//! query for `strew sample --query -`.

use strew_error::integer::Long;
use strew_query::{Token, groups, parts};

use super::{
    Failure, config,
    failure::refused,
    flags::{Counted, Parted},
    output,
    query::QueryArgs,
};
use crate::rest::{Count, Piece, Split};

/// Flags of `strew count`.
#[derive(Debug, clap::Args)]
pub(super) struct CountArgs {
    /// Print the document of GET /v1/count instead: the count, and the query with everything filled in.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    query: QueryArgs<Counted>,
}

pub(super) fn count(args: &CountArgs) -> Result<(), Failure> {
    let config = args.query.settings.merged(config::Uses::QUERIES)?;
    let planned = args.query.plan(&config)?.planned;
    let count = planned.count();
    if args.json {
        let query = planned.resolved();
        return output::print_json([Count {
            count: Long(count),
            query,
        }]);
    }
    output::print(&format!("{count}\n"))
}

/// Flags of `strew split`: those of `strew sample`, and the number of parts.
#[derive(Debug, clap::Args)]
pub(super) struct SplitArgs {
    /// Print the document of POST /v1/points:split instead: the parts with their counts.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    query: QueryArgs<Parted>,
}

/// Prints the parts, a query a line.
pub(super) fn split(args: &SplitArgs) -> Result<(), Failure> {
    let config = args.query.settings.merged(config::Uses::QUERIES)?;
    let parts = parts(&args.query.flags.values_of(groups::SPLIT));
    let parts = parts.map_err(refused)?;
    let ask = args.query.plan(&config)?;
    let part = |(token, count): (Token, u64)| Piece {
        count: Long(count),
        query: ask.draft.part(&token, count).to_body(),
    };
    let count = ask.planned.count();
    let split = ask.planned.split(parts);
    let split = split.map_err(|error| ask.source.refused(error))?;
    let parts: Vec<Piece> = split.into_iter().map(part).collect();
    if args.json {
        return output::print_json([Split {
            count: Long(count),
            parts,
        }]);
    }
    output::print_json(parts.into_iter().map(|part| part.query))
}
