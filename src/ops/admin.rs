//! The path for administrators only: `POST /v1/tables:reload`.

use std::sync::Arc;

use axum::{extract::State, response::Response, routing};
use http::Method;

use super::reload::{Cause, Done, Reloader};
use crate::{
    access::Caller,
    rest::{
        api::{Answer, Endpoint, Operation, Tag},
        json,
    },
    service::{Error, Kind},
};

/// The path.
pub(super) fn endpoint(reloader: Arc<Reloader>) -> Endpoint {
    let operation = Operation {
        method: Method::POST,
        id: "reloadTables",
        summary: "Read tables and keys again",
        about: "For administrators: takes a key with admin = true, or the address of admin.listen. \
                Valid files are served from then on. An invalid file is refused, and its previous \
                content stays in use. Current answers are completed from the tables they began with.",
        tag: Tag::Operations,
        path_parameters: &[],
        parameters: &[],
        body: None,
        answers: vec![Answer {
            status: 200,
            about: "The result.",
            headers: vec![],
            contents: vec![("application/json", |generator| {
                generator.subschema_for::<Done>()
            })],
        }],
        problems: vec![Kind::NotAllowed],
        example: "/v1/tables:reload -X POST".into(),
    };
    let handler = routing::post(reload);
    Endpoint::new("/v1/tables:reload", reloader, vec![(operation, handler)])
}

async fn reload(State(reloader): State<Arc<Reloader>>, caller: Caller) -> Result<Response, Error> {
    caller.must_be_admin()?;
    let reload = reloader.reload(Cause::Request).await?;
    json(&reload)
}
