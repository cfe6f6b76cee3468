//! The points of a window, and sorting them by cells.

use alloc::vec::Vec;
use core::ops::Range;

use super::plain::{ROUNDER, greater, lesser};

/// The number of rows of cells, and of cells in a row for each [`FINE`], is at most this.
const MOST_ROWS: f32 = 1024.0;

/// The number of cells in the length of a row's height.
pub(super) const FINE: usize = 8;

/// Marks a point that moves. Windows have fewer points than this.
pub(super) const MOVES: u32 = 1 << 31;

/// The points of a window, in no order. All lists have the same length.
#[derive(Clone, Debug)]
pub(super) struct Places<const D: usize> {
    /// Where they are and where they were placed from a corner: integers, in units of the window.
    pub(super) at: [Vec<f32>; D],
    pub(super) placed: [Vec<f32>; D],
    /// The [weights](super::freedom::weight) of the shares.
    pub(super) weight: Vec<f32>,
    /// The part of each move that is made.
    pub(super) freedom: Vec<f32>,
    /// The steps in which a point moves: those up to this.
    pub(super) until: Vec<u8>,
    /// The pushes of the points of the same kind in the next step; empty where kinds have none.
    pub(super) of_kin: [Vec<i32>; D],
}

impl<const D: usize> Default for Places<D> {
    fn default() -> Self {
        Self {
            at: [const { Vec::new() }; D],
            placed: [const { Vec::new() }; D],
            weight: Vec::new(),
            freedom: Vec::new(),
            until: Vec::new(),
            of_kin: [const { Vec::new() }; D],
        }
    }
}

impl<const D: usize> Places<D> {
    pub(super) fn clear(&mut self) {
        for list in self.at.iter_mut().chain(&mut self.placed) {
            list.clear();
        }
        for list in &mut self.of_kin {
            list.clear();
        }
        self.weight.clear();
        self.freedom.clear();
        self.until.clear();
    }

    pub(super) const fn len(&self) -> usize {
        self.weight.len()
    }
}

/// A point, sorted by cells.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sorted<const D: usize> {
    pub(super) at: [f32; D],
    pub(super) weight: f32,
    /// Its place in the lists, with [`MOVES`].
    pub(super) point: u32,
}

/// Divides coordinates into cells. It may round either way, but is monotone.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Divisor {
    corner: f32,
    per_unit: f32,
    /// The number of cells.
    pub(super) cells: usize,
}

impl Divisor {
    fn new([least, most]: [f32; 2], side: f32) -> Self {
        let mut divisor = Self {
            corner: least,
            per_unit: 1.0 / side,
            cells: 0,
        };
        divisor.cells = divisor.cell(most) as usize + 1;
        divisor
    }

    /// The cell of a coordinate that is not before the corner.
    #[inline(always)]
    const fn cell(self, v: f32) -> u32 {
        ((v - self.corner) * self.per_unit + ROUNDER).to_bits() - ROUNDER.to_bits()
    }

    /// The cells from one coordinate to another one, as far as there are any.
    #[inline(always)]
    pub(super) fn cells(self, from: f32, to: f32) -> Range<usize> {
        let first = self.cell(greater(from, self.corner)) as usize;
        let end = if to < self.corner {
            0
        } else {
            // No farther than a rounder reaches.
            self.cell(lesser(to, self.corner + 4e6 / self.per_unit)) as usize + 1
        };
        first.min(self.cells)..end.min(self.cells)
    }
}

/// The memory of steps: the points sorted by cells, which are low and wide rows cut finely along x.
#[derive(Clone, Debug)]
pub(super) struct Cells<const D: usize> {
    pub(super) along: [Divisor; D],
    /// The height of a row.
    pub(super) side: f32,
    /// By cell, row after row: the place of its first point; one more for the end.
    pub(super) starts: Vec<u32>,
    cell: Vec<u32>,
    pub(super) points: Vec<Sorted<D>>,
    /// The least weight of all points, and the least by squares of [`FINE`] cells if not all are alike.
    pub(super) least: f32,
    lightest: Vec<f32>,
    pub(super) are_alike: bool,
}

impl<const D: usize> Default for Cells<D> {
    fn default() -> Self {
        Self {
            along: [Divisor::default(); D],
            side: 0.0,
            starts: Vec::new(),
            cell: Vec::new(),
            points: Vec::new(),
            least: 0.0,
            lightest: Vec::new(),
            are_alike: false,
        }
    }
}

impl<const D: usize> Cells<D> {
    /// The number of rows.
    pub(super) fn rows(&self) -> usize {
        self.along[1..].iter().map(|axis| axis.cells).product()
    }

