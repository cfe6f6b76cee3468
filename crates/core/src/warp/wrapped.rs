//! The warp of a periodic set: the same shears, with knots that wrap.
//!
//! A period has 8·2ᵏ knots, so that whole groups of them fill it, at distances as near to those of the plain
//! warp as that allows. Short periods have eight closer ones, and long waves have eight knots at least as well.
//! Steps are in proportion to the distance, so the slopes are those of the plain warp. Everything is integer
//! arithmetic, also the spline, whose knots are at no power of two.

use alloc::{vec, vec::Vec};

use super::{
    Warp, Waves,
    shears::{KNOT_BITS, LONG_BITS, long, refined, shear, short},
    walk::{GROUP, Walk},
};
use crate::{lattice::seed::Seed, table::FRACTION_BITS};

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
    pub(crate) fn new(waves: Waves, warp: Warp, seed: Seed, period: u64) -> Option<Self> {
        let mut knots = GROUP as u64;
        // At √½ to √2 times the plain distance, by a comparison of squares.
        while period * period > 2 * ((knots * knots) << (2 * KNOT_BITS)) {
            knots *= 2;
        }
        let period = (period as i64) << FRACTION_BITS;
        // Exact: the number of knots is a power of two, at most 2²⁰.
        let knots = knots as usize;
        let knot = period / knots as i64;
        let mut controls = short(warp, seed, knot as f64)?.map(|walk| wrapped(&walk, knots));
        let far = (knots >> LONG_BITS).max(GROUP);
        if let Some(walks) = long(waves, warp, seed, (period / far as i64) as f64) {
            for (controls, walk) in controls.iter_mut().zip(walks) {
                add_refined(controls, &wrapped(&walk, far));
            }
        }
        Some(Self {
            period,
            knot,
            controls,
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

    /// The warp moves no place farther than this along an axis.
    pub(crate) fn most(&self) -> i64 {
        let most = |controls: &Vec<i32>| controls.iter().map(|v| i64::from(v.abs())).max();
        self.controls
            .iter()
            .filter_map(most)
            .map(|most| most + 1)
            .sum()
    }

    /// The place to which the warp moves a fixed-point position, on the torus.
    pub(crate) fn apply(&self, position: [i64; 2]) -> [i64; 2] {
        (0..4).fold(position, |p, i| shear(i, p, |s| self.noise(i, s)))
    }
}

/// Adds the spline of a period whose knots are farther apart.
fn add_refined(controls: &mut [i32], far: &[i32]) {
    let parts = controls.len() / far.len();
    for (i, control) in controls.iter_mut().enumerate() {
        let cell = i / parts;
        let knots = [far.len() - 1, 0, 1].map(|step| far[(cell + step) % far.len()]);
        *control += refined(knots, i % parts, parts);
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
        WrappedShears::new(Waves::Short, Warp::ON, Seed(seed), period).expect("on")
    }

    fn all_waves(seed: u64, period: u64) -> WrappedShears {
        WrappedShears::new(Waves::All, Warp::ON, Seed(seed), period).expect("on")
    }

    #[test]
    fn knots_are_about_as_far_apart_as_in_the_plane() {
        for (period, knots) in [(56, 8), (256, 8), (363, 16), (512, 16), (1 << 25, 1 << 20)] {
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
            for shears in [shears(seed, 2 * half), all_waves(seed, 2 * half)] {
                let at = [i64::from(x), i64::from(y)];
                let wrap = |p: [i64; 2]| p.map(|v| v.rem_euclid(shears.period));
                let shifted = [at[0] + i * shears.period, at[1] + j * shears.period];
                prop_assert_eq!(wrap(shears.apply(at)), wrap(shears.apply(shifted)));
            }
        }

        #[test]
        fn the_spline_has_no_seam_and_bounded_slopes(seed: u64, half in 20u64..3000, x: u32) {
            for (shears, most) in [(shears(seed, 2 * half), 0.09), (all_waves(seed, 2 * half), 0.15)] {
                let x = i64::from(x) % shears.period;
                for (direction, slope) in [most, most, most / 2.0, most / 2.0].into_iter().enumerate() {
                    for x in [x, shears.period - 1, shears.knot - 1] {
                        for step in [1, 1 << 10, 1 << 20] {
                            let rise = shears.noise(direction, x + step) - shears.noise(direction, x);
                            prop_assert!(rise.abs() as f64 <= slope * step as f64 + 4.0);
                        }
                    }
                }
            }
        }

        #[test]
        fn a_refined_spline_is_the_same(seed: u64, half in 200u64..3000, x: u32) {
            let (short, all) = (shears(seed, 2 * half), all_waves(seed, 2 * half));
            let far = (all.controls[0].len() >> LONG_BITS).max(GROUP);
            let knot = all.period / far as i64;
            let walks = long(Waves::All, Warp::ON, Seed(seed), knot as f64).expect("on");
            let x = i64::from(x) % all.period;
            for (direction, walk) in walks.iter().enumerate() {
                let controls = wrapped(walk, far);
                let at = (x % knot) as f64 / knot as f64;
                let cell = (x / knot) as usize;
                let [a, b, c] = [far - 1, 0, 1].map(|step| f64::from(controls[(cell + step) % far]));
                let expected = (a + b) / 2.0 + ((b - a) + (a - 2.0 * b + c) / 2.0 * at) * at;
                let found = all.noise(direction, x) - short.noise(direction, x);
                prop_assert!((found as f64 - expected).abs() <= 8.0, "{} {}", found, expected);
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
