//! A cell list, which finds the points near a place on a torus or in a box.

use crate::measure::{Sample, root, wrap};

/// Points sorted into square cells, in space into cubes.
pub(crate) struct CellList<const D: usize = 2> {
    /// The number of cells along an axis.
    per_axis: i64,
    side: f64,
    periodic: bool,
    /// The start of the members of each cell, and the end of the last.
    starts: Vec<u32>,
    /// Index and position of each point, cell by cell; positions are within [0, side).
    pub(crate) members: Vec<(u32, [f64; D])>,
}

impl<const D: usize> CellList<D> {
    /// Sorts the points of a set into cells at least `width` wide. Positions of a periodic set are taken modulo its side.
    pub(crate) fn of(set: &Sample<D>, width: f64) -> Self {
        let (points, side, periodic) = (set.points(), set.side(), set.is_periodic());
        // However small `width` is, there are at most about twice as many cells as points.
        let most = root::<D>(2.0 * points.len() as f64).ceil().max(1.0);
        let per_axis = (side / width).floor().clamp(1.0, most) as i64;
        let home = |p: &[f64; D]| match periodic {
            true => p.map(|v| wrap(v, side)),
            false => *p,
        };
        let home: Vec<[f64; D]> = points.iter().map(home).collect();
        let cell_of = |p: &[f64; D]| place(cell(p, side, per_axis), per_axis);
        let mut starts = vec![0u32; per_axis.pow(D as u32) as usize + 1];
        for p in &home {
            starts[cell_of(p) + 1] += 1;
        }
        for cell in 1..starts.len() {
            starts[cell] += starts[cell - 1];
        }
        let mut next = starts.clone();
        let mut members = vec![(0, [0.0; D]); home.len()];
        for (index, p) in home.iter().enumerate() {
            let slot = &mut next[cell_of(p)];
            members[*slot as usize] = (index as u32, *p);
            *slot += 1;
        }
        Self {
            per_axis,
            side,
            periodic,
            starts,
            members,
        }
    }

    /// The width of a cell.
    pub(crate) fn width(&self) -> f64 {
        self.side / self.per_axis as f64
    }

    /// Calls `visit` for each point in the square ring, or the shell of a cube, of cells at distance `ring` from the cell
    /// of `p`, with the index of the point and the vector from it to `p`. If `p` is a point, it is visited, too. On a torus
    /// all images of a point are visited.
    pub(crate) fn ring(&self, p: [f64; D], ring: i64, mut visit: impl FnMut(u32, [f64; D])) {
        let home = cell(&p, self.side, self.per_axis);
        let across = 2 * ring + 1;
        // Row by row along the first axis.
        for row in 0..across.pow(D as u32 - 1) {
            let (mut at, mut rest) = (home, row);
            let mut is_whole = ring == 0;
            for v in &mut at[1..] {
                let by = rest % across - ring;
                *v += by;
                rest /= across;
                is_whole |= by.abs() == ring;
            }
            let step = if is_whole { 1 } else { 2 * ring };
            for x in (home[0] - ring..=home[0] + ring).step_by(step as usize) {
                at[0] = x;
                self.visit(at, p, &mut visit);
            }
        }
    }

    fn visit(&self, cell: [i64; D], p: [f64; D], visit: &mut impl FnMut(u32, [f64; D])) {
        if !self.periodic && cell.iter().any(|v| !(0..self.per_axis).contains(v)) {
            return;
        }
        let turns = cell.map(|v| v.div_euclid(self.per_axis) as f64 * self.side);
        let cell = place(cell.map(|v| v.rem_euclid(self.per_axis)), self.per_axis);
        for (index, q) in &self.members[self.starts[cell] as usize..self.starts[cell + 1] as usize]
        {
            visit(
                *index,
                std::array::from_fn(|axis| p[axis] - q[axis] - turns[axis]),
            );
        }
    }
}

/// The cell of a place.
fn cell<const D: usize>(p: &[f64; D], side: f64, per_axis: i64) -> [i64; D] {
    p.map(|v| ((v / side * per_axis as f64) as i64).clamp(0, per_axis - 1))
}

/// The number of a cell, of which the first axis runs fastest.
fn place<const D: usize>(cell: [i64; D], per_axis: i64) -> usize {
    cell.iter().rev().fold(0, |at, v| at * per_axis + v) as usize
}
