//! `strew count`: how many points a query has, exactly, without making them.

use serde::Serialize;

use super::{Failure, flags::Counted, output, query::QueryArgs};
use crate::service::query::Resolved;

/// Flags of `strew count`.
#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// Print the document of GET /v1/count instead: the count and the query as understood.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    query: QueryArgs<Counted>,
}

#[derive(Serialize)]
struct Document {
    count: u128,
    query: Resolved,
}

/// Counts.
pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let config = args.query.settings.merged()?;
    let planned = args.query.plan(&config)?.planned;
    let count = planned.count();
    if args.json {
        let query = planned.resolved();
        return output::print_json([Document { count, query }]);
    }
    output::print(&format!("{count}\n"))
}
