//! The layout of pictures: the place, the size and the color of each point's dot.
//!
//! y points up, as on a map. The longer side of the region has the requested size, and the shorter side follows. A
//! dot's radius is a quarter of the mean spacing, within bounds, so that few points are visible and many run together
//! as late as possible.

use std::sync::Arc;

use strew_core::Plan;
use strew_error::{Error, Fault};

use super::{
    EncodeError,
    part::Part,
    rows::Row,
    schema::{Kind, Schema},
};

/// The smallest longer side.
pub const LEAST_SIZE: u32 = 16;
/// The largest longer side: a picture is held while it is drawn, a byte for each pixel.
pub const MOST_SIZE: u32 = 4096;
/// The rule for `size`, in words.
pub const SIZE: &str = "an integer from 16 to 4096";

/// With this number of dots for each pixel, at the least size, hardly any white is left. Sets of up to four times as
/// many dots are drawn as they are.
const DOTS_PER_PIXEL: f64 = 3.0;

/// The colors of Okabe and Ito (2008), distinct with any color vision; the faintest last.
pub(super) const COLORS: [[u8; 3]; 8] = [
    [0x00, 0x00, 0x00],
    [0xe6, 0x9f, 0x00],
    [0x56, 0xb4, 0xe9],
    [0x00, 0x9e, 0x73],
    [0xd5, 0x5e, 0x00],
    [0x00, 0x72, 0xb2],
    [0xcc, 0x79, 0xa7],
    [0xf0, 0xe4, 0x42],
];

/// Where points lie in a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Frame {
    /// Pixels from left to right.
    pub(super) width: u32,
    /// Pixels from top to bottom.
    pub(super) height: u32,
    /// The radius of a dot in pixels.
    pub(super) radius: f64,
    left: f64,
    top: f64,
    scale: f64,
}

impl Frame {
    /// A picture of the regions of some parts, `size` pixels on the longer side.
    pub(super) fn new(parts: &[Part], size: u32) -> Self {
        let (mut min, mut max) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for region in parts.iter().map(|part| part.plan.region()) {
            for axis in 0..2 {
                min[axis] = min[axis].min(region.min()[axis]);
                max[axis] = max[axis].max(region.max()[axis]);
            }
        }
        // Without any part, a picture of nothing.
        let (width, height) = (max[0] - min[0], max[1] - min[1]);
        let longer = width.max(height);
        let pixels = |side: f64| ((f64::from(size) * (side / longer)).round() as u32).max(1);
        let scale = f64::from(size) / longer;
        let count: u128 = parts.iter().map(|part| part.plan.count()).sum();
        let (width, height) = (pixels(width).min(size), pixels(height).min(size));
        let spacing = (f64::from(width) * f64::from(height) / count.max(1) as f64).sqrt();
        Self {
            width,
            height,
            radius: (spacing / 4.0).clamp(0.5, f64::from(size) / 128.0 + 0.5),
            left: min[0],
            top: max[1],
            scale,
        }
    }

    /// This frame with dots of another size, in spacings of the first part's points at full density.
    pub(super) fn with_dots(mut self, dot: Option<f64>, parts: &[Part]) -> Self {
        if let (Some(dot), Some(part)) = (dot, parts.first()) {
            let spacing = part.plan.spacing() * self.scale;
            self.radius = 0.5 * dot * spacing;
        }
        self
    }

    /// The parts to draw in place of these, so that a picture costs what it shows. Where points are so
    /// much finer than pixels that dots cover every pixel, a sparser set in the same area covers them as
    /// well.
    ///
    /// # Errors
    /// [`Error::Invalid`] for a window of too many points, since no sparser set can stand for it.
    pub(super) fn shown(&self, parts: Vec<Part>) -> Result<Vec<Part>, Error> {
        let pixels = f64::from(self.width) * f64::from(self.height);
        let shown = |part: Part| {
            let (min, max) = (part.plan.region().min(), part.plan.region().max());
            let sides = [0, 1].map(|axis| (max[axis] - min[axis]) * self.scale);
            // In a strip thinner than a pixel few points lie side by side.
            let thinnest = sides[0].min(sides[1]).min(1.0);
            let wanted = DOTS_PER_PIXEL / (thinnest * thinnest).max(1e-3) * pixels.max(1.0);
            let area = (max[0] - min[0]) * (max[1] - min[1]);
            let coarse = (area / wanted).sqrt();
            if part.plan.count() as f64 <= 4.0 * wanted {
                return Ok(part);
            }
            let whole = part.plan.plane().filter(|plan| !plan.is_window());
            let dense = |plan: &&Plan| {
                let spacing = plan.placement().spacing.get();
                let density = plan.placement().keep.get() / (spacing * spacing);
                density * area <= 4.0 * wanted
            };
            if part.plan.plane().is_some_and(|plan| dense(&plan)) {
                return Ok(part);
            }
            let Some(plan) = whole else {
                let what = match part.plan.space() {
                    Some(_) => "a volume",
                    None => "a part or a period",
                };
                let detail = format!("{what} of {} points is drawn", part.plan.count());
                let allowed = format!(
                    "png of all points, or of at most {:.0} of them at this size",
                    4.0 * wanted
                );
                let fault = Fault::new("format", "png", detail, allowed);
                return Err(fault.into());
            };
            let plan = plan.preview(coarse).map_err(EncodeError::of)?;
            Ok(Part {
                plan: Arc::new(plan),
                ..part
            })
        };
        parts.into_iter().map(shown).collect()
    }

    /// The place of a point in pixels from the upper left corner.
    pub(super) fn place(&self, row: Row<'_>) -> [f64; 2] {
        [
            (row.point.x - self.left) * self.scale,
            (self.top - row.point.y) * self.scale,
        ]
    }
}

/// The color of a row: that of its layer, else that of its first name, else black.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Coloring {
    column: Option<usize>,
    /// The number of colors.
    pub(super) colors: usize,
}

impl Coloring {
    pub(super) fn new(schema: &Schema) -> Self {
        let names = |kind: &Kind| match kind {
            Kind::Number => None,
            Kind::Dictionary(names) => Some(names.len()),
        };
        let mut columns = schema.columns().iter().enumerate();
        let first = columns.find_map(|(i, column)| Some((i, names(&column.kind)?)));
        Self {
            column: first.map(|(i, _)| i),
            colors: first.map_or(1, |(_, names)| names.clamp(1, COLORS.len())),
        }
    }

    /// The number of a row's color. With more names than colors, they are used again.
    pub(super) fn of(self, row: Row<'_>) -> usize {
        let values = self.column.and_then(|column| row.columns.get(column));
        let index = values.and_then(|values| values.index(row.index));
        index.map_or(0, |index| index as usize % self.colors)
    }
}
