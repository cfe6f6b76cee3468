//! The gate: the key and the address of a request decide whether it is admitted.
//!
//! REST and gRPC are behind the same gate; what it refuses is a problem by one and a status by the
//! other. Open to all are `/livez`, `/readyz`, the pages with the description of the API, and of gRPC
//! health and reflection: probes have no keys, and what the API looks like is no secret.

use std::{
    convert::Infallible,
    future::ready,
    pin::Pin,
    sync::Arc,
    task::{Context, Poll},
};

use axum::extract::MatchedPath;
use http::{HeaderMap, HeaderName, HeaderValue, header};
use strew_error::{Denied, Error, Level};
use strew_service::Record;
use strew_service::access::{Caller, Gate};
use tower::{Layer, Service, layer::layer_fn};

use super::exchange::Client;
use crate::{
    body::{Request, Response},
    rest::Refused,
};

const API_KEY: HeaderName = HeaderName::from_static("x-api-key");
const RATE_LIMIT: HeaderName = HeaderName::from_static("ratelimit");
const RATE_LIMIT_POLICY: HeaderName = HeaderName::from_static("ratelimit-policy");

/// The layer of the routes that are not open to everyone; without a gate everyone is an administrator. What is inside
/// finds the [`Caller`] among the extensions.
pub(super) fn layer<S>(gate: Option<Arc<Gate>>) -> impl Layer<S, Service = Gated<S>> + Clone {
    layer_fn(move |inner| Gated {
        gate: gate.clone(),
        inner,
    })
}

#[derive(Clone, Debug)]
pub(super) struct Gated<S> {
    gate: Option<Arc<Gate>>,
    inner: S,
}

impl<S> Gated<S> {
    fn caller(&self, client: &Client, headers: &HeaderMap) -> Result<Caller, Denied> {
        match &self.gate {
            Some(gate) => {
                let usage = client.usage.clone();
                let caller = gate.admit(shown(headers), client.address, usage)?;
                Record::of(&caller);
                Ok(caller)
            }
            // Except web pages, which can reach what their reader's browser can.
            None if headers.contains_key(header::ORIGIN) => Err(Denied::NotAdmin {
                name: Some("of a web page".into()),
            }),
            None => Ok(Caller::admin()),
        }
    }
}

impl<S> Service<Request> for Gated<S>
where
    S: Service<Request, Response = Response, Error = Infallible>,
    S::Future: Send + 'static,
{
    type Response = Response;
    type Error = Infallible;
    type Future = Pin<Box<dyn Future<Output = Result<Response, Infallible>> + Send>>;

    fn poll_ready(&mut self, context: &mut Context<'_>) -> Poll<Result<(), Infallible>> {
        self.inner.poll_ready(context)
    }

    fn call(&mut self, mut request: Request) -> Self::Future {
        // Those that are refused here have a route, too.
        if let Some(route) = request.extensions().get::<MatchedPath>() {
            Record::at(route.as_str());
        }
        let Some(client) = request.extensions().get::<Client>() else {
            let error = Error::Internal("a request without a client");
            return Box::pin(ready(Ok(Refused(error).response())));
        };
        let dialect = client.dialect;
        match self.caller(client, request.headers()) {
            Ok(caller) => {
                request.extensions_mut().insert(caller.clone());
                let answered = self.inner.call(request);
                Box::pin(async move {
                    let mut response = answered.await?;
                    if !dialect.is_call() {
                        tell(caller.level(), response.headers_mut());
                    }
                    Ok(response)
                })
            }
            Err(denied) => {
                let level = match &denied {
                    Denied::TooFast { short, .. } if !dialect.is_call() => Some(short.level),
                    _ => None,
                };
                let mut response = dialect.refusal(&denied.into());
                tell(level, response.headers_mut());
                Box::pin(ready(Ok(response)))
            }
        }
    }
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
fn tell(level: Option<Level>, headers: &mut HeaderMap) {
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
