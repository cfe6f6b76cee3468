//! Thinned twins: what is left of one period at a share, to be measured.

use strew_core::{Table, Twin, table::to_grid_units};

use crate::measure::Torus;

/// One period of a twin, to be thinned again and again.
pub struct ThinnedTwin<'a> {
    table: &'a Table,
    /// Grid units.
    period: f64,
    points: Vec<Candidate>,
}

/// A point of the full set.
struct Candidate {
    /// The lattice address.
    at: [f64; 2],
    block: u32,
    rank: f64,
    kind: u8,
}

impl<'a> ThinnedTwin<'a> {
    /// The period of a twin of the table's map, or `None` if it is none.
    #[must_use]
    pub fn new(table: &'a Table, twin: Twin) -> Option<Self> {
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
                at: [f64::from(site.x), f64::from(site.y)],
                block: block as u32,
                rank: ranks.start + within * (ranks.end - ranks.start),
                kind: kind(table, block, offset),
            }
        });
        Some(Self {
            table,
            period: twin.period() as f64,
            points: points.collect(),
        })
    }

    /// The points that are left at a share, at unit density. They move by the table's ladder if it has one
    /// and `moves` is set, and otherwise stay where they are in the full set.
    #[must_use]
    pub fn at(&self, share: f64, moves: bool) -> Torus {
        self.set(share, moves, |_| true)
    }

    /// The points of a kind that are left at a share, at unit density. They stay where they are in the full
    /// set. Tables without a mix have points of kind 0 only.
    #[must_use]
    pub fn of_kind(&self, share: f64, kind: u8) -> Torus {
        self.set(share, false, |point| point.kind == kind)
    }

    fn set(&self, share: f64, moves: bool, counts: impl Fn(&Candidate) -> bool) -> Torus {
        let left = self.points.iter();
        let left = left.filter(|point| point.rank < share && counts(point));
        let points = left.map(|point| {
            let block = point.block as usize;
            let by = if moves {
                self.table.displacement_at(block, share)
            } else {
                self.table.displacements()[block]
            };
            [0, 1].map(|axis| point.at[axis] + to_grid_units(by[axis]))
        });
        Torus::new(self.period, points.collect())
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
