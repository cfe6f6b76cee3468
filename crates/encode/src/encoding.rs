//! The formats of an answer: one table of all that is known of them. Beside its row, a format has a file that writes it
//! and an arm in [`Answer`](crate::Answer).

/// A format.
struct Format {
    /// The name in queries.
    name: &'static str,
    /// The media types that clients may accept, the usual one first. Those of NumPy and PLY are not registered, but in use.
    accepted: &'static [&'static str],
    /// The content type of an answer, where it is not the usual media type.
    content_type: Option<&'static str>,
    /// The endings of the names of files, the one under which browsers save an answer first.
    endings: &'static [&'static str],
    traits: Traits,
}

/// Properties that some formats have.
#[derive(Clone, Copy, Debug)]
pub struct Traits {
    /// Browsers show an answer by themselves instead of saving it.
    pub is_shown: bool,
    /// Coordinates are `f32`, relative to a corner.
    pub is_near: bool,
    /// `decimals` has an effect.
    pub is_text: bool,
    /// The last line can be a summary.
    pub has_summary: bool,
    /// Readers want to know what plane coordinates are in.
    pub has_crs: bool,
    /// It is a picture.
    pub is_picture: bool,
    /// Arrow and Parquet come with the feature `columnar`.
    pub is_columnar: bool,
}

const BINARY: Traits = Traits {
    is_shown: false,
    is_near: false,
    is_text: false,
    has_summary: false,
    has_crs: false,
    is_picture: false,
    is_columnar: false,
};

const TEXT: Traits = Traits {
    is_text: true,
    ..BINARY
};

const NEAR: Traits = Traits {
    is_near: true,
    ..BINARY
};

const COLUMNS: Traits = Traits {
    is_columnar: true,
    ..BINARY
};

