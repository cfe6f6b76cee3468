//! `--url`: a server answers the query of a command.
//!
//! The flags are sent as the JSON body of a query, and the answer is written as it arrives. Refusals are shown in
//! the server's words. An answer that breaks off is an error and leaves no file.

mod shown;
mod tally;

use std::{path::PathBuf, time::Duration};

use anyhow::{Context as _, anyhow, bail, ensure};
use http::{Request, header};
use serde_json::{Map, Value};
use strew_config::bounded_file;
use strew_encode::Encoding;

use self::{shown::shown, tally::Tally};
use super::{
    Failure,
    client::{Address, Answer, TrustArgs, send},
    output::Output,
};

/// Flags that let a server answer instead of this program.
#[derive(Debug, clap::Args)]
pub(super) struct RemoteArgs {
    /// Send the query to the daemon at this address, such as http://127.0.0.1:8080, or https://strew.example with
    /// --ca. Its tables, fields, worlds, lists and limits apply.
    #[arg(long, value_name = "URL", conflicts_with_all = ["config", "tables", "set"])]
    url: Option<String>,
    /// A file with the key for that daemon [default: the variable STREW_API_KEY]
    #[arg(long, value_name = "FILE", requires = "url", hide_short_help = true)]
    key_file: Option<PathBuf>,
    #[command(flatten)]
    trust: TrustArgs,
}

/// The environment variable with a key.
const KEY: &str = "STREW_API_KEY";
/// The most bytes of a file with a key.
const MOST_KEY: u64 = 64 << 10;
/// The longest time until an answer begins, and the longest pause within it.
const PATIENCE: Duration = Duration::from_secs(60);
/// The bytes per second that even a slow network can send: a longer query has more time.
const SLOWEST: u64 = 16 << 10;
/// No problem document is longer.
const MOST_BYTES: usize = 1 << 20;

impl RemoteArgs {
    /// Whether a server shall answer. Refuses flags of a connection without a server.
    pub(super) fn is_given(&self) -> Result<bool, Failure> {
        if self.url.is_none() {
            let unused = self.trust.must_be_unused("there is no --url");
            unused.map_err(Failure::Usage)?;
        }
        Ok(self.url.is_some())
    }

    /// Sends a body to a path of the server, and returns its answer.
    pub(super) fn request(&self, path: &str, body: &Map<String, Value>) -> Result<Answer, Failure> {
        let usage = Failure::Usage;
        let address = Address::read(self.url.as_deref().unwrap_or_default()).map_err(usage)?;
        let tls = self.trust.tls(&address, false).map_err(usage)?;
        let key = self.key().map_err(usage)?;
        if key.is_some() && !address.is_tls && !address.is_here() {
            eprintln!("warning: {address}: the key is sent unencrypted; allowed: https, with --ca");
        }
        let mut request = Request::post(path)
            .header(header::CONTENT_TYPE, "application/json")
            .header(header::ACCEPT_ENCODING, "identity");
        if let Some(key) = key {
            request = request.header(header::AUTHORIZATION, format!("Bearer {key}"));
        }
        let body = Value::Object(body.clone()).to_string().into_bytes();
        let patience = PATIENCE + Duration::from_secs(body.len() as u64 / SLOWEST);
        let url = format!("{address}{path}");
        let mut answer = send(&address, tls, request, body, patience)
            .and_then(plain)
            .with_context(|| url.clone())?;
        let status = answer.head.status.as_u16();
        if status == 200 {
            return Ok(answer);
        }
        let problem = problem(&mut answer).with_context(|| url.clone())?;
        let error = anyhow!("{url}: status {status}: {problem}");
        Err(match status {
            400 | 404 | 409 | 413 => Failure::Usage(error),
            _ => Failure::Other(error),
        })
    }

    /// The key for the server, if there is one.
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

/// Refuses an answer without a length, whose end would look like a broken connection, and a compressed one.
fn plain(answer: Answer) -> anyhow::Result<Answer> {
    let headers = &answer.head.headers;
    let has_end = match headers.get(header::TRANSFER_ENCODING) {
        Some(coding) => coding.as_bytes().eq_ignore_ascii_case(b"chunked"),
        None => headers.contains_key(header::CONTENT_LENGTH),
    };
    ensure!(has_end, "the answer has no length");
    let coding = headers.get(header::CONTENT_ENCODING);
    if let Some(coding) = coding.filter(|coding| *coding != "identity") {
        let coding = shown(&String::from_utf8_lossy(coding.as_bytes()));
        bail!("the answer is coded as {coding}; allowed: identity, which was requested");
    }
    Ok(answer)
}

/// The value of a header.
fn text<'a>(answer: &'a Answer, name: &str) -> Option<&'a str> {
    str::from_utf8(answer.head.headers.get(name)?.as_bytes()).ok()
}

/// The text of a refusal.
fn problem(answer: &mut Answer) -> anyhow::Result<String> {
    let text = answer.rest(MOST_BYTES)?;
    let document: Option<Value> = serde_json::from_slice(&text).ok();
    let member = |name: &str| Some(document.as_ref()?.get(name)?.as_str()?.to_owned());
    Ok(shown(&match (member("title"), member("detail")) {
        (Some(title), Some(detail)) => format!("{title}: {detail}"),
        (None, Some(text)) | (Some(text), None) => text,
        (None, None) => String::from_utf8_lossy(&text).trim().to_owned(),
    }))
}

/// The number of points that the head of an answer promises.
pub(super) fn promised(answer: &Answer) -> Result<u64, Failure> {
    let count = text(answer, COUNT).ok_or_else(|| {
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

/// Writes the body of an answer as it arrives. Fails if it holds another number of points than its head promises.
pub(super) fn write(
    mut answer: Answer,
    count: u64,
    (encoding, has_summary): (Encoding, bool),
    mut output: Output,
) -> Result<(), Failure> {
    let mut tally = Tally::new(encoding, has_summary, text(&answer, "strew-columns"));
    while let Some(part) = answer.next().context("the answer broke off")? {
        tally.add(&part);
        output.write(&part)?;
    }
    tally.check(count).map_err(|held| {
        anyhow!(
            "the answer is incomplete: it holds {held}, and its header strew-count says {count}"
        )
    })?;
    Ok(output.finish()?)
}

/// The header with the number of points.
const COUNT: &str = "strew-count";

/// Announces the answer on standard error.
pub(super) fn announce(answer: &Answer, format: &str) {
    let header = |name: &str| text(answer, name).map(shown);
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
