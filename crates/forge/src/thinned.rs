//! Thinned twins: what is left of one period at a share, to be measured.

use strew_core::{Table, Twin};

use crate::measure::{Sample, displaced};

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
    #[must_use]
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
    #[must_use]
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
