//! The intervals of a map that meet across a lattice offset, with frequencies.
//!
//! A neighbor at offset (i, j) has its index shifted by a = (αi + j)/2 along X and (αj + i)/2 along
//! Y. So interval u of one point meets interval v of the other on the part of u that the shift
//! carries into v: an overlap of two partitions of [0, t), one of them shifted. The frequency of a
//! pair of *blocks* is the product of the overlaps along the two axes.

use strew_core::{Map, Pattern};

/// Overlaps shorter than this, 2⁻⁴⁰ of the torus, are dropped: they are rounding errors between
/// thresholds of a fraction that coincide.
const ROUNDING: u64 = 1 << 24;

/// The unit of indices, 2⁻⁶⁴ of the torus.
const UNIT: f64 = 1.0 / 18_446_744_073_709_551_616.0;

/// The part of an interval that an offset carries into another interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Overlap {
    pub(crate) from: usize,
    /// The other interval, which is the neighbor's.
    pub(crate) to: usize,
    /// Its length, as a fraction of the torus.
    pub(crate) length: f64,
}

/// The length of an interval, as a fraction of the torus.
pub(crate) fn length(map: &Map, interval: usize) -> f64 {
    let interval = map.interval(interval);
    (interval.end - interval.start) as f64 * UNIT
}

/// The overlaps of a map along an axis at the offset `own` along it and, across it, an offset of the parity of `other`,
/// interval by interval. They serve both axes: the shift of X by (i, j) is that of Y by (j, i).
pub(crate) fn overlaps(map: &Map, own: i64, other: i64) -> Vec<Overlap> {
    let shift = Pattern::new(map.alpha()).index(own, other & 1).0 as i64;
    let side = i128::from(map.alpha().set_side());
    let mut all = Vec::new();
    for from in 0..map.intervals() {
        let interval = map.interval(from);
        // The shifted interval, cut to the set region. In i128 nothing overflows.
        let mut at = (i128::from(interval.start) + i128::from(shift)).max(0);
        let end = (i128::from(interval.end) + i128::from(shift)).min(side);
        while at < end {
            let Some(to) = map.interval_of(at as u64) else {
                break;
            };
            let next = i128::from(map.interval(to).end).min(end);
            let length = (next - at) as u64;
            if length > ROUNDING {
                let length = length as f64 * UNIT;
                all.push(Overlap { from, to, length });
            }
            at = next;
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use strew_core::{Pattern, pattern::Arrangement};

    use super::*;

    #[test]
    fn overlaps_add_up_to_the_frequency_of_the_offset() {
        let map = Map::new("sqrt(3)".parse().expect("valid"), 20).expect("small");
        let side = map.alpha().set_side_f64();
        let along = |own: i64, other: i64| -> f64 {
            let all = overlaps(&map, own, other);
            all.iter().map(|overlap| overlap.length / side).sum()
        };
        for j in -12..=12 {
            for i in -12..=12 {
                let found = along(i, j) * along(j, i);
                let pair = Arrangement::new(Pattern::new(map.alpha()), &[(i, j)]);
                let expected = pair.expect("small").frequency();
                assert!(
                    (found - expected).abs() < 1e-9,
                    "({i}, {j}): {found} {expected}"
                );
            }
        }
    }
}
