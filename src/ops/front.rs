//! The front: the one service that all connections share. From the head of a request to its answer, in the order in
//! which things are done.

use std::{future::ready, pin::pin, sync::Arc};

use http::{HeaderValue, Method, header};
use http_body::Body as _;
use strew_access::{Caller, Gate};

use super::{
    calls::Calls,
    exchange::{Exchanges, From, Intake, Visit},
    gate,
    metrics::NO_ROUTE,
    panics,
};
use crate::{
    body::{Answering, Body, Request, Response},
    grpc,
    rest::{Finish, Found, Refused, Routes, Wishes},
};

/// Who is let in.
#[derive(Debug)]
pub(super) enum Admission {
    /// As keys and addresses say; requests that are taken on are bounded.
    Gate(Arc<Gate>, Intake),
    /// Everyone, as an administrator.
    Admins,
}

/// All that answers requests.
#[derive(Debug)]
pub(super) struct Front {
    pub(super) routes: Routes,
    /// Calls of gRPC; none at the address of administrators.
    pub(super) calls: Option<Calls>,
    pub(super) admission: Admission,
    pub(super) finish: Finish,
    pub(super) exchanges: Exchanges,
}

/// What a path leads to.
enum Place<'a> {
    Call(grpc::Route),
    Rest(Found<'a>),
    Nothing,
}

impl Place<'_> {
    /// The route, as metrics and logs name it: never the path as it was written.
    fn name(&self) -> &'static str {
        match self {
            Self::Call(route) => route.name,
            Self::Rest(found) => found.path(),
            Self::Nothing => NO_ROUTE,
        }
    }
}

impl Front {
    /// Answers a request of a connection.
    pub(super) async fn answer(self: &Arc<Self>, from: &From, visit: Box<Visit>) -> Response {
        let is_head = *visit.request.method() == Method::HEAD;
        let place = self.place(visit.request.uri().path());
        let name = place.name();
        let answer = |visit| self.finished(place, visit);
        let answered = self.exchanges.answer(from, name, visit, answer);
        let mut response = answered.await;
        // Of other answers the HTTP library says it.
        if let Some(length) = response.body().size_hint().exact()
            && (is_head || length == 0)
        {
            let slot = response.headers_mut().entry(header::CONTENT_LENGTH);
            slot.or_insert_with(|| match length {
                0 => HeaderValue::from_static("0"),
                length => length.into(),
            });
        }
        if is_head {
            *response.body_mut() = Body::empty();
        }
        response
    }

    fn place(&self, path: &str) -> Place<'_> {
        let call = self.calls.as_ref().and_then(|_| grpc::route(path));
        if let Some(route) = call {
            return Place::Call(route);
        }
        self.routes.find(path).map_or(Place::Nothing, Place::Rest)
    }

    /// The answer with all that answers have.
    async fn finished(self: &Arc<Self>, place: Place<'_>, visit: Box<Visit>) -> Response {
        let (request, dialect) = (&visit.request, visit.dialect);
        let misdirected = self.finish.misdirected(request);
        if let (None, Some(allowed)) = (&misdirected, self.finish.preflight(request)) {
            return allowed;
        }
        let wishes = Wishes::of(request, visit.heard.wishes);
        let refusal = misdirected.map(|error| dialect.refusal(&error));
        let mut response = match refusal.or_else(|| self.finish.refusal(request)) {
            Some(refusal) => refusal,
            None => {
                let answer = pin!(self.placed(place, visit));
                panics::answered(&self.exchanges.metrics, dialect, answer).await
            }
        };
        self.finish.answer(&wishes, &mut response).await;
        response
    }

    /// The answer of what the path leads to.
    async fn placed(self: &Arc<Self>, place: Place<'_>, visit: Box<Visit>) -> Response {
        match (place, &self.calls) {
            (Place::Call(route), Some(calls)) => {
                // On the heap, lest all requests have room for a call.
                Box::pin(calls.answer(route, visit)).await
            }
            (Place::Rest(found), _) if found.is_open() => {
                let answer = |request| found.answer(request, Caller::default());
                self.taken(visit, answer).await
            }
            (Place::Rest(found), _) => match &self.admission {
                Admission::Gate(gate, intake) => {
                    let admitted = gate::of_rest(gate, &visit);
                    let (mut response, level) = match admitted {
                        Ok(caller) => {
                            let charged = caller.clone();
                            let answer = |request| found.answer(request, caller);
                            (intake.answer(visit, answer).await, charged.level())
                        }
                        Err(denied) => gate::refused(denied),
                    };
                    gate::tell(level, response.headers_mut());
                    response
                }
                Admission::Admins => match gate::of_admins(visit.request.headers()) {
                    Ok(caller) => found.answer(visit.request, caller).await,
                    Err(denied) => Refused::from(denied).response(),
                },
            },
            _ => {
                let dialect = visit.dialect;
                let answer = |request: Request| -> Answering {
                    Box::pin(ready(match dialect.is_call() {
                        true => grpc::unimplemented(),
                        false => self.routes.nothing(request.uri().path()),
                    }))
                };
                self.taken(visit, answer).await
            }
        }
    }

    /// Answers without asking for a key.
    async fn taken(
        &self,
        visit: Box<Visit>,
        answer: impl FnOnce(Request) -> Answering,
    ) -> Response {
        match &self.admission {
            Admission::Gate(_, intake) => intake.answer(visit, answer).await,
            Admission::Admins => answer(visit.request).await,
        }
    }
}
