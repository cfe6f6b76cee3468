//! Tiles of the world, and the points of a tile by cells, prepared to find whether one of them is near a place.

use alloc::{vec, vec::Vec};
use core::array::from_fn;

use crate::shape::Region;

/// Tiles of the world.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grid<const D: usize> {
    origin: [f64; D],
    pub(super) sides: [f64; D],
    per_side: [f64; D],
    /// More than rounding moves a place, in tiles.
    slack: [f64; D],
}

/// The most fine cells along a side.
const MOST_FINE: f64 = 128.0;

/// Cells over a box.
#[derive(Clone, Copy, Debug)]
struct Cells<const D: usize> {
    corner: [f64; D],
    /// The inverse of the side of a cell.
    scale: f64,
    number: [usize; D],
}

/// The points of a tile, by the cells of a grid.
#[derive(Clone, Debug)]
pub(super) struct Points<const D: usize> {
    cells: Cells<D>,
    /// Smaller cells of the tile and around it, and in the plane which of them any point is near: places in the others
    /// need no further look.
    fine: Cells<D>,
    is_near: Vec<bool>,
    /// For each cell where its points begin; then the end. Empty without points.
    starts: Vec<u32>,
    all: Vec<[f64; D]>,
    /// Whether each of them stays, once that is decided.
    stays: Vec<Option<bool>>,
}

impl<const D: usize> Grid<D> {
    /// Tiles with sides up to some, of which as few as can be hold a box, if there is one.
    pub(super) fn new(within: Option<&Region<D>>, most: [f64; D]) -> Self {
        let (min, max) = within.map_or(([0.0; D], most), |within| (within.min(), within.max()));
        let length: [f64; D] = from_fn(|axis| (max[axis] - min[axis]) * (1.0 + 1e-6));
        let origin: [f64; D] = from_fn(|axis| min[axis] - 4e-7 * (max[axis] - min[axis]));
        let sides: [f64; D] =
            from_fn(|axis| length[axis] / libm::ceil(length[axis] / most[axis]).max(1.0));
        Self {
            origin,
            sides,
            per_side: sides.map(|side| 1.0 / side),
            slack: from_fn(|axis| 1e-15 * origin[axis].abs() / sides[axis]),
        }
    }

    /// The first and the last tile of the places up to `room` from one.
    #[inline(always)]
    pub(super) fn places(&self, at: [f64; D], room: [f64; D]) -> [[i64; D]; 2] {
        let end = |sign: f64, axis: usize| {
            let v = (at[axis] - self.origin[axis]) * self.per_side[axis];
            let room = room[axis] * self.per_side[axis] + 1e-15 * v.abs() + self.slack[axis];
            libm::floor(v + sign * room) as i64
        };
        [-1.0, 1.0].map(|sign| from_fn(|axis| end(sign, axis)))
    }

    /// The box of a tile.
    pub(super) fn region(&self, place: [i64; D]) -> Region<D> {
        let corner = |by: i64| {
            from_fn(|axis| {
                let v = place[axis].saturating_add(by) as f64;
                v * self.sides[axis] + self.origin[axis]
            })
        };
        Region::between(corner(0), corner(1))
    }
}

impl<const D: usize> Cells<D> {
    /// Cells with about a side.
    fn new(region: &Region<D>, side: f64) -> Self {
        let (corner, scale) = (region.min(), 1.0 / side);
        let across = |axis: usize| (region.max()[axis] - corner[axis]) * scale;
        Self {
            corner,
            scale,
            number: from_fn(|axis| across(axis) as usize + 1),
        }
    }

    /// The row or column of a coordinate, which never falls where the coordinate grows. A float below 0 becomes 0.
    #[inline(always)]
    fn line(&self, axis: usize, v: f64) -> usize {
        // Conversions to 32 bits are faster.
        let line = ((v - self.corner[axis]) * self.scale) as u32 as usize;
        line.min(self.number[axis] - 1)
    }

    /// The number of the cell of a place.
    #[inline(always)]
    fn of(&self, at: [f64; D]) -> usize {
        self.at(from_fn(|axis| self.line(axis, at[axis])))
    }

    #[inline(always)]
    fn at(&self, lines: [usize; D]) -> usize {
        (0..D)
            .rev()
            .fold(0, |all, axis| all * self.number[axis] + lines[axis])
    }
}

