//! The warp of the points of a patch, in 32-bit positions, and of points around a place, in 64-bit positions.

use alloc::{vec, vec::Vec};

use super::shears::{
    CELL_BITS, CELL_MASK, KNOT_BITS, Quadratic, Shears, across, evaluate, quadratic, shear,
};

/// The shears of one patch, with all quadratics tabulated. Positions relative to the patch's origin fit 32
/// bits. The origin is a multiple of the knot distance along both axes.
#[derive(Clone, Debug)]
pub struct PatchShears {
    /// By direction, by power, by cell from the first one that the points touch on.
    tables: Vec<f32>,
    /// The length of a table: [`AT_ONCE`](Self::AT_ONCE) − 1 entries follow the last cell.
    length: usize,
    /// By direction, bounds of g.
    pub(crate) bounds: [[i32; 2]; 4],
    /// By direction, the first cell that the points touch.
    pub(crate) first: [i32; 4],
}

impl PatchShears {
    /// The most cells that the points of a patch touch in a direction. A patch is 1024 × 256 grid units. With
    /// displacements below 128, shears along the axes below 55.2 and diagonal ones below 27.6, as they are at the
    /// greatest strength with long waves, coordinates across the diagonals lie from −623 to 1391 and from −422 to
    /// 1702 units, within 68 cells of 32.
    const CELLS: usize = 68;
    /// The most cells that are looked up at once: one vector of numbers.
    pub(crate) const AT_ONCE: usize = 16;

    /// Selects the place of a coordinate in its cell.
    pub(crate) const CELL_MASK: i32 = (1 << CELL_BITS) - 1;

    /// The shears of the points whose displaced positions lie in some ranges of x and y, relative to the
    /// origin. Both ends belong to a range.
    pub(crate) fn new(shears: &Shears, origin: [i64; 2], [x, y]: [[i32; 2]; 2]) -> Self {
        let is_empty = x[0] > x[1] || y[0] > y[1];
        let cells = if is_empty {
            1
        } else {
            most_cells(shears, [x, y])
        };
        let length = cells + Self::AT_ONCE - 1;
        let mut patch = Self {
            tables: vec![0.0; 12 * length],
            length,
            bounds: [[0; 2]; 4],
            first: [0; 4],
        };
        if is_empty {
            return patch;
        }
        let first = across(origin.map(|v| v >> KNOT_BITS));
        let mut tabulate =
            |direction: usize, range| patch.tabulate(shears, direction, first[direction], range);
        let more = |range: [i32; 2], by: [i32; 2]| [range[0] + by[0], range[1] + by[1]];
        let y = more(y, tabulate(0, x));
        let x = more(x, tabulate(1, y));
        let rising = tabulate(2, [x[0] - y[1], x[1] - y[0]]);
        let (x, y) = (more(x, rising), more(y, rising));
        tabulate(3, [x[0] + y[0], x[1] + y[1]]);
        patch
    }

    /// Tabulates the cells of a direction that a range of coordinates touches. Returns a range of g there.
    fn tabulate(
        &mut self,
        shears: &Shears,
        direction: usize,
        first: i64,
        [from, to]: [i32; 2],
    ) -> [i32; 2] {
        let touched = [from, to].map(|s| s >> CELL_BITS);
        let start = i64::from(touched[0]);
        let cells = (touched[1] - touched[0]) as usize + 1;
        debug_assert!(cells <= Self::CELLS, "{cells} cells");
        let mut controls = [0; Self::CELLS + 2];
        let controls = &mut controls[..cells.min(Self::CELLS) + 2];
        shears.controls(direction, first + start - 1, controls);
        let length = self.length;
        let table = &mut self.tables[3 * direction * length..][..3 * length];
        for (place, knots) in controls.windows(3).enumerate() {
            let coefficients = quadratic([knots[0], knots[1], knots[2]]);
            for (power, coefficient) in coefficients.into_iter().enumerate() {
                table[power * length + place] = coefficient;
            }
        }
        // A B-spline stays within its control values. The rest is room for rounding.
        let least = controls.iter().min().map_or(0, |v| v - 64);
        let bounds = [least, controls.iter().max().map_or(0, |v| v + 64)];
        self.first[direction] = touched[0];
        self.bounds[direction] = bounds;
        bounds
    }

    /// The least and the greatest movement, along x and y, of positions in some ranges, both ends of which belong to
    /// them: that of the middle, and as much more or less as slopes allow. Faster than
    /// [`Shears::drift_from`], and nearly as tight where ranges are short.
    pub(crate) fn drift(&self, shears: &Shears, ranges: [[i32; 2]; 2]) -> [[i32; 2]; 2] {
        // Room for rounding in `f32`.
        const ROOM: f64 = 256.0;
        let [middle, half] = [
            ranges.map(|[first, last]| first + (last - first) / 2),
            ranges.map(|[first, last]| last - first - (last - first) / 2),
        ];
        let moved = self.apply(middle[0], middle[1]);
        let [first, second, third, fourth] = shears.slopes();
        let [across, up] = half.map(f64::from);
        let y = first * across;
        let x = second * (up + y);
        let rising = third * (across + x + up + y);
        let falling = fourth * (across + x + up + y + 2.0 * rising);
        let both = rising + falling + ROOM;
        let more = [x + both, y + both].map(|v| v as i32);
        [0, 1].map(|i| {
            let by = moved[i] - middle[i];
            [by - more[i], by + more[i]]
        })
    }

