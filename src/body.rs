//! Bodies of requests and answers are axum's. The memory of an answer that is there as a whole is held beside it.

use std::sync::Arc;

pub use axum::{BoxError, body::Body};
use strew_service::Held;

pub type Request = http::Request<Body>;

pub type Response = http::Response<Body>;

/// The memory of an answer that is there as a whole, among its extensions.
#[derive(Clone, Debug)]
pub(crate) struct Whole(pub(crate) Arc<Held>);

impl Whole {
    /// Holds memory for an answer until the socket has taken it.
    pub(crate) fn hold(response: &mut Response, held: Held) {
        response.extensions_mut().insert(Self(Arc::new(held)));
    }
}
