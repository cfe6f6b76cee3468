//! The warp of the points of a patch, in 32-bit positions.

use super::shears::{CELL_BITS, KNOT_BITS, Shears, evaluate};

/// The first cell across each direction, relative to the patch's origin.
const FIRST_CELLS: [i64; 4] = [-4, -4, -5, -3];

/// The shears of one patch, with all cubics tabulated. Positions relative to the patch's origin fit 32
/// bits. The origin is a multiple of the knot distance along both axes.
#[derive(Clone, Debug)]
pub struct PatchShears {
    /// By direction, by power of u, by the lowest four bits of the cell's number.
    pub(crate) cubics: [[[f32; Self::CELLS]; 4]; 4],
}

impl PatchShears {
    /// The most cells that the points of a patch touch in a direction: one vector of numbers. A patch is
    /// 1024 × 256 grid units. With displacements below 127 and shears of 32 at most, coordinates across
    /// the diagonals span 1280 + 4·127 + 2·32 units, less than 15 cells of 128.
    pub(crate) const CELLS: usize = 16;

    /// Selects the place of a coordinate in its cell.
    pub(crate) const CELL_MASK: i32 = (1 << CELL_BITS) - 1;

    pub(crate) fn new(shears: &Shears, origin: [i64; 2]) -> Self {
        let [x, y] = origin.map(|v| v >> KNOT_BITS);
        let first = [y, x, x - y, x + y];
        let mut cubics = [[[0.0; Self::CELLS]; 4]; 4];
        for (direction, table) in cubics.iter_mut().enumerate() {
            for relative in (FIRST_CELLS[direction]..).take(Self::CELLS) {
                let cubic = shears.cubic(direction, first[direction] + relative);
                for (of_power, coefficient) in table.iter_mut().zip(cubic) {
                    of_power[relative.rem_euclid(Self::CELLS as i64) as usize] = coefficient;
                }
            }
        }
        Self { cubics }
    }

    #[inline(always)]
    fn noise(&self, direction: usize, s: i32) -> i32 {
        let cell = (s >> CELL_BITS) as usize % Self::CELLS;
        let [a, b, c, d] = &self.cubics[direction];
        evaluate(&[a[cell], b[cell], c[cell], d[cell]], s & Self::CELL_MASK)
    }

    /// [`Shears::apply`], relative to the origin.
    #[inline(always)]
    pub(crate) fn apply(&self, x: i32, y: i32) -> [i32; 2] {
        let x = x + self.noise(0, y);
        let y = y + self.noise(1, x);
        let rising = self.noise(2, x - y);
        let (x, y) = (x + rising, y + rising);
        let falling = self.noise(3, x + y);
        [x + falling, y - falling]
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::{
        sample::{Seed, Warp},
        table::FRACTION_BITS,
    };

    proptest! {
        #[test]
        fn a_patch_gives_the_same_bits(
            seed: u64, column in -(1i64 << 42)..1 << 42, row in -(1i64 << 42)..1 << 42,
            x in -127i32 << FRACTION_BITS..1151 << FRACTION_BITS,
            y in -127i32 << FRACTION_BITS..383 << FRACTION_BITS,
            corner in 0u8..8,
            set_side in prop_oneof![Just(0.317), Just(0.01), 0.01..0.5f64], strength in 0.1..=2.0f64,
        ) {
            // The corners reach the farthest cells.
            let [x, y] = match corner {
                0 => [-127 << FRACTION_BITS, -127 << FRACTION_BITS],
                1 => [(1151 << FRACTION_BITS) - 1, -127 << FRACTION_BITS],
                2 => [-127 << FRACTION_BITS, (383 << FRACTION_BITS) - 1],
                3 => [(1151 << FRACTION_BITS) - 1, (383 << FRACTION_BITS) - 1],
                _ => [x, y],
            };
            let warp = Warp::new(strength).expect("in range");
            let shears = Shears::new(warp, Seed(seed), set_side).expect("on");
            let origin = [column * 1024, row * 256];
            let base = origin.map(|v| i128::from(v) << FRACTION_BITS);
            let there = shears.apply([base[0] + i128::from(x), base[1] + i128::from(y)]);
            let patch = PatchShears::new(&shears, origin).apply(x, y);
            prop_assert_eq!([there[0] - base[0], there[1] - base[1]], patch.map(i128::from));
        }
    }
}
