//! Requests as handlers take them: the caller, and all that decides how the answer is sent; for some, the body: read
//! whole, up to a limit, and unpacked if it is gzip.
//!
//! The content type of a body is not looked at: it is read as JSON anyway, and `curl -d` calls everything a form.

use std::{
    fmt::Display,
    mem::take,
    pin::{Pin, pin},
    sync::Arc,
};

use axum::extract::{FromRequest, FromRequestParts, MatchedPath, RawPathParams, State};
use bytes::Bytes;
use futures_util::StreamExt as _;
use http::{HeaderMap, Method, StatusCode, Uri, header, request::Parts};
use serde::Serialize;
use strew_core::server::Stop;
use strew_error::{Error, Fault};
use strew_query::{Draft, Group, Options, Query, Values, parse_pairs, read_body};
use strew_service::access::Caller;
use strew_service::{Record, Service, charge_reading, segments::Segments, unpack::Coding};

use super::{
    document,
    freshness::Freshness,
    problem::{Problem, Refused},
};
use crate::body::{Body, Request, Response};

pub struct Context {
    pub(crate) caller: Caller,
    pub(super) method: Method,
    pub(super) uri: Uri,
    pub(super) headers: HeaderMap,
    pub(super) path: Vec<String>,
}

impl Context {
    /// The parameters in the path: as many as the path of the endpoint has.
    pub fn path<const N: usize>(&self) -> [&str; N] {
        std::array::from_fn(|place| self.path.get(place).map_or("", String::as_str))
    }

    pub(super) fn values(&self, groups: &'static [Group]) -> Values {
        parse_pairs(self.uri.query().unwrap_or_default(), groups)
    }

    /// The freshness of the answer in a content type, `made_of` all that decides its bytes besides the address.
    pub(super) fn freshness(
        &self,
        content_type: &'static str,
        made_of: &impl Serialize,
    ) -> Freshness {
        Freshness::of(&self.uri, &self.headers, content_type, made_of)
    }

    pub(super) async fn answer(
        &self,
        content_type: &'static str,
        made_of: &(impl Serialize + Sync),
        make: Pin<&mut impl Future<Output = Result<Response, Error>>>,
    ) -> Result<Response, Error> {
        let freshness = self.freshness(content_type, made_of);
        freshness.answer(&self.headers, make).await
    }

    pub(super) async fn document(
        &self,
        document: &(impl Serialize + Sync),
    ) -> Result<Response, Error> {
        let make = async { document::json(document) };
        self.answer(document::JSON, document, pin!(make)).await
    }

    pub(super) fn nothing(&self, available: String) -> Error {
        let path = self.uri.path().into();
        Error::NoSuchPath { path, available }
    }

    pub(super) fn nothing_named(&self, path: &str, names: &impl Display) -> Error {
        self.nothing(format!("{path}, where name is {names}"))
    }
}

/// The state of most handlers, and the answers of all.
pub(super) type Shared = State<Arc<Service>>;
pub(super) type Answered = Result<Response, Refused>;

/// Takes all that the head of a request has: handlers have no other extractor after it.
impl<S: Send + Sync> FromRequestParts<S> for Context {
    type Rejection = Response;

    async fn from_request_parts(parts: &mut Parts, state: &S) -> Result<Self, Response> {
        if let Some(route) = parts.extensions.get::<MatchedPath>() {
            Record::at(route.as_str());
        }
        let path = RawPathParams::from_request_parts(parts, state).await;
        let path = path.map_err(|rejection| {
            Problem::of_status(StatusCode::BAD_REQUEST, rejection.body_text())
        })?;
        Ok(Self {
            caller: parts.extensions.remove().unwrap_or_default(),
            method: take(&mut parts.method),
            uri: take(&mut parts.uri),
            headers: take(&mut parts.headers),
            path: path.iter().map(|(_, text)| text.to_owned()).collect(),
        })
    }
}

/// A request with a body: as [`Sent`] one whose query is its body, and which has no parameters beside it.
pub struct Posted<const ALONE: bool = false> {
    pub(super) context: Context,
    pub(super) body: Bytes,
}

