//! The knowledge of a map: the neighbors of a block's points, and how the number of intervals grows with R.

use alloc::{collections::BTreeSet, vec::Vec};

use super::{
    Map,
    cell::{Label, labels},
    size::check_radius,
};
use crate::{
    error::Error,
    pattern::{Alpha, Axis, Class, IndexOrigin, Pattern},
};

impl Map {
    /// The neighbors of every point of a block, given as its intervals of dX and dY: the offsets up to R along
    /// both axes at which there is a point, (0, 0) included, by rows and then columns. A block that the map
    /// does not have has none.
    #[must_use]
    pub fn neighbors(&self, [x, y]: [usize; 2]) -> Vec<(i64, i64)> {
        if x.max(y) >= self.intervals() {
            return Vec::new();
        }
        let origin = IndexOrigin {
            x: self.interval(x).start,
            y: self.interval(y).start,
        };
        let pattern = Pattern::with_origin(self.alpha(), origin);
        let range = -i64::from(self.radius())..i64::from(self.radius()) + 1;
        let of_class = |class| {
            let columns = pattern.axis_set(Axis::X, class);
            let range = range.clone();
            pattern
                .axis_set(Axis::Y, class)
                .iter(range.clone())
                .flat_map(move |y| columns.iter(range.clone()).map(move |x| (x, y)))
        };
        let mut all: Vec<_> = Class::ALL.into_iter().flat_map(of_class).collect();
        all.sort_unstable_by_key(|&(x, y)| (y, x));
        all
    }

    /// The number of intervals per axis of the maps of half-width 0, 1, … `radius`, without making them. It
    /// grows in proportion to R, by 2(α − 1) intervals a grid unit; at a fraction α = p/q it ends at p − q.
    ///
    /// The thresholds of a fraction are compared exactly. A map of a fraction whose denominator is no power of
    /// two has more intervals, a few units of 2⁻⁶⁴ wide, where the rounding of α parts thresholds that coincide.
    ///
    /// # Errors
    /// As [`Map::new`].
    ///
    /// ```
    /// use strew_core::Map;
    ///
    /// let counts = Map::interval_counts("(5-sqrt(3))/2".parse()?, 200)?;
    /// assert_eq!([counts[20], counts[49], counts[100], counts[200]], [27, 63, 129, 255]);
    /// assert_eq!(Map::interval_counts("19/10".parse()?, 200)?[200], 9);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn interval_counts(alpha: Alpha, radius: u32) -> Result<Vec<usize>, Error> {
        check_radius(radius)?;
        // In units of 1/(2q) at a fraction p/q, and in units of 2⁻⁶⁴ otherwise.
        let fraction = alpha.fraction();
        let side = fraction.map_or(alpha.set_side().into(), |(p, q)| u128::from(p - q));
        let threshold = |label: Label| match fraction {
            Some((p, q)) => {
                let shift =
                    i128::from(p) * i128::from(label.k) + i128::from(q) * i128::from(label.b);
                (-shift).rem_euclid(2 * i128::from(q)) as u128
            }
            None => label.index(alpha).into(),
        };
        let mut thresholds = BTreeSet::new();
        let mut counts = Vec::with_capacity(radius as usize + 1);
        for radius in 0..=radius {
            let r = i64::from(radius);
            // The shifts that the half-width before does not have.
            let new = labels(radius).filter(|label| label.k == r || label.k == -r - 1);
            let inside = new.map(threshold);
            thresholds.extend(inside.filter(|&index| 0 < index && index < side));
            counts.push(thresholds.len() + 1);
        }
        Ok(counts)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{map::MAX_RADIUS, pattern::IndexOrigin};

    const ALPHAS: [&str; 6] = [
        "(5-sqrt(3))/2",
        "sqrt(3)",
        "(1+sqrt(5))/2",
        "1.3",
        "5/3",
        "1.97",
    ];

    #[test]
    fn neighbors_are_those_of_the_points_of_the_block() {
        for text in ALPHAS {
            let map = Map::new(text.parse().expect("valid"), 9).expect("small");
            let places = (-120..120).flat_map(|y| (-120..120).map(move |x| (x, y)));
            let mut seen = BTreeSet::new();
            for origin in [(0, 0), (12345, 1 << 60)].map(|(x, y)| IndexOrigin { x, y }) {
                let pattern = Pattern::with_origin(map.alpha(), origin);
                for (x, y) in places.clone() {
                    let (dx, dy) = pattern.index(x, y);
                    let (Some(bx), Some(by)) = (map.interval_of(dx), map.interval_of(dy)) else {
                        continue;
                    };
                    let around = (-9..=9).flat_map(|j| (-9..=9).map(move |i| (i, j)));
                    let around = around.filter(|&(i, j)| pattern.contains(x + i, y + j));
                    assert!(around.eq(map.neighbors([bx, by])), "{text} {x}:{y}");
                    seen.insert([bx, by]);
                }
            }
            // Of the first every block occurs.
            let all = map.intervals().pow(2);
            let least = if text == ALPHAS[0] { all } else { all.min(4) };
            assert!(seen.len() >= least, "{text}");
        }
        let map = Map::new("sqrt(3)".parse().expect("valid"), 9).expect("small");
        assert!(map.neighbors([map.intervals(), 0]).is_empty());
    }

    #[test]
    fn no_two_blocks_have_the_same_neighborhood() {
        // Near α = 2 there are thresholds that no neighbor crosses.
        for text in &ALPHAS[..5] {
            let map = Map::new(text.parse().expect("valid"), 7).expect("small");
            let n = map.intervals();
            let all: BTreeSet<_> = (0..n * n).map(|b| map.neighbors([b % n, b / n])).collect();
            assert_eq!(all.len(), n * n, "{text}");
        }
    }

    #[test]
    fn counts_are_those_of_the_maps_and_grow_in_proportion_to_r() {
        for text in ALPHAS {
            let alpha: Alpha = text.parse().expect("valid");
            let counts = Map::interval_counts(alpha, MAX_RADIUS).expect("in range");
            for radius in (0..=64).chain([500, MAX_RADIUS]) {
                let map = Map::new(alpha, radius).expect("in range");
                let wide = (0..map.intervals()).map(|i| map.interval(i));
                let wide = wide.filter(|interval| interval.end - interval.start > 1 << 20);
                assert_eq!(counts[radius as usize], wide.count(), "{text} {radius}");
            }
        }
        for text in &ALPHAS[..3] {
            let alpha: Alpha = text.parse().expect("valid");
            let counts = Map::interval_counts(alpha, MAX_RADIUS).expect("in range");
            for (radius, &count) in counts.iter().enumerate() {
                let expected = 4.0 * alpha.set_side_f64() * (radius as f64 + 1.0);
                assert!(
                    (count as f64 - expected).abs() < 5.0,
                    "{text} {radius}: {count} {expected}"
                );
            }
        }
        let known = [("sqrt(3)", 73), ("(1+sqrt(5))/2", 61), ("sqrt(2)", 41)];
        for (text, count) in known {
            let counts = Map::interval_counts(text.parse().expect("valid"), 49).expect("in range");
            assert_eq!(counts[49], count, "{text}");
        }
        let alpha = "1.3".parse().expect("valid");
        assert!(Map::interval_counts(alpha, 1_000_000).is_err());
        assert!(Map::new(alpha, MAX_RADIUS + 1).is_err());
    }
}
