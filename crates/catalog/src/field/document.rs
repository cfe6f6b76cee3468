//! The grammar of fields, as documents: JSON, TOML and messages are read into these types.
//!
//! An object with one member, whose name says the shape. The numbers are checked when the document is
//! [built](super::build).

use base64::{Engine as _, prelude::BASE64_STANDARD};
use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize};
use strew_core::field::{Edges, FieldSpec, Filter};
use strew_error::integer::Whole;
use strew_raster::Price;

use crate::bounded_list::list;

/// A field: a share of the density, from 0 to 1, at each place. Exactly one member.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Document {
    /// The name of a field that is loaded.
    Name(String),
    /// The same share everywhere, 0 to 1.
    Constant(f64),
    /// A share that changes from one place to another, constant before and beyond.
    Ramp(Box<Ramp>),
    /// A share that changes with the distance from a place.
    Radial(Box<Radial>),
    /// A share that changes with the distance from points, lines or polygons.
    Distance(Box<Distance>),
    /// Natural patches.
    Noise(Box<Noise>),
    /// The pixels of a mask.
    Raster(Box<Pixels>),
    /// A share that changes with the height of a terrain.
    Height(Box<Height>),
    /// A share that changes with the slope of a terrain.
    Slope(Box<Slope>),
    /// The product of fields.
    Multiply(Parts),
    /// The least of fields.
    Min(Parts),
    /// The greatest of fields.
    Max(Parts),
    /// 1 − the share of a field.
    Invert(Box<Document>),
    /// The share of a field, mapped by a curve.
    Curve(Box<Curve>),
}

impl Document {
    /// The name of its shape.
    pub const fn shape(&self) -> &'static str {
        match self {
            Self::Name(_) => "name",
            Self::Constant(_) => "constant",
            Self::Ramp(_) => "ramp",
            Self::Radial(_) => "radial",
            Self::Distance(_) => "distance",
            Self::Noise(_) => "noise",
            Self::Raster(_) => "raster",
            Self::Height(_) => "height",
            Self::Slope(_) => "slope",
            Self::Multiply(_) => "multiply",
            Self::Min(_) => "min",
            Self::Max(_) => "max",
            Self::Invert(_) => "invert",
            Self::Curve(_) => "curve",
        }
    }

    /// The document as clients see it: of files only their names.
    pub fn without_folders(&self) -> Self {
        let mut shown = self.clone();
        shown.each_pixels(&mut |pixels| {
            if let Some(file) = &mut pixels.file {
                let name = file.rsplit(['/', '\\']).next().unwrap_or_default();
                *file = name.to_owned();
            }
        });
        shown
    }

    /// Whether it is a name, or one of its parts is.
    pub fn has_names(&self) -> bool {
        match self {
            Self::Name(_) => true,
            Self::Multiply(parts) | Self::Min(parts) | Self::Max(parts) => {
                parts.0.iter().any(Self::has_names)
            }
            Self::Invert(of) => of.has_names(),
            Self::Curve(curve) => curve.of.has_names(),
            _ => false,
        }
    }

    /// The price of decoding its pixels, as far as it holds them itself.
    pub fn price(&self) -> Price {
        let mut all = vec![];
        self.for_each_pixels(&mut |pixels| all.push(pixels.price()));
        all.into_iter().sum()
    }

    /// Visits the pixels of all its parts.
    pub(super) fn for_each_pixels<'a>(&'a self, visit: &mut impl FnMut(&'a Pixels)) {
        match self {
            Self::Raster(pixels) => visit(pixels),
            Self::Height(height) => visit(&height.terrain),
            Self::Slope(slope) => visit(&slope.terrain),
            Self::Multiply(parts) | Self::Min(parts) | Self::Max(parts) => {
                parts.0.iter().for_each(|part| part.for_each_pixels(visit));
            }
            Self::Invert(of) => of.for_each_pixels(visit),
            Self::Curve(curve) => curve.of.for_each_pixels(visit),
            _ => {}
        }
    }

    /// Visits the pixels of all its parts, to change them.
    pub fn each_pixels(&mut self, visit: &mut impl FnMut(&mut Pixels)) {
        match self {
            Self::Raster(pixels) => visit(pixels),
            Self::Height(height) => visit(&mut height.terrain),
            Self::Slope(slope) => visit(&mut slope.terrain),
            Self::Multiply(parts) | Self::Min(parts) | Self::Max(parts) => {
                for part in &mut parts.0 {
                    part.each_pixels(visit);
                }
            }
            Self::Invert(of) => of.each_pixels(visit),
            Self::Curve(curve) => curve.of.each_pixels(visit),
            _ => {}
        }
    }
}

/// x and y, or of a field for points in space x, y and z. In space what has places of two numbers is the same at all
/// heights.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
#[schemars(rename = "FieldPlace")]
pub enum Place {
    /// x and y.
    Plane([f64; 2]),
    /// x, y and z.
    Space([f64; 3]),
}

