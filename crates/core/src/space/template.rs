//! Templates: what the rows of one plane, one parity and one interval of dY have in common.
//!
//! All points of such rows have the same places along x and z, and the same displacements along y. A plane has two
//! templates for each interval of dY, few enough to stay in the nearest cache.

use alloc::vec::Vec;
use core::ops::Range;

use super::{
    columns::Lines,
    lattice::{Lattice, fixed},
};
use crate::table::FRACTION_BITS;

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

/// The templates of a plane. Offsets are fixed-point, relative to an origin along x and z, and to the row along y.
#[derive(Clone, Debug, Default)]
pub(super) struct Templates {
    /// Where the template of a parity and interval lies, if it has been made.
    made: [Vec<Option<(u32, u32)>>; 2],
    pub(super) places: [Vec<i32>; 3],
    /// The lattice columns, relative to the origin.
    pub(super) columns: Vec<i32>,
}

impl Templates {
    /// Forgets the templates of another plane.
    pub(super) fn clear(&mut self, intervals: usize) {
        for made in &mut self.made {
            made.clear();
            made.resize(intervals, None);
        }
        self.places.iter_mut().for_each(Vec::clear);
        self.columns.clear();
    }

    /// The template of the rows of a parity and an interval of dY: with bounds, of the points between those along x and z.
    pub(super) fn get(
        &mut self,
        lattice: &Lattice,
        lines: &Lines,
        plane: Plane,
        (origin, bounds): ([i64; 3], Option<&[Range<i64>; 3]>),
        (own, block): (u8, usize),
    ) -> Range<usize> {
        let made = self.made[usize::from(own)][block];
        let (start, end) = made.unwrap_or_else(|| {
            let made = self.make(lattice, lines, plane, (origin, bounds), (own, block));
            self.made[usize::from(own)][block] = Some(made);
            made
        });
        start as usize..end as usize
    }

    fn make(
        &mut self,
        lattice: &Lattice,
        lines: &Lines,
        plane: Plane,
        (origin, bounds): ([i64; 3], Option<&[Range<i64>; 3]>),
        (own, block): (u8, usize),
    ) -> (u32, u32) {
        let n = lattice.table.map().intervals();
        let first = (plane.block * n + block) * n;
        let vectors = &lattice.turned.vectors[first..][..n];
        // The sum of x and y has the parity that the plane demands.
        let parity = usize::from(plane.others ^ own);
        let lines = &lines.x[parity][usize::from(own ^ plane.own)];
        let start = self.columns.len();
        let z = ((plane.at - origin[2]) << FRACTION_BITS) as i32;
        for line in lines {
            if lattice.cut.is_some() && !lattice.keeps(first + line.block as usize, line.index) {
                continue;
            }
            let vector = vectors[line.block as usize];
            if let Some([x, _, z]) = bounds
                && !(x.contains(&(fixed(line.at) + i64::from(vector[0])))
                    && z.contains(&(fixed(plane.at) + i64::from(vector[2]))))
            {
                continue;
            }
            let column = (line.at - origin[0]) as i32;
            self.columns.push(column);
            self.places[0].push((column << FRACTION_BITS) + vector[0]);
            self.places[1].push(vector[1]);
            self.places[2].push(z + vector[2]);
        }
        (start as u32, self.columns.len() as u32)
    }
}
