//! The warp of a periodic set: the same shears, with knots that wrap.
//!
//! A period has 8·2ᵏ knots, so that whole groups of them fill it, at distances as near to those of the plain
//! warp as that allows. Short periods have eight closer ones. Steps are in proportion to the distance, so the
//! slopes are those of the plain warp. Everything is integer arithmetic, also the spline, whose knots are at no
//! power of two.

use alloc::{vec, vec::Vec};

use super::{
    Warp,
    shears::{KNOT_BITS, directed, shear},
    walk::{GROUP, Walk},
};
use crate::{sample::seed::Seed, table::FRACTION_BITS};

/// The shears of one seed on a torus.
#[derive(Clone, Debug)]
pub(crate) struct WrappedShears {
    /// The period, in fixed-point units.
    period: i64,
    /// The distance of the knots, in fixed-point units.
    knot: i64,
    /// The control values of all knots, by direction.
    controls: [Vec<i32>; 4],
}

impl WrappedShears {
    /// The shears of a seed on a torus of `period` grid units, at most 2²⁵, or `None` if the warp is off.
    pub(crate) fn new(warp: Warp, seed: Seed, period: u64) -> Option<Self> {
        let mut knots = GROUP as u64;
        // At √½ to √2 times the plain distance, by a comparison of squares.
        while period * period > 2 * ((knots * knots) << (2 * KNOT_BITS)) {
            knots *= 2;
        }
        let period = (period as i64) << FRACTION_BITS;
        // Exact: the number of knots is a power of two below 2²⁰.
        let knot = period / knots as i64;
        let walks = directed(warp, seed, knot as f64)?;
        Some(Self {
            period,
            knot,
            controls: walks.map(|walk| wrapped(&walk, knots as usize)),
        })
    }

    /// g of a direction at the coordinate across.
    fn noise(&self, direction: usize, across: i64) -> i64 {
        let controls = &self.controls[direction];
        let across = across.rem_euclid(self.period);
        let cell = (across / self.knot) as usize;
        let (at, knot) = (i128::from(across % self.knot), i128::from(self.knot));
        let control = |cell: usize| i128::from(controls[cell % controls.len()]);
        let (before, start) = (control(cell + controls.len() - 1), control(cell));
        let end = control(cell + 1);
        // The uniform quadratic B-spline, over a common denominator.
        let sum = (before + start) * knot * knot
            + 2 * (start - before) * at * knot
            + (before - 2 * start + end) * at * at;
        sum.div_euclid(2 * knot * knot) as i64
    }

    /// The place to which the warp moves a fixed-point position, on the torus.
    pub(crate) fn apply(&self, position: [i64; 2]) -> [i64; 2] {
        (0..4).fold(position, |p, i| shear(i, p, |s| self.noise(i, s)))
    }
}

/// The control values of all knots of a period. Groups begin at another knot in each direction of each seed.
fn wrapped(walk: &Walk, knots: usize) -> Vec<i32> {
    let mut controls = vec![0; knots];
    let (_, first) = walk.place(0);
    for number in 0..knots / GROUP {
        for (place, control) in walk.group(number as i64).into_iter().enumerate() {
            controls[(number * GROUP + place + knots - first) % knots] = control;
        }
    }
    controls
}

#[cfg(test)]
mod tests {
    use alloc::collections::BTreeSet;

    use proptest::prelude::*;

    use super::*;

    fn shears(seed: u64, period: u64) -> WrappedShears {
        WrappedShears::new(Warp::ON, Seed(seed), period).expect("on")
    }

    #[test]
    fn knots_are_about_as_far_apart_as_in_the_plane() {
        for (period, knots) in [
            (224, 8),
            (1024, 8),
            (1450, 16),
            (2048, 16),
            (1 << 25, 1 << 18),
        ] {
            let shears = shears(7, period);
            assert_eq!(shears.controls[0].len(), knots, "{period}");
            assert_eq!(shears.knot * knots as i64, shears.period);
        }
    }

    proptest! {
        #[test]
        fn a_torus_is_mapped_onto_itself(
            seed: u64, half in 20u64..3000, x: i32, y: i32, i in -2i64..=2, j in -2i64..=2,
        ) {
            let shears = shears(seed, 2 * half);
            let at = [i64::from(x), i64::from(y)];
            let wrap = |p: [i64; 2]| p.map(|v| v.rem_euclid(shears.period));
            let shifted = [at[0] + i * shears.period, at[1] + j * shears.period];
            prop_assert_eq!(wrap(shears.apply(at)), wrap(shears.apply(shifted)));
        }

        #[test]
        fn the_spline_has_no_seam_and_bounded_slopes(seed: u64, half in 20u64..3000, x: u32) {
            let shears = shears(seed, 2 * half);
            let x = i64::from(x) % shears.period;
            for (direction, slope) in [0.06, 0.06, 0.03, 0.03].into_iter().enumerate() {
                for x in [x, shears.period - 1, shears.knot - 1] {
                    for step in [1, 1 << 10, 1 << 20] {
                        let rise = shears.noise(direction, x + step) - shears.noise(direction, x);
                        prop_assert!(rise.abs() as f64 <= slope * step as f64 + 3.0);
                    }
                }
            }
        }
    }

    #[test]
    fn places_stay_distinct() {
        let shears = shears(3, 40);
        let places = (0..40i64)
            .flat_map(|y| (0..40i64).map(move |x| [x << FRACTION_BITS, y << FRACTION_BITS]));
        let moved: BTreeSet<_> = places
            .map(|p| shears.apply(p).map(|v| v.rem_euclid(shears.period)))
            .collect();
        assert_eq!(moved.len(), 1600);
    }
}
