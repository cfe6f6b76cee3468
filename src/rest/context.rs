//! Requests as handlers take them: the caller, and all that decides how the answer is sent; for some, the body.

use std::sync::Arc;

use axum::{
    extract::{FromRequest, FromRequestParts, Request},
    response::Response,
};
use bytes::Bytes;
use http::{HeaderMap, Method, Uri, request::Parts};
use serde::Serialize;
use strew_access::Caller;
use strew_error::{Error, Fault};
use strew_query::{Group, Values, parse_pairs};
use strew_service::Service;

use super::{body::Whole, document, freshness::Freshness, problem::Refused};

/// A request without its body.
#[derive(Debug)]
pub(crate) struct Context {
    pub(crate) caller: Caller,
    pub(super) method: Method,
    pub(super) uri: Uri,
    pub(super) headers: HeaderMap,
}

impl Context {
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
        make: impl Future<Output = Result<Response, Error>>,
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
        self.answer(document::JSON, document, make).await
    }

    /// The error of a path that names nothing.
    pub(super) fn nothing(&self, available: String) -> Error {
        let path = self.uri.path().into();
        Error::NoSuchPath { path, available }
    }

    /// Refuses parameters where the query is in the body.
    fn no_parameters(&self) -> Result<(), Error> {
        match self.uri.query().filter(|text| !text.is_empty()) {
            Some(text) => {
                let detail = "not allowed here: the query is in the body";
                Err(Fault::new("query", text, detail, "no parameters").into())
            }
            None => Ok(()),
        }
    }
}

impl<S: Sync> FromRequestParts<S> for Context {
    type Rejection = Refused;

    async fn from_request_parts(parts: &mut Parts, _: &S) -> Result<Self, Refused> {
        Ok(Self {
            caller: Caller::noted(parts.extensions.get())?,
            method: parts.method.clone(),
            uri: parts.uri.clone(),
            headers: parts.headers.clone(),
        })
    }
}

/// A request whose query is its body.
#[derive(Debug)]
pub(super) struct Sent {
    pub(super) context: Context,
    pub(super) body: Bytes,
}

impl FromRequest<Arc<Service>> for Sent {
    type Rejection = Refused;

    async fn from_request(request: Request, service: &Arc<Service>) -> Result<Self, Refused> {
        let (mut parts, body) = request.into_parts();
        let context = Context::from_request_parts(&mut parts, service).await?;
        context.no_parameters()?;
        let request = Request::from_parts(parts, body);
        let Whole(body) = Whole::from_request(request, service).await?;
        Ok(Self { context, body })
    }
}
