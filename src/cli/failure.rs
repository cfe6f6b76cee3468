//! Why a command failed.

/// Why a command failed: decides the exit code.
#[derive(Debug)]
pub(crate) enum Failure {
    /// Wrong flags or settings: 2.
    Usage(anyhow::Error),
    /// Stopped from outside, in good order: 130.
    Interrupted(anyhow::Error),
    /// Anything else: 1.
    Other(anyhow::Error),
}

impl From<anyhow::Error> for Failure {
    fn from(error: anyhow::Error) -> Self {
        Self::Other(error)
    }
}
