//! The path for administrators only: `POST /v1/tables:reload`.

use std::sync::Arc;

use axum::extract::State;
use http::Method;
use strew_error::Kind;

use super::reload::{Cause, Done, Reloader};
use crate::body::Response;
use crate::rest::{
    Context, Refused,
    api::{Answer, Endpoint, Operation, Tag},
    json,
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
        problems: vec![Kind::NotAllowed],
        example: "/v1/tables:reload -X POST".into(),
        ..Operation::new(Tag::Operations, vec![Answer::json::<Done>("The result.")])
    };
    Endpoint::only("/v1/tables:reload", reloader, operation, reload)
}

async fn reload(
    State(reloader): State<Arc<Reloader>>,
    context: Context,
) -> Result<Response, Refused> {
    context.caller.must_be_admin()?;
    let reload = reloader.reload(Cause::Request).await?;
    Ok(json(&reload)?)
}
