//! The lanes of work: short work never waits for long work.

/// Where work is done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lane {
    /// Work of a few milliseconds.
    Short,
    /// All other work.
    Long,
}
