//! A bound on how much the warp stretches and shrinks distances, valid everywhere.
//!
//! A shear p ← p + d·g(d⊥·p) has the Jacobian I + g'·d·d⊥ᵀ; the warp's is the product of four. g is a
//! uniform quadratic B-spline, so its slope goes straight from one step between control values to the next
//! (de Boor, "A Practical Guide to Splines", ch. X): |g'| ≤ s, the greatest step over the distance of the
//! knots. The product is affine in each slope, so its norm is convex in each and greatest at one of the 16
//! corners of the box of slopes, where σ ≥ ‖J‖ is evaluated. All determinants are 1, so ‖J⁻¹‖ = ‖J‖:
//! distances grow and shrink by a factor of at most σ.
//!
//! σ is 1.091 at strength 1 and 1.197 at strength 2. All four shears must be steepest at one place to reach
//! it. Measured distances shrink by a few percent.

use super::Shears;

/// The bound of one warp.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stretch {
    /// The largest factor by which distances grow or shrink; at least 1.
    pub(crate) factor: f64,
    /// The distance of an integer position from that of the smooth warp or its inverse, at most, in
    /// fixed-point units.
    pub(crate) slack: f64,
}

impl Stretch {
    /// The bound where there is no warp.
    const NONE: Self = Self {
        factor: 1.0,
        slack: 0.0,
    };

    /// The bound of a warp, if there is one.
    pub(crate) fn of(shears: Option<&Shears>) -> Self {
        let Some(shears) = shears else {
            return Self::NONE;
        };
        let factor = largest_norm(shears.slopes());
        // In each shear the f32 coefficients and evaluation err by 2⁻²⁰ of the amplitude at most, and
        // truncation by a unit. Later shears stretch the errors of earlier ones.
        let missed: f64 = shears
            .amplitudes()
            .iter()
            .map(|&a| f64::from(a) / f64::from(1 << 20) + 4.0)
            .sum();
        Self {
            factor,
            slack: 2.0 * factor * missed,
        }
    }
}

type Matrix = [[f64; 2]; 2];

fn product(a: Matrix, b: Matrix) -> Matrix {
    let entry = |i: usize, j: usize| a[i][0] * b[0][j] + a[i][1] * b[1][j];
    [[entry(0, 0), entry(0, 1)], [entry(1, 0), entry(1, 1)]]
}

/// The largest singular value of the product of the four shears over the corners of the box of
/// slopes, rounded up.
fn largest_norm(slopes: [f64; 4]) -> f64 {
    let mut largest = 1.0f64;
    for corner in 0..16u32 {
        let [a, b, c, d] = [0, 1, 2, 3].map(|i| {
            if corner >> i & 1 == 0 {
                slopes[i]
            } else {
                -slopes[i]
            }
        });
        let shears: [Matrix; 4] = [
            [[1.0, a], [0.0, 1.0]],
            [[1.0, 0.0], [b, 1.0]],
            [[1.0 + c, -c], [c, 1.0 - c]],
            [[1.0 + d, d], [-d, 1.0 - d]],
        ];
        let all = shears
            .into_iter()
            .reduce(|before, next| product(next, before))
            .unwrap_or([[1.0, 0.0], [0.0, 1.0]]);
        let squares: f64 = all.iter().flatten().map(|v| v * v).sum();
        // The determinant is 1, so σ² + σ⁻² = squares.
        let norm = (libm::sqrt(squares + 2.0) + libm::sqrt((squares - 2.0).max(0.0))) / 2.0;
        largest = largest.max(norm);
    }
    largest * (1.0 + 1e-12)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::sample::{Seed, Warp};

    #[test]
    fn known_norms() {
        assert!((largest_norm([0.0; 4]) - 1.0).abs() < 1e-6);
        // One shear of slope s: √(1 + s²/4) + s/2.
        let one = largest_norm([0.5, 0.0, 0.0, 0.0]);
        assert!((one - (1.0625f64.sqrt() + 0.25)).abs() < 1e-9, "{one}");
        for (strength, expected) in [(1.0, 1.091), (2.0, 1.197)] {
            let warp = Warp::new(strength).expect("in range");
            let shears = Shears::new(warp, Seed(1));
            let factor = Stretch::of(shears.as_ref()).factor;
            assert!((factor - expected).abs() < 0.001, "{strength}: {factor}");
        }
    }

    proptest! {
        #[test]
        fn no_corner_is_exceeded_inside(
            slopes in proptest::array::uniform4(0.0..0.5f64),
            inside in proptest::array::uniform4(0.0..1.0f64),
        ) {
            let smaller = [0, 1, 2, 3].map(|i| slopes[i] * inside[i]);
            prop_assert!(largest_norm(smaller) <= largest_norm(slopes));
        }

        #[test]
        fn distances_stay_within_the_bound(
            seed: u64, strength in 0.01..2.0f64,
            x in -1i128 << 40..1 << 40, y in -1i128 << 40..1 << 40,
            dx in -1i128 << 28..1 << 28, dy in -1i128 << 28..1 << 28, near in 0u32..24,
        ) {
            let warp = Warp::new(strength).expect("in range");
            let Some(shears) = Shears::new(warp, Seed(seed)) else { return Ok(()) };
            let stretch = Stretch::of(Some(&shears));
            let (dx, dy) = (dx >> near, dy >> near);
            let (p, q) = (shears.apply([x, y]), shears.apply([x + dx, y + dy]));
            let length = |dx: i128, dy: i128| (dx as f64).hypot(dy as f64);
            let (before, after) = (length(dx, dy), length(q[0] - p[0], q[1] - p[1]));
            let slack = 2.0 * stretch.slack;
            prop_assert!(after <= stretch.factor * before + slack, "{} {}", before, after);
            prop_assert!(before <= stretch.factor * (after + slack), "{} {}", before, after);
        }
    }
}
