//! The points of a window, and sorting them by cells.

use alloc::vec::Vec;
use core::ops::Range;

/// The number of rows of cells, and of cells in a row for each [`FINE`], is at most this.
const MOST_ROWS: i64 = 1024;

/// The number of cells in the length of a row's height.
pub(super) const FINE: usize = 8;

/// Marks a point that moves. Windows have fewer points than this.
pub(super) const MOVES: u32 = 1 << 31;

/// The points of a window, in no order. All lists have the same length.
#[derive(Clone, Debug, Default)]
pub(super) struct Places {
    /// Where they are and where they were placed, in fixed-point units from a corner.
    pub(super) at: [Vec<i32>; 2],
    pub(super) placed: [Vec<i32>; 2],
    /// The shares, not below [`LEAST_SHARE`](super::LEAST_SHARE).
    pub(super) share: Vec<f32>,
    /// The part of each move that is made.
    pub(super) freedom: Vec<f32>,
    /// The steps in which a point moves: those up to this.
    pub(super) until: Vec<u8>,
    /// The pushes of the points of the same kind in the next step, in quanta; empty where kinds have none.
    pub(super) of_kin: [Vec<i32>; 2],
}

impl Places {
    pub(super) fn clear(&mut self) {
        let lists = self.at.iter_mut().chain(&mut self.placed);
        for list in lists.chain(&mut self.of_kin) {
            list.clear();
        }
        self.share.clear();
        self.freedom.clear();
        self.until.clear();
    }

    pub(super) const fn len(&self) -> usize {
        self.share.len()
    }
}

/// A point, sorted by cells.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sorted {
    pub(super) at: [i32; 2],
    pub(super) share: f32,
    /// Its place in the lists, with [`MOVES`].
    pub(super) point: u32,
}

/// Divides offsets from a corner by the side of a cell. It may round either way, but is monotone.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Divisor {
    corner: i32,
    factor: u32,
    /// The number of cells.
    pub(super) cells: usize,
}

impl Divisor {
    fn new(corner: i32, extent: i64, side: i64) -> Self {
        let mut divisor = Self {
            corner,
            factor: ((1i64 << 32) / side) as u32,
            cells: 0,
        };
        divisor.cells = divisor.cell((i64::from(corner) + extent - 1) as i32) + 1;
        divisor
    }

    /// The cell of a coordinate that is not before the corner.
    #[inline(always)]
    const fn cell(self, v: i32) -> usize {
        let offset = v.wrapping_sub(self.corner) as u32;
        ((offset as u64 * self.factor as u64) >> 32) as usize
    }

    /// The cells from one coordinate to another one, as far as there are any.
    #[inline(always)]
    pub(super) fn cells(self, from: i64, to: i64) -> Range<usize> {
        let corner = i64::from(self.corner);
        let cell = |v: i64| {
            let offset = (v - corner).clamp(0, i64::from(u32::MAX)) as u64;
            ((offset * u64::from(self.factor)) >> 32) as usize
        };
        cell(from).min(self.cells)..(cell(to) + 1).min(self.cells)
    }
}

/// The memory of steps: the points sorted by cells, which are low and wide rows cut finely along x.
#[derive(Clone, Debug, Default)]
pub(super) struct Cells {
    pub(super) along: [Divisor; 2],
    /// The height of a row.
    pub(super) side: i64,
    /// By cell, row after row: the place of its first point; one more for the end.
    pub(super) starts: Vec<u32>,
    cell: Vec<u32>,
    pub(super) points: Vec<Sorted>,
    /// The least share of all points, and the least by squares of [`FINE`] cells if not all are alike.
    pub(super) least: f32,
    sparsest: Vec<f32>,
    pub(super) are_alike: bool,
}

impl Cells {
    /// Sorts the points by cells. Which cell a point is in never matters to where it goes.
    #[inline(always)]
    pub(super) fn sort(&mut self, places: &Places, reach: f64, step: u8) {
        let number = places.len();
        let [xs, ys] = places.at.each_ref().map(|list| &list[..number]);
        let ends = [xs, ys].map(|list| {
            list.iter()
                .fold((i32::MAX, i32::MIN), |(a, b), &v| (a.min(v), b.max(v)))
        });
        let shares = &places.share[..number];
        let least = |a: f32, &b: &f32| if b < a { b } else { a };
        self.least = shares.iter().fold(f32::INFINITY, least);
        self.are_alike = shares.iter().all(|share| *share == self.least);
        let extents = ends.map(|(a, b)| i64::from(b) - i64::from(a) + 1);
        let area = extents[0] as f64 * extents[1] as f64;
        let side = (reach * libm::sqrt(area / number as f64)) as i64;
        let side = extents.iter().fold(side, |side, e| side.max(e / MOST_ROWS));
        let side = side.clamp(1 << 16, i64::from(i32::MAX));
        self.side = side;
        let [x, y] = [
            Divisor::new(ends[0].0, extents[0], side / FINE as i64),
            Divisor::new(ends[1].0, extents[1], side),
        ];
        self.along = [x, y];
        let columns = x.cells;
        self.starts.clear();
        self.starts.resize(columns * y.cells + 1, 0);
        self.cell.clear();
        let cells = xs.iter().zip(ys);
        let cells = cells.map(|(&at_x, &at_y)| (y.cell(at_y) * columns + x.cell(at_x)) as u32);
        self.cell.extend(cells);
        for &cell in &self.cell {
            self.starts[cell as usize] += 1;
        }
        let mut before = 0;
        for start in &mut self.starts {
            before += *start;
            *start = before;
        }
        self.points.resize(number, Sorted::default());
        let lists = self.cell.iter().zip(xs.iter().zip(ys)).zip(shares);
        let lists = lists.zip(places.until[..number].iter().zip(&places.freedom[..number]));
        for (i, (((&cell, (&x, &y)), &share), (&until, &freedom))) in lists.enumerate().rev() {
            let start = &mut self.starts[cell as usize];
            *start -= 1;
            let moves = (until >= step) & (freedom != 0.0);
            self.points[*start as usize] = Sorted {
                at: [x, y],
                share,
                point: i as u32 | if moves { MOVES } else { 0 },
            };
        }
        if !self.are_alike {
            self.find_sparsest(y.cells, columns);
        }
    }

    /// Finds the least share in each square.
    #[inline(always)]
    fn find_sparsest(&mut self, rows: usize, columns: usize) {
        self.sparsest.clear();
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
                    .fold(f32::INFINITY, |a, b| if b.share < a { b.share } else { a });
                self.sparsest.push(least);
            }
        }
    }

    /// The least share in some columns and rows.
    #[inline(always)]
    pub(super) fn least_in(&self, [columns, rows]: &[Range<usize>; 2]) -> f32 {
        let Cells {
            along, sparsest, ..
        } = self;
        let across = along[0].cells.div_ceil(FINE);
        let columns = columns.start / FINE..columns.end.div_ceil(FINE);
        let mut least = 1.0f32;
        for row in rows.clone() {
            for &share in &sparsest[row * across..][columns.clone()] {
                least = if share < least { share } else { least };
            }
        }
        least
    }
}