pub type Sent = Posted<true>;

impl<const ALONE: bool> FromRequest<Arc<Service>> for Posted<ALONE> {
    type Rejection = Response;

    async fn from_request(request: Request, service: &Arc<Service>) -> Result<Self, Response> {
        let text = request.uri().query().filter(|text| !text.is_empty());
        if let (true, Some(text)) = (ALONE, text) {
            let detail = "not allowed here: the query is in the body";
            let fault = Fault::new("query", text, detail, "no parameters");
            return Err(Refused(fault.into()).response());
        }
        let (mut parts, body) = request.into_parts();
        let context = Context::from_request_parts(&mut parts, service).await?;
        let body = whole_body(service, &context.headers, body).await;
        let charged = body.and_then(|body| {
            charge_reading(&context.caller, body.len())?;
            Ok(body)
        });
        let body = charged.map_err(|error| Refused(error).response())?;
        Ok(Self { context, body })
    }
}

async fn whole_body(
    service: &Arc<Service>,
    headers: &HeaderMap,
    body: Body,
) -> Result<Bytes, Error> {
    let limit = service.limits().max_body_bytes;
    let is_packed = is_packed(headers)?;
    let length = headers.get(header::CONTENT_LENGTH);
    let length = length.and_then(|length| length.to_str().ok()?.parse::<u64>().ok());
    // A body that announces that it is too long need not even be sent.
    if length.is_some_and(|length| usize::try_from(length).is_ok_and(|length| length > limit)) {
        return Err(Error::BodyTooLarge { limit });
    }
    let mut pieces = body.into_data_stream();
    let mut segments = Segments::default();
    while let Some(piece) = pieces.next().await {
        let piece = piece.map_err(|error| why(&error))?;
        if segments.len() + piece.len() > limit {
            return Err(Error::BodyTooLarge { limit });
        }
        segments.append(&piece);
    }
    let bytes = segments.joined();
    match is_packed {
        true => service.unpacked(Coding::Gzip, bytes, "body").await,
        false => Ok(bytes),
    }
}

fn is_packed(headers: &HeaderMap) -> Result<bool, Error> {
    let lines = headers.get_all(header::CONTENT_ENCODING).iter();
    let names: Vec<String> = lines
        .flat_map(|line| line.as_bytes().split(|&byte| byte == b','))
        .map(|name| String::from_utf8_lossy(name).trim().to_ascii_lowercase())
        .filter(|name| name != "identity")
        .collect();
    match names.as_slice() {
        [] => Ok(false),
        [name] if name == "gzip" || name == "x-gzip" => Ok(true),
        _ => {
            let coding = names.join(", ").chars().take(60).collect();
            Err(Error::UnknownCoding { coding })
        }
    }
}

/// The bytes of memory that reading takes for each of a body.
pub(super) const BODY_COPIES: usize = 4;

/// The query of a body, read and checked: on the workers if it is long.
pub(super) async fn query_of_body(
    service: &Arc<Service>,
    body: Bytes,
    groups: &'static [Group],
) -> Result<(Draft, Box<Query>, Options), Error> {
    let (bytes, budget) = (body.len(), service.own_budget());
    let read = move || {
        let _held = budget.hold(BODY_COPIES * body.len())?;
        Ok(read_body(&body, groups)?)
    };
    let check = |service: &Service, draft: Draft, stop: &Stop| {
        let (query, options) = service.check(&draft, stop)?;
        Ok((draft, query, options))
    };
    service.read(bytes, read, Draft::price, check).await
}

/// Why a body broke off: as the gate says, or because the client stopped.
fn why(error: &(dyn std::error::Error + 'static)) -> Error {
    let mut cause = Some(error);
    while let Some(inner) = cause {
        if let Some(error) = inner.downcast_ref::<Error>() {
            return error.clone();
        }
        cause = inner.source();
    }
    let detail = "broke off before its end";
    Fault::new("body", "", detail, "a whole body").into()
}
