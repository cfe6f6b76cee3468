//! The blocks of an answer, and why it may not be made to its end.

use std::fmt;

use bytes::Bytes;
use strew_error::Error;

/// A maker of the blocks of an answer.
pub(super) trait Blocks: fmt::Debug + Send {
    /// The next block. An empty block means that work continues without output so far.
    fn next(&mut self) -> Option<Result<Bytes, EncodeError>>;
    /// The number of points encoded so far.
    fn points(&self) -> u64;
}

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
