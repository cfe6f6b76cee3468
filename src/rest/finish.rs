//! The last step of every answer: CORS, problems instead of bare errors, how long
//! it may be kept, compression. Answers to calls only get the first.

use std::{mem::take, sync::Arc};

use http::{HeaderMap, HeaderName, HeaderValue, Method, StatusCode, Version, header};
use strew_config::Config;
use strew_error::Error;
use strew_service::Service;

use super::{
    coding,
    freshness::Keeping,
    origin::{self, Hosts, Origins},
    problem::{self, Problem},
};
use crate::body::{Request, Response};

#[derive(Clone, Debug)]
pub struct Finish {
    origins: Origins,
    hosts: Hosts,
    keeping: Keeping,
    head_bytes: usize,
    service: Arc<Service>,
}

pub struct Preferences {
    is_head: bool,
    origin: Option<HeaderValue>,
    accept: HeaderMap,
}

impl Preferences {
    pub fn of(request: &Request) -> Self {
        let headers = request.headers();
        Self {
            is_head: *request.method() == Method::HEAD,
            origin: headers.get(header::ORIGIN).cloned(),
            accept: match headers.contains_key(header::ACCEPT_ENCODING) {
                false => HeaderMap::new(),
                true => {
                    let lines = headers.get_all(header::ACCEPT_ENCODING).iter().cloned();
                    lines.map(|line| (header::ACCEPT_ENCODING, line)).collect()
                }
            },
        }
    }
}

impl Finish {
    /// Answers that are private are not kept by caches that several clients share. On loopback requests for foreign
    /// hosts are refused.
    pub fn new(
        config: &Config,
        is_private: bool,
        is_on_loopback: bool,
        service: Arc<Service>,
    ) -> Self {
        let settings = &config.http;
        let head_bytes = config.server.max_header_bytes;
        Self {
            origins: Origins::read(&settings.cors_origins),
            hosts: Hosts::new(&settings.public_url, is_on_loopback),
            keeping: Keeping::new(settings.cache_seconds, is_private),
            head_bytes: usize::try_from(head_bytes).unwrap_or(usize::MAX),
            service,
        }
    }

    /// Why a request is refused in the words of its protocol, before anything else is done: it is for a foreign host.
    pub fn misdirected(&self, request: &Request) -> Option<Error> {
        // Requests without one host are refused later.
        self.hosts
            .refusal(request)
            .filter(|_| wrong_host(request).is_none())
    }

    /// The answer to a preflight of a browser, which is complete.
    pub fn preflight(&self, request: &Request) -> Option<Response> {
        origin::preflight(&self.origins, request.method(), request.headers())
    }

    /// Why a request is refused whatever it asks for: by its head.
    pub fn refusal(&self, request: &Request) -> Option<Response> {
        too_long(request, self.head_bytes)
            .or_else(|| wrong_host(request))
            .or_else(|| {
                // Before its body is read.
                let detail = origin::refusal(&self.origins, &self.hosts, request)?;
                Some(Problem::of_status(StatusCode::FORBIDDEN, detail))
            })
    }

    pub async fn finish(&self, preferences: &Preferences, response: &mut Response) {
        let origin = preferences.origin.as_ref();
        origin::allow(&self.origins, origin, response.headers_mut());
        if is_grpc(response.headers()) {
            return;
        }
        if problem::is_bare(response) {
            *response = Box::pin(problem::instead(take(response))).await;
        }
        self.keeping.set(response);
        guard(response.headers_mut(), self.origins == Origins::All);
        if let Some(chosen) = coding::choose(&preferences.accept, response) {
            let plain = take(response);
            // On the heap, lest plain answers have room for it.
            let coded = Box::pin(chosen.apply(preferences.is_head, &self.service, plain)).await;
            *response = coded.unwrap_or_else(|error| Problem::response(&error));
        }
    }
}

const NO_SNIFFING: HeaderValue = HeaderValue::from_static("nosniff");
const NO_REFERRER: HeaderValue = HeaderValue::from_static("no-referrer");
/// The policy of an answer that is no page: a browser that opens it loads and runs nothing. Pictures bring
/// their own style.
const NO_PAGE: HeaderValue = HeaderValue::from_static(
    "default-src 'none'; style-src 'unsafe-inline'; frame-ancestors 'none'; sandbox",
);

const RESOURCE_POLICY: HeaderName = HeaderName::from_static("cross-origin-resource-policy");
const ANY_ORIGIN: HeaderValue = HeaderValue::from_static("cross-origin");
const SAME_ORIGIN: HeaderValue = HeaderValue::from_static("same-origin");

/// Sets the headers of an answer; pages have all but the last one. If all pages may read answers, they may also show
/// them as pictures.
fn guard(headers: &mut HeaderMap, all_may_read: bool) {
    let resource = if all_may_read {
        ANY_ORIGIN
    } else {
        SAME_ORIGIN
    };
    if !headers.contains_key(header::CONTENT_SECURITY_POLICY) {
        headers.insert(header::X_CONTENT_TYPE_OPTIONS, NO_SNIFFING);
        headers.insert(header::REFERRER_POLICY, NO_REFERRER);
        headers.insert(header::CONTENT_SECURITY_POLICY, NO_PAGE);
    }
    headers.insert(RESOURCE_POLICY, resource);
}

fn is_grpc(headers: &HeaderMap) -> bool {
    let content_type = headers.get(header::CONTENT_TYPE).map(HeaderValue::as_bytes);
    content_type.is_some_and(|value| value.starts_with(b"application/grpc"))
}

/// The refusal of a request of HTTP/1.1 without one `Host` (RFC 9112, 3.2).
fn wrong_host(request: &Request) -> Option<Response> {
    let hosts = request.headers().get_all(header::HOST).iter().count();
    let is_wrong = request.version() == Version::HTTP_11 && hosts != 1;
    let detail = || format!("it has {hosts} lines `Host`; allowed: exactly one");
    is_wrong.then(|| Problem::of_status(StatusCode::BAD_REQUEST, detail()))
}

/// The refusal of a request whose head is too long. (What is much too long never gets here: the
/// HTTP library refuses it without a body.)
fn too_long(request: &Request, limit: usize) -> Option<Response> {
    let address = request
        .uri()
        .path_and_query()
        .map_or(0, |of| of.as_str().len());
    let lines = request.headers().iter();
    let headers: usize = lines.map(|(n, v)| n.as_str().len() + v.len() + 4).sum();
    let (status, length) = match (address > limit, address + headers > limit) {
        (true, _) => (StatusCode::URI_TOO_LONG, address),
        (_, true) => {
            let status = StatusCode::REQUEST_HEADER_FIELDS_TOO_LARGE;
            (status, address + headers)
        }
        _ => return None,
    };
    let detail = format!("it has {length} bytes; allowed: at most {limit}");
    Some(Problem::of_status(status, detail))
}
