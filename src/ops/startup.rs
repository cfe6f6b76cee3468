//! What is looked at before the daemon starts: who can reach it, who can read its keys, and whether the system allows it
//! as many open files, and so connections, as it needs.

use strew_config::Config;

/// The warning about a file of keys that every user of the machine can read. Keys are stored as
/// hashes, but their names and limits are confidential.
pub fn readable_keys(config: &Config) -> Option<String> {
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        const OTHERS: u32 = 0o004;
        let path = config.access.keys_file()?;
        let mode = std::fs::metadata(path).ok()?.permissions().mode();
        let path = path.display();
        (mode & OTHERS != 0)
            .then(|| format!("every user of this machine can read the keys file {path}: chmod o-r"))
    }
    #[cfg(not(unix))]
    None
}

/// The warning about a daemon that listens beyond this machine without TLS, or without keys or client
/// certificates.
pub fn warning(config: &Config) -> Option<String> {
    let listen = config.server.listen;
    let is_local = listen.ip().is_loopback();
    if is_local {
        return None;
    }
    let needs_key = config.access.needs_key();
    if config.tls.is_on() {
        let is_guarded = needs_key || config.tls.proves_clients();
        return (!is_guarded).then(|| {
            format!(
                "listening on {listen}, beyond this machine, without keys: every client that can reach the port \
                 is served; set access.keys_file, or tls.client_ca to let in only those with a \
                 certificate"
            )
        });
    }
    Some(if needs_key {
        format!(
            "listening on {listen}, beyond this machine, without TLS: others can listen and take the \
             keys; set tls.certificate and tls.key, or put a proxy in front that speaks TLS"
        )
    } else {
        format!(
            "listening on {listen}, beyond this machine, without TLS and without keys: every client that can \
             reach the port is served, and others can listen; set tls.certificate and tls.key, and \
             access.keys_file or tls.client_ca, or put a proxy in front that does"
        )
    })
}

/// Files that are no connections: tables, the log, the runtime's own.
const OTHERS: u64 = 64;

/// Raises the limit on open files as far as `connections` need and the system allows. Returns the number of
/// connections that there is room for, if that is less.
pub fn make_room(connections: usize) -> Option<u64> {
    let wanted = u64::try_from(connections)
        .unwrap_or(u64::MAX)
        .saturating_add(OTHERS);
    let allowed = raise(wanted);
    (allowed < wanted).then(|| allowed.saturating_sub(OTHERS))
}

/// The limit after an attempt to have it at `wanted`.
#[cfg(unix)]
fn raise(wanted: u64) -> u64 {
    use rustix::process::{Resource, Rlimit, getrlimit, setrlimit};
    let Rlimit { current, maximum } = getrlimit(Resource::Nofile);
    let Some(now) = current else {
        return u64::MAX;
    };
    let possible = maximum.map_or(wanted, |most| most.min(wanted));
    if possible <= now {
        return now;
    }
    let raised = Rlimit {
        current: Some(possible),
        maximum,
    };
    match setrlimit(Resource::Nofile, raised) {
        Ok(()) => possible,
        Err(_) => now,
    }
}

#[cfg(not(unix))]
fn raise(_wanted: u64) -> u64 {
    u64::MAX
}
