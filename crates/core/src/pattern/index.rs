//! The index torus and membership, and the pattern as the holes of a rounded linear map (paper, Eq. 1).
//!
//! Let M send every grid point (x, y) to ⌊½ [α −1; 1 α] (x, y)⌋. Some target pixels stay empty, and
//! they are exactly the images M(x − 1, y − 1) + (0, 1) of the points (x, y) of AA(α) with index origin
//! (½, 0). Their density is t² over the determinant (α² + 1)/4, so it equals that of the pattern only
//! at α = √3, where M rotates by 30°.

use core::ops::Range;

use super::{Alpha, Axis, AxisSet, Class};

/// The index of the lattice origin, in units of 2⁻⁶⁴ of the torus. Another origin shows another piece
/// of the same unbounded pattern.
///
/// ```
/// use strew_core::{Alpha, Pattern, pattern::IndexOrigin};
///
/// let alpha: Alpha = "sqrt(3)".parse()?;
/// let moved = Pattern::with_origin(alpha, IndexOrigin { x: alpha.set_side(), y: 0 });
/// // (0, 0) is a point of one piece and not of the other.
/// assert!(Pattern::new(alpha).contains(0, 0) && !moved.contains(0, 0));
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct IndexOrigin {
    /// dX of the lattice point (0, 0).
    pub x: u64,
    /// dY of the lattice point (0, 0).
    pub y: u64,
}

impl IndexOrigin {
    /// dX for [`Axis::X`], dY for [`Axis::Y`], in units of 2⁻⁶⁴.
    #[must_use]
    pub const fn along(self, axis: Axis) -> u64 {
        match axis {
            Axis::X => self.x,
            Axis::Y => self.y,
        }
    }
}

/// The AA pattern of one α, seen from one origin in index space.
///
/// ```
/// use strew_core::Pattern;
///
/// let pattern = Pattern::new("(5-sqrt(3))/2".parse()?);
/// assert!(pattern.contains(0, 0) && !pattern.contains(1, 0));
/// // Counting takes no longer for a larger box.
/// let side = -1_000_000_000_000..1_000_000_000_000;
/// let count = pattern.count(side.clone(), side);
/// let t = pattern.alpha().set_side_f64();
/// assert!((count as f64 / 4e24 - t * t).abs() < 1e-11);
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Pattern {
    alpha: Alpha,
    origin: IndexOrigin,
}

impl Pattern {
    /// The pattern whose lattice origin has the index (0, 0).
    #[must_use]
    pub const fn new(alpha: Alpha) -> Self {
        Self::with_origin(alpha, IndexOrigin { x: 0, y: 0 })
    }

    /// The pattern whose lattice origin has the index `origin`.
    #[must_use]
    pub const fn with_origin(alpha: Alpha, origin: IndexOrigin) -> Self {
        Self { alpha, origin }
    }

    /// The number α.
    #[must_use]
    pub const fn alpha(&self) -> Alpha {
        self.alpha
    }

    /// The index of a coordinate along an axis, given the parity of the other coordinate:
    /// {origin + (α·v + parity)/2}, in units of 2⁻⁶⁴.
    #[must_use]
    pub const fn axis_index(&self, axis: Axis, v: i64, other_parity: u8) -> u64 {
        self.alpha
            .half()
            .wrapping_mul(v as u64)
            .wrapping_add(self.origin.along(axis))
            .wrapping_add((other_parity as u64) << 63)
    }

    /// The index (dX, dY) of a lattice point, in units of 2⁻⁶⁴ (paper, Eqs. 2 and 3).
    ///
    /// ```
    /// use strew_core::Pattern;
    ///
    /// let pattern = Pattern::new("1.5".parse()?);
    /// // dX = {(1.5·1 + 2)/2} = 3/4, dY = {(1.5·2 + 1)/2} = 0.
    /// assert_eq!(pattern.index(1, 2), (3 << 62, 0));
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub const fn index(&self, x: i64, y: i64) -> (u64, u64) {
        let class = Class::of(x, y);
        (
            self.axis_index(Axis::X, x, class.y),
            self.axis_index(Axis::Y, y, class.x),
        )
    }

    /// Whether a lattice point belongs to the pattern: dX < t and dY < t (paper, Eq. 4).
    #[must_use]
    pub const fn contains(&self, x: i64, y: i64) -> bool {
        let (index_x, index_y) = self.index(x, y);
        let side = self.alpha.set_side();
        index_x < side && index_y < side
    }

    /// The columns (`Axis::X`) or rows (`Axis::Y`) of one class: the pattern is the union, over the
    /// four classes, of columns × rows.
    #[must_use]
    pub fn axis_set(&self, axis: Axis, class: Class) -> AxisSet {
        self.axis_subset(axis, class, 0..self.alpha.set_side())
    }

