//! The control values of g: zero-sum walks.
//!
//! The knots of a direction come in groups of [`GROUP`]. In a group, the steps from one control value to the
//! next are the sines of as many evenly spaced angles, in a hashed order and turned by a hashed phase. They
//! sum to zero, so every walk ends at 0, where the next one begins: g is bounded, and a control value takes
//! a sum over its own group and not over the plane. Sines are large more often than they are small, so much
//! of the greatest slope is used everywhere.

use crate::lattice::seed::split_mix;

/// The number of knots of a group, in bits: 2³ = 8.
const GROUP_BITS: u32 = 3;
pub(super) const GROUP: usize = 1 << GROUP_BITS;

/// 2³⁰·sin(2πi/128) for i = 0 … 32, rounded to nearest.
const SINES: [i32; 33] = [
    0,
    52_686_014,
    105_245_103,
    157_550_647,
    209_476_638,
    260_897_982,
    311_690_799,
    361_732_726,
    410_903_207,
    459_083_786,
    506_158_392,
    552_013_618,
    596_538_995,
    639_627_258,
    681_174_602,
    721_080_937,
    759_250_125,
    795_590_213,
    830_013_654,
    862_437_520,
    892_783_698,
    920_979_082,
    946_955_747,
    970_651_112,
    992_008_094,
    1_010_975_242,
    1_027_506_862,
    1_041_563_127,
    1_053_110_176,
    1_062_120_190,
    1_068_571_464,
    1_072_448_455,
    1_073_741_824,
];

/// 2³⁰ times the sines of the 128ths of a turn. Exactly antisymmetric.
static SINE: [i32; 128] = {
    let mut all = [0; 128];
    let mut i = 0;
    while i < 64 {
        let sine = SINES[if i <= 32 { i } else { 64 - i }];
        (all[i], all[i + 64]) = (sine, -sine);
        i += 1;
    }
    all
};

/// One direction of one seed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Walk {
    key: u64,
    /// The greatest step between control values, in fixed-point units.
    step: i32,
}

/// The control values of the knots of a group, in fixed-point units.
pub(super) type Group = [i32; GROUP];

impl Walk {
    pub(super) const fn new(key: u64, step: i32) -> Self {
        Self { key, step }
    }

    /// The greatest step between control values, in fixed-point units.
    pub(super) const fn step(&self) -> i32 {
        self.step
    }

    /// A bound of the control values, in fixed-point units: the four positive steps of a group in a row, at
    /// most 1/sin(π/8) = 2.6131 times the greatest.
    pub(super) fn amplitude(&self) -> i32 {
        (f64::from(self.step) * 2.6132) as i32 + 4
    }

    /// The group of a knot, and the knot's place in it. Groups begin at another knot in each direction of
    /// each seed.
    pub(super) const fn place(&self, knot: i64) -> (i64, usize) {
        let knot = knot.wrapping_add((self.key >> (64 - GROUP_BITS)) as i64);
        (knot >> GROUP_BITS, (knot & (GROUP as i64 - 1)) as usize)
    }

    /// The control values of a group.
    pub(super) fn group(&self, number: i64) -> Group {
        let mut group = [0; GROUP];
        self.part(number, 0, &mut group);
        group
    }

    /// The control values of some knots of a group, from a place on. They are found from the end: the steps after a
    /// place are the opposite of those up to it, and the shuffle decides on the last places first.
    fn part(&self, number: i64, place: usize, out: &mut [i32]) {
        let hash = split_mix(self.key ^ (number as u64).wrapping_mul(0xd6e8_feb8_6659_fd93));
        // The highest byte is left; its lowest four bits turn the angles by up to an eighth of a turn.
        let phase = (hash >> 56 & 15) as usize;
        // A shuffle (Fisher and Yates) of the bytes of `order`, by one byte of the hash at a time from the
        // lowest on.
        let mut order = 0x0706_0504_0302_0100u64;
        let mut bytes = hash;
        let mut control = 0;
        for last in (place..GROUP).rev() {
            if let Some(out) = out.get_mut(last - place) {
                *out = control;
            }
            if last == place {
                break;
            }
            let other = ((bytes & 255) * (last as u64 + 1)) >> 8;
            bytes >>= 8;
            let different = (order >> (8 * last) ^ order >> (8 * other)) & 255;
            order ^= different << (8 * last);
            order ^= different << (8 * other);
            let angle = 16 * (order >> (8 * last) & 7) as usize + phase;
            // Toward zero, so that opposite sines make opposite steps.
            control -= (i64::from(SINE[angle]) * i64::from(self.step) / (1 << 30)) as i32;
        }
    }

