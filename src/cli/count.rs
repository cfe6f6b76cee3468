//! `strew count`: how many points a query has, exactly, without making them.

use std::io::Read as _;

use anyhow::Context as _;
use serde::{Deserialize, Serialize};
use serde_json::value::RawValue;

use super::{Failure, config, flags::Counted, output, query::QueryArgs, remote::RemoteArgs};
use crate::service::query::Resolved;

/// More than the answer with any query as understood.
const MOST_BYTES: u64 = 16 << 20;

/// Flags of `strew count`.
#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// Print the document of GET /v1/count instead: the count and the query as understood.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    query: QueryArgs<Counted>,
    #[command(flatten)]
    remote: RemoteArgs,
}

/// The answer of a server.
#[derive(Deserialize)]
struct FromServer {
    count: u128,
}

#[derive(Serialize)]
struct Document {
    count: u128,
    query: Resolved,
}

/// Counts.
pub(super) fn run(args: &Args) -> Result<(), Failure> {
    if args.remote.is_given()? {
        return from_server(args);
    }
    let config = args.query.settings.merged(config::Uses::QUERIES)?;
    let planned = args.query.plan(&config)?.planned;
    let count = planned.count();
    if args.json {
        let query = planned.resolved();
        return output::print_json([Document { count, query }]);
    }
    output::print(&format!("{count}\n"))
}

/// Prints the count of a server.
fn from_server(args: &Args) -> Result<(), Failure> {
    let body = args.query.for_server()?.to_body();
    let mut answer = args.remote.request("/v1/count", &body)?;
    let mut text = String::new();
    let read = (&mut answer.body)
        .take(MOST_BYTES)
        .read_to_string(&mut text);
    read.context("the answer broke off")?;
    if args.json {
        let document: Box<RawValue> =
            serde_json::from_str(&text).context("the answer is not JSON")?;
        return output::print(&format!("{document}\n"));
    }
    let counted: FromServer = serde_json::from_str(&text).context("the answer holds no count")?;
    output::print(&format!("{}\n", counted.count))
}
