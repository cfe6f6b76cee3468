//! Who asks, for handlers: whoever has been let in stands among a request's extensions.

use axum::extract::FromRequestParts;
use http::request::Parts;

use crate::{access::Caller, service::Error};

impl<S: Sync> FromRequestParts<S> for Caller {
    type Rejection = Error;

    async fn from_request_parts(parts: &mut Parts, _: &S) -> Result<Self, Error> {
        let caller = parts.extensions.get::<Self>().cloned();
        caller.ok_or(Error::Internal("nobody has been let in"))
    }
}
