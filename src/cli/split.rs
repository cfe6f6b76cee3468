//! `strew split`: splits a query into parts, each a query for `strew sample --query -`.

use serde::Serialize;
use serde_json::{Map, Value};
use strew_query::{Token, groups, parts};

use super::{Failure, config, flags::Parted, output, query::QueryArgs, refusal::Source};

/// Flags of `strew split`: those of `strew sample`, and the number of parts.
#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// Print the document of POST /v1/points:split instead: the parts with their counts.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    query: QueryArgs<Parted>,
}

#[derive(Serialize)]
struct Document {
    count: u128,
    parts: Vec<Part>,
}

#[derive(Serialize)]
struct Part {
    count: u64,
    query: Map<String, Value>,
}

/// Prints the parts, a query a line.
pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let config = args.query.settings.merged(config::Uses::QUERIES)?;
    let parts = parts(&args.query.flags.values_of(groups::SPLIT));
    let parts = parts.map_err(|faults| Source::Flags.refused(faults.into()))?;
    let ask = args.query.plan(&config)?;
    let part = |(token, count): (Token, u64)| Part {
        count,
        query: ask.draft.part(&token, count).to_body(),
    };
    let count = ask.planned.count();
    let split = ask.planned.split(parts);
    let split = split.map_err(|error| ask.source.refused(error))?;
    let parts: Vec<Part> = split.into_iter().map(part).collect();
    if args.json {
        return output::print_json([Document { count, parts }]);
    }
    output::print_json(parts.into_iter().map(|part| part.query))
}
