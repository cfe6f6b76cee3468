//! What a table is optimized on: a map, and the twins that stand for its pattern.

use strew_core::{Alpha, Map, Twin};

use crate::twins::{farthest, fraction, next_to_alpha, of_fraction};

/// How many twins a table is optimized on. They lie on both sides of α, so that among them they
/// show nearly every pair of blocks that any twin of the map has.
const TWINS: usize = 6;
/// Twins with fewer points repeat before a block's neighborhood ends.
const LEAST_TWIN: u64 = 4000;

/// Where between a map's own α (0) and that of its farthest large twin below (−1) or above (1) a
/// spread map stands, and its share. In between, errors change slowly.
const SPREAD: [(f64, f64); 4] = [(-0.95, 0.2), (-0.5, 0.15), (0.5, 0.15), (0.95, 0.2)];
/// The share of the map's own α.
const OWN_SHARE: f64 = 0.3;
/// Spread maps have fractions of this denominator.
const FINE: f64 = (1u64 << 30) as f64;
/// Maps of a larger half-width are not spread: their pairs would take several gigabytes.
const SPREAD_RADIUS: u32 = 100;

/// A map and some of its twins.
#[derive(Clone, Debug)]
pub(crate) struct Ground {
    pub(crate) map: Map,
    pub(crate) twins: Vec<Twin>,
}

impl Ground {
    /// The map with its smallest useful twins; a map whose α is a fraction of small numbers may
    /// have none.
    pub(crate) fn new(map: Map) -> Self {
        let twins = next_to_alpha(&map)
            .filter(|twin| twin.is_uniform() && twin.points() >= LEAST_TWIN)
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
    /// sides as far as its large twins lie. Large maps are given at their own α alone.
    pub(crate) fn spread(&self) -> Vec<(Map, f64)> {
        let mut maps = vec![(self.map.clone(), OWN_SHARE)];
        if self.map.radius() <= SPREAD_RADIUS {
            let own = self.map.alpha().to_f64();
            let [least, greatest] =
                farthest(&self.map).map_or([own; 2], |twins| twins.map(|twin| fraction(&twin)));
            let at = |&(part, share): &(f64, f64)| {
                let end = if part < 0.0 { least } else { greatest };
                let alpha = own + part.abs() * (end - own);
                let alpha = Alpha::from_fraction((alpha * FINE) as u64, FINE as u64).ok()?;
                let map = Map::new(alpha, self.map.radius()).ok()?;
                (map.intervals() == self.map.intervals()).then_some((map, share))
            };
            maps.extend(SPREAD.iter().filter_map(at));
        }
        let total: f64 = maps.iter().map(|(_, share)| share).sum();
        maps.iter_mut().for_each(|(_, share)| *share /= total);
        maps
    }

    /// The same map for each of the twins' fractions.
    pub(crate) fn maps(&self) -> Vec<Map> {
        let of = |&twin: &Twin| of_fraction(&self.map, twin);
        self.twins.iter().filter_map(of).collect()
    }
}
