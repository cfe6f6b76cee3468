//! Ground on which the density of points varies, its points, and how near they lie in units of the local density.

use rayon::prelude::*;
use strew_core::{
    Field, Point, PointSet, Region,
    field::{FieldSpec, Noise},
};

use crate::Outcome;

/// The neighbor distance of the hexagonal lattice, in mean spacings.
pub const HEXAGONAL: f64 = 1.074_569_931_823_542;

/// A rectangle of the plane. Places are relative to its corner.
pub struct Ground<'a> {
    pub corner: [f64; 2],
    pub size: [f64; 2],
    pub field: &'a dyn Field,
    /// The density where the share of the field is 1.
    pub unit: f64,
}

/// Densities at the middles of the cells of a grid, row by row.
pub struct Grid {
    pub columns: usize,
    /// The width and height of a cell.
    pub cell: [f64; 2],
    pub densities: Vec<f64>,
}

impl Grid {
    /// The middles of the cells, from the corner of the grid.
    pub fn places(&self) -> impl Iterator<Item = [f64; 2]> {
        (0..self.densities.len()).map(|number| {
            let cell = [number % self.columns, number / self.columns];
            [0, 1].map(|i| (cell[i] as f64 + 0.5) * self.cell[i])
        })
    }
}

impl Ground<'_> {
    pub fn density(&self, [x, y]: [f64; 2]) -> f64 {
        let at = [self.corner[0] + x, self.corner[1] + y];
        self.field.share(at) * self.unit
    }

    /// A grid of some columns and rows over a box.
    pub fn grid(&self, corner: [f64; 2], size: [f64; 2], numbers: [usize; 2]) -> Grid {
        let mut grid = Grid {
            columns: numbers[0],
            cell: [0, 1].map(|i| size[i] / numbers[i] as f64),
            densities: vec![0.0; numbers[0] * numbers[1]],
        };
        let place = |p: [f64; 2]| [0, 1].map(|i| self.corner[i] + corner[i] + p[i]);
        let places: Vec<[f64; 2]> = grid.places().map(place).collect();
        self.field.shares(&places, &mut grid.densities);
        grid.densities.iter_mut().for_each(|v| *v *= self.unit);
        grid
    }
}

/// Nearest-neighbor distances in hexagonal distances of the local density.
pub struct Near {
    pub least: f64,
    /// 1 % of the points have a nearer neighbor.
    pub hundredth: f64,
    pub mean: f64,
    /// Pairs below 0.4, counted by their points.
    pub pairs: f64,
    /// The least distance, in world units.
    pub plain: f64,
}

impl Near {
    /// Distances of points on a ground. A pair is measured by its denser point.
    pub fn of(ground: &Ground<'_>, points: &[[f64; 2]]) -> Self {
        let points = points.iter().map(|&p| (p, ground.density(p)));
        let mut points: Vec<([f64; 2], f64)> = points.collect();
        points.sort_by(|(a, _), (b, _)| a[0].total_cmp(&b[0]));
        let nearest = |i: usize| {
            let (p, density) = points[i];
            let (mut best, mut plain) = (f64::INFINITY, f64::INFINITY);
            // Whether points farther away along x can be nearer than the best one.
            let mut look = |(q, other): &([f64; 2], f64)| {
                let distance = (q[0] - p[0]).hypot(q[1] - p[1]);
                if distance > 0.0 {
                    plain = plain.min(distance);
                    best = best.min(distance * density.max(*other).sqrt());
                }
                (q[0] - p[0]).abs() * density.sqrt() < best
            };
            let (before, after) = points.split_at(i);
            let _ = before.iter().rev().all(&mut look);
            let _ = after.iter().all(&mut look);
            (best / HEXAGONAL, plain)
        };
        let each = (0..points.len()).into_par_iter().map(nearest);
        let (mut all, plain): (Vec<f64>, Vec<f64>) = each.unzip();
        all.sort_by(f64::total_cmp);
        Self {
            least: all[0],
            hundredth: all[all.len() / 100],
            mean: all.iter().sum::<f64>() / all.len() as f64,
            pairs: all.partition_point(|&v| v < 0.4) as f64 / 2.0,
            plain: plain.into_iter().fold(f64::INFINITY, f64::min),
        }
    }
}

/// The points of a square, from its corner.
pub fn square(set: &PointSet, corner: [f64; 2], side: f64) -> Outcome<Vec<Point>> {
    let region = Region::new(corner, corner.map(|v| v + side))?;
    let mut points = set.within(region)?.to_vec();
    for point in &mut points {
        (point.x, point.y) = (point.x - corner[0], point.y - corner[1]);
    }
    Ok(points)
}

/// Where points are.
pub fn places(points: &[Point]) -> Vec<[f64; 2]> {
    points.iter().map(Point::at).collect()
}

/// Natural noise from 0 to 1.
pub fn noise(seed: u64, wavelength: f64, octaves: u32) -> Outcome<FieldSpec> {
    let range = [0.0, 1.0];
    Ok(FieldSpec::noise(Noise {
        seed,
        wavelength,
        octaves,
        range,
    })?)
}
