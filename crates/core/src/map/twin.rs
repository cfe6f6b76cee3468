//! Periodic twins: small fractions whose pattern has the same neighborhood map.

use core::fmt;

/// The AA pattern of a fraction p/q in (1, 2), in integer arithmetic: one unit of its index torus is
/// 1/(2q). It repeats every 2q grid units along both axes and has (p − q)² points in a period.
///
/// A twin *of a map* ([`Map::twins`](crate::Map::twins)) has its thresholds in the map's order. So its
/// points fall into the map's blocks, and a table optimized on it is valid for the map's α.
///
/// ```
/// use strew_core::map::Twin;
///
/// // The twin on which the tables of R = 49 and α = (5−√3)/2 are optimized first.
/// let twin = Twin::new(183, 112).expect("reduced and between 1 and 2");
/// assert_eq!((twin.period(), twin.points()), (224, 5041));
/// assert_eq!(twin.to_string(), "183/112");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Twin {
    p: u64,
    q: u64,
}

/// The largest q. A period of 2²⁵ grid units, 10¹³ points, is far beyond what memory holds.
pub(super) const MAX_Q: u64 = 1 << 24;

impl Twin {
    /// The twin p/q, or `None` unless q < p < 2q, p and q have no common factor, and q ≤ 2²⁴.
    #[must_use]
    pub fn new(p: u64, q: u64) -> Option<Self> {
        let coprime = |mut a: u64, mut b: u64| {
            while b != 0 {
                (a, b) = (b, a % b);
            }
            a == 1
        };
        (q <= MAX_Q && q < p && p < 2 * q && coprime(p, q)).then_some(Self { p, q })
    }

    /// The numerator of α' = p/q.
    #[must_use]
    pub const fn p(self) -> u64 {
        self.p
    }

    /// The denominator of α' = p/q.
    #[must_use]
    pub const fn q(self) -> u64 {
        self.q
    }

    /// t = p − q: the side of the set region in units of 1/(2q).
    #[must_use]
    pub const fn t(self) -> u64 {
        self.p - self.q
    }

    /// r = 2q − p. A twin is often named by t/r.
    #[must_use]
    pub const fn r(self) -> u64 {
        2 * self.q - self.p
    }

    /// The period along both axes, in grid units.
    #[must_use]
    pub const fn period(self) -> u64 {
        2 * self.q
    }

    /// The number of points in a period.
    #[must_use]
    pub const fn points(self) -> u64 {
        self.t() * self.t()
    }

    /// Whether every block holds points in proportion to its area: true if p and q differ in parity,
    /// as the period's grid points then have each index pair once. With both odd, dX and dY always
    /// have the same parity, and a block of one unit may be empty.
    #[must_use]
    pub const fn is_uniform(self) -> bool {
        (self.p + self.q) % 2 == 1
    }
}

impl fmt::Display for Twin {
    /// As p/q.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.p, self.q)
    }
}

#[cfg(test)]
mod tests {
    use alloc::vec::Vec;

    use super::*;
    use crate::map::Map;

    fn map(alpha: &str) -> Map {
        Map::new(alpha.parse().expect("valid"), 49).expect("small")
    }

    #[test]
    fn twins_are_the_known_ones_smallest_first() {
        let t_r = |alpha: &str, n| -> Vec<_> {
            map(alpha).twins().take(n).map(|w| (w.t(), w.r())).collect()
        };
        let default = t_r("(5-sqrt(3))/2", 400);
        assert_eq!(default[0], (71, 41));
        for known in [(97, 56), (265, 153)] {
            assert!(default.contains(&known), "{known:?}");
        }
        assert!(default.is_sorted());
        assert!(map("(5-sqrt(3))/2").has_twin(Twin::new(989 + 1560, 1560).expect("coprime")));
        let first = map("sqrt(3)").twins().next().expect("endless");
        assert_eq!((first.t(), first.q()), (112, 153));
        let first = map("(1+sqrt(5))/2").twins().next().expect("endless");
        assert_eq!((first.t(), first.q()), (89, 144));
    }

    #[test]
    fn a_twin_orders_its_thresholds_as_the_map_and_no_other_fraction_does() {
        for alpha in ["(5-sqrt(3))/2", "sqrt(3)", "(1+sqrt(5))/2"] {
            let map = map(alpha);
            let order = |a: u128, unit: u128| -> Option<Vec<(i64, u8)>> {
                // Thresholds with their labels, from first principles; a·k + b/2 in units.
                let side = a - unit / 2;
                let mut all = Vec::new();
                for k in -49i64..=49 {
                    for b in 0..2u8 {
                        for (e, shift) in [(0, 0), (side, 1)] {
                            let v = (e as i128
                                - a as i128 * i128::from(k)
                                - i128::from(b) * unit as i128 / 2)
                                .rem_euclid(unit as i128)
                                as u128;
                            // Labels of e = t are those of e = 0 one step on.
                            let label = if shift == 1 {
                                (k - 1, (b + 1) % 2)
                            } else {
                                (k, b)
                            };
                            if v > 0 && v < side {
                                all.push((v, label));
                            }
                        }
                    }
                }
                all.sort_unstable();
                all.dedup();
                let strict = all.windows(2).all(|w| w[0].0 < w[1].0);
                strict.then(|| all.into_iter().map(|(_, label)| label).collect())
            };
            let own = order(map.alpha().half().into(), 1 << 64).expect("no ties");
            let mut twins = 0;
            for q in 2..420u64 {
                for p in q + 1..2 * q {
                    let Some(twin) = Twin::new(p, q) else {
                        continue;
                    };
                    let same = order(p.into(), u128::from(2 * q)) == Some(own.clone());
                    if map.has_twin(twin) {
                        assert!(same, "{alpha} {twin}");
                        twins += 1;
                    } else if same {
                        // Only a tie outside the map's own thresholds may be refused.
                        let near = p as f64 / q as f64 - map.alpha().to_f64();
                        assert!(near.abs() > 1e-4, "{alpha} {twin} was missed");
                    }
                }
            }
            assert!(twins > 3, "{alpha}: {twins}");
        }
    }
}
