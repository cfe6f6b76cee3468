//! `strew count`: the number of points of a query, exactly, without making them.

use anyhow::{Context as _, anyhow};
use serde::{Deserialize, Serialize};
use serde_json::value::RawValue;
use strew_error::integer::{Long, integer};
use strew_query::Resolved;

use super::{Failure, config, flags::Counted, output, query::QueryArgs, remote::RemoteArgs};

/// No answer is longer, even with the longest query in it.
const MOST_BYTES: usize = 16 << 20;

/// Flags of `strew count`.
#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// Print the document of GET /v1/count instead: the count, and the query with everything filled in.
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
    /// A number, or text if it is long.
    count: Box<RawValue>,
}

#[derive(Serialize)]
struct Document {
    count: Long<u128>,
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
        return output::print_json([Document {
            count: Long(count),
            query,
        }]);
    }
    output::print(&format!("{count}\n"))
}

/// Prints the count that a server returns.
fn from_server(args: &Args) -> Result<(), Failure> {
    let body = args.query.for_server()?.to_body();
    let mut answer = args
        .remote
        .request(args.query.path("/v1/count", "/v1/space/count"), &body)?;
    let text = answer.rest(MOST_BYTES).context("the answer broke off")?;
    if args.json {
        let document: Box<RawValue> =
            serde_json::from_slice(&text).context("the answer is not JSON")?;
        return output::print(&format!("{document}\n"));
    }
    let counted: FromServer = serde_json::from_slice(&text).context("the answer holds no count")?;
    let count = counted.count.get().trim_matches('"');
    let count: u128 = integer(count).map_err(|detail| anyhow!("the count {detail}"))?;
    output::print(&format!("{count}\n"))
}
