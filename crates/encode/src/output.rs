//! How an answer is to look: the format and its options.

use crate::{
    crs::Crs,
    encoding::Encoding,
    place::{Coordinates, Place},
};

/// The default longer side of a picture, in pixels.
pub const DEFAULT_SIZE: u32 = 512;

/// More decimals than this add nothing: an `f64` has 17 significant digits.
pub const MOST_DECIMALS: u8 = 17;

/// The level of zstd that Parquet files are compressed at: higher levels take time and save nothing here.
pub const ZSTD_LEVEL: u8 = 1;

/// How an answer looks.
#[derive(Clone, Debug, PartialEq)]
pub struct Output {
    /// The format.
    pub encoding: Encoding,
    /// Decimals of all numbers in text formats; by default the shortest digits that read back.
    pub decimals: Option<u8>,
    /// The point that coordinates are relative to; by default the world's origin, in `f32` the
    /// region's lower corner.
    pub relative_to: Option<Place>,
    /// The longer side of a picture, in pixels.
    pub size: u32,
    /// Whether a stream of lines ends with a summary.
    pub has_summary: bool,
    /// The coordinate reference system of the plane.
    pub crs: Option<Crs>,
    /// The diameter of dots in a picture, in spacings of points at full density; by default half of a mean
    /// spacing.
    pub dot: Option<f64>,
    /// The level of zstd, for Parquet: 0, not compressed, to 22.
    pub zstd: u8,
}

impl Output {
    /// The coordinates of an answer whose parts have a lower `corner`.
    pub fn coordinates(&self, corner: impl FnOnce() -> Place) -> Coordinates {
        match (self.encoding, self.relative_to) {
            (encoding, origin) if encoding.traits().is_near => {
                Coordinates::Near(origin.unwrap_or_else(corner))
            }
            (encoding, Some(origin)) if !encoding.traits().is_picture => {
                Coordinates::Relative(origin)
            }
            _ => Coordinates::World,
        }
    }

    /// A format without further wishes.
    #[must_use]
    pub const fn new(encoding: Encoding) -> Self {
        Self {
            encoding,
            decimals: None,
            relative_to: None,
            size: DEFAULT_SIZE,
            has_summary: true,
            crs: None,
            dot: None,
            zstd: ZSTD_LEVEL,
        }
    }

    /// The bytes in which an answer is made besides its blocks: those of a picture, or of the rows of a group.
    #[must_use]
    pub const fn room(&self) -> usize {
        match self.encoding {
            Encoding::Png => (self.size as usize).pow(2),
            Encoding::Parquet => 16 << 20,
            _ => 0,
        }
    }

    /// A warning of a mistake that readers of the format may make.
    pub(super) fn warning(&self) -> Option<&'static str> {
        if !matches!(self.encoding, Encoding::Geojson | Encoding::Geojsonseq) {
            return None;
        }
        match &self.crs {
            None => Some(
                "GeoJSON readers take coordinates for degrees of longitude and latitude. Say by crs= what \
                 the plane is, and use a projected one: what is even in degrees is not even on the ground",
            ),
            Some(crs) if crs.is_geographic() => Some(
                "points are even in degrees, not on the ground: use a projected plane, such as a UTM zone",
            ),
            Some(_) if self.encoding == Encoding::Geojsonseq => Some(
                "text sequences (RFC 8142) have no place for a reference system, so readers take coordinates for degrees \
                 of longitude and latitude: use geojson, or parquet",
            ),
            Some(_) => None,
        }
    }
}
