//! Handlers: what answers an operation.

use std::{fmt, sync::Arc};

use strew_service::Service;

use crate::{
    body::{Answering, Body, Response},
    rest::{
        Refused,
        body::{self, Whole},
        context::{Context, Sent},
    },
};

/// What answers an operation. Cheap to clone.
#[derive(Clone)]
pub struct Handler(Arc<dyn Fn(Context, Body) -> Answering + Send + Sync>);

impl fmt::Debug for Handler {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Handler")
    }
}

impl Handler {
    /// Answers a request.
    pub(in crate::rest) fn answer(&self, context: Context, body: Body) -> Answering {
        (self.0)(context, body)
    }
}

/// A function that answers: of a state and a request, or of the service and a request whose query is its body, or with
/// parameters and a body.
pub trait Handle<S, T>: Send + Sync + 'static {
    /// The answer to a request.
    fn answer(&self, state: &S, context: Context, body: Body) -> Answering;
}

impl<S, F, A> Handle<S, (Context,)> for F
where
    S: Clone + Send + 'static,
    F: Fn(S, Context) -> A + Clone + Send + Sync + 'static,
    A: Future<Output = Result<Response, Refused>> + Send + 'static,
{
    fn answer(&self, state: &S, context: Context, _: Body) -> Answering {
        let (state, answer) = (state.clone(), self.clone());
        Box::pin(async move { said(answer(state, context).await) })
    }
}

impl<F, A> Handle<Arc<Service>, (Sent,)> for F
where
    F: Fn(Arc<Service>, Sent) -> A + Clone + Send + Sync + 'static,
    A: Future<Output = Result<Response, Refused>> + Send + 'static,
{
    fn answer(&self, service: &Arc<Service>, context: Context, body: Body) -> Answering {
        let (service, answer) = (service.clone(), self.clone());
        Box::pin(async move {
            match Sent::read(&service, context, body).await {
                Ok(sent) => said(answer(service, sent).await),
                Err(refused) => refused.response(),
            }
        })
    }
}

impl<F, A> Handle<Arc<Service>, (Context, Whole)> for F
where
    F: Fn(Arc<Service>, Context, Whole) -> A + Clone + Send + Sync + 'static,
    A: Future<Output = Result<Response, Refused>> + Send + 'static,
{
    fn answer(&self, service: &Arc<Service>, context: Context, body: Body) -> Answering {
        let (service, answer) = (service.clone(), self.clone());
        Box::pin(async move {
            match body::whole(&service, &context.headers, body).await {
                Ok(body) => said(answer(service, context, Whole(body)).await),
                Err(error) => Refused(error).response(),
            }
        })
    }
}

fn said(answered: Result<Response, Refused>) -> Response {
    answered.unwrap_or_else(|refused| refused.response())
}

/// A function as the handler of an operation.
pub fn handler<S, T>(state: &S, handle: impl Handle<S, T>) -> Handler
where
    S: Clone + Send + Sync + 'static,
{
    let state = state.clone();
    Handler(Arc::new(move |context, body| {
        handle.answer(&state, context, body)
    }))
}
