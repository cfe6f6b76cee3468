//! The pattern in space: {(αx + y + z)/2} and cyclic.
//!
//! A lattice point (x, y, z) has the index dX = {(αx + y + z)/2}, dY = {(αy + x + z)/2}, dZ = {(αz + x + y)/2}, and
//! belongs to the pattern if all three are below t = (α − 1)/2. An index depends on the two other coordinates by the
//! parity of their sum only, so the pattern is a union of eight Cartesian products, one for each class of parities,
//! of the same one-dimensional sets as in the plane.

use core::ops::Range;

use crate::{
    lattice::seed::Seed,
    pattern::{Alpha, AxisSet},
};

/// The pattern of one α in space, seen from one origin in index space.
///
/// ```
/// use strew_core::space::Pattern;
///
/// let pattern = Pattern::new("(5-sqrt(3))/2".parse()?, [0; 3]);
/// assert!(pattern.contains([0, 0, 0]) && !pattern.contains([1, 0, 0]));
/// // Counting takes no longer for a larger box.
/// let side = -10_000_000_000..10_000_000_000;
/// let count = pattern.count([side.clone(), side.clone(), side]);
/// let t = pattern.alpha().set_side_f64();
/// assert!((count as f64 / 8e30 - t * t * t).abs() < 1e-9);
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pattern {
    alpha: Alpha,
    origin: [u64; 3],
}

/// A coordinate along an axis whose planes hold points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Visit {
    /// The parity of the coordinate.
    pub(super) own: u8,
    /// The parity of the sum of the two other coordinates of its points.
    pub(super) others: u8,
    /// Its index, in units of 2⁻⁶⁴.
    pub(super) index: u64,
}

impl Pattern {
    /// The pattern whose lattice origin has the index `origin`, in units of 2⁻⁶⁴.
    #[must_use]
    pub const fn new(alpha: Alpha, origin: [u64; 3]) -> Self {
        Self { alpha, origin }
    }

    /// The index of the lattice origin that a seed chooses.
    #[must_use]
    pub fn origin(seed: Seed) -> [u64; 3] {
        let planar = seed.origin();
        let z = match seed {
            Seed(0) => 0,
            Seed(number) => Seed(planar.y ^ number).origin().x,
        };
        [planar.x, planar.y, z]
    }

    /// The number α.
    #[must_use]
    pub const fn alpha(&self) -> Alpha {
        self.alpha
    }

    /// The index (dX, dY, dZ) of a lattice point, in units of 2⁻⁶⁴.
    ///
    /// ```
    /// use strew_core::space::Pattern;
    ///
    /// let pattern = Pattern::new("1.5".parse()?, [0; 3]);
    /// // {(1.5·1 + 2 + 2)/2} = 3/4, {(1.5·2 + 1 + 2)/2} = 0.
    /// assert_eq!(pattern.index([1, 2, 2]), [3 << 62, 0, 0]);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn index(&self, at: [i64; 3]) -> [u64; 3] {
        let [x, y, z] = at;
        let others = [y ^ z, x ^ z, x ^ y];
        [0, 1, 2].map(|axis| self.axis_index(axis, at[axis], (others[axis] & 1) as u8))
    }

    /// Whether a lattice point belongs to the pattern.
    #[must_use]
    pub fn contains(&self, at: [i64; 3]) -> bool {
        let side = self.alpha.set_side();
        self.index(at).iter().all(|&index| index < side)
    }

    /// The number of points in a half-open lattice box: eight products of three floor sums. The number must be below
    /// 2¹²⁸, as it is in boxes with sides up to 2⁴³.
    #[must_use]
    pub fn count(&self, ranges: [Range<i64>; 3]) -> u128 {
        let counts = [0, 1, 2].map(|axis| self.axis_counts(axis, &ranges[axis]));
        products(&counts)
    }

    /// The numbers of coordinates of a range that hold points, by the parity of their own and then of the others.
    fn axis_counts(&self, axis: usize, range: &Range<i64>) -> [[u64; 2]; 2] {
        let whole = 0..self.alpha.set_side();
        [0, 1].map(|own| {
            [0, 1].map(|others| {
                let zero = self.axis_index(axis, 0, others);
                AxisSet::new(self.alpha, zero, own, whole.clone()).count(range.clone())
            })
        })
    }

    /// The index of a coordinate, given the parity of the sum of the others.
    pub(super) const fn axis_index(&self, axis: usize, v: i64, others: u8) -> u64 {
        self.alpha
            .half()
            .wrapping_mul(v as u64)
            .wrapping_add(self.origin[axis])
            .wrapping_add((others as u64) << 63)
    }

    /// The class and the index of a coordinate, or `None` if its plane holds no points. The two indices that a
    /// coordinate may have differ by one half, so at most one of them is below t.
    #[inline]
    pub(super) const fn visit(&self, axis: usize, v: i64) -> Option<Visit> {
        let even = self.axis_index(axis, v, 0);
        let side = self.alpha.set_side();
        let own = (v & 1) as u8;
        let (others, index) = if even < side {
            (0, even)
        } else if even ^ (1 << 63) < side {
            (1, even ^ (1 << 63))
        } else {
            return None;
        };
        Some(Visit { own, others, index })
    }
}

/// The number of triples of coordinates that are points, from the numbers of coordinates of each axis by the parity of
/// their own and then of the others.
pub(super) fn products(counts: &[[[u64; 2]; 2]; 3]) -> u128 {
    let mut sum = 0;
    for class in 0..8usize {
        let [x, y, z] = [class & 1, class >> 1 & 1, class >> 2];
        let columns = u128::from(counts[0][x][y ^ z]);
        let rows = u128::from(counts[1][y][x ^ z]);
        sum += columns * rows * u128::from(counts[2][z][x ^ y]);
    }
    sum
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn eight_products_make_the_pattern(
            corner in prop::array::uniform3(-1i64 << 40..1 << 40), sides in prop::array::uniform3(0i64..24),
            origin in prop::array::uniform3(any::<u64>()),
        ) {
            let pattern = Pattern::new("(5-sqrt(3))/2".parse().expect("valid"), origin);
            let ranges = [0, 1, 2].map(|axis| corner[axis]..corner[axis] + sides[axis]);
            let mut direct = 0;
            for z in ranges[2].clone() {
                for y in ranges[1].clone() {
                    direct += ranges[0].clone().filter(|&x| pattern.contains([x, y, z])).count() as u128;
                }
            }
            prop_assert_eq!(pattern.count(ranges), direct);
        }

        #[test]
        fn a_visited_coordinate_has_the_class_and_index_of_its_points(
            at in prop::array::uniform3(-50i64..50), origin in prop::array::uniform3(any::<u64>()),
        ) {
            let pattern = Pattern::new("(5-sqrt(3))/2".parse().expect("valid"), origin);
            let visits = [0, 1, 2].map(|axis| pattern.visit(axis, at[axis]));
            let sum: i64 = at.iter().sum();
            let fits = |axis: usize| visits[axis].is_some_and(|visit| {
                i64::from(visit.others) == (sum - at[axis]) & 1 && visit.index == pattern.index(at)[axis]
            });
            prop_assert_eq!(pattern.contains(at), (0..3).all(fits));
        }
    }
}