    /// The part of [`axis_set`](Self::axis_set) whose index lies in `interval`, in units of 2⁻⁶⁴.
    #[must_use]
    pub fn axis_subset(&self, axis: Axis, class: Class, interval: Range<u64>) -> AxisSet {
        let (own, other) = match axis {
            Axis::X => (class.x, class.y),
            Axis::Y => (class.y, class.x),
        };
        let interval = interval.start..interval.end.min(self.alpha.set_side());
        AxisSet::new(self.alpha, self.axis_index(axis, 0, other), own, interval)
    }

    /// The class and the index of a column (`Axis::X`) or row (`Axis::Y`), or `None` if it holds no
    /// points. A coordinate has two indices, by the parity of the other one; at most one of them lies
    /// in the set region, so a column or row belongs to one class only.
    ///
    /// ```
    /// use strew_core::{Pattern, pattern::{Axis, Class}};
    ///
    /// let pattern = Pattern::new("sqrt(3)".parse()?);
    /// // Row 0 has its points in even columns.
    /// assert_eq!(pattern.visit(Axis::Y, 0), Some((Class { x: 0, y: 0 }, 0)));
    /// let empty = (0..).find(|&y| pattern.visit(Axis::Y, y).is_none()).expect("one in four");
    /// assert_eq!(pattern.count(-1_000_000..1_000_000, empty..empty + 1), 0);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub const fn visit(&self, axis: Axis, v: i64) -> Option<(Class, u64)> {
        let even = self.axis_index(axis, v, 0);
        let odd = even ^ (1 << 63);
        let side = self.alpha.set_side();
        let (other, index) = if even < side {
            (0, even)
        } else if odd < side {
            (1, odd)
        } else {
            return None;
        };
        let own = (v & 1) as u8;
        let class = match axis {
            Axis::X => Class { x: own, y: other },
            Axis::Y => Class { x: other, y: own },
        };
        Some((class, index))
    }

    /// The number of points in a half-open lattice box, in O(log).
    #[must_use]
    pub fn count(&self, x: Range<i64>, y: Range<i64>) -> u128 {
        Class::ALL
            .into_iter()
            .map(|class| {
                u128::from(self.axis_set(Axis::X, class).count(x.clone()))
                    * u128::from(self.axis_set(Axis::Y, class).count(y.clone()))
            })
            .sum()
    }
}

/// M(x, y) = ⌊½ [α −1; 1 α] (x, y)⌋ (Ahmed, Huang, Deussen 2015, Eq. 1), or `None` where the result
/// leaves `i64`.
#[must_use]
pub fn forward_map(alpha: Alpha, x: i64, y: i64) -> Option<(i64, i64)> {
    let half = i128::from(alpha.half());
    let (x, y) = (i128::from(x), i128::from(y));
    let one_half = 1i128 << 63;
    let column = half.checked_mul(x)?.checked_sub(one_half * y)? >> 64;
    let row = half.checked_mul(y)?.checked_add(one_half * x)? >> 64;
    Some((i64::try_from(column).ok()?, i64::try_from(row).ok()?))
}

/// Whether M, the [`forward_map`], sends no grid point to a target pixel, by brute force over the nearest
/// candidates. The pixels that stay vacant are M(x − 1, y − 1) + (0, 1) for the points (x, y) of the
/// pattern with index origin (½, 0).
///
/// Requires |column|, |row| ≤ 2⁴⁰: farther out `f64` cannot locate the candidates.
///
/// ```
/// use strew_core::{Alpha, Pattern, pattern::{IndexOrigin, forward_map, is_vacant}};
///
/// let alpha: Alpha = "sqrt(3)".parse()?;
/// let pattern = Pattern::with_origin(alpha, IndexOrigin { x: 1 << 63, y: 0 });
/// // Points of the pattern have holes, other places have not.
/// for x in 0..99 {
///     let (column, row) = forward_map(alpha, x - 1, 4).expect("small");
///     assert_eq!(is_vacant(alpha, column, row + 1), pattern.contains(x, 5));
/// }
/// # Ok::<(), strew_core::Error>(())
/// ```
#[must_use]
pub fn is_vacant(alpha: Alpha, column: i64, row: i64) -> bool {
    let a = alpha.to_f64();
    let scale = 2.0 / (a * a + 1.0);
    let (c, r) = (column as f64 + 0.5, row as f64 + 0.5);
    let (x, y) = (
        libm::floor(scale * (a * c + r)) as i64,
        libm::floor(scale * (a * r - c)) as i64,
    );
    // The preimage of a pixel is a square of side √2 at most, so sources lie within 2 of its center.
    (x - 2..=x + 3)
        .all(|x| (y - 2..=y + 3).all(|y| forward_map(alpha, x, y) != Some((column, row))))
}

