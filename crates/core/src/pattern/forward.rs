//! The pattern as the holes of a rounded linear map (paper, Eq. 1).
//!
//! Let M send every grid point (x, y) to ⌊½ [α −1; 1 α] (x, y)⌋. Some target pixels stay empty, and
//! they are exactly the images M(x − 1, y − 1) + (0, 1) of the points (x, y) of AA(α) with index origin
//! (½, 0). Their density is t² over the determinant (α² + 1)/4, so it equals that of the pattern only
//! at α = √3, where M rotates by 30°.

use super::Alpha;

/// M(x, y) = ⌊½ [α −1; 1 α] (x, y)⌋ (Ahmed, Huang, Deussen 2015, Eq. 1), or `None` where the result
/// leaves `i64`.
///
/// ```
/// use strew_core::pattern::forward_map;
///
/// // At α = √3, M rotates by 30° and rounds down.
/// assert_eq!(forward_map("sqrt(3)".parse()?, 10, 0), Some((8, 5)));
/// assert_eq!(forward_map("sqrt(3)".parse()?, i64::MAX, i64::MIN), None);
/// # Ok::<(), strew_core::Error>(())
/// ```
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
    use alloc::collections::BTreeSet;

    use super::*;
    use crate::pattern::{IndexOrigin, Pattern};

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
        assert!(forward_map(alpha, i64::MAX, i64::MIN).is_none());
        assert!(forward_map(alpha, i64::MAX / 2, i64::MIN / 2).is_some());
    }
}
