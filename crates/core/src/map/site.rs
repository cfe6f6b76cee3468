//! The points of a periodic twin, with their blocks.

use alloc::vec::Vec;

use super::{Map, Twin};

/// A point of a twin's period: its lattice address in [0, 2q)² and its block.
///
/// ```
/// use strew_core::{Table, map::Twin};
///
/// let table = Table::undisplaced("(5-sqrt(3))/2".parse()?, 49, "pattern")?;
/// let twin = Twin::new(183, 112).expect("reduced and between 1 and 2");
/// let site = twin.sites(table.map()).expect("a twin of the map")[17];
/// // The vector of a point is that of its block.
/// let place = site.block_y as usize * table.map().intervals() + site.block_x as usize;
/// assert_eq!(table.displacements()[place], [0, 0]);
/// # Ok::<(), strew_core::Error>(())
/// ```
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

impl Twin {
    /// The index of a coordinate along an axis, in units of 1/(2q), given the parity of the other
    /// coordinate.
    pub(crate) const fn index(self, v: u64, other_parity: u64) -> u64 {
        (self.p() * v + self.q() * other_parity) % (2 * self.q())
    }

    /// The points of one period with their blocks, row by row, or `None` if this is not a twin of the
    /// map.
    #[must_use]
    pub fn sites(self, map: &Map) -> Option<Vec<Site>> {
        if !map.has_twin(self) {
            return None;
        }
        let block_of = self.blocks(map);
        // The coordinates inside the set region with their blocks, by parity of the other coordinate.
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

    /// The block of each index in [0, t), ascending.
    pub(crate) fn blocks(self, map: &Map) -> Vec<u32> {
        let r = i64::from(map.radius());
        let mut starts: Vec<u64> = (-r - 1..=r)
            .flat_map(|k| {
                [0, 1].map(|b| {
                    let shift = self.p() as i64 * k + self.q() as i64 * b;
                    (-shift).rem_euclid(2 * self.q() as i64) as u64
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

#[cfg(test)]
mod tests {
    use alloc::collections::BTreeSet;

    use super::*;
    use crate::pattern::Alpha;

    fn map(alpha: &str) -> Map {
        Map::new(alpha.parse().expect("valid"), 49).expect("small")
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
