//! The crate's one error type.

use alloc::{borrow::Cow, boxed::Box, string::String, string::ToString};
use core::fmt;

/// Whether the words of errors have decimal numbers and escapes, which take tables and long division.
const WORDS: bool = cfg!(feature = "words");

/// The reason why a request was refused.
///
/// One opaque type serves the whole crate. Every error names the *field* that was wrong, the *value*
/// it had and what is *allowed*; the four parts can be read one by one, and [`Display`](fmt::Display)
/// joins them into a sentence. Programs that react to particular causes match on [`kind`](Self::kind).
///
/// The type is one pointer wide, so `Result<T, Error>` costs nothing where all goes well.
///
/// ```
/// use strew_core::{ErrorKind, PointSet, Table};
///
/// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let error = PointSet::new(table).spacing(-4.0).unwrap_err();
/// assert_eq!(error.kind(), ErrorKind::Spacing);
/// assert_eq!((error.field(), error.value()), ("spacing", "-4"));
/// assert_eq!(error.to_string(), "spacing is -4; it must be a number from 1e-100 to 1e100");
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, PartialEq)]
pub struct Error(Box<Parts>);

#[derive(Clone, PartialEq)]
struct Parts {
    kind: ErrorKind,
    field: Cow<'static, str>,
    value: String,
    problem: Cow<'static, str>,
    allowed: Cow<'static, str>,
    limit: Option<f64>,
}

/// The cause of an [`Error`], for programs.
///
/// ```
/// use strew_core::{ErrorKind, Spacing};
///
/// let error = Spacing::new(0.0).unwrap_err();
/// let advice = match error.kind() {
///     ErrorKind::Spacing | ErrorKind::Density => "choose another spacing",
///     ErrorKind::TooFar => "move closer to the origin",
///     _ => "see the message",
/// };
/// assert_eq!(advice, "choose another spacing");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ErrorKind {
    /// A text is not an α, or its value is not between 1 and 2.
    Alpha,
    /// The offsets of an arrangement; [`limit`](Error::limit) is the one that was exceeded.
    Arrangement,
    /// The neighbor distance of clusters, or the number of their points.
    Clusters,
    /// The half-width or the size of a neighborhood map.
    MapSize,
    /// The period of a periodic set: its number of points or its side.
    Period,
    /// A table or its file: which part is damaged or not allowed is the [`field`](Error::field).
    Table,
    /// A table file larger than [`MAX_FILE_BYTES`](crate::table::MAX_FILE_BYTES).
    TableTooLarge,
    /// A table file that ends before its stated length.
    TableTruncated,
    /// A table file written by a release with another file format.
    TableVersion,
    /// A line of a table's text form.
    TableText,
    /// A text is not 64 hexadecimal digits.
    Digest,
    /// A mean spacing.
    Spacing,
    /// A density.
    Density,
    /// The strength of a warp.
    Warp,
    /// A share of points to keep.
    Keep,
    /// The number of steps by which points settle.
    Settle,
    /// The pixels of a field.
    Field,
    /// A corner of a box.
    Region,
    /// The size or the place of a chunk.
    Chunk,
    /// A circle or a polygon.
    Area,
    /// An area that is not bounded, where all of its points are requested.
    Unbounded,
    /// A place or region so far from the origin that `f64` cannot separate neighbors;
    /// [`limit`](Error::limit) is the largest absolute coordinate.
    TooFar,
    /// A text is not a point id.
    PointId,
    /// A place to search around is not finite.
    Place,
    /// A radius to search within.
    Radius,
    /// More neighbors requested than one search returns.
    Neighbors,
    /// A search that would visit more points than allowed; [`limit`](Error::limit) is their number.
    TooMany,
    /// A distance to keep clear of other points; [`limit`](Error::limit) is the largest.
    Clearance,
    /// A least distance that is not a positive finite number.
    Distance,
    /// The table guarantees no useful least distance.
    NoLeastDistance,
    /// A number of points to place.
    Count,
    /// A number of points that needs a smaller spacing than the caller allows, which is the
    /// [`limit`](Error::limit).
    TooDense,
    /// The name, range or number of an attribute.
    Attribute,
    /// A list of variants.
    Variants,
    /// The weights of kinds.
    Shares,
    /// A kind of points that the table does not have.
    Kinds,
    /// Counting was stopped by its [`Stop`](crate::server::Stop).
    Stopped,
}

