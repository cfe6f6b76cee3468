//! The last step of every answer: CORS, problems instead of bare errors, how long
//! it may be kept, compression. Answers to calls only get the first.

use std::sync::Arc;

use axum::{
    Router,
    extract::{Request, State},
    middleware::{self, Next},
    response::Response,
};
use http::{HeaderMap, HeaderName, HeaderValue, Method, StatusCode, Version, header};
use strew_config::Http;
use strew_service::Service;

use super::{
    coding,
    cors::{self, Origins},
    freshness, harden,
    problem::{self, Problem},
};

/// The settings that finishing needs.
#[derive(Clone, Debug)]
struct Finish {
    origins: Origins,
    cache_seconds: u32,
    /// Answers are for one client, not for those who share a cache with it.
    is_private: bool,
    head_bytes: usize,
    service: Arc<Service>,
}

/// Finishes the answers of a router; heads of requests longer than `head_bytes` are refused. Answers
/// that are private are not kept by caches that several clients share.
pub fn finished(
    router: Router,
    settings: &Http,
    head_bytes: u32,
    is_private: bool,
    service: Arc<Service>,
) -> Router {
    let finish = Finish {
        origins: Origins::read(&settings.cors_origins),
        cache_seconds: settings.cache_seconds,
        is_private,
        head_bytes: usize::try_from(head_bytes).unwrap_or(usize::MAX),
        service,
    };
    router.layer(middleware::from_fn_with_state(finish, finish_answer))
}

async fn finish_answer(State(finish): State<Finish>, request: Request, next: Next) -> Response {
    let (method, headers) = (request.method(), request.headers());
    if let Some(allowed) = cors::preflight(&finish.origins, method, headers) {
        return allowed;
    }
    let is_head = *method == Method::HEAD;
    let origin = headers.get(header::ORIGIN).cloned();
    let accept = picked(headers, &header::ACCEPT_ENCODING);
    let refusal = too_long(&request, finish.head_bytes)
        .or_else(|| wrong_host(&request))
        .or_else(|| foreign(&finish.origins, &request));
    let mut response = match refusal {
        Some(refusal) => refusal,
        None => next.run(request).await,
    };
    cors::allow(&finish.origins, origin.as_ref(), response.headers_mut());
    if is_grpc(response.headers()) {
        return response;
    }
    let mut response = problem::instead_of_bare(response).await;
    freshness::keep(&mut response, finish.cache_seconds, finish.is_private);
    harden::guard(response.headers_mut(), finish.origins == Origins::All);
    let coded = coding::apply(&accept, is_head, &finish.service, response).await;
    coded.unwrap_or_else(|error| Problem::response(&error))
}

/// The lines of one header.
fn picked(headers: &HeaderMap, name: &HeaderName) -> HeaderMap {
    let lines = headers.get_all(name).iter().cloned();
    lines.map(|line| (name.clone(), line)).collect()
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

/// The refusal of a request of a page that may not send it, before its body is read.
fn foreign(origins: &Origins, request: &Request) -> Option<Response> {
    let detail = cors::refusal(origins, request)?;
    Some(Problem::of_status(StatusCode::FORBIDDEN, detail))
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
        (_, true) => (
            StatusCode::REQUEST_HEADER_FIELDS_TOO_LARGE,
            address + headers,
        ),
        _ => return None,
    };
    let detail = format!("it has {length} bytes; allowed: at most {limit}");
    Some(Problem::of_status(status, detail))
}
