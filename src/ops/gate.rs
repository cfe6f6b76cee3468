//! The gate: the key and the address of a request decide whether it is admitted.
//!
//! REST and gRPC are behind the same gate; what it refuses is a problem by one and a status by the
//! other. Open to all are `/livez`, `/readyz`, the pages with the description of the API, and of gRPC
//! health and reflection: probes have no keys, and what the API looks like is no secret.

use http::{HeaderMap, HeaderName, HeaderValue, header};
use strew_access::{Caller, Gate};
use strew_error::{Denied, Level};
use strew_service::Record;

use super::exchange::Visit;
use crate::{body::Response, rest::Refused};

const API_KEY: HeaderName = HeaderName::from_static("x-api-key");
const RATE_LIMIT: HeaderName = HeaderName::from_static("ratelimit");
const RATE_LIMIT_POLICY: HeaderName = HeaderName::from_static("ratelimit-policy");

/// The services of gRPC that are open to all.
const OPEN: [&str; 2] = ["/grpc.health.", "/grpc.reflection."];

/// The caller of a request of REST, if it is let in.
pub(super) fn of_rest(gate: &Gate, visit: &Visit) -> Result<Caller, Denied> {
    let key = visit.heard.key.then(|| shown(visit.request.headers()));
    let client = &visit.client;
    let caller = gate.admit(key.flatten(), client.address, client.usage.clone())?;
    Record::of(&caller);
    Ok(caller)
}

/// The answer to a request that is not let in, and the level of its rate.
pub(super) fn refused(denied: Denied) -> (Response, Option<Level>) {
    let level = match &denied {
        Denied::TooFast { short, .. } => Some(short.level),
        _ => None,
    };
    (Refused::from(denied).response(), level)
}

/// The caller of a call, if it is let in; of what is open to all, anyone.
pub(super) fn of_calls(gate: &Gate, visit: &Visit) -> Result<Caller, Denied> {
    let path = visit.request.uri().path();
    if OPEN.iter().any(|open| path.starts_with(open)) {
        return Ok(Caller::default());
    }
    of_rest(gate, visit)
}

/// The gate of the administrators' own address: every client there is an administrator, except web
/// pages, which can reach what their reader's browser can.
pub(super) fn of_admins(headers: &HeaderMap) -> Result<Caller, Denied> {
    if headers.contains_key(header::ORIGIN) {
        return Err(Denied::NotAdmin {
            name: Some("of a web page".into()),
        });
    }
    Ok(Caller::admin())
}

/// The key of a request: `x-api-key`, or else `Authorization` of the scheme Bearer.
fn shown(headers: &HeaderMap) -> Option<&[u8]> {
    let own = headers.get(API_KEY).map(HeaderValue::as_bytes);
    own.or_else(|| {
        let line = headers.get(header::AUTHORIZATION)?.as_bytes();
        let (scheme, key) = line.split_at_checked("Bearer ".len())?;
        let is_bearer = scheme.eq_ignore_ascii_case(b"Bearer ");
        is_bearer.then(|| key.trim_ascii())
    })
}

/// Adds the headers that describe a rate (draft-ietf-httpapi-ratelimit-headers), if there is one.
pub(super) fn tell(level: Option<Level>, headers: &mut HeaderMap) {
    let Some(level) = level else {
        return;
    };
    let rate = level.rate;
    let burst = rate.burst_points as u64;
    let window = (rate.burst_points / rate.points_per_second).ceil().max(1.0) as u64;
    let full_in = level.full_in.as_secs_f64().ceil() as u64;
    let policy = format!("\"points\";q={burst};w={window}");
    let now = format!("\"points\";r={};t={full_in}", level.left);
    for (name, text) in [(RATE_LIMIT_POLICY, policy), (RATE_LIMIT, now)] {
        if let Ok(value) = HeaderValue::from_str(&text) {
            headers.insert(name, value);
        }
    }
}
