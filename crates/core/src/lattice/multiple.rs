//! Multiples of a chunk's size on the fixed-point grid, exactly.
//!
//! A size and a step are integers times powers of two, so a multiple of one is compared with a multiple of
//! the other in integers. Far from the origin this separates positions that `f64` world coordinates do not.

/// The multiple `index`·`size` in world units, laid on the grid of fixed-point coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Multiple {
    /// The least fixed-point coordinate at or above it.
    pub(crate) first: i128,
    /// The distance from it to [`first`](Self::first) in world units, below one step, as the sum of two
    /// numbers of which the second is a rounding error of the first.
    pub(crate) gap: [f64; 2],
}

impl Multiple {
    /// `index`·`size`, where `step` is the world units of a fixed-point unit. The multiple is within 2⁵³
    /// lattice units.
    pub(crate) fn new(step: f64, size: f64, index: i64) -> Self {
        let ((step_units, step_power), (size_units, size_power)) = (parts(step), parts(size));
        let multiple = i128::from(index) * i128::from(size_units);
        let shift = size_power - step_power;
        if multiple == 0 {
            return Self {
                first: 0,
                gap: [0.0; 2],
            };
        }
        // Numerator and denominator of the multiple in steps, and the power of two of both.
        let (numerator, denominator, power) = if shift >= 0 {
            // At most 2⁵³ · 2²⁰ steps of at most 2⁵³.
            (multiple << shift, i128::from(step_units), step_power)
        } else if shift >= -MOST_SHIFT {
            let denominator = i128::from(step_units) << -shift;
            (multiple, denominator, size_power)
        } else if multiple < 0 {
            // A small part of a step below 0.
            return Self {
                first: 0,
                gap: scaled(-multiple, size_power),
            };
        } else {
            return Self {
                first: 1,
                gap: [step - size * index as f64, 0.0],
            };
        };
        let first = -(-numerator).div_euclid(denominator);
        Self {
            first,
            gap: scaled(first * denominator - numerator, power),
        }
    }
}

/// Shifts of the step up to this fit; beyond it the size is below 2⁻²⁰ steps.
const MOST_SHIFT: i32 = 73;

/// A positive finite number as an integer below 2⁵³ and a power of two.
fn parts(value: f64) -> (i64, i32) {
    let bits = value.to_bits();
    let (exponent, fraction) = ((bits >> 52) as i32 & 0x7ff, (bits & ((1 << 52) - 1)) as i64);
    match exponent {
        0 => (fraction, -1074),
        _ => (fraction | 1 << 52, exponent - 1075),
    }
}

/// `value`·2^`power` as the sum of two numbers.
fn scaled(value: i128, power: i32) -> [f64; 2] {
    let high = value as f64;
    let low = (value - high as i128) as f64;
    [high, low].map(|v| libm::ldexp(v, power))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn the_first_coordinate_is_the_least_one_at_or_above(
            step in 1e-9..1e-3f64, size in prop_oneof![1e-3..1e3f64, 1e-40..1e-20f64],
            index in prop_oneof![-9i64..9, -(1i64 << 40)..1 << 40],
        ) {
            let Multiple { first, gap } = Multiple::new(step, size, index);
            // In integers: first · step ≥ index · size > (first − 1) · step.
            let ((s, p), (z, q)) = (parts(step), parts(size));
            let power = p.min(q);
            prop_assume!((p - power).max(q - power) < 60);
            let at = |k: i128| k * (i128::from(s) << (p - power));
            let multiple = i128::from(index) * (i128::from(z) << (q - power));
            prop_assert!(at(first) >= multiple && at(first - 1) < multiple);
            let exact = libm::ldexp((at(first) - multiple) as f64, power);
            prop_assert_eq!(gap[0], exact);
            prop_assert!(gap[1].abs() <= gap[0] * f64::EPSILON && gap[0] <= step);
        }
    }

    #[test]
    fn sizes_far_below_a_step() {
        let step = 0.6 / 1_048_576.0;
        for size in [1e-290, 5e-324, 1e-35] {
            let above = Multiple::new(step, size, 3);
            assert_eq!((above.first, above.gap[0]), (1, step));
            let below = Multiple::new(step, size, -3);
            assert_eq!((below.first, below.gap[0]), (0, 3.0 * size));
        }
    }
}