/// Declares the formats with their rows.
macro_rules! formats {
    ($(
        $(#[$doc:meta])* $format:ident = $name:literal,
        $accepted:expr, $content_type:expr, $endings:expr, $traits:expr;
    )*) => {
        /// The formats of an answer.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Encoding { $($(#[$doc])* $format,)* }

        /// The rows, in the order of [`Encoding`].
        const FORMATS: &[Format] = &[$(Format {
            name: $name,
            accepted: &$accepted,
            content_type: $content_type,
            endings: &$endings,
            traits: $traits,
        },)*];

        impl Encoding {
            /// All formats.
            pub const ALL: &[Self] = &[$(Self::$format,)*];
        }
    };
}

formats! {
    /// One JSON document.
    Json = "json", ["application/json"], None, ["json"], Traits { is_shown: true, ..TEXT };
    /// One JSON document a line.
    Ndjson = "ndjson", ["application/x-ndjson", "application/ndjson", "application/jsonl"], None,
        ["ndjson", "jsonl"], Traits { has_summary: true, ..TEXT };
    /// Comma-separated values.
    Csv = "csv", ["text/csv"], Some("text/csv; charset=utf-8; header=present"), ["csv"], TEXT;
    /// Interleaved little-endian `f32` pairs, relative to the box's lower corner.
    F32 = "f32", ["application/vnd.strew.f32"], Some(BYTES), ["f32"], NEAR;
    /// Interleaved little-endian `f64` pairs.
    F64 = "f64", ["application/vnd.strew.f64", BYTES], Some(BYTES), ["f64"], BINARY;
    /// One GeoJSON feature collection.
    Geojson = "geojson", ["application/geo+json"], None, ["geojson"], Traits { has_crs: true, ..TEXT };
    /// GeoJSON features as a text sequence.
    Geojsonseq = "geojsonseq", ["application/geo+json-seq"], None, ["geojsonl", "geojsons", "geojsonseq"], TEXT;
    /// A NumPy array of `f64`.
    Npy = "npy", ["application/x-npy"], None, ["npy"], BINARY;
    /// PLY vertices, binary and little-endian.
    Ply = "ply", ["application/ply", "model/ply"], None, ["ply"], BINARY;
    /// An Arrow IPC stream.
    Arrow = "arrow", ["application/vnd.apache.arrow.stream"], None, ["arrows"], COLUMNS;
    /// A picture in pixels.
    Png = "png", ["image/png"], None, ["png"],
        Traits { is_shown: true, is_picture: true, ..BINARY };
    /// A picture of circles.
    Svg = "svg", ["image/svg+xml"], None, ["svg"], Traits { is_shown: true, is_picture: true, ..TEXT };
    /// A binary glTF file: meshes that are drawn at every point.
    Glb = "glb", ["model/gltf-binary"], None, ["glb"], NEAR;
    /// A USD stage as text: instancers.
    Usda = "usda", ["model/vnd.usda"], None, ["usda"], NEAR;
    /// The buffer of a Godot `MultiMesh`.
    Multimesh = "multimesh", ["application/vnd.strew.multimesh"], Some(BYTES), ["multimesh"], NEAR;
    /// Records of 16 bytes for graphics cards, relative to the box's lower corner.
    Instances = "instances", ["application/vnd.strew.instances"], Some(BYTES), ["instances"], NEAR;
    /// A Parquet file.
    Parquet = "parquet", ["application/vnd.apache.parquet"], None, ["parquet"],
        Traits { has_crs: true, ..COLUMNS };
    /// An Arrow IPC file.
    Feather = "feather", ["application/vnd.apache.arrow.file"], None, ["arrow", "feather"], COLUMNS;
}

const BYTES: &str = "application/octet-stream";

impl Encoding {
    const fn format(self) -> &'static Format {
        &FORMATS[self as usize]
    }

    /// The name in queries.
    #[must_use]
    pub const fn name(self) -> &'static str {
        self.format().name
    }

    /// The format with a name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        (Self::ALL.iter().copied()).find(|encoding| encoding.name() == name)
    }

    /// The format of a file whose name has an ending: `arrow` is that of files.
    #[must_use]
    pub fn of_ending(ending: &str) -> Option<Self> {
        (Self::ALL.iter().copied()).find(|encoding| encoding.format().endings.contains(&ending))
    }

    /// Whether this build writes it: Arrow and Parquet come with the feature `columnar`.
    #[must_use]
    pub const fn is_written(self) -> bool {
        cfg!(feature = "columnar") || !self.traits().is_columnar
    }

    /// The media types that clients may accept, the usual one first.
    #[must_use]
    pub const fn accepted(self) -> &'static [&'static str] {
        self.format().accepted
    }

    /// The content type of the format when a client names it.
    #[must_use]
    pub const fn content_type(self) -> &'static str {
        match self.format().content_type {
            Some(own) => own,
            None => self.accepted()[0],
        }
    }

    /// The name under which browsers save an answer.
    #[must_use]
    pub fn file_name(self) -> String {
        format!("points.{}", self.format().endings[0])
    }

    /// The properties of the format.
    #[must_use]
    pub const fn traits(self) -> &'static Traits {
        &self.format().traits
    }

    /// The names of the formats that this build writes, for a text.
    pub fn names() -> String {
        Self::names_where(Self::is_written)
    }

    /// The names of the formats that some test holds for, for an error.
    pub fn names_where(holds: impl Fn(Self) -> bool) -> String {
        let holding = Self::ALL.iter().filter(|encoding| holds(**encoding));
        holding.map(|of| of.name()).collect::<Vec<_>>().join(", ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_an_ending_and_a_media_type_are_of_one_format_alone() {
        let every = || FORMATS.iter();
        assert_eq!(every().count(), Encoding::ALL.len());
        let lists: [Vec<&str>; 3] = [
            every().map(|format| format.name).collect(),
            every().flat_map(|format| format.endings).copied().collect(),
            (every().flat_map(|format| format.accepted).copied()).collect(),
        ];
        for mut list in lists {
            let all = list.len();
            list.sort_unstable();
            list.dedup();
            assert_eq!(list.len(), all, "{list:?}");
        }
        for &encoding in Encoding::ALL {
            assert_eq!(Encoding::from_name(encoding.name()), Some(encoding));
            // The name of a format is an ending of its files; `arrow` is that of files of Arrow.
            let of_ending = Encoding::of_ending(encoding.name());
            assert!(of_ending == Some(encoding) || encoding == Encoding::Arrow);
        }
    }
}
