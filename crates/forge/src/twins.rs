//! The twins a table is optimized and judged on: those next to α, and their points, whole or thinned.
//!
//! The twins of a map lie on the interval of α on which its thresholds keep their order. For small
//! maps this interval is wide, and a twin far from α has another density and other frequencies. So
//! of the twins with the same side t only the two fractions around α are considered. Maps of useful
//! size have no other twins of moderate size.

use strew_core::{
    Alpha, Map, Table, Twin,
    table::{Displacement, to_grid_units},
};

use crate::measure::Sample;

/// The largest side t of a twin that is considered: 17 million points.
const MAX_SIDE: u64 = 4096;

/// Returns the twins of a map next to its α, smallest first, up to [`MAX_SIDE`]. An α that is a
/// fraction of small integers may have none: some of its thresholds coincide, those of twins do
/// not.
pub(crate) fn next_to_alpha(map: &Map) -> impl Iterator<Item = Twin> {
    let excess = map.alpha().to_f64() - 1.0;
    (1..=MAX_SIDE).flat_map(move |t| {
        let q = (t as f64 / excess) as u64;
        [q, q + 1]
            .into_iter()
            .filter_map(move |q| Twin::new(t + q, q))
            .filter(|&twin| map.has_twin(twin) && map_of_twin(map, twin).is_some())
    })
}

/// The least number of points of a large twin. In smaller ones a ring holds so few Bragg peaks that
/// its mean power shows their speckle.
pub(crate) const LARGE_TWIN: u64 = 65_000;
/// The number of large twins that the farthest are chosen from: for the default map, all of up to
/// 200,000 points. Larger ones hardly lie farther out.
const LARGE_TWINS: usize = 40;

/// Returns the large twins of a map with the least and the greatest α.
pub(crate) fn farthest(map: &Map) -> Option<[Twin; 2]> {
    let large = next_to_alpha(map).filter(|twin| twin.points() >= LARGE_TWIN);
    let twins: Vec<Twin> = large.take(LARGE_TWINS).collect();
    let by_alpha = |a: &&Twin, b: &&Twin| fraction(a).total_cmp(&fraction(b));
    let [least, greatest] = [twins.iter().min_by(by_alpha), twins.iter().max_by(by_alpha)];
    Some([*least?, *greatest?])
}

/// The nearest to α of some twins.
pub(crate) fn nearest(map: &Map, twins: impl Iterator<Item = Twin>) -> Option<Twin> {
    let alpha = map.alpha().to_f64();
    let far = |twin: &Twin| (fraction(twin) - alpha).abs();
    twins.min_by(|a, b| far(a).total_cmp(&far(b)))
}

/// The α of a twin, p/q.
pub(crate) fn fraction(twin: &Twin) -> f64 {
    twin.p() as f64 / twin.q() as f64
}

/// The map at the α of a twin, or `None` if it has other intervals.
pub(crate) fn map_of_twin(map: &Map, twin: Twin) -> Option<Map> {
    let alpha = Alpha::from_fraction(twin.p(), twin.q()).ok()?;
    let same = |found: &Map| found.intervals() == map.intervals();
    Map::new(alpha, map.radius()).ok().filter(same)
}

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
    /// sides, within the range of its large twins. A large map is returned at its own α alone.
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

/// Returns one period of a twin, displaced, or `None` if it is no twin of the table's map.
pub fn twin_set(table: &Table, twin: Twin) -> Option<Sample> {
    Some(ThinnedTwin::new(table, twin)?.at(1.0, None))
}

/// The place of a point, by its lattice address and its vector.
fn displaced(address: [u32; 2], by: Displacement) -> [f64; 2] {
    [0, 1].map(|axis| f64::from(address[axis]) + to_grid_units(by[axis]))
}

/// One period of a twin, to be thinned again and again.
pub struct ThinnedTwin {
    /// Grid units.
    period: f64,
    points: Vec<Candidate>,
}

/// A point of the full set.
struct Candidate {
    /// Grid units.
    at: [f64; 2],
    rank: f64,
    kind: u8,
}

