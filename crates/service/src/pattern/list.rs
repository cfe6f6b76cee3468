//! The formats in which occurrences are listed.

/// The format of a list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum List {
    /// One document with the facts.
    Json,
    /// An object on each line.
    NdJson,
    /// Lines of numbers, the first with the names of columns.
    Csv,
}

impl List {
    /// The format with a name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        let all = [Self::Json, Self::NdJson, Self::Csv];
        all.into_iter().find(|list| list.name() == name)
    }

    /// Its name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Json => "json",
            Self::NdJson => "ndjson",
            Self::Csv => "csv",
        }
    }

    /// Its content type.
    #[must_use]
    pub const fn content_type(self) -> &'static str {
        match self {
            Self::Json => "application/json",
            Self::NdJson => "application/x-ndjson",
            Self::Csv => "text/csv",
        }
    }
}
