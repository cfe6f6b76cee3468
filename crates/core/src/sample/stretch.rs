//! How far the warp stretches and shrinks distances: a bound that holds everywhere.
//!
//! A shear p ← p + d·g(d⊥·p) has the Jacobian I + g'·d·d⊥ᵀ, and the warp the product of four. g is
//! a uniform cubic B-spline: its slope is a mean of differences of adjacent control values over the
//! knot distance h, so |g'| ≤ 2A/h for control values within ±A (de Boor, "A Practical Guide to
//! Splines", ch. X). The product is affine in each slope, its norm therefore convex in each, and
//! greatest at one of the 16 corners of the box of slopes: ‖J‖ ≤ σ, evaluated there. All
//! determinants are 1, so ‖J⁻¹‖ = ‖J‖: distances grow at most σ-fold and shrink at most σ-fold.
//!
//! At strength 1, σ is 1.257 for α = (5−√3)/2; at 2 it is 1.630. The bound is for
//! slopes that all four shears reach at one place, which hardly ever happens: measured, distances
//! shrink by a few percent.

use super::warp::Shears;

/// What a warp does to distances at most. In fixed-point units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stretch {
    /// The factor by which distances grow or shrink at most; 1 or more.
    pub(super) factor: f64,
    /// How far an integer position may be from the smooth warp's, before or after it.
    pub(super) slack: f64,
}

impl Stretch {
    /// No warp.
    pub(super) const NONE: Self = Self {
        factor: 1.0,
        slack: 0.0,
    };

    pub(super) fn of(shears: Option<&Shears>) -> Self {
        let Some(shears) = shears else {
            return Self::NONE;
        };
        let factor = largest_norm(shears.slopes());
        // Per shear: the cubic's coefficients and its evaluation in f32 are good to 2⁻²⁰ of the
        // amplitude, truncation costs a unit; later shears stretch what earlier ones have missed.
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
        // Of determinant 1: σ² + σ⁻² = squares.
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
        for (strength, expected) in [(1.0, 1.257), (2.0, 1.630)] {
            let warp = Warp::new(strength).expect("in range");
            let shears = Shears::new(warp, Seed(1), 0.317);
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
            let Some(shears) = Shears::new(warp, Seed(seed), 0.317) else { return Ok(()) };
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
