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
    /// A binary glTF file: meshes that are drawn at every point.
    Glb,
    /// A USD stage as text: instancers.
    Usda,
    /// The buffer of a Godot `MultiMesh`.
    Multimesh,
    /// Records of 16 bytes for graphics cards, relative to the box's lower corner.
    Instances,
    /// A Parquet file. Only the command line writes it.
    Parquet,
    /// An Arrow IPC file. Only the command line writes it.
    Feather,
}

impl Encoding {
    /// The formats that only the command line writes, to files.
    pub const FILES: [Self; 2] = [Self::Parquet, Self::Feather];

    /// The formats that are streamed.
    pub const ALL: [Self; 16] = [
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
        Self::Glb,
        Self::Usda,
        Self::Multimesh,
        Self::Instances,
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
            Self::Glb => "glb",
            Self::Usda => "usda",
            Self::Multimesh => "multimesh",
            Self::Instances => "instances",
            Self::Parquet => "parquet",
            Self::Feather => "feather",
        }
    }

    /// The format with a name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        let mut all = Self::ALL.into_iter().chain(Self::FILES);
        all.find(|encoding| encoding.name() == name)
    }

    /// Whether the daemon streams it; other formats are for files only.
    #[must_use]
    pub fn is_streamed(self) -> bool {
        Self::ALL.contains(&self)
    }

    /// Whether this build writes it: Arrow and Parquet come with the feature `columnar`.
    #[must_use]
    pub const fn is_written(self) -> bool {
        cfg!(feature = "columnar") || !matches!(self, Self::Arrow | Self::Feather | Self::Parquet)
    }

    /// The content type of the format when a client names it. Those of NumPy and PLY are not registered, but in use.
    #[must_use]
    pub const fn content_type(self) -> &'static str {
        match self {
            Self::Json => "application/json",
            Self::Ndjson => "application/x-ndjson",
            Self::Csv => "text/csv; charset=utf-8; header=present",
            Self::F32 | Self::F64 | Self::Multimesh | Self::Instances => "application/octet-stream",
            Self::Geojson => "application/geo+json",
            Self::Geojsonseq => "application/geo+json-seq",
            Self::Npy => "application/x-npy",
            Self::Ply => "application/ply",
            Self::Arrow => "application/vnd.apache.arrow.stream",
            Self::Png => "image/png",
            Self::Svg => "image/svg+xml",
            Self::Glb => "model/gltf-binary",
            Self::Usda => "model/vnd.usda",
            Self::Parquet => "application/vnd.apache.parquet",
            Self::Feather => "application/vnd.apache.arrow.file",
        }
    }

    /// The name under which browsers save an answer.
    #[must_use]
    pub const fn file_name(self) -> &'static str {
        match self {
            Self::Json => "points.json",
            Self::Ndjson => "points.ndjson",
            Self::Csv => "points.csv",
            Self::F32 => "points.f32",
            Self::F64 => "points.f64",
            Self::Geojson => "points.geojson",
            Self::Geojsonseq => "points.geojsonl",
            Self::Npy => "points.npy",
            Self::Ply => "points.ply",
            Self::Arrow => "points.arrows",
            Self::Png => "points.png",
            Self::Svg => "points.svg",
            Self::Glb => "points.glb",
            Self::Usda => "points.usda",
            Self::Multimesh => "points.multimesh",
            Self::Instances => "points.instances",
            Self::Parquet => "points.parquet",
            Self::Feather => "points.arrow",
        }
    }

    /// Whether browsers show an answer by themselves instead of saving it.
    #[must_use]
    pub const fn is_shown(self) -> bool {
        matches!(self, Self::Json | Self::Png | Self::Svg)
    }

    /// Whether coordinates are `f32`, relative to a corner.
    #[must_use]
    pub const fn is_near(self) -> bool {
        matches!(
            self,
            Self::F32 | Self::Glb | Self::Usda | Self::Multimesh | Self::Instances
        )
    }

    /// Whether `decimals` has an effect.
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
            | Self::Glb
            | Self::Usda
            | Self::Multimesh
            | Self::Instances
            | Self::Parquet
            | Self::Feather => false,
        }
    }

    /// Whether its last line can be a summary.
    #[must_use]
    pub const fn has_summary(self) -> bool {
        matches!(self, Self::Ndjson)
    }

    /// Whether readers want to know what plane coordinates are in.
    #[must_use]
    pub const fn has_crs(self) -> bool {
        matches!(self, Self::Geojson | Self::Parquet)
    }

    /// Whether it is a picture.
    #[must_use]
    pub const fn is_picture(self) -> bool {
        matches!(self, Self::Png | Self::Svg)
    }

    /// The names of the formats that some test holds for, for an error.
    pub fn names_where(holds: impl Fn(Self) -> bool) -> String {
        let all = Self::ALL.into_iter().chain(Self::FILES);
        let names = all.filter(|encoding| holds(*encoding));
        names.map(Self::name).collect::<Vec<_>>().join(", ")
    }
}