impl ThinnedTwin {
    /// The period of a twin of the table's map, or `None` if it is none.
    pub fn new(table: &Table, twin: Twin) -> Option<Self> {
        let n = table.map().intervals();
        let (p, q) = (twin.p(), twin.q());
        let index = |site: &strew_core::map::Site| {
            (p * u64::from(site.x) + q * u64::from(site.y & 1)) % (2 * q)
        };
        let sites = twin.sites(table.map())?;
        // The first and the last index of each interval.
        let mut ends = vec![[u64::MAX, 0]; n];
        for site in &sites {
            let ends = &mut ends[site.block_x as usize];
            *ends = [ends[0].min(index(site)), ends[1].max(index(site))];
        }
        let points = sites.iter().map(|site| {
            let block = site.block_y as usize * n + site.block_x as usize;
            let [first, last] = ends[site.block_x as usize];
            let within = ((index(site) - first) as f64 + 0.5) / (last - first + 1) as f64;
            let ranks = table.block_ranks(block);
            let interval = table.map().interval(site.block_x as usize);
            let offset = within * (interval.end - interval.start) as f64;
            Candidate {
                at: displaced([site.x, site.y], table.displacements()[block]),
                rank: ranks.start + within * (ranks.end - ranks.start),
                kind: kind(table, block, offset),
            }
        });
        Some(Self {
            period: twin.period() as f64,
            points: points.collect(),
        })
    }

    /// The points that are left at a share, of a kind or all, at unit density. Tables without a mix have points of kind 0
    /// only.
    pub fn at(&self, share: f64, kind: Option<u8>) -> Sample {
        let is_of_kind = |point: &Candidate| kind.is_none_or(|kind| point.kind == kind);
        let left = self.points.iter();
        let left = left.filter(|point| point.rank < share && is_of_kind(point));
        let points = left.map(|point| point.at);
        Sample::torus(self.period, points.collect())
    }
}

/// The kind of a point of a block, given how far its dX lies beyond the start of the block's interval.
fn kind(table: &Table, block: usize, offset: f64) -> u8 {
    table.mix().map_or(0, |mix| {
        let splits = mix.splits().iter();
        let mut here = splits.filter(|split| split.block as usize == block);
        let split = here.find(|split| split.offset as f64 <= offset);
        split.map_or(mix.labels()[block], |split| split.kind)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn maps_of_useful_size_have_no_other_twins() {
        for alpha in ["(5-sqrt(3))/2", "sqrt(3)", "(1+sqrt(5))/2"] {
            let map = Map::new(alpha.parse().expect("valid"), 49).expect("small");
            let all: Vec<Twin> = map.twins().take(60).collect();
            let found: Vec<Twin> = next_to_alpha(&map).take(60).collect();
            assert_eq!(found, all, "{alpha}");
        }
    }

    #[test]
    fn they_are_near_alpha_and_finitely_many() {
        for (alpha, radius) in [("1.1", 1), ("1.95", 1), ("sqrt(2)", 3), ("3/2", 4)] {
            let map = Map::new(alpha.parse().expect("valid"), radius).expect("small");
            for twin in next_to_alpha(&map)
                .skip_while(|twin| twin.points() < 4000)
                .take(50)
            {
                let fraction = twin.p() as f64 / twin.q() as f64;
                assert!(
                    (fraction - map.alpha().to_f64()).abs() < 0.02,
                    "{alpha} {twin}"
                );
                let finer = map_of_twin(&map, twin).expect("the same map");
                assert_eq!(finer.intervals(), map.intervals());
            }
        }
        let tied = Map::new("3/2".parse().expect("valid"), 4).expect("small");
        assert_eq!(next_to_alpha(&tied).filter(|t| t.points() > 1).count(), 0);
    }

    #[test]
    fn a_twin_has_its_points_at_unit_density() {
        let table = Table::undisplaced("(5-sqrt(3))/2".parse().expect("valid"), 20, "pattern");
        let table = table.expect("small");
        let twin = table.map().twins().next().expect("endless");
        let set = twin_set(&table, twin).expect("a twin");
        assert_eq!(set.points().len() as u64, twin.points());
        assert_eq!(set.side(), twin.t() as f64);
        assert!(twin_set(&table, Twin::new(3, 2).expect("coprime")).is_none());
    }
}