impl<'de> Deserialize<'de> for Place {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let numbers: Vec<f64> = list(deserializer, 2..=3, "numbers")?;
        Ok(match numbers[..] {
            [x, y, z] => Self::Space([x, y, z]),
            _ => Self::Plane([numbers[0], numbers[1]]),
        })
    }
}

/// `shares[0]` at one place, `shares[1]` at another, linear between them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "FieldRamp")]
pub struct Ramp {
    /// The first place.
    pub from: Place,
    /// The second place.
    pub to: Place,
    /// The shares at both; 0 and 1 by default.
    #[serde(default = "rising")]
    pub shares: [f64; 2],
}

/// `shares[0]` up to `radii[0]`, `shares[1]` from `radii[1]` on, linear between.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "FieldRadial")]
pub struct Radial {
    /// The place.
    pub center: Place,
    /// Two distances in ascending order.
    pub radii: [f64; 2],
    /// The shares at both; 1 and 0 by default.
    #[serde(default = "falling")]
    pub shares: [f64; 2],
}

/// `shares[0]` up to `distances[0]`, `shares[1]` from `distances[1]` on, linear between. Exactly one of points,
/// lines and polygons.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "FieldDistance")]
pub struct Distance {
    /// Points: x and y of each.
    #[serde(
        default,
        deserialize_with = "points",
        skip_serializing_if = "Option::is_none"
    )]
    pub points: Option<Vec<[f64; 2]>>,
    /// Lines: the vertices of each, at least two.
    #[serde(
        default,
        deserialize_with = "lines",
        skip_serializing_if = "Option::is_none"
    )]
    pub lines: Option<Vec<Vec<[f64; 2]>>>,
    /// Rings: the vertices of each, at least three. Rings in rings are holes. Distances inside are below 0.
    #[serde(
        default,
        deserialize_with = "lines",
        skip_serializing_if = "Option::is_none"
    )]
    pub polygons: Option<Vec<Vec<[f64; 2]>>>,
    /// Two distances in ascending order.
    pub distances: [f64; 2],
    /// The shares at both; 0 and 1 by default, which keeps points away.
    #[serde(default = "rising")]
    pub shares: [f64; 2],
}

/// Smooth patches without a pattern.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "FieldNoise")]
pub struct Noise {
    /// Another seed makes other patches; 0 by default. It has nothing to do with the seed of the points.
    #[serde(default, deserialize_with = "Whole::read")]
    pub seed: u64,
    /// The size of the largest patches, in world units.
    pub wavelength: f64,
    /// The number of sizes, 1 to 8; 1 by default. More makes patches rougher.
    #[serde(default = "one_octave", deserialize_with = "Whole::read")]
    pub octaves: u32,
    /// The shares between which the noise lies; 0 and 1 by default.
    #[serde(default = "rising")]
    pub range: [f64; 2],
}

/// Pixels, and where they lie. Exactly one of file, png and f32. The first row is at the top, where y is
/// greatest.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "FieldPixels")]
pub struct Pixels {
    /// A file beside the daemon's: only in its configuration and its folder of fields, and on the command
    /// line.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// A PNG, as base64.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub png: Option<String>,
    /// Floats of 32 bits, little endian, row by row, as base64; with width and height.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub f32: Option<String>,
    /// The width of bare floats, in pixels.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "Whole::read_some"
    )]
    pub width: Option<usize>,
    /// Their height.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "Whole::read_some"
    )]
    pub height: Option<usize>,
    /// Where the pixels lie: min x, min y, max x, max y. By default the place that a GeoTIFF states, else one
    /// world unit for each pixel from the origin on.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bbox: Option<[f64; 4]>,
    /// The values beyond the pixels: zero (the default), clamp, repeat or mirror.
    #[serde(default)]
    pub edges: EdgesName,
    /// The values between the centers of pixels: linear or nearest. By default linear, and nearest where pixels are
    /// bits, or 0 and 1 with white = 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub filter: Option<FilterName>,
    /// The number that counts as 0; 0 by default. Not for a terrain, as those below. With black or white the numbers
    /// are those of the file: of a palette its indices.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub black: Option<f64>,
    /// The number that counts as 1, above black; 255 or 65535 where pixels are integers, else 1. An array and a
    /// GeoTIFF of integers that reach less than an eighth of that need it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub white: Option<f64>,
    /// The share of black; 0 by default.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub low: Option<f64>,
    /// The share of white; 1 by default. It may be below low.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub high: Option<f64>,
    /// The share of v between black and white is low + (high − low)·v^gamma; 1 by default.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gamma: Option<f64>,
}