    /// The rows between some cells along all axes but x.
    #[inline(always)]
    pub(super) fn rows_between(
        &self,
        cells: &[Range<usize>; D],
    ) -> impl Iterator<Item = usize> + use<D> {
        let across = self.along[1].cells;
        let (ys, zs) = (cells[1].clone(), cells.get(2).cloned().unwrap_or(0..1));
        zs.flat_map(move |z| ys.clone().map(move |y| z * across + y))
    }

    /// Sorts the points by cells, with their weights times `weight`. Which cell a point is in never matters to where it
    /// goes.
    #[inline(always)]
    pub(super) fn sort(&mut self, places: &Places<D>, (reach, weight): (f32, f32), step: u8) {
        let number = places.len();
        let at = places.at.each_ref().map(|list| &list[..number]);
        let ends = at.map(self::ends);
        let weights = &places.weight[..number];
        let [least, most] = self::ends(weights);
        self.least = least * weight;
        self.are_alike = least == most;
        let sides = ends.map(|[least, most]| most - least + 1.0);
        let size: f64 = sides.iter().map(|side| f64::from(*side)).product();
        let spacing = if D == 2 { libm::sqrt } else { libm::cbrt }(size / number as f64);
        let longest = sides.iter().fold(0.0, |a, &b| greater(b, a));
        let side = greater(greater(reach * spacing as f32, longest / MOST_ROWS), 512.0);
        self.side = side;
        self.along = core::array::from_fn(|axis| {
            let parts = if axis == 0 { FINE as f32 } else { 1.0 };
            Divisor::new(ends[axis], side / parts)
        });
        let along = self.along;
        let (columns, rows) = (along[0].cells, self.rows());
        self.starts.clear();
        self.starts.resize(columns * rows + 1, 0);
        self.cell.clear();
        self.cell.extend((0..number).map(|i| {
            let mut cell = 0;
            for axis in (0..D).rev() {
                cell = cell * along[axis].cells as u32 + along[axis].cell(at[axis][i]);
            }
            cell
        }));
        for &cell in &self.cell {
            self.starts[cell as usize] += 1;
        }
        let mut before = 0;
        for start in &mut self.starts {
            before += *start;
            *start = before;
        }
        let none = Sorted {
            at: [0.0; D],
            weight: 0.0,
            point: 0,
        };
        self.points.resize(number, none);
        let points = &mut self.points[..number];
        let lists = self.cell.iter().zip(weights);
        let lists = lists.zip(places.until[..number].iter().zip(&places.freedom[..number]));
        for (i, ((&cell, &own), (&until, &freedom))) in lists.enumerate().rev() {
            let start = &mut self.starts[cell as usize];
            *start -= 1;
            let moves = (until >= step) & (freedom > 0.0);
            points[*start as usize] = Sorted {
                at: at.map(|list| list[i]),
                weight: own * weight,
                point: i as u32 | (u32::from(moves) << 31),
            };
        }
        if !self.are_alike {
            self.find_lightest(rows, columns);
        }
    }

    /// Finds the least weight in each square.
    #[inline(always)]
    fn find_lightest(&mut self, rows: usize, columns: usize) {
        self.lightest.clear();
        for row in 0..rows {
            for first in (0..columns).step_by(FINE) {
                let end = (first + FINE).min(columns);
                let (start, end) = (
                    self.starts[row * columns + first],
                    self.starts[row * columns + end],
                );
                let points = &self.points[start as usize..end as usize];
                let least = points
                    .iter()
                    .fold(f32::INFINITY, |a, b| lesser(b.weight, a));
                self.lightest.push(least);
            }
        }
    }

    /// The least weight in some columns and rows.
    #[inline(always)]
    pub(super) fn least_in(&self, cells: &[Range<usize>; D]) -> f32 {
        let Cells {
            along, lightest, ..
        } = self;
        let across = along[0].cells.div_ceil(FINE);
        let columns = cells[0].start / FINE..cells[0].end.div_ceil(FINE);
        let mut least = f32::INFINITY;
        for row in self.rows_between(cells) {
            for &weight in &lightest[row * across..][columns.clone()] {
                least = lesser(weight, least);
            }
        }
        least
    }
}

/// The least and the greatest of some numbers.
#[inline(always)]
fn ends(list: &[f32]) -> [f32; 2] {
    let mut some = [[f32::INFINITY; 8], [-f32::INFINITY; 8]];
    let (whole, rest) = list.as_chunks::<8>();
    let mut add = |k: usize, v: f32| {
        some[0][k] = lesser(v, some[0][k]);
        some[1][k] = greater(v, some[1][k]);
    };
    for part in whole {
        for (k, &v) in part.iter().enumerate() {
            add(k, v);
        }
    }
    for &v in rest {
        add(0, v);
    }
    [
        some[0].iter().fold(f32::INFINITY, |a, &b| lesser(b, a)),
        some[1].iter().fold(-f32::INFINITY, |a, &b| greater(b, a)),
    ]
}
