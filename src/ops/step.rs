//! Steps of the [app](super::app): layers of tower, each an async function of a request and of what is inside.

use std::{
    convert::Infallible,
    pin::Pin,
    sync::Arc,
    task::{Context, Poll},
};

use axum::Router;
use tower::{Layer, Service, layer::layer_fn};

use super::exchange::Inbound;
use crate::body::Response;

/// The answer of a service that always has one.
type Answering = Pin<Box<dyn Future<Output = Result<Response, Infallible>> + Send>>;

/// What is inside of a step.
pub(super) trait Next: Clone + Send + Sync + 'static {
    /// The answer to a request.
    fn answer(self, inbound: Box<Inbound>) -> impl Future<Output = Response> + Send;
}

impl<S> Next for S
where
    S: Service<Box<Inbound>, Response = Response, Error = Infallible>,
    S: Clone + Send + Sync + 'static,
    S::Future: Send,
{
    async fn answer(mut self, inbound: Box<Inbound>) -> Response {
        let answered = self.call(inbound).await;
        answered.unwrap_or_else(|never| match never {})
    }
}

/// A step.
pub(super) trait Step: Sized + Send + Sync + 'static {
    /// The answer to a request, of which the next step answers what this one does not.
    fn answer(
        &self,
        inbound: Box<Inbound>,
        next: impl Next,
    ) -> impl Future<Output = Response> + Send;

    /// The step as a layer around others.
    fn layer<S>(self) -> impl Layer<S, Service = Layered<Self, S>> {
        let step = Arc::new(self);
        layer_fn(move |inner| Layered {
            step: step.clone(),
            inner,
        })
    }
}

/// A step that may be left out.
impl<T: Step> Step for Option<T> {
    async fn answer(&self, inbound: Box<Inbound>, next: impl Next) -> Response {
        match self {
            Some(step) => step.answer(inbound, next).await,
            None => next.answer(inbound).await,
        }
    }
}

/// A step around others.
pub(super) struct Layered<T, S> {
    step: Arc<T>,
    inner: S,
}

impl<T, S: Clone> Clone for Layered<T, S> {
    fn clone(&self) -> Self {
        Self {
            step: self.step.clone(),
            inner: self.inner.clone(),
        }
    }
}

impl<T: Step, S: Next> Service<Box<Inbound>> for Layered<T, S> {
    type Response = Response;
    type Error = Infallible;
    type Future = Answering;

    fn poll_ready(&mut self, _: &mut Context<'_>) -> Poll<Result<(), Infallible>> {
        Poll::Ready(Ok(()))
    }

    fn call(&mut self, inbound: Box<Inbound>) -> Answering {
        let Self { step, inner } = self.clone();
        Box::pin(async move { Ok(step.answer(inbound, inner).await) })
    }
}

/// The router as the last step: from here on the client is among the extensions of the request.
#[derive(Clone)]
pub(super) struct Routed(pub(super) Router);

impl Service<Box<Inbound>> for Routed {
    type Response = Response;
    type Error = Infallible;
    type Future = <Router as Service<crate::body::Request>>::Future;

    fn poll_ready(&mut self, _: &mut Context<'_>) -> Poll<Result<(), Infallible>> {
        Poll::Ready(Ok(()))
    }

    fn call(&mut self, inbound: Box<Inbound>) -> Self::Future {
        let Inbound {
            mut request,
            client,
            ..
        } = *inbound;
        request.extensions_mut().insert(client);
        self.0.call(request)
    }
}
