//! Who can reach the daemon, and whether it says so loudly enough.

use crate::config::Config;

/// What to warn of, if anyone can ask, unseen and unproven: a daemon that listens wider than on
/// this machine, and does not speak TLS or does not ask who is there.
#[must_use]
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
                "listening on {listen}, beyond this machine, without keys: whoever can reach the port \
                 may ask; set access.keys_file, or tls.client_ca to let in only those with a \
                 certificate"
            )
        });
    }
    Some(if needs_key {
        format!(
            "listening on {listen}, beyond this machine, without TLS: others may listen and take the \
             keys; set tls.certificate and tls.key, or put a proxy in front that speaks TLS"
        )
    } else {
        format!(
            "listening on {listen}, beyond this machine, without TLS and without keys: whoever can reach \
             the port may ask, and others may listen; set tls.certificate and tls.key, and \
             access.keys_file or tls.client_ca, or put a proxy in front that does"
        )
    })
}
