//! What handlers take from a request besides its body: the caller, and what decides how the answer is
//! sent.

use axum::extract::FromRequestParts;
use http::{HeaderMap, Method, Uri, request::Parts};

use crate::{
    access::Caller,
    service::{
        Error, Fault,
        query::{Group, Values, parse_pairs},
    },
};

/// A request without its body.
#[derive(Debug)]
pub(super) struct Context {
    pub(super) caller: Caller,
    pub(super) method: Method,
    pub(super) uri: Uri,
    pub(super) headers: HeaderMap,
}

impl Context {
    /// The parameters of the address.
    pub(super) fn values(&self, groups: &'static [Group]) -> Values {
        parse_pairs(self.uri.query().unwrap_or_default(), groups)
    }

    /// Refuses parameters where the query is in the body.
    pub(super) fn no_parameters(&self) -> Result<(), Error> {
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
    type Rejection = Error;

    async fn from_request_parts(parts: &mut Parts, state: &S) -> Result<Self, Error> {
        Ok(Self {
            caller: Caller::from_request_parts(parts, state).await?,
            method: parts.method.clone(),
            uri: parts.uri.clone(),
            headers: parts.headers.clone(),
        })
    }
}

impl<S: Sync> FromRequestParts<S> for Caller {
    type Rejection = Error;

    async fn from_request_parts(parts: &mut Parts, _: &S) -> Result<Self, Error> {
        Ok(Self::noted(parts.extensions.get())?)
    }
}
