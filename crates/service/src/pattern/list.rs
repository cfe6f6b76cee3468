//! The formats in which occurrences are listed.

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum List {
    Json,
    NdJson,
    /// Lines of numbers, the first with the names of columns.
    Csv,
}

impl List {
    pub fn from_name(name: &str) -> Option<Self> {
        let all = [Self::Json, Self::NdJson, Self::Csv];
        all.into_iter().find(|list| list.name() == name)
    }

    pub const fn name(self) -> &'static str {
        match self {
            Self::Json => "json",
            Self::NdJson => "ndjson",
            Self::Csv => "csv",
        }
    }

    pub const fn content_type(self) -> &'static str {
        match self {
            Self::Json => "application/json",
            Self::NdJson => "application/x-ndjson",
            Self::Csv => "text/csv",
        }
    }
}