    /// The control values of three successive knots of each of some walks, from those of `first` on: as
    /// [`controls`](Self::controls), of all walks at once, by operations that vectors have.
    #[inline(always)]
    pub(super) fn three<const N: usize>(walks: [Self; N], first: [i64; N]) -> [[i32; 3]; N] {
        let places: [_; N] = core::array::from_fn(|i| walks[i].place(first[i]));
        let steps = walks.map(|walk| i64::from(walk.step));
        // The group of the first knot, and the next one.
        let mut groups = [[[0; N]; GROUP]; 2];
        for (next, group) in (0..).zip(&mut groups) {
            let (mut bytes, mut phases) = ([0; N], [0; N]);
            for i in 0..N {
                let number = places[i].0.wrapping_add(next) as u64;
                bytes[i] = split_mix(walks[i].key ^ number.wrapping_mul(0xd6e8_feb8_6659_fd93));
                phases[i] = bytes[i] >> 56 & 15;
            }
            let mut orders = [0x0706_0504_0302_0100u64; N];
            let mut controls = [0i64; N];
            for last in (1..GROUP as u64).rev() {
                group[last as usize] = controls;
                for i in 0..N {
                    let other = ((bytes[i] & 255) * (last + 1)) >> 8;
                    bytes[i] >>= 8;
                    let order = orders[i];
                    let different = (order >> (8 * last) ^ order >> (8 * other)) & 255;
                    orders[i] = order ^ different << (8 * last) ^ different << (8 * other);
                    let angle = 16 * (orders[i] >> (8 * last) & 7) + phases[i];
                    let sine = i64::from(SINE[angle as usize & 127]);
                    controls[i] -= sine * steps[i] / (1 << 30);
                }
            }
            group[0] = controls;
        }
        core::array::from_fn(|i| {
            [0, 1, 2].map(|more| {
                let place = places[i].1 + more;
                groups[place / GROUP][place % GROUP][i] as i32
            })
        })
    }

    /// The control values of successive knots, from `first` on.
    pub(super) fn controls(&self, first: i64, out: &mut [i32]) {
        let (mut number, mut place) = self.place(first);
        let mut next = 0;
        while next < out.len() {
            let count = (GROUP - place).min(out.len() - next);
            self.part(number, place, &mut out[next..next + count]);
            next += count;
            number = number.wrapping_add(1);
            place = 0;
        }
    }
}

#[cfg(test)]
mod tests {
    use alloc::vec;

    use proptest::prelude::*;

    use super::*;

    #[test]
    fn sines_are_those_of_the_library() {
        for (i, &sine) in SINE.iter().enumerate() {
            let expected = libm::sin(core::f64::consts::TAU * i as f64 / 128.0);
            let expected = libm::round(expected * f64::from(1 << 30)) as i64;
            assert_eq!(i64::from(sine), expected, "{i}");
        }
    }

    proptest! {
        #[test]
        fn groups_end_at_zero_and_stay_within_bounds(key: u64, number: i64, step in 0i32..1 << 25) {
            let walk = Walk::new(key, step);
            let group = walk.group(number);
            prop_assert_eq!(group[GROUP - 1], 0);
            let mut before = 0;
            for control in group {
                prop_assert!(control.abs() <= walk.amplitude());
                prop_assert!((control - before).abs() <= step);
                before = control;
            }
        }

        #[test]
        fn successive_controls_are_those_of_their_groups(key: u64, first: i64, length in 0usize..40) {
            let walk = Walk::new(key, 1 << 23);
            let mut controls = vec![0; length];
            walk.controls(first, &mut controls);
            for (knot, control) in (0..).map(|i| first.wrapping_add(i)).zip(controls) {
                let (number, place) = walk.place(knot);
                prop_assert_eq!(walk.group(number)[place], control);
            }
        }

        #[test]
        fn controls_of_many_walks_are_those_of_each(keys: [u64; 5], first: [i64; 5], step in 0i32..1 << 25) {
            let walks = keys.map(|key| Walk::new(key, step));
            for (i, found) in Walk::three(walks, first).into_iter().enumerate() {
                let mut controls = [0; 3];
                walks[i].controls(first[i], &mut controls);
                prop_assert_eq!(found, controls);
            }
        }
    }
}
