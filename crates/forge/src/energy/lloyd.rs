//! Centroidal Voronoi energy: the squared distance from each place to its nearest point.
//!
//! E = Σ ∫ |x − p|² over the Voronoi cell of p. Its gradient at p is 2·area·(p − centroid), so at
//! unit density a step of ½ against it leads to the centroid: Lloyd's relaxation.

use super::SetEnergy;
use crate::measure::{Polygon, Sample, cells};

/// The centroidal Voronoi energy.
#[derive(Clone, Copy, Debug)]
pub struct Lloyd;

/// The moments of a Voronoi cell about its point p.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cell {
    /// The area, ∫ 1.
    pub area: f64,
    /// The first moment, ∫ x − p: the area times the vector from p to the centroid.
    pub first: [f64; 2],
    /// The second moment, ∫ |x − p|².
    pub second: f64,
}

impl Lloyd {
    /// Returns the Voronoi cells of a periodic set, in order of the points.
    pub fn cells(set: &Sample) -> Vec<Cell> {
        let mut all = vec![Cell::default(); set.points().len()];
        for (index, cell) in cells(set, 0.0, moments) {
            all[index as usize] = cell;
        }
        all
    }
}

impl SetEnergy for Lloyd {
    fn evaluate(&self, set: &Sample, gradient: &mut [[f64; 2]]) -> f64 {
        let mut energy = 0.0;
        let cells = Self::cells(set);
        for (cell, out) in cells.iter().zip(gradient) {
            *out = cell.first.map(|v| -2.0 * v);
            energy += cell.second;
        }
        energy / cells.len().max(1) as f64
    }
}

/// The moments of a cell, as sums over the triangles of its edges and its point.
fn moments(polygon: &Polygon) -> Cell {
    let mut cell = Cell::default();
    let corners = &polygon.corners;
    for (at, [a, _]) in corners.iter().enumerate() {
        let [b, _] = &corners[(at + 1) % corners.len()];
        let cross = a[0] * b[1] - a[1] * b[0];
        cell.area += 0.5 * cross;
        for axis in 0..2 {
            cell.first[axis] += cross * (a[axis] + b[axis]) / 6.0;
            let square = a[axis] * a[axis] + a[axis] * b[axis] + b[axis] * b[axis];
            cell.second += cross * square / 12.0;
        }
    }
    cell
}

#[cfg(test)]
mod tests {
    use strew_core::{Map, Twin};

    use super::*;
    use crate::{
        numeric::SplitMix,
        optimize::{Sets, check_slopes, jitter},
    };

    #[test]
    fn cells_fill_the_torus() {
        let cells = Lloyd::cells(&Sample::torus(1.0, SplitMix::new(4).places(3000, 1.0)));
        let sum: f64 = cells.iter().map(|cell| cell.area).sum();
        assert!((sum - 3000.0).abs() < 1e-8, "{sum}");
    }

    #[test]
    fn the_gradient_is_that_of_the_energy() {
        let map = Map::new("(5-sqrt(3))/2".parse().expect("valid"), 9).expect("small");
        let blocks = map.intervals() * map.intervals();
        let twin = map.twins().find(|twin| twin.points() > 600);
        let mut sets = Sets::new(Lloyd, &map, twin.as_slice());
        check_slopes(&mut sets, &jitter(blocks, 0.4, 4), &[0, 7, blocks / 2]);
    }

    /// The largest difference between the displacements of two points of the same block after
    /// `steps` steps to the centroid.
    fn disagreement(radius: u32, steps: u32) -> f64 {
        let map = Map::new("(5-sqrt(3))/2".parse().expect("valid"), radius).expect("small");
        let twin = Twin::new(683, 418).expect("coprime");
        let sites = twin.sites(&map).expect("a twin");
        let start = sites.iter().map(|s| [f64::from(s.x), f64::from(s.y)]);
        let mut set = Sample::torus(twin.period() as f64, start.collect());
        let start = set.points().to_vec();
        for _ in 0..steps {
            let cells = Lloyd::cells(&set);
            for (p, cell) in set.points_mut().iter_mut().zip(&cells) {
                *p = [
                    p[0] + cell.first[0] / cell.area,
                    p[1] + cell.first[1] / cell.area,
                ];
            }
        }
        let n = map.intervals();
        let mut first: Vec<Option<[f64; 2]>> = vec![None; n * n];
        let mut worst = 0.0f64;
        for ((site, p), q) in sites.iter().zip(set.points()).zip(&start) {
            let way = [p[0] - q[0], p[1] - q[1]];
            let block = site.block_y as usize * n + site.block_x as usize;
            let other = first[block].get_or_insert(way);
            worst = worst.max((way[0] - other[0]).abs().max((way[1] - other[1]).abs()));
        }
        worst
    }

    #[test]
    fn points_of_a_block_move_alike_while_the_block_fixes_their_neighborhood() {
        // A cell reaches 0.9 mean spacings, so a step depends on points up to 1.8 away. A block of
        // half-width 49 fixes the neighborhood up to 15.
        for steps in [2, 6] {
            let found = disagreement(49, steps);
            assert!(found < 1e-9, "{steps}: {found}");
        }
        assert!(disagreement(7, 1) < 1e-9);
        // Six steps depend on points farther away than a block of half-width 7 fixes.
        assert!(disagreement(7, 6) > 1e-4);
    }
}
