//! Bounds of the warp: how far it moves the points of a box, and how much it stretches distances.
//!
//! *Movement.* g varies slowly, so within a small box all points move nearly alike: its columns and rows have much
//! tighter bounds than the largest movement anywhere.
//!
//! *Stretch*, a bound valid everywhere. A shear p ← p + d·g(d⊥·p) has the Jacobian I + g'·d·d⊥ᵀ; the warp's is the
//! product of four. g is a uniform quadratic B-spline, so its slope goes straight from one step between control
//! values to the next (de Boor, "A Practical Guide to Splines", ch. X): |g'| ≤ s, the greatest step over the distance
//! of the knots. The product is affine in each slope, so its norm is convex in each and greatest at one of the 16
//! corners of the box of slopes, where σ ≥ ‖J‖ is evaluated. All determinants are 1, so ‖J⁻¹‖ = ‖J‖: distances grow
//! and shrink by a factor of at most σ.
//!
//! σ is 1.142 at strength 1 and 1.321 at strength 2 (with long waves, 1.257 and 1.632). All four shears must be
//! steepest at one place to reach it. Measured distances shrink by a few percent.

use core::ops::Range;

use super::{Shears, shears::CELL_BITS};

/// The least and the greatest movement along x and y, in fixed-point units.
type Drift = [[i32; 2]; 2];

/// Over more cells than these a bound of all control values serves.
const MOST_CELLS: i128 = 12;
/// Room for rounding in `f32`, in fixed-point units.
const ROOM: i32 = 64;

impl Shears {
    /// The least and the greatest value of a direction's g from one coordinate to another.
    fn range(&self, direction: usize, [from, to]: [i128; 2]) -> [i32; 2] {
        let [first, last] = [from, to].map(|s| s >> CELL_BITS);
        if last - first >= MOST_CELLS {
            let amplitude = self.amplitudes()[direction];
            return [-amplitude, amplitude];
        }
        let mut controls = [0; MOST_CELLS as usize + 2];
        let controls = &mut controls[..(last - first) as usize + 3];
        self.controls(direction, first as i64 - 1, controls);
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        let number = controls.len() - 2;
        for cell in [0, number - 1] {
            let [a, b, c] = [0, 1, 2].map(|i| f64::from(controls[cell + i]));
            // The part of the cell within the range, in [0, 1].
            let start = (first + cell as i128) << CELL_BITS;
            let part = |s: i128| {
                let offset = (s - start).clamp(0, 1 << CELL_BITS) as i32;
                f64::from(offset) / f64::from(1 << CELL_BITS)
            };
            let [start, end] = [part(from), part(to)];
            let (slope, curve) = (b - a, (a - 2.0 * b + c) / 2.0);
            let vertex = (-slope / (2.0 * curve)).clamp(start, end);
            // NaN where the curve is straight, whose ends suffice.
            let vertex = if vertex.is_nan() { start } else { vertex };
            for u in [start, vertex, end] {
                let value = (a + b) / 2.0 + (slope + curve * u) * u;
                least = least.min(value);
                most = most.max(value);
            }
        }
        // Cells between stay within their control values.
        for &control in controls
            .get(1..number + 1)
            .filter(|_| number > 2)
            .unwrap_or(&[])
        {
            least = least.min(f64::from(control));
            most = most.max(f64::from(control));
        }
        [least as i32 - ROOM, most as i32 + ROOM]
    }

    /// The movement of the points that the warp takes from anywhere into a box, which is not empty.
    pub(crate) fn drift_into(&self, bounds: [&Range<i128>; 2]) -> Drift {
        let [x, y] = bounds.map(|bounds| [bounds.start, bounds.end - 1]);
        let falling = self.range(3, [x[0] + y[0], x[1] + y[1]]);
        let (x, y) = (less(x, falling), more(y, falling));
        let rising = self.range(2, [x[0] - y[1], x[1] - y[0]]);
        let (x, y) = (less(x, rising), less(y, rising));
        let along_x = self.range(1, y);
        let along_y = self.range(0, less(x, along_x));
        moved([along_x, along_y], rising, falling)
    }