impl<const D: usize> Points<D> {
    /// The points of a box, given their mean spacing and the greatest distance of a test.
    pub(super) fn new(
        region: &Region<D>,
        (spacing, distance): (f64, f64),
        unsorted: &[[f64; D]],
    ) -> Self {
        let cells = Cells::new(region, spacing);
        let around = Region::between(
            region.min().map(|v| v - distance),
            region.max().map(|v| v + distance),
        );
        let longest = around.sides().iter().copied().fold(0.0, f64::max);
        let fine = Cells::new(&around, (0.5 * distance).max(longest / MOST_FINE));
        let mut points = Self {
            cells,
            fine,
            is_near: Vec::new(),
            starts: Vec::new(),
            all: vec![[0.0; D]; unsorted.len()],
            stays: vec![None; unsorted.len()],
        };
        if unsorted.is_empty() {
            return points;
        }
        if D == 2 {
            points.is_near = vec![false; fine.number.iter().product()];
            let room = distance * (1.0 + 1e-9);
            for at in unsorted {
                let lines = |axis| [at[axis] - room, at[axis] + room].map(|v| fine.line(axis, v));
                let ([left, right], [bottom, top]) = (lines(0), lines(1));
                for row in bottom..=top {
                    let row = row * fine.number[0];
                    points.is_near[row + left..=row + right].fill(true);
                }
            }
        }
        points.starts = vec![0; cells.number.iter().product::<usize>() + 1];
        for &at in unsorted {
            points.starts[cells.of(at)] += 1;
        }
        let mut sum = 0;
        for start in &mut points.starts {
            sum += *start;
            *start = sum;
        }
        // Each point moves the end of its cell down, in the end to where the cell begins.
        for &at in unsorted {
            let end = &mut points.starts[cells.of(at)];
            *end -= 1;
            points.all[*end as usize] = at;
        }
        points
    }

    /// The memory that this takes.
    pub(super) fn bytes(&self) -> usize {
        let points = self.all.len() * (size_of::<[f64; D]>() + 1);
        points + size_of_val(&self.starts[..]) + self.is_near.len()
    }

    /// Whether a point may be near a place.
    #[inline(always)]
    pub(super) fn may_have(&self, at: [f64; D]) -> bool {
        !self.all.is_empty() && (D != 2 || self.is_near[self.fine.of(at)])
    }

    /// Whether a point that stays is nearer to a place than a distance. All such points lie up to `room` from it along each
    /// axis.
    #[inline]
    pub(super) fn has_near(
        &mut self,
        (at, room): ([f64; D], [f64; D]),
        distance: f64,
        mut stays: impl FnMut([f64; D]) -> bool,
    ) -> bool {
        let [first, last]: [[usize; D]; 2] = [-1.0, 1.0]
            .map(|sign| from_fn(|axis| self.cells.line(axis, at[axis] + sign * room[axis])));
        let mut row = first;
        loop {
            let from = self.cells.at(row);
            let [from, to] = [from, from + 1 + last[0] - first[0]].map(|i| self.starts[i] as usize);
            let points = self.all[from..to].iter().zip(&mut self.stays[from..to]);
            for (&point, decided) in points {
                if is_nearer(point, at, distance) && *decided.get_or_insert_with(|| stays(point)) {
                    return true;
                }
            }
            let Some(axis) = (1..D).find(|&axis| row[axis] < last[axis]) else {
                return false;
            };
            row[axis] += 1;
            row[..axis].copy_from_slice(&first[..axis]);
        }
    }
}

/// Whether two places are nearer than a distance.
pub(super) fn is_nearer<const D: usize>(a: [f64; D], b: [f64; D], distance: f64) -> bool {
    let squared = (0..D).map(|axis| (a[axis] - b[axis]) * (a[axis] - b[axis]));
    squared.sum::<f64>() < distance * distance
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn points_at_the_edges_of_tiles_are_found(
            min in -1e12..0.0f64, side in 1.0..100.0f64, part in 0.0..1.0f64, distance in 0.01..3.0f64,
        ) {
            let grid = Grid::new(Some(&Region::between([min], [10.0])), [side]);
            // Most places near the origin, far from that of the grid.
            let number = (-min * part.powi(20) / side) as i64;
            let [[place], _] = grid.places([-(number as f64) * side], [0.0]);
            let edge = grid.region([place]).min()[0];
            let places = |at: f64| grid.places([at], [distance * (1.0 + 1e-9) + at.abs() * 1e-15]);
            let below = edge.next_down();
            prop_assert!(places(below + distance)[0][0] < place);
            prop_assert!(places(edge - distance)[1][0] >= place);
        }
    }
}
