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
    /// Tiles of which a few hold a box, with sides up to some.
    pub(super) fn new(within: &Region<D>, most: [f64; D]) -> Self {
        let (min, max) = (within.min(), within.max());
        let sides: [f64; D] = from_fn(|axis| {
            let length = (max[axis] - min[axis]) * (1.0 + 1e-6);
            // Not so for numbers that are infinite or not a number.
            let number = libm::ceil(length / most[axis]).max(1.0);
            if number < 1e15 && length > 0.0 {
                length / number
            } else {
                most[axis]
            }
        });
        Self {
            origin: from_fn(|axis| min[axis] - 4e-7 * (max[axis] - min[axis])),
            sides,
            per_side: sides.map(|side| 1.0 / side),
        }
    }

    /// The first and the last tile of the places up to `room` from one.
    #[inline(always)]
    pub(super) fn places(&self, at: [f64; D], room: [f64; D]) -> [[i64; D]; 2] {
        let mut ends = [[0; D]; 2];
        for axis in 0..D {
            let v = (at[axis] - self.origin[axis]) * self.per_side[axis];
            let room = room[axis] * self.per_side[axis];
            let whole = v as i64;
            let whole = whole - i64::from(whole as f64 > v);
            let part = v - whole as f64;
            let floor = |v: f64| libm::floor(v) as i64;
            ends[0][axis] = if part > room { whole } else { floor(v - room) };
            ends[1][axis] = if part + room < 1.0 {
                whole
            } else {
                floor(v + room)
            };
        }
        ends
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

    fn all(&self) -> usize {
        self.number.iter().product()
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
    /// Points in a box, with a mean spacing, and the greatest distance that is asked for.
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
            points.is_near = vec![false; fine.all()];
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
        points.starts = vec![0; cells.all() + 1];
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

    /// Whether a point may be near a place.
    #[inline(always)]
    pub(super) fn may_have(&self, at: [f64; D]) -> bool {
        !self.all.is_empty() && (D != 2 || self.is_near[self.fine.of(at)])
    }

    /// Whether a point that stays is nearer to a place than a distance; all such points lie up to `room` from it along each axis.
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
