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

impl Failure {
    /// An error that wrong flags or settings cause.
    pub(crate) fn usage(error: impl Into<anyhow::Error>) -> Self {
        Self::Usage(error.into())
    }

    /// Any other error.
    pub(crate) fn other(error: impl Into<anyhow::Error>) -> Self {
        Self::Other(error.into())
    }
}

impl From<anyhow::Error> for Failure {
    fn from(error: anyhow::Error) -> Self {
        Self::Other(error)
    }
}

/// Returns [`Failure::Usage`] with a formatted message.
macro_rules! refuse {
    ($($message:tt)+) => {
        return Err($crate::cli::Failure::Usage(anyhow::anyhow!($($message)+)))
    };
}

pub(crate) use refuse;

/// Refuses the value of a flag that is out of range.
pub(crate) fn must_be_within(
    flag: &str,
    value: f64,
    [least, most]: [f64; 2],
) -> Result<(), Failure> {
    if !(least..=most).contains(&value) {
        refuse!("{flag} {value}: out of range; allowed: a number from {least} to {most}");
    }
    Ok(())
}