    /// The three tables of a direction, one after another, and the number of entries of each.
    #[inline(always)]
    pub(crate) fn tables(&self, direction: usize) -> (&[f32], usize) {
        let length = self.length;
        (&self.tables[3 * direction * length..][..3 * length], length)
    }

    /// The place of the last cell.
    #[inline(always)]
    pub(crate) const fn last_place(&self) -> usize {
        self.length - Self::AT_ONCE
    }

    #[inline(always)]
    fn noise(&self, direction: usize, s: i32) -> i32 {
        // Cells that no point touches have those of another one.
        let place = ((s >> CELL_BITS) - self.first[direction]) as u32 as usize;
        let place = place.min(self.last_place());
        let (tables, length) = self.tables(direction);
        let quadratic: Quadratic = [0, 1, 2].map(|power| tables[power * length + place]);
        evaluate(&quadratic, s & Self::CELL_MASK)
    }

    /// The movement along y of the first shear, which depends on x alone.
    #[inline(always)]
    pub(crate) fn first(&self, x: i32) -> i32 {
        self.noise(0, x)
    }

    /// The place of a position after the first shear, both relative to the origin.
    #[inline(always)]
    pub(crate) fn apply_others(&self, x: i32, y: i32) -> [i32; 2] {
        let x = x + self.noise(1, y);
        let rising = self.noise(2, x - y);
        let (x, y) = (x + rising, y + rising);
        let falling = self.noise(3, x + y);
        [x + falling, y - falling]
    }

    /// The place to which the warp moves a position, both relative to the origin.
    #[inline(always)]
    pub(crate) fn apply(&self, x: i32, y: i32) -> [i32; 2] {
        self.apply_others(x, y + self.first(x))
    }
}

/// A bound of the number of cells that positions in some ranges touch in a direction. Those across the last
/// diagonal are farthest apart.
fn most_cells(shears: &Shears, [x, y]: [[i32; 2]; 2]) -> usize {
    let [along_y, along_x, rising, _] = shears.amplitudes().map(|a| 2 * (i64::from(a) + 64));
    let length = |[first, last]: [i32; 2]| i64::from(last) - i64::from(first);
    let width = length(x) + length(y) + along_x + along_y + 2 * rising;
    (width >> CELL_BITS) as usize + 2
}

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
    use crate::{
        lattice::seed::Seed,
        table::FRACTION_BITS,
        warp::{Warp, Waves},
    };

    proptest! {
        #[test]
        fn a_patch_gives_the_same_bits(
            seed: u64, column in -(1i64 << 42)..1 << 42, row in -(1i64 << 42)..1 << 42,
            x in -128i32 << FRACTION_BITS..1152 << FRACTION_BITS,
            y in -128i32 << FRACTION_BITS..384 << FRACTION_BITS,
            corner in 0u8..8, is_long: bool,
            strength in prop_oneof![0.1..=2.0f64, Just(2.0)],
        ) {
            // The corners reach the farthest cells.
            let [x, y] = match corner {
                0 => [-128 << FRACTION_BITS, -128 << FRACTION_BITS],
                1 => [(1152 << FRACTION_BITS) - 1, -128 << FRACTION_BITS],
                2 => [-128 << FRACTION_BITS, (384 << FRACTION_BITS) - 1],
                3 => [(1152 << FRACTION_BITS) - 1, (384 << FRACTION_BITS) - 1],
                _ => [x, y],
            };
            let warp = Warp::new(strength).expect("in range");
            let waves = if is_long { Waves::All } else { Waves::Short };
            let shears = Shears::new(waves, warp, Seed(seed)).expect("on");
            let origin = [column * 1024, row * 256];
            let base = origin.map(|v| i128::from(v) << FRACTION_BITS);
            let there = shears.apply([base[0] + i128::from(x), base[1] + i128::from(y)]);
            let around = |v: i32, low: i32, high: i32| match corner {
                0..4 => [-128 << FRACTION_BITS, high << FRACTION_BITS],
                // Fewer cells serve fewer points.
                _ => [v.max((-128 << FRACTION_BITS) + low) - low, v.min((high << FRACTION_BITS) - low) + low],
            };
            let ranges = [around(x, 9 << FRACTION_BITS, 1152), around(y, 3 << FRACTION_BITS, 384)];
            let patch = PatchShears::new(&shears, origin, ranges).apply(x, y);
            prop_assert_eq!([there[0] - base[0], there[1] - base[1]], patch.map(i128::from));
        }
    }

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
