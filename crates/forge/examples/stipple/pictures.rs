//! The pictures: a lit ball, land from above, and hills in the evening.

use std::{error::Error, fs::File, io::BufReader, path::Path};

use strew_core::{
    Field, PointSet, Raster, Region,
    field::{Edges, FieldSpec, Noise, Pixels},
};
use strew_forge::numeric::SplitMix;
use strew_raster::{Image, Limits};

/// Cells of the ground for each point. Weighted Voronoi stippling needs many, so that cells of points have round edges.
const CELLS_PER_POINT: f64 = 200.0;

/// A picture in shades of gray.
pub struct Picture {
    pub name: &'static str,
    width: usize,
    height: usize,
    /// Darkness in linear light, to the exponent of its contrast: row by row from below.
    field: FieldSpec,
}

impl Picture {
    /// All pictures.
    pub fn all() -> Result<Vec<Self>, Box<dyn Error>> {
        Ok(vec![ball()?, land()?, hills()?])
    }

    fn new(
        name: &'static str,
        width: usize,
        darkness: Vec<u16>,
        gamma: f64,
    ) -> Result<Self, Box<dyn Error>> {
        let height = darkness.len() / width;
        let region = Region::new([0.0, 0.0], [width as f64, height as f64])?;
        let raster = Raster::of(region, Pixels::from_words(width, darkness)?)?;
        let field = FieldSpec::raster(raster.edges(Edges::Clamp).tone(0.0, 1.0, gamma)?)?;
        Ok(Self {
            name,
            width,
            height,
            field,
        })
    }

    /// A picture from the darkness at the middles of its pixels, 0 to 1, by places from the lower left corner.
    fn drawn(
        name: &'static str,
        [width, height]: [usize; 2],
        darkness: impl Fn([f64; 2]) -> f64,
    ) -> Result<Self, Box<dyn Error>> {
        let places = (0..width * height).map(|i| [i % width, i / width].map(|v| v as f64 + 0.5));
        let words = places.map(|at| (darkness(at).clamp(0.0, 1.0) * 65535.0).round() as u16);
        Self::new(name, width, words.collect(), 1.0)
    }

    /// The name of the file with what became of it.
    pub fn file(&self) -> String {
        format!("{}.png", self.name)
    }

    pub fn size(&self) -> [f64; 2] {
        [self.width, self.height].map(|v| v as f64)
    }

    /// The points of `strew stipple`.
    pub fn stippled(
        &self,
        count: u64,
        seed: u64,
        steps: u32,
    ) -> Result<Vec<[f64; 2]>, Box<dyn Error>> {
        let set = PointSet::blue()
            .seed(seed)
            .in_field(self.field.clone())
            .settle(steps)?;
        let plan = set.exactly(count.into(), Region::new([0.0, 0.0], self.size())?)?;
        Ok(plan
            .to_vec()
            .iter()
            .map(|point| [point.x, point.y])
            .collect())
    }

    /// The picture as a density with an integral of `count` points.
    pub fn ground(&self, count: usize) -> Result<Ground, Box<dyn Error>> {
        let [width, height] = self.size();
        let cell = (width * height / (count as f64 * CELLS_PER_POINT)).sqrt();
        let [columns, rows] = [width, height].map(|v| (v / cell).ceil() as usize);
        let cell = [width / columns as f64, height / rows as f64];
        let middle = |i: usize| [i % columns, i / columns].map(|v| v as f64 + 0.5);
        let places = (0..columns * rows).map(middle);
        let places: Vec<[f64; 2]> = places.map(|[x, y]| [x * cell[0], y * cell[1]]).collect();
        let mut densities = vec![0.0; places.len()];
        self.field.shares(&places, &mut densities);
        let sum: f64 = densities.iter().sum();
        let unit = count as f64 / (sum * cell[0] * cell[1]);
        densities.iter_mut().for_each(|v| *v *= unit);
        Ok(Ground {
            count,
            columns,
            cell,
            densities,
            unit,
            field: self.field.clone(),
        })
    }
}

/// A picture as a density: on a grid, and at each place.
pub struct Ground {
    pub count: usize,
    pub columns: usize,
    /// The width and height of a cell.
    pub cell: [f64; 2],
    /// Points of a unit of area, by cells, row by row.
    pub densities: Vec<f64>,
    /// The density where the picture is black.
    unit: f64,
    field: FieldSpec,
}

impl Ground {
    pub fn density(&self, at: [f64; 2]) -> f64 {
        self.field.share(at) * self.unit
    }

    /// Independent places, spread by the density.
    pub fn chance(&self, count: usize, seed: u64) -> Vec<[f64; 2]> {
        let mut random = SplitMix::new(seed);
        let mut sum = 0.0;
        let add = |v: &f64| {
            sum += v;
            sum
        };
        let sums: Vec<f64> = self.densities.iter().map(add).collect();
        let places = (0..count).map(|_| {
            let drawn = random.next_f64() * sum;
            let i = sums.partition_point(|&v| v <= drawn).min(sums.len() - 1);
            let corner = [i % self.columns, i / self.columns];
            [0, 1].map(|axis| (corner[axis] as f64 + random.next_f64()) * self.cell[axis])
        });
        places.collect()
    }
}

/// A ball on a table, with its light, its shade and its shadow.
fn ball() -> Result<Picture, Box<dyn Error>> {
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
fn land() -> Result<Picture, Box<dyn Error>> {
    let height = FieldSpec::noise(Noise {
        seed: 9,
        wavelength: 260.0,
        octaves: 6,
        range: [0.0, 1.0],
    })?;
    Picture::drawn("land", [600, 480], |[x, y]| {
        let level = height.share([x, y]);
        if level < 0.4 {
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
fn hills() -> Result<Picture, Box<dyn Error>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/fields/hills.webp");
    let image = Image::read_picture(BufReader::new(File::open(path)?), Limits::FILES)?;
    let [width, _] = image.size;
    let darkness = image.darkness(false);
    let rows = darkness.chunks_exact(width).rev().flatten();
    Picture::new("hills", width, rows.copied().collect(), 1.6)
}
