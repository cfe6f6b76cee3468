//! What only administrators may ask for: `POST /v1/tables:reload`.

use std::sync::Arc;

use axum::{
    body::Body,
    extract::State,
    response::{IntoResponse as _, Response},
    routing,
};
use http::{HeaderValue, Method, header};
use serde_json::json;

use super::reload::{Cause, Reloader};
use crate::{
    access::Caller,
    rest::api::{Answer, Endpoint, Operation},
    service::{Error, Kind},
};

/// The path.
pub(super) fn endpoint(reloader: Arc<Reloader>) -> Endpoint {
    let operation = Operation {
        method: Method::POST,
        id: "reloadTables",
        summary: "Read tables and keys again",
        about: "For administrators: takes a key with admin = true, or the address of admin.listen. \
                What is in order is served from then on; each file that is not is refused, and what \
                it held serves on. Answers under way end on the tables they began with.",
        path_parameters: &[],
        parameters: vec![],
        body: None,
        answers: vec![Answer {
            status: 200,
            about: "What came of it.",
            headers: vec![],
            contents: vec![("application/json".into(), schema())],
        }],
        problems: vec![Kind::NotAllowed],
        example: "/v1/tables:reload -X POST".into(),
    };
    let handler = routing::post(reload);
    Endpoint::new("/v1/tables:reload", reloader, vec![(operation, handler)])
}

fn schema() -> serde_json::Value {
    let text = || json!({ "type": "string" });
    let table = json!({
        "type": "object",
        "required": ["profile", "alpha", "map", "digest", "source"],
        "properties": {
            "profile": text(),
            "alpha": text(),
            "map": text(),
            "digest": text(),
            "source": text(),
            "replaces": { "type": "string", "description": "The digest of the table before." },
        },
    });
    let refusal = json!({
        "type": "object",
        "required": ["source", "detail", "serving"],
        "properties": {
            "source": text(),
            "detail": text(),
            "serving": {
                "type": ["string", "null"],
                "description": "The digest of the table of this file that serves on.",
            },
        },
    });
    let tables = || json!({ "type": "array", "items": table });
    json!({
        "type": "object",
        "required": ["loaded", "kept", "removed", "refused", "keys"],
        "properties": {
            "loaded": tables(),
            "kept": tables(),
            "removed": tables(),
            "refused": { "type": "array", "items": refusal },
            "keys": {
                "type": ["integer", "null"],
                "description": "How many keys are let in; null where there are none, or where they \
                                were refused and those before stay.",
            },
        },
    })
}

async fn reload(State(reloader): State<Arc<Reloader>>, caller: Caller) -> Result<Response, Error> {
    caller.must_be_admin()?;
    let reload = reloader.reload(Cause::Request).await?;
    let mut body =
        serde_json::to_vec(&reload).map_err(|_| Error::Internal("the answer cannot be written"))?;
    body.push(b'\n');
    let json = HeaderValue::from_static("application/json");
    Ok(([(header::CONTENT_TYPE, json)], Body::from(body)).into_response())
}
