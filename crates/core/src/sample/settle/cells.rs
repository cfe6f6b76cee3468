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
#[derive(Clone, Debug, Default)]
pub(super) struct Places {
    /// Where they are and where they were placed from a corner: integers, in units of the window.
    pub(super) at: [Vec<f32>; 2],
    pub(super) placed: [Vec<f32>; 2],
    /// The shares, not below [`LEAST_SHARE`](super::LEAST_SHARE).
    pub(super) share: Vec<f32>,
    /// The part of each move that is made.
    pub(super) freedom: Vec<f32>,
    /// The steps in which a point moves: those up to this.
    pub(super) until: Vec<u8>,
    /// The pushes of the points of the same kind in the next step; empty where kinds have none.
    pub(super) of_kin: [Vec<i32>; 2],
}

impl Places {
    pub(super) fn clear(&mut self) {
        for list in self.at.iter_mut().chain(&mut self.placed) {
            list.clear();
        }
        for list in &mut self.of_kin {
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
    pub(super) at: [f32; 2],
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
#[derive(Clone, Debug, Default)]
pub(super) struct Cells {
    pub(super) along: [Divisor; 2],
    /// The height of a row.
    pub(super) side: f32,
    /// By cell, row after row: the place of its first point; one more for the end.
    pub(super) starts: Vec<u32>,
    cell: Vec<u32>,
    pub(super) points: Vec<Sorted>,
    /// The least weight of all points, and the least by squares of [`FINE`] cells if not all are alike.
    pub(super) least: f32,
    lightest: Vec<f32>,
    pub(super) are_alike: bool,
}

impl Cells {
    /// Sorts the points by cells, with their shares times `weight`. Which cell a point is in never matters to where it
    /// goes.
    #[inline(always)]
    pub(super) fn sort(&mut self, places: &Places, (reach, weight): (f32, f32), step: u8) {
        let number = places.len();
        let [xs, ys] = [&places.at[0][..number], &places.at[1][..number]];
        let ends = [self::ends(xs), self::ends(ys)];
        let shares = &places.share[..number];
        let [least, most] = self::ends(shares);
        self.least = least * weight;
        self.are_alike = least == most;
        let [width, height] = ends.map(|[least, most]| most - least + 1.0);
        let area = f64::from(width) * f64::from(height);
        let side = reach * libm::sqrt(area / number as f64) as f32;
        let side = greater(greater(side, greater(width, height) / MOST_ROWS), 512.0);
        self.side = side;
        let [x, y] = [
            Divisor::new(ends[0], side / FINE as f32),
            Divisor::new(ends[1], side),
        ];
        self.along = [x, y];
        let columns = x.cells;
        self.starts.clear();
        self.starts.resize(columns * y.cells + 1, 0);
        self.cell.clear();
        let cells = xs.iter().zip(ys);
        self.cell
            .extend(cells.map(|(&at_x, &at_y)| y.cell(at_y) * columns as u32 + x.cell(at_x)));
        for &cell in &self.cell {
            self.starts[cell as usize] += 1;
        }
        let mut before = 0;
        for start in &mut self.starts {
            before += *start;
            *start = before;
        }
        self.points.resize(number, Sorted::default());
        let points = &mut self.points[..number];
        let lists = self.cell.iter().zip(xs.iter().zip(ys)).zip(shares);
        let lists = lists.zip(places.until[..number].iter().zip(&places.freedom[..number]));
        for (i, (((&cell, (&x, &y)), &share), (&until, &freedom))) in lists.enumerate().rev() {
            let start = &mut self.starts[cell as usize];
            *start -= 1;
            let moves = (until >= step) & (freedom > 0.0);
            points[*start as usize] = Sorted {
                at: [x, y],
                weight: share * weight,
                point: i as u32 | (u32::from(moves) << 31),
            };
        }
        if !self.are_alike {
            self.find_lightest(y.cells, columns);
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
    pub(super) fn least_in(&self, [columns, rows]: &[Range<usize>; 2]) -> f32 {
        let Cells {
            along, lightest, ..
        } = self;
        let across = along[0].cells.div_ceil(FINE);
        let columns = columns.start / FINE..columns.end.div_ceil(FINE);
        let mut least = f32::INFINITY;
        for row in rows.clone() {
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
