//! Requests as handlers take them: the caller, and all that decides how the answer is sent; for some, the body.

use std::{
    pin::{Pin, pin},
    sync::Arc,
};

use bytes::Bytes;
use http::{HeaderMap, Method, Uri};
use serde::Serialize;
use strew_access::Caller;
use strew_error::{Error, Fault};
use strew_query::{Group, Values, parse_pairs};
use strew_service::{Service, charge_reading};

use super::{body, document, freshness::Freshness, problem::Refused};
use crate::body::{Body, Response};

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

/// A request whose query is its body.
#[derive(Debug)]
pub struct Sent {
    pub(super) context: Context,
    pub(super) body: Bytes,
}

impl Sent {
    /// Reads the body of a request, which has no parameters beside it.
    pub(super) async fn read(
        service: &Arc<Service>,
        context: Context,
        body: Body,
    ) -> Result<Self, Refused> {
        context.no_parameters()?;
        let body = body::whole(service, &context.headers, body).await?;
        charge_reading(&context.caller, body.len())?;
        Ok(Self { context, body })
    }
}