#[cfg(test)]
mod tests {
    use alloc::{collections::BTreeSet, vec::Vec};

    use proptest::prelude::*;

    use super::*;
    use crate::pattern::{IndexOrigin, Pattern};

    fn alpha(text: &str) -> Alpha {
        text.parse().expect("valid")
    }

    #[test]
    fn membership_agrees_with_the_real_formula() {
        for text in ["sqrt(3)", "(5-sqrt(3))/2", "(1+sqrt(5))/2", "1.3"] {
            let a = alpha(text);
            let pattern = Pattern::new(a);
            let (v, t) = (a.to_f64(), a.set_side_f64());
            for y in -60..60i64 {
                for x in -60..60i64 {
                    let dx = ((v * x as f64 + y as f64) / 2.0).rem_euclid(1.0);
                    let dy = ((v * y as f64 + x as f64) / 2.0).rem_euclid(1.0);
                    // Stay away from the ends, where f64 cannot decide.
                    let clear = [dx, dy]
                        .iter()
                        .all(|d| (d - t).abs() > 1e-9 && *d > 1e-9 && *d < 1.0 - 1e-9);
                    if clear {
                        assert_eq!(pattern.contains(x, y), dx < t && dy < t, "{text} {x} {y}");
                    }
                }
            }
        }
    }

    proptest! {
        #[test]
        fn four_products_make_the_pattern(
            x0 in any::<i64>(), y0 in any::<i64>(), w in 0i64..60, h in 0i64..60, ox: u64, oy: u64,
        ) {
            let (x0, y0) = (x0.min(i64::MAX - 60), y0.min(i64::MAX - 60));
            let pattern = Pattern::with_origin(alpha("(5-sqrt(3))/2"), IndexOrigin { x: ox, y: oy });
            let mut direct = Vec::new();
            for y in y0..y0 + h {
                direct.extend((x0..x0 + w).filter(|&x| pattern.contains(x, y)).map(|x| (y, x)));
            }
            let mut products = Vec::new();
            for class in Class::ALL {
                for y in pattern.axis_set(Axis::Y, class).iter(y0..y0 + h) {
                    let columns = pattern.axis_set(Axis::X, class).iter(x0..x0 + w);
                    products.extend(columns.map(|x| (y, x)));
                }
            }
            products.sort_unstable();
            prop_assert_eq!(pattern.count(x0..x0 + w, y0..y0 + h), direct.len() as u128);
            prop_assert_eq!(products, direct);
        }
    }

    #[test]
    fn vacant_pixels_are_the_image_of_the_pattern() {
        for text in ["sqrt(3)", "(5-sqrt(3))/2", "(1+sqrt(5))/2", "13/10", "1.93"] {
            let alpha: Alpha = text.parse().expect("valid");
            let pattern = Pattern::with_origin(alpha, IndexOrigin { x: 1 << 63, y: 0 });
            for (x0, y0) in [(0i64, 0i64), (1_000_003, -77_000_111)] {
                let mut image = BTreeSet::new();
                for y in y0 - 150..y0 + 150 {
                    for x in x0 - 150..x0 + 150 {
                        if pattern.contains(x, y) {
                            let (c, r) = forward_map(alpha, x - 1, y - 1).expect("in range");
                            assert!(image.insert((c, r + 1)), "two points share a pixel");
                        }
                    }
                }
                let (c0, r0) = forward_map(alpha, x0, y0).expect("in range");
                let mut vacant = 0;
                for r in r0 - 60..r0 + 60 {
                    for c in c0 - 60..c0 + 60 {
                        assert_eq!(
                            is_vacant(alpha, c, r),
                            image.contains(&(c, r)),
                            "{text} {c} {r}"
                        );
                        vacant += u32::from(is_vacant(alpha, c, r));
                    }
                }
                let (a, t) = (alpha.to_f64(), alpha.set_side_f64());
                let expected = t * t * 4.0 / (a * a + 1.0) * 14_400.0;
                assert!(
                    (f64::from(vacant) / expected - 1.0).abs() < 0.15,
                    "{text} {vacant} {expected}"
                );
            }
        }
    }

    #[test]
    fn the_map_works_to_the_ends_of_the_lattice() {
        let alpha: Alpha = "sqrt(3)".parse().expect("valid");
        // M turns by 30° and rounds down.
        assert_eq!(forward_map(alpha, 10, 0), Some((8, 5)));
        assert!(forward_map(alpha, i64::MAX, i64::MIN).is_none());
        assert!(forward_map(alpha, i64::MAX / 2, i64::MIN / 2).is_some());
    }
}
