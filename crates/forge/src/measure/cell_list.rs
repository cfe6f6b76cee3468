//! A cell list, which finds the points near a place on a torus or in a box.

use super::Sample;

/// Points sorted into square cells.
pub(crate) struct CellList {
    /// The number of cells along an axis.
    per_axis: i64,
    side: f64,
    periodic: bool,
    /// The start of the members of each cell, and the end of the last.
    starts: Vec<u32>,
    /// Index and position of each point, cell by cell; positions are within [0, side).
    members: Vec<(u32, [f64; 2])>,
}

impl CellList {
    /// Sorts the points of a set into cells at least `cell` wide. Positions of a periodic set are taken modulo its side.
    pub(crate) fn of(set: &Sample, cell: f64) -> Self {
        let (points, side, periodic) = (set.points(), set.side(), set.is_periodic());
        // However small `cell` is, there are at most about twice as many cells as points.
        let most = (2.0 * points.len() as f64).sqrt().ceil().max(1.0);
        let per_axis = (side / cell).floor().clamp(1.0, most) as i64;
        let home: Vec<[f64; 2]> = points
            .iter()
            .map(|p| {
                if periodic {
                    p.map(|v| wrap(v, side))
                } else {
                    *p
                }
            })
            .collect();
        let cell_of = |p: &[f64; 2]| {
            let [x, y] = p.map(|v| ((v / side * per_axis as f64) as i64).clamp(0, per_axis - 1));
            (y * per_axis + x) as usize
        };
        let mut starts = vec![0u32; (per_axis * per_axis) as usize + 1];
        for p in &home {
            starts[cell_of(p) + 1] += 1;
        }
        for cell in 1..starts.len() {
            starts[cell] += starts[cell - 1];
        }
        let mut next = starts.clone();
        let mut members = vec![(0, [0.0; 2]); home.len()];
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

    /// All points, cell by cell.
    pub(crate) fn members(&self) -> &[(u32, [f64; 2])] {
        &self.members
    }

    /// Calls `visit` for each point in the square ring of cells at distance `ring` from the cell of
    /// `p`, with the index of the point and the vector from it to `p`. If `p` is a point, it is
    /// visited, too. On a torus all images of a point are visited.
    pub(crate) fn ring(&self, p: [f64; 2], ring: i64, mut visit: impl FnMut(u32, [f64; 2])) {
        let [cx, cy] =
            p.map(|v| ((v / self.side * self.per_axis as f64) as i64).min(self.per_axis - 1));
        for y in cy - ring..=cy + ring {
            let whole_row = (y - cy).abs() == ring;
            let step = if whole_row || ring == 0 { 1 } else { 2 * ring };
            for x in (cx - ring..=cx + ring).step_by(step as usize) {
                self.cell(x, y, p, &mut visit);
            }
        }
    }

    fn cell(&self, x: i64, y: i64, p: [f64; 2], visit: &mut impl FnMut(u32, [f64; 2])) {
        let inside = |v: i64| (0..self.per_axis).contains(&v);
        if !(self.periodic || inside(x) && inside(y)) {
            return;
        }
        let turns = [x, y].map(|v| v.div_euclid(self.per_axis) as f64 * self.side);
        let [x, y] = [x, y].map(|v| v.rem_euclid(self.per_axis));
        let cell = (y * self.per_axis + x) as usize;
        for (index, q) in &self.members[self.starts[cell] as usize..self.starts[cell + 1] as usize]
        {
            visit(*index, [p[0] - q[0] - turns[0], p[1] - q[1] - turns[1]]);
        }
    }
}

/// Returns `v` modulo `side`, in [0, side).
pub(crate) fn wrap(v: f64, side: f64) -> f64 {
    let wrapped = v - (v / side).floor() * side;
    if wrapped < side {
        wrapped.max(0.0)
    } else {
        0.0
    }
}
