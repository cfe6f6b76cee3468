//! `strew probe`: asks a daemon whether it is alive or takes requests, for health checks of containers
//! that hold no other program.

use std::time::Duration;

use anyhow::{Context as _, anyhow};
use http::Request;

use super::{
    Failure,
    client::{Address, TrustArgs, send},
    config, must_be_within,
};

/// Flags of `strew probe`.
#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// Where the daemon is, such as http://127.0.0.1:8080 or https://strew.example [default: where the settings say
    /// that it listens, over TLS if they say so]
    #[arg(long, value_name = "URL")]
    url: Option<String>,
    /// Ask whether it takes requests (/readyz). This is the default.
    #[arg(long, conflicts_with = "live")]
    ready: bool,
    /// Ask only whether it is alive (/livez).
    #[arg(long)]
    live: bool,
    /// The longest time for an answer, in seconds.
    #[arg(long, value_name = "SECONDS", default_value = "2")]
    timeout: f64,
    #[command(flatten)]
    trust: TrustArgs,
    #[command(flatten)]
    settings: config::Served,
}

/// Succeeds if the daemon answers with status 200.
pub(super) fn run(args: &Args) -> Result<(), Failure> {
    must_be_within("--timeout", args.timeout, [0.001, 3600.0])?;
    let timeout = Duration::from_secs_f64(args.timeout);
    let address = match &args.url {
        Some(url) => {
            args.settings.must_be_unused("--url has the address")?;
            Address::read(url)
        }
        None => {
            let settings = args.settings.merged()?;
            Address::of_listener(settings.server.listen, settings.tls.is_on())
        }
    };
    let address = address.map_err(Failure::Usage)?;
    let tls = args.trust.tls(&address, args.url.is_none());
    let tls = tls.map_err(Failure::Usage)?;
    let (path, wanted) = match args.live {
        true => ("/livez", "alive"),
        false => ("/readyz", "ready"),
    };
    let url = format!("{address}{path}");
    let answer = send(&address, tls, Request::get(path), vec![], timeout);
    match answer.with_context(|| url.clone())?.head.status.as_u16() {
        200 => Ok(()),
        status => Err(anyhow!("{url}: not {wanted}: status {status}").into()),
    }
}
