//! Warnings at the start: who can reach the daemon, and who can read its keys.

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
