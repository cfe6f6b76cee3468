//! Requests as handlers take them: the caller, and all that decides how the answer is sent; for some, the body.

use std::{
    mem::take,
    pin::{Pin, pin},
    sync::Arc,
};

use axum::extract::{FromRequest, FromRequestParts, MatchedPath, RawPathParams};
use bytes::Bytes;
use http::{HeaderMap, Method, StatusCode, Uri, request::Parts};
use serde::Serialize;
use strew_error::{Error, Fault};
use strew_query::{Group, Values, parse_pairs};
use strew_service::access::Caller;
use strew_service::{Record, Service, charge_reading};

use super::{
    body, document,
    freshness::Freshness,
    problem::{Problem, Refused},
};
use crate::body::{Request, Response};

/// A request without its body.
#[derive(Debug)]
pub struct Context {
    pub(crate) caller: Caller,
    pub(super) method: Method,
    pub(super) uri: Uri,
    pub(super) headers: HeaderMap,
    /// The parameters in its path, in their order.
    pub(super) path: Vec<String>,
}

impl Context {
    /// The parameters in the path: as many as the path of the endpoint has.
    pub fn path<const N: usize>(&self) -> [&str; N] {
        std::array::from_fn(|place| self.path.get(place).map_or("", String::as_str))
    }

    /// The parameters of the address.
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

    /// Makes an answer, unless the client has it.
    pub(super) async fn answer(
        &self,
        content_type: &'static str,
        made_of: &(impl Serialize + Sync),
        make: Pin<&mut impl Future<Output = Result<Response, Error>>>,
    ) -> Result<Response, Error> {
        let freshness = self.freshness(content_type, made_of);
        freshness.answer(&self.headers, make).await
    }

    /// Answers with a document, unless the client has it.
    pub(super) async fn document(
        &self,
        document: &(impl Serialize + Sync),
    ) -> Result<Response, Error> {
        let make = async { document::json(document) };
        self.answer(document::JSON, document, pin!(make)).await
    }

    /// The error of a path that names nothing.
    pub(super) fn nothing(&self, available: String) -> Error {
        let path = self.uri.path().into();
        Error::NoSuchPath { path, available }
    }
}

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

/// A request with its body.
#[derive(Debug)]
pub struct Posted {
    pub(super) context: Context,
    pub(super) body: Bytes,
}

impl FromRequest<Arc<Service>> for Posted {
    type Rejection = Response;

    async fn from_request(request: Request, service: &Arc<Service>) -> Result<Self, Response> {
        let (mut parts, body) = request.into_parts();
        let context = Context::from_request_parts(&mut parts, service).await?;
        let body = body::whole(service, &context.headers, body).await;
        let body = body.map_err(|error| Refused(error).response())?;
        Ok(Self { context, body })
    }
}

/// A request whose query is its body, and which has no parameters beside it.
#[derive(Debug)]
pub struct Sent {
    pub(super) context: Context,
    pub(super) body: Bytes,
}

impl FromRequest<Arc<Service>> for Sent {
    type Rejection = Response;

    async fn from_request(request: Request, service: &Arc<Service>) -> Result<Self, Response> {
        let refused = |error| Refused(error).response();
        let (mut parts, body) = request.into_parts();
        let context = Context::from_request_parts(&mut parts, service).await?;
        if let Some(text) = context.uri.query().filter(|text| !text.is_empty()) {
            let detail = "not allowed here: the query is in the body";
            return Err(refused(
                Fault::new("query", text, detail, "no parameters").into(),
            ));
        }
        let body = body::whole(service, &context.headers, body).await;
        let body = body.map_err(refused)?;
        charge_reading(&context.caller, body.len()).map_err(refused)?;
        Ok(Self { context, body })
    }
}
