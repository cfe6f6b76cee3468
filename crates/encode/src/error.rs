//! Why an answer cannot be made to its end.

use std::fmt;

use strew_error::Error;

/// An answer that could not be made to its end: a bug, for what can be refused is refused before.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the answer cannot be encoded: {0}")]
pub struct EncodeError(pub String);

impl EncodeError {
    /// For something that has failed.
    pub fn of(error: impl fmt::Display) -> Self {
        Self(error.to_string())
    }
}

impl From<EncodeError> for Error {
    /// Logs the reason, which is not for clients.
    fn from(error: EncodeError) -> Self {
        tracing::error!(%error);
        Self::Internal("the answer cannot be encoded")
    }
}
