//! A panic is a bug, and stays one request's: it is logged, answered as an internal error in the
//! client's own language, and the connection goes on.

use std::{any::Any, panic::AssertUnwindSafe, sync::Arc};

use futures_util::FutureExt as _;
use strew_error::Error;

use super::{
    exchange::Inbound,
    metrics::Metrics,
    step::{Next, Step},
};
use crate::body::Response;

/// Answers what panics.
#[derive(Clone, Debug)]
pub(super) struct Panics(pub(super) Arc<Metrics>);

impl Step<Inbound> for Panics {
    async fn answer(&self, inbound: Box<Inbound>, next: &impl Next<Inbound>) -> Response {
        let dialect = inbound.client.dialect;
        let answer = AssertUnwindSafe(next.answer(inbound)).catch_unwind().await;
        answer.unwrap_or_else(|panic| {
            self.0.panics.inc();
            tracing::error!(panic = said(&*panic), "a handler panicked");
            let error = Error::Internal("the request could not be answered");
            dialect.refusal(&error)
        })
    }
}

/// The message of a panic, if it is text.
fn said(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<&str>().copied();
    let text = text.or_else(|| panic.downcast_ref::<String>().map(String::as_str));
    text.unwrap_or("no text")
}
