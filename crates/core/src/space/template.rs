//! Templates: the places along x of the rows of a column of planes that have the same lines, interval of dY and interval of
//! dZ, and the intervals of dX of their points.
//!
//! The places of these points along y and z depend on the intervals alone: a row has n of each, so they are found once, and
//! points pick theirs. Rows of many planes share a template.

use alloc::vec::Vec;
use core::ops::Range;

use super::{
    columns::{Across, Lines},
    lattice::{Lattice, fixed},
};
use crate::{
    kernel::{Backend, PICKS, add_picked},
    table::FRACTION_BITS,
};

/// A plane of the lattice that holds points.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Plane {
    /// The lattice coordinate.
    pub(super) at: i64,
    /// The parity of the coordinate.
    pub(super) own: u8,
    /// The parity of the sum of x and y of its points.
    pub(super) others: u8,
    /// The interval of dZ.
    pub(super) block: usize,
}

/// The templates of a column of planes, with places of a kind: fixed-point offsets from an origin, or what a format makes
/// of them.
#[derive(Clone, Debug, Default)]
pub(super) struct Templates<T> {
    /// The lines that templates are made of.
    of: u64,
    /// By lines and intervals, the number of a template in `parts` from 1 on, or 0 if it has not been made.
    made: Vec<u32>,
    /// Where the templates lie.
    parts: Vec<Range<usize>>,
    /// The places along x.
    pub(super) places: Vec<T>,
    /// The intervals of dX.
    pub(super) blocks: Vec<u16>,
    /// The lattice columns, relative to the origin, in fixed-point units.
    pub(super) columns: Vec<i32>,
    /// For each interval of dY, where the places along z of those of dX lie in this plane, if they have been made.
    high: Vec<Option<u32>>,
    heights: Vec<T>,
    /// Room for offsets.
    offsets: Vec<i32>,
}

/// The number of places beyond which all templates are made anew: some 2.5 MB of `f32`.
const MOST: usize = 1 << 18;

/// How the sums of a number and some others, offsets along an axis, become places, which are added to a list.
pub(super) trait Convert<T>: Fn(usize, i32, &[i32], &mut Vec<T>) {}

impl<T, F: Fn(usize, i32, &[i32], &mut Vec<T>)> Convert<T> for F {}

/// The origin of offsets, and the bounds between which points along x lie, if they are tested.
pub(super) type Frame<'a> = ([i64; 3], Option<&'a Range<i64>>);

impl<T> Templates<T> {
    /// Begins a plane of a column.
    pub(super) fn begin_plane(&mut self, lines: &Lines, intervals: usize) {
        if self.of != lines.number || self.places.len() > MOST {
            self.of = lines.number;
            self.made.clear();
            self.made.resize(4 * intervals * intervals, 0);
            self.parts.clear();
            self.places.clear();
            self.blocks.clear();
            self.columns.clear();
        }
        self.high.clear();
        self.high.resize(intervals, None);
        self.heights.clear();
    }

    /// The template of the rows of a parity and an interval of dY: with bounds, of the points between them along x.
    #[inline]
    pub(super) fn get(
        &mut self,
        (lattice, lines): (&Lattice, &Lines),
        plane: Plane,
        frame: Frame<'_>,
        (own, block): (u8, usize),
        (backend, convert): (Backend, &impl Convert<T>),
    ) -> Range<usize> {
        // The sum of x and y has the parity that the plane demands.
        let parities = [plane.others ^ own, plane.own ^ own].map(usize::from);
        let intervals = self.high.len();
        let key = (2 * parities[0] + parities[1]) * intervals + plane.block;
        let key = key * intervals + block;
        if self.high[block].is_none() {
            self.high[block] = Some(self.heights.len() as u32);
            let zs = lattice.components(2, plane.block, block);
            let z = ((plane.at - frame.0[2]) << FRACTION_BITS) as i32;
            convert(2, z, zs, &mut self.heights);
        }
        if let Some(number) = self.made[key].checked_sub(1) {
            return self.parts[number as usize].clone();
        }
        let [parity, sum] = parities;
        let made = self.make(
            (lattice, &lines.x[parity][sum]),
            frame,
            [block, plane.block],
            (backend, convert),
        );
        self.parts.push(made.clone());
        self.made[key] = self.parts.len() as u32;
        made
    }

    /// The places along z of the points of a template, by the interval of dX, and some more. It has been made.
    pub(super) fn heights(&self, block: usize) -> &[T] {
        let start = self.high[block].unwrap_or(0) as usize;
        &self.heights[start..][..self.high.len().next_multiple_of(PICKS)]
    }

    /// Takes the points of a part of a template whose columns are before one of the lattice.
    pub(super) fn before(&self, points: &mut Range<usize>, end: i32) -> Range<usize> {
        let end = end.saturating_mul(1 << FRACTION_BITS);
        let part = &self.columns[points.clone()];
        let length = if part.last().is_some_and(|&last| last < end) {
            part.len()
        } else {
            part.partition_point(|&column| column < end)
        };
        let part = points.start..points.start + length;
        points.start = part.end;
        part
    }

    fn make(
        &mut self,
        (lattice, lines): (&Lattice, &Across),
        (origin, bounds): Frame<'_>,
        [row, plane]: [usize; 2],
        (backend, convert): (Backend, &impl Convert<T>),
    ) -> Range<usize> {
        let dx = lattice.components(0, plane, row);
        let start = self.columns.len();
        // Points of the lines between lie inside whatever their vectors are.
        let mut whole = 0..lines.at.len();
        let from = fixed(origin[0]);
        if let Some(x) = bounds {
            let reach = lattice.turned.reach[0].map(i64::from);
            let before = |reach: i64, end: i64| {
                let is_before = |&line: &i32| from + i64::from(line) + reach < end;
                lines.at.partition_point(is_before)
            };
            let (first, last) = (before(reach[0], x.start), before(reach[1], x.end));
            whole = first..last.max(first);
        }
        if lattice.cut.is_some() {
            whole = 0..0;
        }
        let first = lattice.number([0, row, plane]);
        let test = |&line: &usize| {
            let block = usize::from(lines.blocks[line]);
            let at = from + i64::from(lines.at[line] + dx[block]);
            let is_inside = bounds.is_none_or(|x| x.contains(&at));
            let is_kept =
                || lattice.cut.is_none() || lattice.keeps(first + block, lines.indices[line]);
            is_inside && is_kept()
        };
        let (columns, blocks) = (&mut self.columns, &mut self.blocks);
        let mut push = |line: usize| {
            columns.push(lines.at[line]);
            blocks.push(lines.blocks[line]);
        };
        (0..whole.start).filter(test).for_each(&mut push);
        columns.extend_from_slice(&lines.at[whole.clone()]);
        blocks.extend_from_slice(&lines.blocks[whole.clone()]);
        let mut push = |line: usize| {
            columns.push(lines.at[line]);
            blocks.push(lines.blocks[line]);
        };
        (whole.end..lines.at.len()).filter(test).for_each(&mut push);
        let (columns, blocks) = (&self.columns[start..], &self.blocks[start..]);
        self.offsets.resize(columns.len(), 0);
        add_picked(backend, columns, blocks, dx, &mut self.offsets);
        convert(0, 0, &self.offsets, &mut self.places);
        start..self.columns.len()
    }
}
