//! The limit of the system on open files, and so on connections.

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
