//! Steps of the [app](super::app): layers of tower, each an async function of a request and of what is inside. Nothing is
//! boxed on the way: the steps of a request are one future.

use axum::Router;
use tower::{Layer, Service as _, layer::layer_fn};

use super::exchange::Inbound;
use crate::body::Response;

/// What is inside of a step.
pub(super) trait Next: Send + Sync {
    /// The answer to a request.
    fn answer(&self, inbound: Box<Inbound>) -> impl Future<Output = Response> + Send;
}

/// A step.
pub(super) trait Step: Sized + Send + Sync {
    /// The answer to a request, of which the next step answers what this one does not.
    fn answer(
        &self,
        inbound: Box<Inbound>,
        next: &impl Next,
    ) -> impl Future<Output = Response> + Send;

    /// The step as a layer around others.
    fn layer<S>(self) -> impl Layer<S, Service = Layered<Self, S>>
    where
        Self: Clone,
    {
        layer_fn(move |inner| Layered {
            step: self.clone(),
            inner,
        })
    }
}

/// A step that may be left out.
impl<T: Step> Step for Option<T> {
    async fn answer(&self, inbound: Box<Inbound>, next: &impl Next) -> Response {
        match self {
            Some(step) => step.answer(inbound, next).await,
            None => next.answer(inbound).await,
        }
    }
}

/// A step around others.
#[derive(Debug)]
pub(super) struct Layered<T, S> {
    step: T,
    inner: S,
}

impl<T: Step, S: Next> Next for Layered<T, S> {
    fn answer(&self, inbound: Box<Inbound>) -> impl Future<Output = Response> + Send {
        self.step.answer(inbound, &self.inner)
    }
}

/// The router is the last step: from here on the client is among the extensions of the request.
impl Next for Router {
    async fn answer(&self, inbound: Box<Inbound>) -> Response {
        let Inbound {
            mut request,
            client,
            ..
        } = *inbound;
        request.extensions_mut().insert(client);
        let answered = self.clone().call(request).await;
        answered.unwrap_or_else(|never| match never {})
    }
}