impl Pixels {
    /// The price of decoding them, as far as the document holds them itself.
    pub fn price(&self) -> Price {
        match (&self.png, self.f32.is_some(), self.width, self.height) {
            (Some(png), ..) => {
                // Whole groups of four characters, of three bytes each.
                let head = png.get(..Price::HEADER / 3 * 4).unwrap_or_default();
                Price::of_png(&BASE64_STANDARD.decode(head).unwrap_or_default())
            }
            (None, true, Some(width), Some(height)) => Price::of_floats([width, height]),
            _ => Price::default(),
        }
    }

    /// The form in which the document holds them, for faults: never the pixels themselves.
    pub fn shown(&self) -> String {
        let bytes = |text: &str| text.trim_end_matches('=').len() * 3 / 4;
        match (&self.file, &self.png, &self.f32) {
            (Some(file), ..) => file.clone(),
            (None, Some(png), _) => format!("a png of {} bytes", bytes(png)),
            (None, None, Some(floats)) => format!("an f32 of {} bytes", bytes(floats)),
            (None, None, None) => String::new(),
        }
    }
}

/// `shares[0]` up to `heights[0]`, `shares[1]` from `heights[1]` on, linear between.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "FieldHeight")]
pub struct Height {
    /// The terrain: the numbers of its pixels are heights.
    pub terrain: Pixels,
    /// Two heights in ascending order.
    pub heights: [f64; 2],
    /// The shares at both; 0 and 1 by default.
    #[serde(default = "rising")]
    pub shares: [f64; 2],
}

/// `shares[0]` up to `slopes[0]`, `shares[1]` from `slopes[1]` on, linear between. A slope is rise over run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "FieldSlope")]
pub struct Slope {
    /// The terrain: the numbers of its pixels are heights, in world units.
    pub terrain: Pixels,
    /// Two slopes in ascending order.
    pub slopes: [f64; 2],
    /// The shares at both; 1 and 0 by default.
    #[serde(default = "falling")]
    pub shares: [f64; 2],
}

/// Shares mapped to shares, linear between points.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "FieldCurve")]
pub struct Curve {
    /// The field.
    pub of: Document,
    /// Pairs of a share of the field and what it becomes, 2 to 256, in ascending order of the first.
    #[serde(deserialize_with = "curve")]
    #[schemars(length(min = 2, max = 256))]
    pub points: Vec<[f64; 2]>,
}

/// The values beyond the pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(rename = "FieldEdges")]
pub enum EdgesName {
    /// Nothing.
    #[default]
    Zero,
    /// The outermost pixels.
    Clamp,
    /// The pixels, repeated.
    Repeat,
    /// The pixels, repeated in mirror image.
    Mirror,
}

impl From<EdgesName> for Edges {
    fn from(name: EdgesName) -> Self {
        match name {
            EdgesName::Zero => Self::Zero,
            EdgesName::Clamp => Self::Clamp,
            EdgesName::Repeat => Self::Repeat,
            EdgesName::Mirror => Self::Mirror,
        }
    }
}

/// The values between the centers of pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(rename = "FieldFilter")]
pub enum FilterName {
    /// Linear between the four nearest.
    Linear,
    /// The nearest pixel.
    Nearest,
}

impl From<FilterName> for Filter {
    fn from(name: FilterName) -> Self {
        match name {
            FilterName::Linear => Self::Linear,
            FilterName::Nearest => Self::Nearest,
        }
    }
}

/// Fields that are joined: at least one.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Parts(pub Vec<Document>);

impl<'de> Deserialize<'de> for Parts {
    /// Stops at more than a field may have, so that a long list takes no memory.
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        list(deserializer, 0..=FieldSpec::MAX_PARTS, "fields").map(Self)
    }
}

type Vertices = Vec<[f64; 2]>;

/// The vertices of one shape.
#[derive(Deserialize)]
struct Line(#[serde(deserialize_with = "vertices")] Vertices);

fn vertices<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vertices, D::Error> {
    list(deserializer, 0..=FieldSpec::MAX_VERTICES, "vertices")
}

/// Several of them.
#[derive(Deserialize)]
struct Lines(#[serde(deserialize_with = "shapes")] Vec<Line>);

fn shapes<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<Line>, D::Error> {
    list(deserializer, 0..=FieldSpec::MAX_VERTICES, "shapes")
}

fn points<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Vertices>, D::Error> {
    let points = Option::<Line>::deserialize(deserializer)?;
    Ok(points.map(|points| points.0))
}

fn lines<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Vec<Vertices>>, D::Error> {
    let lines = Option::<Lines>::deserialize(deserializer)?;
    Ok(lines.map(|lines| lines.0.into_iter().map(|line| line.0).collect()))
}

fn curve<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<[f64; 2]>, D::Error> {
    list(deserializer, 0..=FieldSpec::MAX_CURVE, "points")
}

const fn rising() -> [f64; 2] {
    [0.0, 1.0]
}

const fn falling() -> [f64; 2] {
    [1.0, 0.0]
}

const fn one_octave() -> u32 {
    1
}
