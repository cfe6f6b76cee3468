//! The warp of points around a place, in 64-bit positions.

use super::shears::{CELL_BITS, CELL_MASK, Quadratic, Shears, across, evaluate, shear};

/// The shears near one place. Positions are relative to an origin nearby, and the quadratics last used in each
/// direction are kept, by the lowest bits of the cell: points around a place touch two or three cells.
#[derive(Debug)]
pub(crate) struct NearShears<'a> {
    shears: &'a Shears,
    /// The cells of the origin, by direction.
    cells: [i64; 4],
    last: [[(i64, Quadratic); KEPT]; 4],
}

/// The number of quadratics kept in a direction, a power of two.
const KEPT: usize = 4;

/// The place of a cell among those kept.
const fn slot(cell: i64) -> usize {
    cell as usize % KEPT
}

impl<'a> NearShears<'a> {
    /// The shears near `place`, and the origin of positions: a multiple of the knot distance along both
    /// axes, so that cells start there in every direction.
    pub(crate) fn new(shears: &'a Shears, place: [i128; 2]) -> (Self, [i128; 2]) {
        let [x, y] = place.map(|v| (v >> CELL_BITS) as i64);
        let cells = across([x, y]);
        let relative = across(place.map(|v| (v & CELL_MASK) as i64)).map(|s| s >> CELL_BITS);
        // Shears seldom move a place to another cell. So the quadratics of its own cells are the ones that it needs,
        // and looking all four up before the first shear lets these lookups overlap.
        let last = core::array::from_fn(|i| {
            let cell = cells[i].wrapping_add(relative[i]);
            // The last cell of all marks an empty slot: no position comes near it.
            let mut last = [(i64::MAX, [0.0; 3]); KEPT];
            last[slot(relative[i])] = (relative[i], shears.quadratic(i, cell));
            last
        });
        let near = Self {
            shears,
            cells,
            last,
        };
        (near, [x, y].map(|v| i128::from(v) << CELL_BITS))
    }

    #[inline]
    fn noise(&mut self, i: usize, s: i64) -> i64 {
        let cell = s >> CELL_BITS;
        let last = &mut self.last[i][slot(cell)];
        if last.0 != cell {
            *last = (
                cell,
                self.shears.quadratic(i, self.cells[i].wrapping_add(cell)),
            );
        }
        evaluate(&last.1, (s & CELL_MASK as i64) as i32).into()
    }

    /// The place to which the warp moves a position, both relative to the origin.
    #[inline]
    pub(crate) fn apply(&mut self, position: [i64; 2]) -> [i64; 2] {
        (0..4).fold(position, |p, i| shear(i, p, |s| self.noise(i, s)))
    }

    /// The exact inverse of [`apply`](Self::apply).
    #[inline]
    pub(crate) fn invert(&mut self, position: [i64; 2]) -> [i64; 2] {
        (0..4)
            .rev()
            .fold(position, |p, i| shear(i, p, |s| -self.noise(i, s)))
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::sample::{Seed, Warp, warp::Waves};

    proptest! {
        #[test]
        fn points_near_a_place_get_the_same_bits(
            seed: u64, is_long: bool, x in -(1i128 << 72)..1 << 72, y in -(1i128 << 72)..1 << 72,
            near in proptest::collection::vec([-1i64 << 30..1 << 30, -1i64 << 30..1 << 30], 1..20),
        ) {
            let waves = if is_long { Waves::All } else { Waves::Short };
            let shears = Shears::new(waves, Warp::ON, Seed(seed)).expect("on");
            let (mut relative, [left, bottom]) = NearShears::new(&shears, [x, y]);
            for [dx, dy] in near {
                let there = shears.apply([left + i128::from(dx), bottom + i128::from(dy)]);
                let [dx, dy] = relative.apply([dx, dy]).map(i128::from);
                prop_assert_eq!(there, [left + dx, bottom + dy]);
                let [x, y] = [there[0] - left, there[1] - bottom].map(|v| v as i64);
                let back = relative.invert([x, y]).map(i128::from);
                prop_assert_eq!(shears.invert(there), [left + back[0], bottom + back[1]]);
            }
        }
    }
}
