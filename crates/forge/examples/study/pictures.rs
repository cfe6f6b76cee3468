//! The pictures: a lit ball, land from above, and hills in the evening.

use std::{fs::File, io::BufReader, path::Path};

use strew_core::{
    Field, PointSet, Raster, Region,
    field::{Edges, FieldSpec, Pixels},
};
use strew_raster::{Image, Limits};

use crate::{
    Outcome,
    ground::{Grid, Ground, noise, places},
};

/// Cells of the grid for each point. Weighted Voronoi stippling needs many, so that cells of points have round edges.
const CELLS_PER_POINT: f64 = 200.0;

/// A picture in shades of gray.
pub struct Picture {
    pub name: &'static str,
    pub size: [f64; 2],
    /// Darkness in linear light, to the exponent of its contrast: row by row from below.
    field: FieldSpec,
}

impl Picture {
    /// All pictures.
    pub fn all() -> Outcome<[Self; 3]> {
        Ok([ball()?, land()?, hills()?])
    }

    fn new(name: &'static str, width: usize, darkness: Vec<u16>, gamma: f64) -> Outcome<Self> {
        let size = [width, darkness.len() / width].map(|v| v as f64);
        let region = Region::new([0.0, 0.0], size)?;
        let raster = Raster::of(region, Pixels::from_words(width, darkness)?)?;
        let field = FieldSpec::raster(raster.edges(Edges::Clamp).tone(0.0, 1.0, gamma)?)?;
        Ok(Self { name, size, field })
    }

    /// A picture from the darkness at the middles of its pixels, 0 to 1, by places from the lower left corner.
    fn drawn(
        name: &'static str,
        [width, height]: [usize; 2],
        darkness: impl Fn([f64; 2]) -> f64,
    ) -> Outcome<Self> {
        let places = (0..width * height).map(|i| [i % width, i / width].map(|v| v as f64 + 0.5));
        let words = places.map(|at| (darkness(at).clamp(0.0, 1.0) * 65535.0).round() as u16);
        Self::new(name, width, words.collect(), 1.0)
    }

    /// The points of `strew stipple`.
    pub fn stippled(&self, count: usize, seed: u64, steps: u32) -> Outcome<Vec<[f64; 2]>> {
        let set = PointSet::blue().seed(seed).in_field(self.field.clone());
        let region = Region::new([0.0, 0.0], self.size)?;
        let plan = set.settle(steps)?.exactly(count as u128, region)?;
        Ok(places(&plan.to_vec()))
    }

    /// The picture as a density with an integral of `count` points.
    pub fn ground(&self, count: usize) -> Ground<'_> {
        let mut ground = Ground {
            corner: [0.0; 2],
            size: self.size,
            field: &self.field,
            unit: 1.0,
        };
        let Grid {
            densities, cell, ..
        } = self.grid(&ground, count);
        ground.unit = count as f64 / (densities.iter().sum::<f64>() * cell[0] * cell[1]);
        ground
    }

    /// The grid of the picture for a number of points.
    pub fn grid(&self, ground: &Ground<'_>, count: usize) -> Grid {
        let [width, height] = self.size;
        let cell = (width * height / (count as f64 * CELLS_PER_POINT)).sqrt();
        ground.grid(
            [0.0; 2],
            self.size,
            self.size.map(|v| (v / cell).ceil() as usize),
        )
    }
}

/// A ball on a table, with its light, its shade and its shadow.
fn ball() -> Outcome<Picture> {
    const SIDE: f64 = 480.0;
    let light = [-0.48, 0.62, 0.62];
    Picture::drawn("ball", [SIDE as usize; 2], |[x, y]| {
        let [x, y] = [x / SIDE - 0.5, y / SIDE - 0.54].map(|v| v / 0.34);
        let squared = x * x + y * y;
        if squared < 1.0 {
            let normal = [x, y, (1.0 - squared).sqrt()];
            let lit: f64 = (0..3).map(|i| normal[i] * light[i]).sum();
            // What the table throws back lights the ball from below.
            let back = 0.12 * (0.5 - 0.5 * y);
            return 1.0 - 0.03 - back - 0.85 * lit.max(0.0) - 0.6 * lit.max(0.0).powi(24);
        }
        let table = 0.1 + 0.12 * (0.5 - 0.3 * y);
        let [u, v] = [(x - 0.62) / 1.05, (y + 0.98) / 0.3];
        table + 0.6 * (1.0 - (u * u + v * v).min(1.0)).powf(0.7)
    })
}

/// Natural land from above, with light from the upper left, and dark water.
fn land() -> Outcome<Picture> {
    let height = noise(9, 260.0, 6)?;
    Picture::drawn("land", [600, 480], |[x, y]| {
        if height.share([x, y]) < 0.4 {
            return 0.85;
        }
        let slope =
            |dx: f64, dy: f64| height.share([x + dx, y + dy]) - height.share([x - dx, y - dy]);
        let [east, north] = [slope(1.0, 0.0), slope(0.0, 1.0)].map(|v| v * 40.0);
        let lit = (1.0 - 0.9 * east + 0.9 * north) / (1.0 + east * east + north * north).sqrt();
        0.9 - 0.55 * lit
    })
}

/// The hills of the documentation, as its example stipples them.
fn hills() -> Outcome<Picture> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/fields/hills.webp");
    let image = Image::read_picture(BufReader::new(File::open(path)?), Limits::FILES)?;
    let [width, _] = image.size;
    let darkness = image.darkness(false);
    let rows = darkness.chunks_exact(width).rev().flatten();
    Picture::new("hills", width, rows.copied().collect(), 1.6)
}
