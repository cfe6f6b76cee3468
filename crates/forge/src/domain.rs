//! The ground on which a table is optimized: a map, its twins, and the map at other α.

use strew_core::{Alpha, Map, Twin};

use crate::twins::{farthest, fraction, map_of_twin, next_to_alpha};

/// The number of twins a table is optimized on. They lie on both sides of α, so together they have
/// nearly every pair of blocks that occurs in any twin of the map.
const TWINS: usize = 6;
/// The least number of points of these twins. Smaller ones repeat within a block's neighborhood.
const MIN_TWIN_POINTS: u64 = 4000;

/// Further α that a curve is followed at, each with its share of the average. The first number is
/// the position between the map's own α (0) and the α of its farthest large twin below (−1) or
/// above (1). Between these α errors change slowly.
const SPREAD: [(f64, f64); 4] = [(-0.95, 0.2), (-0.5, 0.15), (0.5, 0.15), (0.95, 0.2)];
/// The share of the map's own α.
const OWN_SHARE: f64 = 0.3;
/// The denominator of the further α.
const SPREAD_DENOMINATOR: f64 = (1u64 << 30) as f64;
/// The largest half-width at which further α are used. The pairs of larger maps would take
/// gigabytes.
const MAX_SPREAD_RADIUS: u32 = 100;

/// A map and the twins that a table is optimized on.
#[derive(Clone, Debug)]
pub(crate) struct Domain {
    pub(crate) map: Map,
    pub(crate) twins: Vec<Twin>,
}

impl Domain {
    /// The map with its smallest useful twins, of which a fraction of small integers may have none.
    pub(crate) fn new(map: Map) -> Self {
        let twins = next_to_alpha(&map)
            .filter(|twin| twin.is_uniform() && twin.points() >= MIN_TWIN_POINTS)
            .take(TWINS)
            .collect();
        Self { map, twins }
    }

    /// Mean spacings per grid unit.
    pub(crate) fn scale(&self) -> f64 {
        self.map.alpha().set_side_f64()
    }

    /// The number of blocks.
    pub(crate) fn blocks(&self) -> usize {
        self.map.intervals() * self.map.intervals()
    }

    /// The map at several α with their shares, which sum to 1: its own α first, then others on both
    /// sides, as far as its large twins lie. Large maps are returned at their own α alone.
    pub(crate) fn spread(&self) -> Vec<(Map, f64)> {
        let mut maps = vec![(self.map.clone(), OWN_SHARE)];
        if self.map.radius() <= MAX_SPREAD_RADIUS {
            let own = self.map.alpha().to_f64();
            let [least, greatest] =
                farthest(&self.map).map_or([own; 2], |twins| twins.map(|twin| fraction(&twin)));
            let at = |&(position, share): &(f64, f64)| {
                let end = if position < 0.0 { least } else { greatest };
                let alpha = own + position.abs() * (end - own);
                let numerator = (alpha * SPREAD_DENOMINATOR) as u64;
                let alpha = Alpha::from_fraction(numerator, SPREAD_DENOMINATOR as u64).ok()?;
                let map = Map::new(alpha, self.map.radius()).ok()?;
                (map.intervals() == self.map.intervals()).then_some((map, share))
            };
            maps.extend(SPREAD.iter().filter_map(at));
        }
        let total: f64 = maps.iter().map(|(_, share)| share).sum();
        maps.iter_mut().for_each(|(_, share)| *share /= total);
        maps
    }

    /// The map at the α of each twin.
    pub(crate) fn twin_maps(&self) -> Vec<Map> {
        let of = |&twin: &Twin| map_of_twin(&self.map, twin);
        self.twins.iter().filter_map(of).collect()
    }
}