impl Error {
    /// `field` has `value`; it must be `allowed`.
    pub(crate) fn new(
        kind: ErrorKind,
        field: impl Into<Cow<'static, str>>,
        value: impl fmt::Display,
        allowed: impl Into<Cow<'static, str>>,
    ) -> Self {
        Self(Box::new(Parts {
            kind,
            field: field.into(),
            value: value.to_string(),
            problem: "".into(),
            allowed: allowed.into(),
            limit: None,
        }))
    }

    /// Says what is wrong with the value, where "must be" does not.
    pub(crate) fn because(mut self, problem: impl Into<Cow<'static, str>>) -> Self {
        self.0.problem = problem.into();
        self
    }

    /// Adds the number that [`limit`](Self::limit) returns.
    pub(crate) fn with_limit(mut self, limit: f64) -> Self {
        self.0.limit = Some(limit);
        self
    }

    /// The cause, for programs that react to it.
    #[must_use]
    pub fn kind(&self) -> ErrorKind {
        self.0.kind
    }

    /// The name of what was wrong: `spacing`, `min_x`, `ring 2`.
    #[must_use]
    pub fn field(&self) -> &str {
        &self.0.field
    }

    /// The value it had, as text. Long texts are cut.
    #[must_use]
    pub fn value(&self) -> &str {
        &self.0.value
    }

    /// The problem with the value; empty where [`allowed`](Self::allowed) says it all.
    #[must_use]
    pub fn problem(&self) -> &str {
        &self.0.problem
    }

    /// The allowed values: `a number from 1e-100 to 1e100`.
    #[must_use]
    pub fn allowed(&self) -> &str {
        &self.0.allowed
    }

    /// The limit as a number, for the [kinds](ErrorKind) that document one.
    #[must_use]
    pub fn limit(&self) -> Option<f64> {
        self.0.limit
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Parts {
            field,
            value,
            problem,
            allowed,
            ..
        } = &*self.0;
        write!(f, "{field} is {value}")?;
        if !problem.is_empty() {
            write!(f, ": {problem}")?;
        }
        if allowed.is_empty() {
            Ok(())
        } else {
            write!(f, "; it must be {allowed}")
        }
    }
}

impl fmt::Debug for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?}: {self}", self.0.kind)
    }
}

impl core::error::Error for Error {}

/// A number for a message: plain digits, or an exponent where there would be too many.
pub(crate) fn number(value: f64) -> String {
    let plain = value == 0.0 || !value.is_finite() || (1e-5..1e16).contains(&value.abs());
    if plain && WORDS {
        alloc::format!("{value}")
    } else {
        exponential(value)
    }
}

/// A number for a message, with an exponent.
pub(crate) fn exponential(value: f64) -> String {
    if WORDS {
        alloc::format!("{value:e}")
    } else {
        bits(value)
    }
}

/// A number for a message, with some digits after the point.
pub(crate) fn rounded(value: f64, digits: usize) -> String {
    if WORDS {
        alloc::format!("{value:.digits$}")
    } else {
        let scale = 10_u64.pow(digits as u32) as f64;
        bits(libm::round(value * scale) / scale)
    }
}

/// A text in quotes, cut and escaped.
pub(crate) fn quoted(text: &str) -> String {
    let text = shown(text);
    if WORDS {
        alloc::format!("{text:?}")
    } else {
        ["\"", &text, "\""].concat()
    }
}

/// The bits of a number, where texts of numbers are left out.
fn bits(value: f64) -> String {
    alloc::format!("#{:016x}", value.to_bits())
}

/// Cuts long input for a message.
pub(crate) fn shown(text: &str) -> String {
    const MOST: usize = 80;
    match text.char_indices().nth(MOST) {
        Some((at, _)) => alloc::format!("{}…", &text[..at]),
        None => text.into(),
    }
}
