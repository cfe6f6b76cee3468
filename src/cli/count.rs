//! `strew count`: the number of points of a query, exactly, without making them.

use serde::Serialize;
use strew_error::integer::Long;
use strew_query::Resolved;

use super::{Failure, config, flags::Counted, output, query::QueryArgs};

/// Flags of `strew count`.
#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// Print the document of GET /v1/count instead: the count, and the query with everything filled in.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    query: QueryArgs<Counted>,
}

#[derive(Serialize)]
struct Document {
    count: Long<u128>,
    query: Resolved,
}

/// Counts.
pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let config = args.query.settings.merged(config::Uses::QUERIES)?;
    let planned = args.query.plan(&config)?.planned;
    let count = planned.count();
    if args.json {
        let query = planned.resolved();
        return output::print_json([Document {
            count: Long(count),
            query,
        }]);
    }
    output::print(&format!("{count}\n"))
}
