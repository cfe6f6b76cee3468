//! The addresses of a period that have points, with their indices.

use alloc::vec::Vec;

use crate::{
    map::Twin,
    sample::{
        lattice::{Grade, Keep, Settle},
        seed::Seed,
        warp::{Warp, Waves, WrappedShears},
    },
    table::{Table, TurnedTable},
};

/// The parts of a period that a set has.
#[derive(Clone, Debug, Default)]
pub(super) struct Parts {
    pub(super) keep: Keep,
    pub(super) settle: Settle,
    pub(super) lod: Keep,
    pub(super) kind: Option<u8>,
    /// The field, whose shares are those of the whole set.
    pub(super) field: Option<Grade>,
}

/// The parts of a periodic set that follow from the seed and the warp.
#[derive(Debug)]
pub(super) struct Made {
    pub(super) turned: TurnedTable,
    pub(super) shears: Option<WrappedShears>,
    /// The index of column and row 0.
    origin: [u64; 2],
    /// The columns inside the set region with their indices, by the parities of row and column.
    pub(super) columns: [[Vec<(u64, u64)>; 2]; 2],
}

impl Made {
    pub(super) fn new(table: &Table, twin: Twin, seed: Seed, warp: Warp) -> Self {
        let origin = seed.origin();
        let scaled = |v: u64| ((u128::from(v) * u128::from(twin.period())) >> 64) as u64;
        let mut made = Self {
            turned: TurnedTable::new(table, seed.symmetry()),
            shears: WrappedShears::new(Waves::of(table.profile()), warp, seed, twin.period()),
            origin: [scaled(origin.x), scaled(origin.y)],
            columns: Default::default(),
        };
        let listed = |y: u64, parity: u64| {
            let columns = (parity..twin.period()).step_by(2);
            columns
                .filter_map(|x| Some((x, made.index_x(twin, x, y)?)))
                .collect()
        };
        made.columns = [0, 1].map(|y| [0, 1].map(|parity| listed(y, parity)));
        made
    }

    /// dX of an address, in units of 1/(2q), if it is inside the set region.
    pub(super) fn index_x(&self, twin: Twin, x: u64, y: u64) -> Option<u64> {
        let index = (twin.index(x, y % 2) + self.origin[0]) % twin.period();
        (index < twin.t()).then_some(index)
    }

    /// dY of an address, likewise.
    pub(super) fn index_y(&self, twin: Twin, x: u64, y: u64) -> Option<u64> {
        let index = (twin.index(y, x % 2) + self.origin[1]) % twin.period();
        (index < twin.t()).then_some(index)
    }
}
