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

/// The part of an interval that an offset carries into another interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Overlap {
    /// The other interval, which is the neighbor's.
    pub(crate) to: u32,
    /// Its length, as a fraction of the torus.
    pub(crate) length: f64,
}

/// All overlaps of a map along an axis, for all offsets up to a reach.
///
/// They serve both axes: the shift of X by (i, j) is that of Y by (j, i).
pub(crate) struct Overlaps {
    reach: i64,
    intervals: usize,
    /// Where the items of each offset along the axis, parity across it, and interval start; and the
    /// end of the last.
    starts: Vec<u32>,
    items: Vec<Overlap>,
    /// The length of each interval, as a fraction of the torus.
    lengths: Vec<f64>,
}

/// The unit of indices, 2⁻⁶⁴ of the torus.
const UNIT: f64 = 1.0 / 18_446_744_073_709_551_616.0;

impl Overlaps {
    pub(crate) fn new(map: &Map, reach: i64) -> Self {
        let pattern = Pattern::new(map.alpha());
        let intervals = map.intervals();
        let mut all = Self {
            reach,
            intervals,
            starts: vec![0],
            items: Vec::new(),
            lengths: (0..intervals)
                .map(|i| map.interval(i))
                .map(|interval| (interval.end - interval.start) as f64 * UNIT)
                .collect(),
        };
        for own in -reach..=reach {
            for other in 0..2 {
                all.add(map, pattern.index(own, other).0 as i64);
            }
        }
        all
    }

    /// Appends the overlaps of one shift, interval by interval.
    fn add(&mut self, map: &Map, shift: i64) {
        for from in 0..self.intervals {
            let own = map.interval(from);
            // The shifted interval, cut to the set region. In i128 nothing overflows.
            let side = i128::from(map.alpha().set_side());
            let start = (i128::from(own.start) + i128::from(shift)).max(0);
            let end = (i128::from(own.end) + i128::from(shift)).min(side);
            let mut at = start;
            while at < end {
                let Some(to) = map.interval_of(at as u64) else {
                    break;
                };
                let next = i128::from(map.interval(to).end).min(end);
                let length = (next - at) as u64;
                if length > ROUNDING {
                    self.items.push(Overlap {
                        to: to as u32,
                        length: length as f64 * UNIT,
                    });
                }
                at = next;
            }
            self.starts.push(self.items.len() as u32);
        }
    }

    /// The overlaps of the interval `from` at offset `own` along the axis and, across it, an offset
    /// of the parity of `other`.
    pub(crate) fn of(&self, own: i64, other: i64, from: usize) -> &[Overlap] {
        let offset = (own + self.reach) as usize * 2 + (other & 1) as usize;
        let at = offset * self.intervals + from;
        &self.items[self.starts[at] as usize..self.starts[at + 1] as usize]
    }

    /// The largest offset along an axis.
    pub(crate) const fn reach(&self) -> i64 {
        self.reach
    }

    /// The length of an interval, as a fraction of the torus.
    pub(crate) fn length(&self, interval: usize) -> f64 {
        self.lengths[interval]
    }
}

#[cfg(test)]
mod tests {
    use strew_core::{Pattern, pattern::Arrangement};

    use super::*;

    #[test]
    fn overlaps_add_up_to_the_frequency_of_the_offset() {
        let map = Map::new("sqrt(3)".parse().expect("valid"), 20).expect("small");
        let overlaps = Overlaps::new(&map, 12);
        let side = map.alpha().set_side_f64();
        let along = |own: i64, other: i64| -> f64 {
            (0..map.intervals())
                .flat_map(|from| overlaps.of(own, other, from))
                .map(|overlap| overlap.length / side)
                .sum()
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
