//! A panic is a bug, and stays one request's: it is logged, answered as an internal error in the
//! client's own language, and the connection goes on.

use std::{any::Any, panic::AssertUnwindSafe};

use axum::{
    extract::{Request, State},
    middleware::Next,
    response::Response,
};
use futures_util::FutureExt as _;
use strew_error::Error;

use super::{dialect::Dialect, metrics::Metrics};

/// Answers what panics.
pub(super) async fn answered(
    State(metrics): State<Metrics>,
    request: Request,
    next: Next,
) -> Response {
    let dialect = Dialect::of(request.headers());
    let path = request.uri().path().to_owned();
    let answer = AssertUnwindSafe(next.run(request)).catch_unwind().await;
    answer.unwrap_or_else(|panic| {
        metrics.panics.inc();
        tracing::error!(path, panic = said(&*panic), "a handler panicked");
        let error = Error::Internal("the request could not be answered");
        dialect.refusal(&error)
    })
}

/// The message of a panic, if it is text.
fn said(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<&str>().copied();
    let text = text.or_else(|| panic.downcast_ref::<String>().map(String::as_str));
    text.unwrap_or("no text")
}
