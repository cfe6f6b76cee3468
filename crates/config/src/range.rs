//! Ranges of settings that are numbers.

use std::ops::RangeInclusive;

pub(super) const SECOND: f64 = 1.0;
pub(super) const HOUR: f64 = 3600.0;
pub(super) const DAY: f64 = 86_400.0;

/// The fault of a number, if it is out of range.
pub(super) fn fault(key: &str, value: f64, range: RangeInclusive<f64>) -> Option<String> {
    let (min, max) = (range.start(), range.end());
    (!range.contains(&value)).then(|| format!("{key} = {value}; allowed: {min} to {max}"))
}

/// The faults of the numbers of a section: `out_of_range!(self, "server", max_connections: 1.0..=1e6)`.
macro_rules! out_of_range {
    ($settings:expr, $section:literal, $($field:ident: $range:expr),+ $(,)?) => {{
        let faults = [$($crate::range::fault(
            concat!($section, ".", stringify!($field)),
            $settings.$field as f64,
            $range,
        )),+];
        faults.into_iter().flatten().collect::<Vec<String>>()
    }};
}
pub(super) use out_of_range;
