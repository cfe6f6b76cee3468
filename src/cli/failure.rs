//! Why a command failed, in the words of a command line: flags instead of parameters, settings instead of a server.

use anyhow::anyhow;
use strew_error::{Error, Fault};
use strew_forge::SettingError;
use strew_query::{Parameter, patterns::PATTERN_PARAMETERS};

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
    pub(crate) fn usage(error: impl Into<anyhow::Error>) -> Self {
        Self::Usage(error.into())
    }

    /// A setting that is a flag of the same name.
    pub(crate) fn of_setting(error: SettingError) -> Self {
        let SettingError {
            field,
            value,
            allowed,
        } = error;
        Self::Usage(anyhow!("--{field} {value}: allowed: {allowed}"))
    }

    pub(crate) fn other(error: impl Into<anyhow::Error>) -> Self {
        Self::Other(error.into())
    }
}

impl From<anyhow::Error> for Failure {
    fn from(error: anyhow::Error) -> Self {
        Self::Other(error)
    }
}

macro_rules! refuse {
    ($($message:tt)+) => {
        return Err($crate::cli::Failure::Usage(anyhow::anyhow!($($message)+)))
    };
}
pub(crate) use refuse;

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

pub(super) fn flag(name: &str) -> String {
    format!("--{}", name.replace('_', "-"))
}

/// Refuses what flags ask for.
pub(super) fn refused(error: impl Into<Error>) -> Failure {
    Source::Flags.refused(error)
}

/// The source of a query, which decides how its parameters are written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Source {
    Flags,
    File(String),
}

impl Source {
    pub(super) fn refused(&self, error: impl Into<Error>) -> Failure {
        let error = error.into();
        let text = match &error {
            Error::Invalid(faults) => self.described(faults.as_slice()),
            Error::TooManyPoints { count, limit } => format!(
                "the query has {count} points, and the settings allow {limit}: choose a smaller \
                 region or fewer points, or raise it by --set limits.max_points={count}"
            ),
            Error::TooManyRows { rows, limit } => format!(
                "counting takes about {rows} steps (lattice rows, or points that keep clear of others), \
                 and the settings allow {limit}: choose a smaller region, a wider spacing, or a box \
                 with --warp off, or raise it by --set limits.max_rows={rows}"
            ),
            Error::OtherTable { pinned, loaded } => format!(
                "the query names the table {pinned}, but {loaded} would answer: leave --table out, \
                 or load the table by --tables DIR"
            ),
            Error::NoSuchPoint { .. } | Error::Internal(_) => return Failure::Other(error.into()),
            _ => return Failure::Usage(error.into()),
        };
        Failure::Usage(anyhow!("{text}"))
    }

    fn described(&self, faults: &[Fault]) -> String {
        let mut all: Vec<String> = faults.iter().map(|fault| self.one(fault)).collect();
        let place = match self {
            Self::Flags => String::new(),
            Self::File(name) => format!("{name}: "),
        };
        match all.as_slice() {
            [only] => format!("{place}{only}"),
            _ => {
                all.insert(0, format!("{place}{} errors", all.len()));
                all.join("\n  ")
            }
        }
    }

    fn one(&self, fault: &Fault) -> String {
        let Fault {
            field,
            value,
            detail,
            allowed,
        } = fault;
        if *self != Self::Flags {
            return fault.to_string();
        }
        let is_pattern = |known: &&&Parameter| known.name == *field && !known.is_required;
        let is_flag = Parameter::named(field).is_some()
            || PATTERN_PARAMETERS.iter().any(|known| is_pattern(&known))
            || ["chunk", "region"].contains(&&**field);
        let name = if is_flag { flag(field) } else { field.clone() };
        match (value, &**field) {
            (None, "bbox" | "region") => {
                "a region is missing: use --bbox, --circle, --polygon, --chunk or --region, or a \
                 whole query by --query"
                    .into()
            }
            (None, "spacing") => {
                let names = allowed.trim_start_matches("one of ").split(", ");
                let flags: Vec<String> = names.map(flag).collect();
                format!("an amount is missing: use one of {}", flags.join(", "))
            }
            (None, _) => format!("{name} is missing; allowed: {allowed}"),
            (Some(value), _) => format!("{name} {value}: {detail}; allowed: {allowed}"),
        }
    }
}
