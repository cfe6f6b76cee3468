//! `strew serve`.

use std::{
    io::Write as _,
    net::{SocketAddr, TcpListener},
};

use anyhow::{Context as _, anyhow};
use strew_config::LogOutput;

use super::{Failure, config};
use crate::{
    ops::{App, memory, shutdown, startup, telemetry},
    rest::Pages,
};

pub(super) fn run(args: &config::Served, pages: fn() -> Pages) -> Result<(), Failure> {
    let mut config = args.merged()?;
    telemetry::start(&config.log).context("log.filter")?;
    memory::fit(&mut config);
    // A container's share of the processors counts, not all that the machine has.
    let threads = match config.workers.threads {
        0 => std::thread::available_parallelism().map_or(1, usize::from),
        threads => threads,
    };
    let listen = config.server.listen;
    let admin = config
        .admin
        .address()
        .map_err(|problem| anyhow!("admin.listen: {problem}"))?;
    for warning in [startup::warning(&config), startup::readable_keys(&config)]
        .into_iter()
        .flatten()
    {
        tracing::warn!("{warning}");
    }
    let wanted = config.server.max_connections;
    if let Some(room) = startup::make_room(wanted) {
        tracing::warn!(
            wanted,
            room,
            "the system's limit on open files has no room for server.max_connections"
        );
    }
    let scheme = if config.tls.is_on() { "https" } else { "http" };
    let announced = (config.log.output == LogOutput::Stderr).then_some(scheme);
    let mut app = App::new(config).map_err(Failure::Usage)?;
    if app.service().catalog().tables().len() == 0 {
        tracing::warn!("no table is loaded: every query will be refused");
    }
    let listener = bind(listen)?;
    app.pages = pages();
    app.admin = admin.map(bind).transpose()?;
    let runtime = tokio::runtime::Builder::new_multi_thread()
        .enable_all()
        .build()
        .context("cannot start the runtime")?;
    let served = runtime.block_on(serve(app, listener, announced, threads));
    // A thread that waits for a hanging file system must not keep the process.
    runtime.shutdown_timeout(LAST_WORK);
    Ok(served?)
}

/// The time for work that still runs when the daemon has stopped.
const LAST_WORK: std::time::Duration = std::time::Duration::from_secs(1);

fn bind(listen: SocketAddr) -> anyhow::Result<TcpListener> {
    TcpListener::bind(listen).map_err(|error| match error.kind() {
        std::io::ErrorKind::AddrInUse => anyhow!(
            "cannot listen on {listen}: the port is in use; choose another with --listen, or 0 \
             for any free one"
        ),
        _ => anyhow!("cannot listen on {listen}: {error}"),
    })
}

async fn serve(
    mut app: App,
    listener: TcpListener,
    announced: Option<&str>,
    threads: usize,
) -> anyhow::Result<()> {
    let address = listener.local_addr().context("no address")?;
    // Listen for signals before announcing the address.
    let stop = shutdown::Signals::new().context("cannot listen for signals")?;
    let hangups = shutdown::Hangups::new().context("cannot listen for signals")?;
    app.hangups = Some(hangups);
    if let Some(scheme) = announced {
        announce(scheme, address, app.admin_address())
            .context("cannot write to standard output")?;
    }
    let tables = app.service().catalog().tables().len();
    tracing::info!(%address, tables, threads, "serving");
    let broken = app.run(listener, stop.first_then_exit()).await?;
    if broken > 0 {
        tracing::warn!(broken, "stopped; some streams were broken off");
    } else {
        tracing::info!("stopped");
    }
    Ok(())
}

fn announce(scheme: &str, address: SocketAddr, admin: Option<SocketAddr>) -> std::io::Result<()> {
    let mut text = format!("listening on {scheme}://{address}\n");
    if let Some(admin) = admin {
        text += &format!("administrators on {scheme}://{admin}\n");
    }
    // In one write, for readers that take only the first line.
    let mut out = std::io::stdout().lock();
    out.write_all(text.as_bytes())?;
    out.flush()
}
