//! Periodic twins: small fractions whose pattern has the same neighborhood map.

use alloc::vec::Vec;
use core::fmt;

use super::Map;

/// The AA pattern of a fraction p/q in (1, 2), in exact integer arithmetic: one unit of its index
/// torus is 1/(2q). It repeats every 2q grid units along both axes and holds (p − q)² points in a
/// period.
///
/// A twin *of a map* (see [`Map::twins`]) has its thresholds in the map's order, so its points fall
/// into the map's blocks and a table optimized on it is valid for the map's α.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Twin {
    p: u64,
    q: u64,
}

/// One point of a twin's period: its lattice address in [0, 2q)² and its block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Site {
    /// The column, in [0, 2q).
    pub x: u32,
    /// The row, in [0, 2q).
    pub y: u32,
    /// The block of dX.
    pub block_x: u32,
    /// The block of dY.
    pub block_y: u32,
}

/// The largest q: a period of 2²⁵ grid units, 10¹³ points, is far beyond what is ever listed.
pub(super) const MAX_Q: u64 = 1 << 24;

impl Twin {
    /// The twin p/q, or `None` unless q < p < 2q, p and q have no common factor and q ≤ 2²⁴.
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

    /// How many points a period holds.
    #[must_use]
    pub const fn points(self) -> u64 {
        self.t() * self.t()
    }

    /// Whether every block holds points in proportion to its area: p and q of different parity,
    /// so that the period's grid points have all index pairs, each once. With both odd, dX and dY
    /// always have the same parity, and a block of one unit may be empty.
    #[must_use]
    pub const fn is_uniform(self) -> bool {
        (self.p + self.q) % 2 == 1
    }

    /// The index of a coordinate along an axis, in units of 1/(2q), given the parity of the other
    /// coordinate.
    const fn index(self, v: u64, other_parity: u64) -> u64 {
        (self.p * v + self.q * other_parity) % (2 * self.q)
    }

    /// The points of one period with their blocks, row by row; `None` if this is no twin of the
    /// map.
    #[must_use]
    pub fn sites(self, map: &Map) -> Option<Vec<Site>> {
        if !map.has_twin(self) {
            return None;
        }
        let block_of = self.blocks(map);
        // Per parity of the other coordinate: the coordinates inside the set region, with blocks.
        let members = |other: u64| -> Vec<(u32, u32)> {
            (0..self.period())
                .filter_map(|v| {
                    let index = self.index(v, other);
                    (index < self.t()).then(|| (v as u32, block_of[index as usize]))
                })
                .collect()
        };
        let by_other = [members(0), members(1)];
        let mut sites = Vec::with_capacity(self.points() as usize);
        for y in 0..self.period() {
            for x_parity in [0, 1] {
                let index = self.index(y, x_parity);
                if index >= self.t() {
                    continue;
                }
                let columns = by_other[(y % 2) as usize].iter();
                sites.extend(columns.filter(|(x, _)| u64::from(x % 2) == x_parity).map(
                    |&(x, block_x)| Site {
                        x,
                        y: y as u32,
                        block_x,
                        block_y: block_of[index as usize],
                    },
                ));
            }
        }
        Some(sites)
    }

    /// The block of each index in [0, t).
    fn blocks(self, map: &Map) -> Vec<u32> {
        let r = i64::from(map.radius());
        let mut starts: Vec<u64> = (-r - 1..=r)
            .flat_map(|k| {
                [0, 1].map(|b| {
                    let shift = self.p as i64 * k + self.q as i64 * b;
                    (-shift).rem_euclid(2 * self.q as i64) as u64
                })
            })
            .filter(|&v| v > 0 && v < self.t())
            .collect();
        starts.sort_unstable();
        starts.dedup();
        let mut block = 0;
        (0..self.t())
            .map(|index| {
                while starts.get(block).is_some_and(|&start| start <= index) {
                    block += 1;
                }
                block as u32
            })
            .collect()
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
    use alloc::collections::BTreeSet;

    use super::*;
    use crate::pattern::Alpha;

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
    fn an_alpha_on_the_edge_of_two_maps_has_no_twins() {
        let edge = Map::new("3/2".parse().expect("valid"), 49).expect("small");
        assert_eq!(edge.twins().next(), None);
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

    #[test]
    fn sites_are_the_pattern_of_the_fraction() {
        let map = map("(5-sqrt(3))/2");
        for twin in map.twins().take(12) {
            let sites = twin.sites(&map).expect("a twin");
            assert_eq!(sites.len() as u64, twin.points());
            let (p, q) = (twin.p(), twin.q());
            let members: BTreeSet<_> = sites.iter().map(|s| (s.x, s.y)).collect();
            assert_eq!(members.len(), sites.len());
            for y in 0..2 * q {
                for x in 0..2 * q {
                    let (dx, dy) = ((p * x + q * y) % (2 * q), (p * y + q * x) % (2 * q));
                    let inside = dx < p - q && dy < p - q;
                    assert_eq!(members.contains(&(x as u32, y as u32)), inside);
                }
            }
            let blocks: BTreeSet<_> = sites.iter().map(|s| (s.block_x, s.block_y)).collect();
            if twin.is_uniform() {
                assert_eq!(blocks.len(), 63 * 63, "{twin}: every block occurs");
            }
        }
        assert!(Twin::new(3, 2).expect("coprime").sites(&map).is_none());
    }

    #[test]
    fn a_large_twin_has_the_blocks_of_the_irrational_pattern_near_the_origin() {
        let map = map("sqrt(3)");
        let twin = map
            .twins()
            .find(|t| t.points() > 1_000_000)
            .expect("endless");
        let pattern = crate::Pattern::new("sqrt(3)".parse::<Alpha>().expect("valid"));
        let mut compared = 0;
        for site in twin
            .sites(&map)
            .expect("a twin")
            .iter()
            .filter(|s| s.x < 120 && s.y < 120)
        {
            let (dx, dy) = pattern.index(site.x.into(), site.y.into());
            if let (Some(bx), Some(by)) = (map.interval_of(dx), map.interval_of(dy)) {
                assert_eq!((bx as u32, by as u32), (site.block_x, site.block_y));
                compared += 1;
            }
        }
        assert!(compared > 1000);
    }
}
