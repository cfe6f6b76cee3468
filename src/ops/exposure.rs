//! Who can reach the daemon, and whether it says so loudly enough.

use crate::config::Config;

/// What to warn of, if anyone can ask, unseen and unproven: a daemon that listens wider than on
/// this machine, and neither speaks TLS nor asks who is there.
#[must_use]
pub fn warning(config: &Config) -> Option<String> {
    let listen = config.server.listen;
    let is_local = listen.ip().is_loopback();
    let is_guarded = config.tls.is_on();
    (!is_local && !is_guarded).then(|| {
        format!(
            "listening on {listen}, beyond this machine, without TLS: whoever can reach the port \
             may ask, and others may listen; set tls.certificate and tls.key (and tls.client_ca to \
             let in only those with a certificate), or put a proxy in front that does"
        )
    })
}
