//! API keys: entries of a key file, and requests that present a key.

use strew_service::access::Hashed;
use strew_testkit::http1;

use super::daemon::Daemon;

/// The entry of a key; `more` holds further lines.
pub fn entry(name: &str, key: &str, more: &str) -> String {
    let hash = Hashed::of(key.as_bytes());
    format!("[[key]]\nname = \"{name}\"\nhash = \"{hash}\"\n{more}\n")
}

/// The setting that admits the keys of some entries.
pub fn keys(entries: &str) -> String {
    format!("access.keys={entries}")
}

/// The answer to a request that presents a key.
pub fn get_with_key(daemon: &Daemon, path: &str, key: &str) -> http1::Answer {
    http1::get(daemon.address(), path, &[("x-api-key", key)])
}
