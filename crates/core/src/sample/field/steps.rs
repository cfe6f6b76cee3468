//! The moves of points in a field by the ladder, many at a time.

use alloc::vec::Vec;
use core::ops::Range;

use crate::{
    sample::{
        kernel::{Backend, PlainLoop, compiled_loop},
        lattice::{Grade, Lattice, around, damping, longer, steepness},
    },
    table::{FRACTION_BITS, LADDER_SHIFT, Ladder, Lookup, Stage, TurnedTable, between, part},
};

/// Marks a position whose point must look at the field around its place. There are fewer blocks than this.
pub(super) const STEEP: u32 = 1 << 31;

/// Marks a position whose point is left whatever its share.
pub(super) const WHOLE: u32 = 1 << 30;

/// Selects the position.
pub(super) const POSITION: u32 = WHOLE - 1;

/// The number of points that are moved at once, in vectors.
const SOME: usize = 64;

/// The steepness of a field around some points, and the memory to find it out.
#[derive(Clone, Debug, Default)]
pub(super) struct Steps {
    /// The points where the field is steep, the places around them where it is looked at, and the shares there.
    steep: Vec<u32>,
    around: Vec<[[f64; 2]; 4]>,
    shares: Vec<f64>,
    /// By point, the square of how steep the field is; empty where it is gentle for all.
    steepness: Vec<f64>,
}

/// Points that are left. All slices have the same length.
pub(super) struct Points<'a> {
    pub(super) addresses: &'a [u32],
    /// By position in the order of blocks, with [`STEEP`] and [`WHOLE`].
    pub(super) positions: &'a [u32],
    pub(super) shares: &'a [f64],
    /// Displaced positions relative to the patch, at full density.
    pub(super) displaced: [&'a mut [i32]; 2],
}

impl Steps {
    /// Moves points. `place` has the place of a point at full density.
    pub(super) fn take(
        &mut self,
        (lattice, grade): (&Lattice, &Grade),
        ladder: &Ladder,
        points: Points<'_>,
        place: impl Fn(usize) -> [f64; 2],
        backend: Backend,
    ) {
        self.look_around(lattice, grade, &points, place);
        let turned = &lattice.turned;
        let mut work = Work {
            turned,
            ladder,
            points,
            steepness: &self.steepness,
        };
        compiled_loop(backend, &mut work);
    }

    /// Looks at the field around the places where it may be steep.
    fn look_around(
        &mut self,
        lattice: &Lattice,
        grade: &Grade,
        points: &Points<'_>,
        place: impl Fn(usize) -> [f64; 2],
    ) {
        let spacing = lattice.placement.spacing.get();
        self.steep.clear();
        self.around.clear();
        self.steepness.clear();
        let flags = points.positions.iter().zip(points.shares).enumerate();
        for (i, (position, &share)) in flags {
            // Points of a share of 1 stay.
            if position & STEEP != 0 && share < 1.0 {
                self.steep.push(i as u32);
                self.around.push(around(place(i), share, spacing));
            }
        }
        if self.steep.is_empty() {
            return;
        }
        self.shares.clear();
        self.shares.resize(4 * self.steep.len(), 0.0);
        grade.shares(self.around.as_flattened(), &mut self.shares);
        self.steepness.resize(points.shares.len(), 0.0);
        for (&i, around) in self.steep.iter().zip(self.shares.as_chunks().0) {
            let i = i as usize;
            self.steepness[i] = steepness(points.shares[i], *around);
        }
    }
}

struct Work<'a> {
    turned: &'a TurnedTable,
    ladder: &'a Ladder,
    points: Points<'a>,
    steepness: &'a [f64],
}

impl PlainLoop for Work<'_> {
    #[inline(always)]
    fn run(&mut self) {
        let mut moves = Lookup::new();
        for start in (0..self.points.shares.len()).step_by(SOME) {
            let end = self.points.shares.len().min(start + SOME);
            if self.steepness.is_empty() {
                self.move_some::<false>(start..end, &mut moves);
            } else {
                self.move_some::<true>(start..end, &mut moves);
            }
        }
    }
}

impl Work<'_> {
    #[inline(always)]
    fn move_some<const IS_STEEP: bool>(&mut self, some: Range<usize>, moves: &mut Lookup<SOME>) {
        let number = some.len();
        let Points {
            addresses,
            positions,
            shares,
            displaced: [xs, ys],
        } = &mut self.points;
        let shares = &shares[some.clone()];
        let (xs, ys) = (&mut xs[some.clone()], &mut ys[some.clone()]);
        let addresses = &addresses[some.clone()];
        let mut known = [0u32; SOME];
        for (known, position) in known.iter_mut().zip(&positions[some.clone()]) {
            *known = position & POSITION;
        }
        let turned = self.turned;
        self.ladder.look_up(shares, &known[..number], moves);
        // Vectors need a number that is known beforehand; what follows the last point does not matter.
        let mut full = [[0; SOME]; 2];
        let mut steep = [[0.0; SOME]; 2];
        for (i, address) in addresses.iter().enumerate() {
            full[0][i] = xs[i] - (((address & 0xffff) as i32) << FRACTION_BITS);
            full[1][i] = ys[i] - (((address >> 16) as i32) << FRACTION_BITS);
        }
        if IS_STEEP {
            steep[0][..number].copy_from_slice(shares);
            steep[1][..number].copy_from_slice(&self.steepness[some]);
        }
        let mut to = [[0; SOME]; 2];
        for i in 0..SOME {
            let full = [full[0][i], full[1][i]];
            let [above, below] = [moves.vectors[0][i], moves.vectors[1][i]].map(|packed| {
                let wide = |v: i32| (v >> 16) << LADDER_SHIFT;
                turned.turn([wide((packed << 16) as i32), wide(packed as i32)])
            });
            let from = [0, 1].map(|axis| {
                if moves.is_first[i] != 0 {
                    full[axis]
                } else {
                    above[axis]
                }
            });
            let event = [f64::from(moves.events[0][i]), f64::from(moves.events[1][i])];
            let mut spread = 0.0;
            if IS_STEEP {
                spread = longer(moves.per_share[i], steep[0][i], steep[1][i]);
            }
            let mut moved = between(from, below, part([moves.way[i], spread], event));
            if IS_STEEP {
                moved = between(full, moved, damping(steep[1][i]));
            }
            [to[0][i], to[1][i]] = [moved[0] - full[0], moved[1] - full[1]];
        }
        for &i in &moves.others[..moves.number] {
            let i = i as usize;
            let full = [full[0][i], full[1][i]];
            let stage = self.ladder.stage(shares[i]);
            let mut moved = full;
            if stage != Stage::FULL {
                moved = turned.moved(self.ladder, stage, known[i] as usize);
                if IS_STEEP {
                    moved = between(full, moved, damping(steep[1][i]));
                }
            }
            [to[0][i], to[1][i]] = [moved[0] - full[0], moved[1] - full[1]];
        }
        for i in 0..number {
            (xs[i], ys[i]) = (xs[i] + to[0][i], ys[i] + to[1][i]);
        }
    }
}
