//! `--url`: a server answers the query of a command.
//!
//! The flags become the body that they would be in a file, and the answer is written as it comes. What the server
//! refuses is shown in its words. An answer that is cut off is an error, and leaves no file.

mod http;
mod shown;
mod tally;

use std::{
    io::{ErrorKind, Read as _},
    net::IpAddr,
    path::PathBuf,
    time::{Duration, Instant},
};

use anyhow::{Context as _, anyhow, bail};
use serde_json::{Map, Value};

use self::{http::Answer, shown::shown, tally::Tally};
use super::{
    Failure,
    output::Output,
    probe::{OVER_HTTP, TrustArgs, connect, explained, host},
};
use crate::{bounded_file, service::Encoding};

/// Flags of a server that answers instead of this program.
#[derive(Debug, clap::Args)]
pub(super) struct RemoteArgs {
    /// Let the daemon at this address answer, such as http://127.0.0.1:8080, or https://strew.example with --ca: its
    /// tables, fields, worlds, lists and limits count.
    #[arg(long, value_name = "URL", conflicts_with_all = ["config", "tables", "set"])]
    url: Option<String>,
    /// A file with the key for that daemon [default: the key in the variable STREW_API_KEY, if it is set]
    #[arg(long, value_name = "FILE", requires = "url", hide_short_help = true)]
    key_file: Option<PathBuf>,
    #[command(flatten)]
    trust: TrustArgs,
}

/// The variable with a key.
const KEY: &str = "STREW_API_KEY";
/// The most bytes of a file with a key.
const MOST_KEY: u64 = 64 << 10;
/// How long a connection may take, and how long an answer may pause.
const PATIENCE: Duration = Duration::from_secs(60);
/// More than any problem document.
const MOST_BYTES: u64 = 1 << 20;

impl RemoteArgs {
    /// Whether a server is to answer. Without one, flags of a connection mean nothing.
    pub(super) fn is_given(&self) -> Result<bool, Failure> {
        if self.url.is_none() {
            let unused = self.trust.must_be_unused("there is no --url");
            unused.map_err(Failure::Usage)?;
        }
        Ok(self.url.is_some())
    }

    /// The answer of the server to a body.
    pub(super) fn request(&self, path: &str, body: &Map<String, Value>) -> Result<Answer, Failure> {
        let url = self.url.as_deref().unwrap_or_default();
        let usage = Failure::Usage;
        let (is_tls, host) = host(url).map_err(usage)?;
        let trust = match is_tls {
            true => self.trust.trust(&host, false).map(Some),
            false => self.trust.must_be_unused(OVER_HTTP).map(|()| None),
        };
        let trust = trust.map_err(usage)?;
        let key = self.key().map_err(usage)?;
        if key.is_some() && !is_tls && !is_here(&host) {
            eprintln!("warning: {url}: the key is sent unencrypted; allowed: https, with --ca");
        }
        let text = Value::Object(body.clone()).to_string();
        let response = connect(&host, Instant::now() + PATIENCE).and_then(|stream| {
            stream.set_read_timeout(Some(PATIENCE))?;
            stream.set_write_timeout(Some(PATIENCE))?;
            http::post(
                stream,
                trust,
                (&host, path),
                key.as_deref(),
                text.as_bytes(),
            )
        });
        let response = response.map_err(|error| explained(error, PATIENCE));
        let mut answer = response.with_context(|| format!("{url}{path}"))?;
        if answer.status == 200 {
            return Ok(answer);
        }
        let problem = problem(&mut answer).with_context(|| format!("{url}{path}"))?;
        let error = anyhow!("{url}{path}: status {}: {problem}", answer.status);
        Err(match answer.status {
            400 | 404 | 409 | 413 => Failure::Usage(error),
            _ => Failure::Other(error),
        })
    }

    /// The key to show, if there is one.
    fn key(&self) -> anyhow::Result<Option<String>> {
        let (source, key) = match &self.key_file {
            Some(file) => {
                let text = bounded_file::read_text(file, MOST_KEY);
                let text = text.with_context(|| format!("--key-file {}", file.display()))?;
                (format!("--key-file {}", file.display()), text)
            }
            None => match std::env::var(KEY) {
                Ok(key) => (KEY.into(), key),
                Err(_) => return Ok(None),
            },
        };
        let key = key.trim();
        if key.is_empty() || !key.bytes().all(|byte| byte.is_ascii_graphic()) {
            bail!("{source}: holds no key; allowed: one line of what `strew key new` prints");
        }
        Ok(Some(key.into()))
    }
}

/// Whether a host, with its port, is this machine by its name.
fn is_here(host: &str) -> bool {
    let name = host.rsplit_once(':').map_or(host, |(name, _)| name);
    let address = name.trim_matches(['[', ']']).parse::<IpAddr>();
    name == "localhost" || address.is_ok_and(|address| address.is_loopback())
}

/// The text of a refusal.
fn problem(answer: &mut Answer) -> anyhow::Result<String> {
    let mut text = vec![];
    (&mut answer.body).take(MOST_BYTES).read_to_end(&mut text)?;
    let document: Option<Value> = serde_json::from_slice(&text).ok();
    let member = |name: &str| Some(document.as_ref()?.get(name)?.as_str()?.to_owned());
    Ok(shown(&match (member("title"), member("detail")) {
        (Some(title), Some(detail)) => format!("{title}: {detail}"),
        (None, Some(text)) | (Some(text), None) => text,
        (None, None) => String::from_utf8_lossy(&text).trim().to_owned(),
    }))
}

/// The points that the head of an answer promises.
pub(super) fn promised(answer: &Answer) -> Result<u64, Failure> {
    let count = answer.header(COUNT).ok_or_else(|| {
        let problem =
            "the answer has no header strew-count; allowed: the address of a strew daemon";
        anyhow!("--url: {problem}")
    })?;
    let number = count.parse().map_err(|_| {
        let count = shown(count);
        anyhow!("the answer has the header strew-count: {count}; allowed: a number")
    });
    Ok(number?)
}

/// Writes the body of an answer as it comes. Fails if it does not hold the points that its head promises.
pub(super) fn write(
    mut answer: Answer,
    (count, encoding): (u64, Encoding),
    mut output: Output,
) -> Result<(), Failure> {
    let mut tally = Tally::new(encoding, answer.header("strew-columns"));
    let mut part = vec![0; 1 << 16];
    loop {
        let read = match answer.body.read(&mut part) {
            Err(error) if error.kind() == ErrorKind::Interrupted => continue,
            read => read.map_err(|error| explained(error.into(), PATIENCE)),
        };
        let read = read.context("the answer broke off")?;
        if read == 0 {
            break;
        }
        tally.add(&part[..read]);
        output.write(&part[..read])?;
    }
    tally.check(count).map_err(|held| {
        anyhow!("the answer holds {held}, and its header strew-count says {count}: it is not whole")
    })?;
    Ok(output.finish()?)
}

/// The header with the number of points.
const COUNT: &str = "strew-count";

/// Announces the answer on standard error.
pub(super) fn announce(answer: &Answer, format: &str) {
    let header = |name: &str| answer.header(name).map(shown);
    eprintln!("{} points as {format}", header(COUNT).unwrap_or("?".into()));
    for (name, text) in [
        ("strew-next", "the rest begins at the cursor "),
        ("strew-origin", "coordinates are relative to the origin "),
        ("strew-columns", "columns: "),
        ("strew-warning", "warning: "),
    ] {
        if let Some(value) = header(name) {
            eprintln!("{text}{value}");
        }
    }
}
