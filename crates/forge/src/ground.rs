//! What a table is optimized on: a map, and the twins that stand for its pattern.

use strew_core::{Map, Twin};

use crate::twins::{next_to_alpha, of_fraction};

/// How many twins a table is optimized on. They lie on both sides of α, so that among them they
/// show nearly every pair of blocks that any twin of the map has.
const TWINS: usize = 6;
/// Twins with fewer points repeat before a block's neighborhood ends.
const LEAST_TWIN: u64 = 4000;

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

    /// The same map for each of the twins' fractions.
    pub(crate) fn maps(&self) -> Vec<Map> {
        let of = |&twin: &Twin| of_fraction(&self.map, twin);
        self.twins.iter().filter_map(of).collect()
    }
}
