//! Templates: what the rows of one plane, one parity and one interval of dY have in common.
//!
//! All points of such rows have the same places along x and z, and the same displacements along y. A plane has two
//! templates for each interval of dY, few enough to stay in the nearest cache.

use alloc::vec::Vec;
use core::ops::Range;

use super::{
    columns::{Line, Lines},
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
        // Points of the lines between lie inside whatever their vectors are.
        let mut whole = 0..lines.len();
        if let Some([x, _, z]) = bounds {
            let [reach_x, _, reach_z] = lattice.turned.reach.map(|ends| ends.map(i64::from));
            let at = fixed(plane.at);
            let is_inside = z.start <= at + reach_z[0] && at + reach_z[1] < z.end;
            let first = lines.partition_point(|line| fixed(line.at) + reach_x[0] < x.start);
            let last = lines.partition_point(|line| fixed(line.at) + reach_x[1] < x.end);
            whole = if is_inside {
                first..last.max(first)
            } else {
                0..0
            };
        }
        if lattice.cut.is_some() {
            whole = 0..0;
        }
        let test = |line: &Line| {
            let vector = vectors[line.block as usize];
            let is_inside = bounds.is_none_or(|[x, _, z]| {
                x.contains(&(fixed(line.at) + i64::from(vector[0])))
                    && z.contains(&(fixed(plane.at) + i64::from(vector[2])))
            });
            is_inside
                && (lattice.cut.is_none() || lattice.keeps(first + line.block as usize, line.index))
        };
        let z = ((plane.at - origin[2]) << FRACTION_BITS) as i32;
        let (before, rest) = lines.split_at(whole.start);
        let (inside, after) = rest.split_at(whole.len());
        for line in before.iter().filter(|line| test(line)) {
            self.push(line, vectors[line.block as usize], origin[0], z);
        }
        let column = |line: &Line| (line.at - origin[0]) as i32;
        let vector = |line: &Line| &vectors[line.block as usize];
        self.columns.extend(inside.iter().map(column));
        let [xs, ys, zs] = &mut self.places;
        xs.extend(
            inside
                .iter()
                .map(|line| (column(line) << FRACTION_BITS) + vector(line)[0]),
        );
        ys.extend(inside.iter().map(|line| vector(line)[1]));
        zs.extend(inside.iter().map(|line| z + vector(line)[2]));
        for line in after.iter().filter(|line| test(line)) {
            self.push(line, vectors[line.block as usize], origin[0], z);
        }
        (start as u32, self.columns.len() as u32)
    }

    /// Adds the point of a line.
    fn push(&mut self, line: &Line, vector: [i32; 3], origin: i64, z: i32) {
        let column = (line.at - origin) as i32;
        self.columns.push(column);
        self.places[0].push((column << FRACTION_BITS) + vector[0]);
        self.places[1].push(vector[1]);
        self.places[2].push(z + vector[2]);
    }
}
