//! Steps of the [app](super::app): layers of tower, each an async function of a request and of what is inside. Nothing is
//! boxed on the way: the steps of a request are one future.

use tower::{Layer, layer::layer_fn};

use crate::body::Response;

pub(super) trait Next<R>: Send + Sync {
    fn answer(&self, inbound: Box<R>) -> impl Future<Output = Response> + Send;
}

pub(super) trait Step<R>: Sized + Send + Sync {
    /// The answer to a request, of which the next step answers what this one does not.
    fn answer(&self, inbound: Box<R>, next: &impl Next<R>)
    -> impl Future<Output = Response> + Send;

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

impl<R: Send, T: Step<R>> Step<R> for Option<T> {
    async fn answer(&self, inbound: Box<R>, next: &impl Next<R>) -> Response {
        match self {
            Some(step) => step.answer(inbound, next).await,
            None => next.answer(inbound).await,
        }
    }
}

pub(super) struct Layered<T, S> {
    step: T,
    inner: S,
}

impl<R: Send, T: Step<R>, S: Next<R>> Next<R> for Layered<T, S> {
    fn answer(&self, inbound: Box<R>) -> impl Future<Output = Response> + Send {
        self.step.answer(inbound, &self.inner)
    }
}
