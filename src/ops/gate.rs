//! The gate: the key and the address of a request decide whether it is admitted.
//!
//! REST and gRPC are behind the same gate; what it refuses is a problem by one and a status by the
//! other. Open to all are `/livez`, `/readyz`, the pages with the description of the API, and of gRPC
//! health and reflection: probes have no keys, and what the API looks like is no secret.

use std::{net::IpAddr, sync::Arc};

use axum::{
    body::Body,
    extract::{Request, State},
    middleware::Next,
    response::{IntoResponse as _, Response},
};
use http::{HeaderMap, HeaderName, HeaderValue, header};
use strew_access::{Caller, Gate, Usage};
use strew_error::{Denied, Level};

use super::exchange::Client;
use crate::{grpc, rest::Refused};

const API_KEY: HeaderName = HeaderName::from_static("x-api-key");
const RATE_LIMIT: HeaderName = HeaderName::from_static("ratelimit");
const RATE_LIMIT_POLICY: HeaderName = HeaderName::from_static("ratelimit-policy");

/// The services of gRPC that are open to all.
const OPEN: [&str; 2] = ["/grpc.health.", "/grpc.reflection."];

/// The gate of REST.
pub(super) async fn of_rest(
    State(gate): State<Arc<Gate>>,
    mut request: Request,
    next: Next,
) -> Response {
    let (mut response, level) = match admit(&gate, &request) {
        Ok(caller) => {
            request.extensions_mut().insert(caller.clone());
            let response = next.run(request).await;
            (response, caller.level())
        }
        Err(denied) => {
            let level = match &denied {
                Denied::TooFast { short, .. } => Some(short.level),
                _ => None,
            };
            (Refused::from(denied).into_response(), level)
        }
    };
    if let Some(level) = level {
        add_rate_limit(level, response.headers_mut());
    }
    response
}

/// The gate of gRPC.
pub(super) async fn of_calls(
    State(gate): State<Arc<Gate>>,
    mut request: Request,
    next: Next,
) -> Response {
    let path = request.uri().path();
    if !OPEN.iter().any(|open| path.starts_with(open)) {
        match admit(&gate, &request) {
            Ok(caller) => {
                request.extensions_mut().insert(caller);
            }
            Err(denied) => return grpc::refusal(&denied.into()).map(Body::new),
        }
    }
    next.run(request).await
}

/// The gate of the administrators' own address: every client there is an administrator, except web
/// pages, which can reach what their reader's browser can.
pub(super) async fn of_admins(mut request: Request, next: Next) -> Response {
    if request.headers().contains_key(header::ORIGIN) {
        let denied = Denied::NotAdmin {
            name: Some("of a web page".into()),
        };
        return Refused::from(denied).into_response();
    }
    request.extensions_mut().insert(Caller::admin());
    next.run(request).await
}

fn admit(gate: &Gate, request: &Request) -> Result<Caller, Denied> {
    let client = request.extensions().get::<Client>();
    let (address, usage) = match client {
        Some(client) => (client.address, client.usage.clone()),
        None => (IpAddr::from([0, 0, 0, 0]), Usage::unlimited()),
    };
    gate.admit(shown(request.headers()), address, usage)
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

/// Adds the headers that describe a rate (draft-ietf-httpapi-ratelimit-headers).
fn add_rate_limit(level: Level, headers: &mut HeaderMap) {
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
