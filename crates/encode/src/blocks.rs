//! The blocks of an answer.

use std::fmt;

use bytes::Bytes;

use crate::error::EncodeError;

/// A maker of the blocks of an answer.
pub(super) trait Blocks: fmt::Debug + Send {
    /// The next block. An empty block means that work continues without output so far.
    fn next(&mut self) -> Option<Result<Bytes, EncodeError>>;
    /// The number of points encoded so far.
    fn points(&self) -> u64;
}

/// No blocks, of an answer without points.
#[derive(Debug)]
pub(super) struct Nothing;

impl Blocks for Nothing {
    fn next(&mut self) -> Option<Result<Bytes, EncodeError>> {
        None
    }

    fn points(&self) -> u64 {
        0
    }
}
