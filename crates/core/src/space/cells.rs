//! Cells: which parts of a slab of planes lie inside, which outside, and where points have to be tested.
//!
//! A slab has 32 planes of a column. It is cut into cubes of 32 lattice units; a part of the column is cut further only
//! if its points lie neither all inside nor all outside.

use alloc::vec::Vec;
use core::ops::Range;

use super::{
    Volume,
    scope::{Scope, State, common},
};

/// The bits of the side of a cell.
pub(super) const CELL_BITS: u32 = 5;
/// The most cells of a slab along an axis: those of a column, one of which may be cut by an end on either side.
const SIDE: usize = 34;

/// All points lie outside.
pub(super) const OUT: u16 = 0;
/// All points lie inside.
pub(super) const IN: u16 = 1;
/// Points are tested by the scope's volume; greater numbers are of volumes that were reduced to what matters.
pub(super) const TEST: u16 = 2;

/// A part of a row of cells.
#[derive(Clone, Copy, Debug)]
pub(super) struct Run {
    /// The end along x, relative to the origin.
    pub(super) end: i32,
    pub(super) state: u16,
}

/// The cells of a slab.
#[derive(Clone, Debug, Default)]
pub(super) struct Cells {
    grid: Vec<u16>,
    volumes: Vec<Volume>,
    runs: Vec<Run>,
    /// The runs of each row of cells.
    rows: Vec<Range<usize>>,
}

impl Cells {
    /// Looks at the cells of a box of the lattice; the origin is that of the first cell.
    pub(super) fn look(&mut self, scope: &Scope, ranges: &[Range<i64>; 3], origin: [i64; 3]) {
        self.grid.clear();
        self.grid.resize(SIDE * SIDE, OUT);
        self.volumes.clear();
        let count = |axis: usize| {
            let last = ranges[axis].end - 1 - origin[axis];
            ((last >> CELL_BITS) + 1) as usize
        };
        let counts = [count(0), count(1)];
        self.divide(
            scope,
            ranges,
            origin,
            [0..counts[0], 0..counts[1]],
            scope.volume.as_ref(),
        );
        self.join(counts);
    }

    /// Has all points tested, where looking at cells would cost more.
    pub(super) fn test_all(&mut self, rows: usize) {
        self.volumes.clear();
        self.runs.clear();
        self.rows.clear();
        let (end, state) = (i32::MAX, TEST);
        self.runs.push(Run { end, state });
        self.rows.resize(rows, 0..1);
    }

    /// The runs of a row of cells.
    pub(super) fn row(&self, row: usize) -> &[Run] {
        &self.runs[self.rows[row].clone()]
    }

    /// The volume by which the points of a state are tested.
    pub(super) fn volume<'a>(&'a self, scope: &'a Scope, state: u16) -> Option<&'a Volume> {
        match (state as usize).checked_sub(1 + TEST as usize) {
            Some(number) => Some(&self.volumes[number]),
            None => scope.volume.as_ref(),
        }
    }

    fn divide(
        &mut self,
        scope: &Scope,
        ranges: &[Range<i64>; 3],
        origin: [i64; 3],
        cells: [Range<usize>; 2],
        volume: Option<&Volume>,
    ) {
        let side = |axis: usize| {
            let at = |cell: usize| origin[axis] + ((cell as i64) << CELL_BITS);
            common(&(at(cells[axis].start)..at(cells[axis].end)), &ranges[axis])
        };
        let part = [side(0), side(1), ranges[2].clone()];
        if part.iter().any(Range::is_empty) {
            return;
        }
        let state = match scope.state(&part, volume) {
            State::Out => return,
            State::In => IN,
            State::Test(near) => {
                let longest = usize::from(cells[1].len() > cells[0].len());
                if cells[longest].len() > 1 {
                    let middle = cells[longest].start + cells[longest].len() / 2;
                    let mut halves = [cells.clone(), cells.clone()];
                    halves[0][longest].end = middle;
                    halves[1][longest].start = middle;
                    for half in halves {
                        self.divide(scope, ranges, origin, half, near.as_ref());
                    }
                    return;
                }
                match near {
                    // Only bounds are left to test, which a volume of all space stands for.
                    None if scope.volume.is_none() => TEST,
                    near => {
                        self.volumes.push(near.unwrap_or(Volume::AllOf(Vec::new())));
                        TEST + self.volumes.len() as u16
                    }
                }
            }
        };
        for y in cells[1].clone() {
            self.grid[y * SIDE..][cells[0].clone()].fill(state);
        }
    }

    /// Joins equal neighbors of each row.
    fn join(&mut self, counts: [usize; 2]) {
        self.runs.clear();
        self.rows.clear();
        for y in 0..counts[1] {
            let first = self.runs.len();
            for (x, &state) in self.grid[y * SIDE..][..counts[0]].iter().enumerate() {
                let end = (x as i32 + 1) << CELL_BITS;
                match self.runs[first..].last_mut() {
                    Some(last) if last.state == state => last.end = end,
                    _ => self.runs.push(Run { end, state }),
                }
            }
            self.rows.push(first..self.runs.len());
        }
    }
}
