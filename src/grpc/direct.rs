//! The path around tonic in both directions: messages that are decoded already, and frames that are made already.

use std::{
    convert::Infallible,
    pin::Pin,
    sync::Arc,
    task::{Context, Poll},
};

use http::{Request, Response};
use strew_service as service;
use tonic::{body::Body, codegen::Service, server::NamedService};

use super::{frames::Frames, message};

/// A service whose requests come with their message decoded (`message`), and whose answers may carry
/// [`Frames`]: then these are the body.
#[derive(Clone, Debug)]
pub(super) struct Direct<S> {
    pub(super) inner: S,
    pub(super) service: Arc<service::Service>,
}

impl<S: NamedService> NamedService for Direct<S> {
    const NAME: &'static str = S::NAME;
}

type Answer = Pin<Box<dyn Future<Output = Result<Response<Body>, Infallible>> + Send>>;

impl<S> Service<Request<Body>> for Direct<S>
where
    S: Service<Request<Body>, Response = Response<Body>, Error = Infallible>,
    S: Clone + Send + 'static,
    S::Future: Send + 'static,
{
    type Response = Response<Body>;
    type Error = Infallible;
    type Future = Answer;

    fn poll_ready(&mut self, cx: &mut Context<'_>) -> Poll<Result<(), Infallible>> {
        self.inner.poll_ready(cx)
    }

    fn call(&mut self, request: Request<Body>) -> Answer {
        // Generated services are always ready.
        let Self { mut inner, service } = self.clone();
        Box::pin(async move {
            // The memory of the message is held until the head of the answer.
            let (request, _held) = match message::read(&service, request).await {
                Ok(read) => read,
                Err(refused) => return Ok(refused.into_http()),
            };
            let mut answer = inner.call(request).await?;
            let frames = answer.extensions_mut().remove::<Frames>();
            if let Some(body) = frames.and_then(|frames| frames.body()) {
                *answer.body_mut() = body;
            }
            Ok(answer)
        })
    }
}
