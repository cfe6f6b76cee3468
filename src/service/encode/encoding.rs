//! The formats of an answer: their names and content types.

/// The formats of an answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    /// One JSON document.
    Json,
    /// One JSON document a line.
    Ndjson,
    /// Comma-separated values.
    Csv,
    /// Interleaved little-endian `f32` pairs, relative to the box's lower corner.
    F32,
    /// Interleaved little-endian `f64` pairs.
    F64,
}

impl Encoding {
    /// All formats.
    pub const ALL: [Self; 5] = [Self::Json, Self::Ndjson, Self::Csv, Self::F32, Self::F64];

    /// The name in queries.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Json => "json",
            Self::Ndjson => "ndjson",
            Self::Csv => "csv",
            Self::F32 => "f32",
            Self::F64 => "f64",
        }
    }

    /// The format of a name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL
            .into_iter()
            .find(|encoding| encoding.name() == name)
    }

    /// The content type, when the format is asked for by name.
    #[must_use]
    pub const fn content_type(self) -> &'static str {
        match self {
            Self::Json => "application/json",
            Self::Ndjson => "application/x-ndjson",
            Self::Csv => "text/csv; charset=utf-8; header=present",
            Self::F32 | Self::F64 => "application/octet-stream",
        }
    }

    /// Whether numbers are written as digits.
    #[must_use]
    pub const fn is_text(self) -> bool {
        matches!(self, Self::Json | Self::Ndjson | Self::Csv)
    }

    /// The names of the formats that some test holds for, for an error.
    pub(super) fn names_where(holds: impl Fn(Self) -> bool) -> String {
        let names = Self::ALL.into_iter().filter(|encoding| holds(*encoding));
        names.map(Self::name).collect::<Vec<_>>().join(", ")
    }
}
