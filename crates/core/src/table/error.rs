//! What can be wrong with a table.

use alloc::string::String;

use super::{FORMAT_VERSION, MAX_FILE_BYTES};
use crate::{map::RadiusError, pattern::AlphaError};

/// Why some bytes or parts are not a table. Checks run in the order of the variants, so a damaged
/// file is named by the first thing that does not hold.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TableError {
    /// More bytes than any table has.
    #[error("the table file has {bytes} bytes; at most {MAX_FILE_BYTES} are allowed")]
    TooLarge {
        /// The size of the input.
        bytes: u64,
    },
    /// The first bytes are not a table's.
    #[error("not a Strew table: the first 8 bytes are {found:02x?}, expected 89 'STREW' 0d 0a")]
    Magic {
        /// What stands there.
        found: [u8; 8],
    },
    /// Written by an older release whose format is no longer read.
    #[error(
        "table format version {found} at byte 8 is older than {FORMAT_VERSION}, the one read here"
    )]
    OlderVersion {
        /// The version found.
        found: u32,
    },
    /// Written by a newer release.
    #[error(
        "table format version {found} at byte 8 is newer than {FORMAT_VERSION}, the one read here"
    )]
    NewerVersion {
        /// The version found.
        found: u32,
    },
    /// The input ends before the file does.
    #[error("the table file is truncated: {have} bytes of {need}")]
    Truncated {
        /// The size of the input.
        have: u64,
        /// The size the header states, or the least size of any header.
        need: u64,
    },
    /// The input goes on after the file's end.
    #[error("the table file is oversized: {have} bytes, but its header states {need}")]
    Oversized {
        /// The size of the input.
        have: u64,
        /// The size the header states.
        need: u64,
    },
    /// Some bit has changed since the file was written.
    #[error(
        "the table file is damaged: its digest is {computed}, but its last 32 bytes say {stated}"
    )]
    Digest {
        /// The digest of what stands there, in hexadecimal.
        computed: String,
        /// The digest the file states, in hexadecimal.
        stated: String,
    },
    /// A section does not parse.
    #[error("section {section} of the table file, at byte {at}: {problem}")]
    Section {
        /// The four letters that name the section.
        section: String,
        /// Where in the file.
        at: u64,
        /// What is wrong there.
        problem: String,
    },
    /// A line of the text form is wrong.
    #[error("line {line} of the text: {problem}")]
    Text {
        /// The line, from 1; the last one if lines are missing.
        line: usize,
        /// What is wrong with it.
        problem: String,
    },
    /// α is not valid.
    #[error(transparent)]
    Alpha(#[from] AlphaError),
    /// R is not valid.
    #[error(transparent)]
    Radius(#[from] RadiusError),
    /// A part has a value that is not allowed.
    #[error("{field} of the table is {value}; allowed: {allowed}")]
    Field {
        /// Which part.
        field: &'static str,
        /// Its value.
        value: String,
        /// What is allowed.
        allowed: String,
    },
}
