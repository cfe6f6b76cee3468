//! Decimals that stay within the region: what would be rounded onto the upper bound, or below the lower one, is written
//! as the nearest number within. So `min ≤ p < max` holds for what readers see.

use strew_error::Fault;

use crate::{number::Digits, place::Place, source::Source};

/// For each axis the coordinates between which all are that stay within the bounds of a part when they are rounded.
#[derive(Clone, Copy, Debug)]
pub(super) struct Within([[f64; 2]; 3]);

impl Within {
    /// Those of a part whose coordinates are relative to a point.
    ///
    /// # Errors
    /// A fault of `decimals` if there is no number with so few within the bounds.
    pub(super) fn new(plan: &dyn Source, origin: Place, decimals: u8) -> Result<Self, Fault> {
        let [x, y] = origin.flat();
        let [[min_x, min_y], [max_x, max_y]] = [plan.region().min(), plan.region().max()];
        let heights = plan
            .heights()
            .map(|[low, top]| [low - origin.z(), top - origin.z()]);
        let bounds = [[min_x - x, max_x - x], [min_y - y, max_y - y]];
        let mut within = [[f64::MIN, f64::MAX]; 3];
        if plan.count() == 0 {
            return Ok(Self(within));
        }
        let axes = bounds.into_iter().chain(heights).zip("xyz".chars());
        for (([min, max], axis), within) in axes.zip(&mut within) {
            *within = inner(min, max, decimals).ok_or_else(|| {
                let detail = format!("no such number is within {min} ≤ {axis} < {max}");
                let more = (decimals + 1..=super::MOST_DECIMALS)
                    .find(|more| inner(min, max, *more).is_some());
                let allowed = more.map_or("none".into(), |more| format!("{more} or more"));
                Fault::new("decimals", decimals, detail, allowed)
            })?;
        }
        Ok(Self(within))
    }

    /// A coordinate that stays within.
    pub(super) fn apply(&self, axis: usize, value: f64) -> f64 {
        let [first, last] = self.0[axis];
        value.clamp(first, last)
    }
}

/// The first and the last number from `min` up to `max` that are within these bounds when they are rounded.
fn inner(min: f64, max: f64, decimals: u8) -> Option<[f64; 2]> {
    let text = |value: f64| {
        let mut text = vec![];
        Digits::of(Some(decimals)).write(value, &mut text);
        String::from_utf8(text).unwrap_or_default()
    };
    let read = |value: f64| text(value).parse::<f64>().unwrap_or(value);
    // The number whose last decimal is one more or less. Where there are more digits than integers hold, neighbors
    // among `f64` are farther apart than decimals, and no rounding reaches a bound.
    let next = |value: f64, by: i128| {
        let digits: i128 = text(value).replace('.', "").parse().ok()?;
        format!("{}e-{decimals}", digits + by).parse::<f64>().ok()
    };
    let (mut first, mut last) = (min, max.next_down());
    if read(first) < min {
        first = next(first, 1).unwrap_or(first);
    }
    if read(last) >= max {
        last = next(last, -1).unwrap_or(last);
    }
    (first <= last && read(first) < max && read(last) >= min).then_some([first, last])
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn rounded(value: f64, decimals: u8) -> String {
        let mut text = vec![];
        Digits::of(Some(decimals)).write(value, &mut text);
        String::from_utf8(text).expect("digits")
    }

    #[test]
    fn bounds_move_in_where_rounding_would_reach_them() {
        for (min, max, decimals, expected) in [
            (0.0, 64.0, 1, Some([0.0, 63.9])),
            (-64.0, 0.0, 1, Some([-64.0, -0.1])),
            (0.04, 64.0, 1, Some([0.1, 63.9])),
            (0.0, 64.04, 1, Some([0.0, 64.04_f64.next_down()])),
            (0.0, 1.0, 0, Some([0.0, 0.0])),
            (0.3, 0.4, 1, Some([0.3, 0.3])),
            (0.3, 0.4, 0, None),
            (0.6, 0.9, 0, None),
            (0.31, 0.39, 1, None),
            (
                1e17,
                1e17 + 64.0,
                17,
                Some([1e17, (1e17_f64 + 64.0).next_down()]),
            ),
        ] {
            assert_eq!(
                inner(min, max, decimals),
                expected,
                "{min} {max} {decimals}"
            );
        }
    }

    proptest! {
        /// By brute force: the nearest of all decimals within the bounds.
        #[test]
        fn what_is_written_is_the_nearest_decimal_within(
            low in -3000_i32..3000, width in 1_i32..3000, share in 0.0..1.0_f64, decimals in 0_u8..=2
        ) {
            let [min, max] = [low, low + width].map(|bound| f64::from(bound) / 1000.0);
            let value = (min + share * (max - min)).max(min).min(max.next_down());
            let unit = 10_i32.pow(decimals.into());
            let all = (-6 * unit..=6 * unit).map(|number| f64::from(number) / f64::from(unit));
            let all: Vec<f64> = all.filter(|decimal| (min..max).contains(decimal)).collect();
            let within = inner(min, max, decimals);
            prop_assert_eq!(within.is_none(), all.is_empty());
            if let Some([first, last]) = within {
                let written: f64 = rounded(value.clamp(first, last), decimals).parse().expect("a number");
                let least = all.iter().map(|one| (one - value).abs()).fold(f64::MAX, f64::min);
                prop_assert!(all.contains(&written), "{written} of {all:?}");
                prop_assert!((written - value).abs() <= least + 1e-12, "{written} for {value}");
            }
        }

        #[test]
        fn any_bounds_hold(min in -1e12..1e12_f64, width in 1e-9..1e9_f64, share in 0.0..1.0_f64, decimals in 0_u8..=17) {
            let max = min + width;
            prop_assume!(min < max);
            let value = (min + share * width).clamp(min, max.next_down());
            if let Some([first, last]) = inner(min, max, decimals) {
                for value in [value, min, max.next_down()] {
                    let text = rounded(value.clamp(first, last), decimals);
                    let written: f64 = text.parse().expect("a number");
                    prop_assert!((min..max).contains(&written), "{text}");
                }
            }
        }
    }
}
