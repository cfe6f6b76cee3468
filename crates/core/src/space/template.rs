//! Templates: what the rows of one plane, one parity and one interval of dY have in common.
//!
//! All points of such rows have the same places along x, and the same intervals of dX. Their places along y and z depend
//! on these intervals alone: a row has n of each, so they are found once, and points pick theirs. A plane has two
//! templates for each interval of dY, few enough to stay in the nearest cache.

use alloc::vec::Vec;
use core::ops::Range;

use super::{
    columns::Lines,
    lattice::{Lattice, fixed},
};
use crate::{
    sample::{
        Backend,
        space::{PICKS, add_picked},
    },
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

/// The templates of a plane, with places of a kind: fixed-point offsets from an origin, or what a format makes of them.
#[derive(Clone, Debug, Default)]
pub(super) struct Templates<T> {
    /// Where the template of a parity and interval lies, if it has been made.
    made: [Vec<Option<(u32, u32)>>; 2],
    /// The places along x.
    pub(super) places: Vec<T>,
    /// The intervals of dX.
    pub(super) blocks: Vec<u16>,
    /// The lattice columns, relative to the origin, in fixed-point units.
    pub(super) columns: Vec<i32>,
    /// For each interval of dY, where the places along z of those of dX lie, if they have been made.
    high: Vec<Option<u32>>,
    heights: Vec<T>,
    /// Room for offsets.
    offsets: Vec<i32>,
}

/// How the offsets along an axis become places, which are added to a list.
pub(super) trait Convert<T>: Fn(usize, &[i32], &mut Vec<T>) {}

impl<T, F: Fn(usize, &[i32], &mut Vec<T>)> Convert<T> for F {}

/// The origin of offsets, and the bounds between which points along x and z lie, if they are tested.
pub(super) type Frame<'a> = ([i64; 3], Option<&'a [Range<i64>; 3]>);

impl<T> Templates<T> {
    /// Forgets the templates of another plane.
    pub(super) fn clear(&mut self, intervals: usize) {
        for made in &mut self.made {
            made.clear();
            made.resize(intervals, None);
        }
        self.high.clear();
        self.high.resize(intervals, None);
        self.places.clear();
        self.blocks.clear();
        self.columns.clear();
        self.heights.clear();
    }

    /// The template of the rows of a parity and an interval of dY: with bounds, of the points between those along x and z.
    pub(super) fn get(
        &mut self,
        (lattice, lines): (&Lattice, &Lines),
        plane: Plane,
        frame: Frame<'_>,
        (own, block): (u8, usize),
        (backend, convert): (Backend, &impl Convert<T>),
    ) -> Range<usize> {
        if let Some((start, end)) = self.made[usize::from(own)][block] {
            return start as usize..end as usize;
        }
        let made = self.make(
            (lattice, lines),
            plane,
            frame,
            (own, block),
            (backend, convert),
        );
        self.made[usize::from(own)][block] = Some((made.start as u32, made.end as u32));
        if self.high[block].is_none() {
            self.high[block] = Some(self.heights.len() as u32);
            let [_, _, zs] = lattice.vectors(plane.block, block);
            let z = ((plane.at - frame.0[2]) << FRACTION_BITS) as i32;
            self.offsets.clear();
            self.offsets.extend(zs.iter().map(|dz| z + dz));
            convert(2, &self.offsets, &mut self.heights);
        }
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
        (lattice, lines): (&Lattice, &Lines),
        plane: Plane,
        (origin, bounds): Frame<'_>,
        (own, block): (u8, usize),
        (backend, convert): (Backend, &impl Convert<T>),
    ) -> Range<usize> {
        let [dx, _, dz] = lattice.vectors(plane.block, block);
        // The sum of x and y has the parity that the plane demands.
        let parity = usize::from(plane.others ^ own);
        let lines = &lines.x[parity][usize::from(own ^ plane.own)];
        let start = self.columns.len();
        // Points of the lines between lie inside whatever their vectors are.
        let mut whole = 0..lines.at.len();
        let from = fixed(origin[0]);
        if let Some([x, _, z]) = bounds {
            let [reach_x, _, reach_z] = lattice.turned.reach.map(|ends| ends.map(i64::from));
            let at = fixed(plane.at);
            let is_inside = z.start <= at + reach_z[0] && at + reach_z[1] < z.end;
            let before = |reach: i64, end: i64| {
                let is_before = |&line: &i32| from + i64::from(line) + reach < end;
                lines.at.partition_point(is_before)
            };
            let (first, last) = (before(reach_x[0], x.start), before(reach_x[1], x.end));
            whole = if is_inside {
                first..last.max(first)
            } else {
                0..0
            };
        }
        if lattice.cut.is_some() {
            whole = 0..0;
        }
        let row = lattice.number([0, block, plane.block]);
        let test = |&line: &usize| {
            let block = usize::from(lines.blocks[line]);
            let is_inside = bounds.is_none_or(|[x, _, z]| {
                x.contains(&(from + i64::from(lines.at[line] + dx[block])))
                    && z.contains(&(fixed(plane.at) + i64::from(dz[block])))
            });
            is_inside && (lattice.cut.is_none() || lattice.keeps(row + block, lines.indices[line]))
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
        convert(0, &self.offsets, &mut self.places);
        start..self.columns.len()
    }
}
