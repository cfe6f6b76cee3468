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
    /// One GeoJSON feature collection.
    Geojson,
    /// GeoJSON features as a text sequence.
    Geojsonseq,
    /// A NumPy array of `f64`.
    Npy,
    /// PLY vertices, binary and little-endian.
    Ply,
    /// An Arrow IPC stream.
    Arrow,
    /// A picture in pixels.
    Png,
    /// A picture of circles.
    Svg,
    /// A Parquet file; only for files, not by any protocol.
    Parquet,
}

impl Encoding {
    /// All formats that are streamed: all but Parquet, which is for files.
    pub const ALL: [Self; 12] = [
        Self::Json,
        Self::Ndjson,
        Self::Csv,
        Self::F32,
        Self::F64,
        Self::Geojson,
        Self::Geojsonseq,
        Self::Npy,
        Self::Ply,
        Self::Arrow,
        Self::Png,
        Self::Svg,
    ];

    /// The name in queries.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Json => "json",
            Self::Ndjson => "ndjson",
            Self::Csv => "csv",
            Self::F32 => "f32",
            Self::F64 => "f64",
            Self::Geojson => "geojson",
            Self::Geojsonseq => "geojsonseq",
            Self::Npy => "npy",
            Self::Ply => "ply",
            Self::Arrow => "arrow",
            Self::Png => "png",
            Self::Svg => "svg",
            Self::Parquet => "parquet",
        }
    }

    /// The format with a name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        let mut all = Self::ALL.into_iter().chain([Self::Parquet]);
        all.find(|encoding| encoding.name() == name)
    }

    /// Whether the daemon streams it; other formats are for files only.
    #[must_use]
    pub fn is_streamed(self) -> bool {
        Self::ALL.contains(&self)
    }

    /// The content type, when the format is asked for by name. NumPy's and PLY are registered by
    /// nobody; these are the names in use.
    #[must_use]
    pub const fn content_type(self) -> &'static str {
        match self {
            Self::Json => "application/json",
            Self::Ndjson => "application/x-ndjson",
            Self::Csv => "text/csv; charset=utf-8; header=present",
            Self::F32 | Self::F64 => "application/octet-stream",
            Self::Geojson => "application/geo+json",
            Self::Geojsonseq => "application/geo+json-seq",
            Self::Npy => "application/x-npy",
            Self::Ply => "application/ply",
            Self::Arrow => "application/vnd.apache.arrow.stream",
            Self::Png => "image/png",
            Self::Svg => "image/svg+xml",
            Self::Parquet => "application/vnd.apache.parquet",
        }
    }

    /// Whether numbers are written as digits.
    #[must_use]
    pub const fn is_text(self) -> bool {
        match self {
            Self::Json
            | Self::Ndjson
            | Self::Csv
            | Self::Geojson
            | Self::Geojsonseq
            | Self::Svg => true,
            Self::F32
            | Self::F64
            | Self::Npy
            | Self::Ply
            | Self::Arrow
            | Self::Png
            | Self::Parquet => false,
        }
    }

    /// Whether it is a picture.
    #[must_use]
    pub const fn is_picture(self) -> bool {
        matches!(self, Self::Png | Self::Svg)
    }

    /// The names of the formats that some test holds for, for an error.
    pub(super) fn names_where(holds: impl Fn(Self) -> bool) -> String {
        let names = Self::ALL.into_iter().filter(|encoding| holds(*encoding));
        names.map(Self::name).collect::<Vec<_>>().join(", ")
    }
}
