//! Centroidal Voronoi energy: the squared distance from each place to its nearest point.
//!
//! E = Σ ∫ |x − p|² over the Voronoi cell of p. Its gradient at p is 2·area·(p − centroid), so at
//! unit density a step of ½ against it leads to the centroid: Lloyd's relaxation.
//!
//! Each Voronoi cell is cut out of a square by the bisectors to the points around, in the order of
//! a cell list from the inside out. Plain arithmetic in this fixed order yields the same bits on
//! every machine and with any number of threads. A triangulation, which would have to be built anew
//! in every step, is not needed.

use rayon::prelude::*;

use super::SetEnergy;
use crate::{cell_list::CellList, measure::Sample};

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

/// Half the side of the square that cells are cut from, in mean spacings. No cell is nearly as
/// large.
const HALF_SIDE: f64 = 4.0;
/// Points per parallel task.
const CHUNK: usize = 256;

impl Lloyd {
    /// Returns the Voronoi cells of a periodic set of at least 100 points, in order of the points.
    pub fn cells(set: &Sample) -> Vec<Cell> {
        let list = CellList::of(set, 1.0);
        let found: Vec<Vec<(u32, Cell)>> = list
            .members
            .par_chunks(CHUNK)
            .map(|chunk| {
                let mut cutter = Cutter::default();
                let of = |&(index, p): &(u32, [f64; 2])| (index, cutter.cell(&list, index, p));
                chunk.iter().map(of).collect()
            })
            .collect();
        let mut cells = vec![Cell::default(); set.points().len()];
        for (index, cell) in found.into_iter().flatten() {
            cells[index as usize] = cell;
        }
        cells
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

/// Cuts Voronoi cells, one at a time.
#[derive(Default)]
struct Cutter {
    /// The corners of the cell so far, counterclockwise, relative to its point.
    corners: Vec<[f64; 2]>,
    /// The corners of the next cut.
    spare: Vec<[f64; 2]>,
    /// The largest squared distance of a corner from the point.
    reach: f64,
}

impl Cutter {
    /// The cell of the point `p`, which has the index `own`.
    fn cell(&mut self, list: &CellList, own: u32, p: [f64; 2]) -> Cell {
        self.corners.clear();
        self.corners.extend([
            [-HALF_SIDE, -HALF_SIDE],
            [HALF_SIDE, -HALF_SIDE],
            [HALF_SIDE, HALF_SIDE],
            [-HALF_SIDE, HALF_SIDE],
        ]);
        self.reach = 2.0 * HALF_SIDE * HALF_SIDE;
        for ring in 0.. {
            // Bisectors to points in this ring are at least this far away.
            let far = 0.5 * f64::from((ring - 1).max(0)) * list.width();
            if far * far > self.reach {
                break;
            }
            list.ring(p, ring.into(), |index, [dx, dy]| {
                let squared = dx * dx + dy * dy;
                if squared < 4.0 * self.reach && !(index == own && squared == 0.0) {
                    self.cut([-dx, -dy], 0.5 * squared);
                }
            });
        }
        self.moments()
    }

    /// Keeps the part of the cell where x·n ≤ `limit`.
    fn cut(&mut self, n: [f64; 2], limit: f64) {
        let excess = |c: &[f64; 2]| c[0] * n[0] + c[1] * n[1] - limit;
        if self.corners.iter().all(|c| excess(c) <= 0.0) {
            return;
        }
        self.spare.clear();
        for (at, corner) in self.corners.iter().enumerate() {
            let next = &self.corners[(at + 1) % self.corners.len()];
            let (here, there) = (excess(corner), excess(next));
            if here <= 0.0 {
                self.spare.push(*corner);
            }
            if (here <= 0.0) != (there <= 0.0) {
                let part = here / (here - there);
                let along = |axis: usize| corner[axis] + part * (next[axis] - corner[axis]);
                self.spare.push([along(0), along(1)]);
            }
        }
        std::mem::swap(&mut self.corners, &mut self.spare);
        let squared = |c: &[f64; 2]| c[0] * c[0] + c[1] * c[1];
        self.reach = self.corners.iter().map(squared).fold(0.0, f64::max);
    }

    /// The moments of the polygon, as sums over the triangles of its edges and its point.
    fn moments(&self) -> Cell {
        let mut cell = Cell::default();
        for (at, a) in self.corners.iter().enumerate() {
            let b = &self.corners[(at + 1) % self.corners.len()];
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
}

#[cfg(test)]
mod tests {
    use strew_core::{Map, Twin};

    use super::*;
    use crate::{
        measure::Voronoi,
        numeric::SplitMix,
        optimize::{Sets, check_slopes, jitter},
    };

    fn noise(count: usize) -> Sample {
        Sample::torus(1.0, SplitMix::new(4).places(count, 1.0))
    }

    #[test]
    fn cells_fill_the_torus_and_agree_with_a_triangulation() {
        let set = noise(3000);
        let cells = Lloyd::cells(&set);
        let sum: f64 = cells.iter().map(|cell| cell.area).sum();
        assert!((sum - 3000.0).abs() < 1e-8, "{sum}");
        let worst = cells.iter().map(|cell| (cell.area - 1.0).abs());
        let expected = Voronoi::of(&set);
        assert!((worst.fold(0.0, f64::max) - expected.area_deviation).abs() < 1e-9);
        let squares: f64 = cells.iter().map(|cell| (cell.area - 1.0).powi(2)).sum();
        assert!(((squares / 3000.0).sqrt() - expected.area_spread).abs() < 1e-9);
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