    /// The movement of points from a box to wherever the warp takes them. Both ends belong to it.
    pub(crate) fn drift_from(&self, [x, y]: [[i128; 2]; 2]) -> Drift {
        let along_y = self.range(0, x);
        let y = more(y, along_y);
        let along_x = self.range(1, y);
        let x = more(x, along_x);
        let rising = self.range(2, [x[0] - y[1], x[1] - y[0]]);
        let (x, y) = (more(x, rising), more(y, rising));
        let falling = self.range(3, [x[0] + y[0], x[1] + y[1]]);
        moved([along_x, along_y], rising, falling)
    }
}

fn more([low, high]: [i128; 2], [least, most]: [i32; 2]) -> [i128; 2] {
    [low + i128::from(least), high + i128::from(most)]
}

fn less(range: [i128; 2], [least, most]: [i32; 2]) -> [i128; 2] {
    more(range, [-most, -least])
}

fn moved([x, y]: [[i32; 2]; 2], rising: [i32; 2], falling: [i32; 2]) -> Drift {
    [
        [x[0] + rising[0] + falling[0], x[1] + rising[1] + falling[1]],
        [y[0] + rising[0] - falling[1], y[1] + rising[1] - falling[0]],
    ]
}

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
    use crate::{
        lattice::seed::Seed,
        warp::{Warp, Waves},
    };

    proptest! {
        #[test]
        fn no_point_of_a_box_moves_farther(
            seed: u64, strength in 0.01..=2.0f64, is_long: bool, x in -1i128 << 60..1 << 60, y in -1i128 << 60..1 << 60,
            sides in [1i128 << 20..1 << 32, 1i128 << 20..1 << 32],
            inside in proptest::collection::vec([0.0..1.0f64, 0.0..1.0f64], 1..30),
        ) {
            let warp = Warp::new(strength).expect("in range");
            let waves = if is_long { Waves::All } else { Waves::Short };
            let Some(shears) = Shears::new(waves, warp, Seed(seed)) else { return Ok(()) };
            let [width, height] = sides;
            let into = shears.drift_into([&(x..x + width), &(y..y + height)]);
            let from = shears.drift_from([[x, x + width - 1], [y, y + height - 1]]);
            let reach = shears.reach() + 8 * ROOM;
            for [u, v] in inside {
                let at = [x + (u * width as f64) as i128, y + (v * height as f64) as i128];
                for (drift, start, end) in
                    [(from, at, shears.apply(at)), (into, shears.invert(at), at)]
                {
                    for axis in 0..2 {
                        let [least, most] = drift[axis].map(i128::from);
                        let moved = end[axis] - start[axis];
                        prop_assert!(least <= moved && moved <= most, "{} {:?}", moved, drift);
                        prop_assert!(-reach <= drift[axis][0] && drift[axis][1] <= reach);
                    }
                }
            }
        }
    }

    #[test]
    fn known_norms() {
        assert!((largest_norm([0.0; 4]) - 1.0).abs() < 1e-6);
        // One shear of slope s: √(1 + s²/4) + s/2.
        let one = largest_norm([0.5, 0.0, 0.0, 0.0]);
        assert!((one - (1.0625f64.sqrt() + 0.25)).abs() < 1e-9, "{one}");
        let known = [
            (Waves::Short, 1.0, 1.142),
            (Waves::Short, 2.0, 1.321),
            (Waves::All, 1.0, 1.257),
            (Waves::All, 2.0, 1.632),
        ];
        for (waves, strength, expected) in known {
            let warp = Warp::new(strength).expect("in range");
            let shears = Shears::new(waves, warp, Seed(1));
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
            seed: u64, strength in 0.01..2.0f64, is_long: bool,
            x in -1i128 << 40..1 << 40, y in -1i128 << 40..1 << 40,
            dx in -1i128 << 28..1 << 28, dy in -1i128 << 28..1 << 28, near in 0u32..24,
        ) {
            let warp = Warp::new(strength).expect("in range");
            let waves = if is_long { Waves::All } else { Waves::Short };
            let Some(shears) = Shears::new(waves, warp, Seed(seed)) else { return Ok(()) };
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
