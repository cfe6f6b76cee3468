//! Labels: which kind each block of a table is of, so that each kind is evenly spread, by annealing: swaps of two blocks of
//! different kinds.
//!
//! The energy is a Gaussian of the distance of two points of a kind, σ = 0.55 of the kind's own spacing,
//! summed over all pairs by their exact frequencies. Pairs of all kinds weigh the same: dense kinds, which are
//! the hard ones, have more of them.
//!
//! Everything is an integer: energies, areas, temperatures, random numbers and their logarithms. The energy
//! that each block would have as each kind is kept up to date, so a swap that is refused, as nearly all are,
//! costs a few additions, and one that is taken the blocks near it.

use std::f64::consts::PI;

use strew_core::{
    Table,
    table::{Mix, Shares},
};

use super::press::{Kernel, Presses, each};
use crate::{
    ForgeError,
    numeric::{SplitMix, exp},
    optimize::{Ground, longest, moves_of},
    watch::Meter,
};

/// The energy of a mean block, in integer units.
pub(super) const UNIT: f64 = (1u64 << 20) as f64;
/// All points, in units of area.
const WHOLE: f64 = (1u64 << AREA_BITS) as f64;
const AREA_BITS: u32 = 32;
/// The temperatures at the start and at the end, in energies of a mean block.
const HEAT: [f64; 2] = [0.5, 0.01];
/// Sweeps: proposals for each block that is not of the last kind.
const SWEEPS: u32 = 1500;
/// Steps of the meter.
pub(super) const STEPS: u32 = 100;
/// The seed of the proposals, chosen arbitrarily.
const SEED: u64 = 0x6b69_6e64;
/// The cost of an excess or lack of a kind by the area of a mean block, in energies of a mean block.
const STIFFNESS: f64 = 2.0;
/// Values of the table of logarithms, a power of two.
const LOGS: usize = 1 << LOG_BITS;
const LOG_BITS: u32 = 12;
/// Logarithms are in units of 2⁻¹⁶.
const LOG_UNIT: u32 = 16;

/// A kind to place.
pub(super) struct Kind {
    /// Its share of the points.
    pub(super) share: f64,
    /// The number of the list of presses that its blocks feel.
    pub(super) presses: usize,
    /// The energy of the kind if it were spread evenly, over the square of its share, in mean blocks. Energies
    /// grow with areas, so without this a swap of unequal blocks would pay by what it takes from a kind.
    pub(super) even: f64,
}

/// Labels being annealed.
pub(super) struct Annealer<'a> {
    kinds: &'a [Kind],
    presses: &'a [Presses],
    labels: Vec<u8>,
    /// The energy of each block as each kind, block by block.
    fields: Vec<i64>,
    areas: Vec<i64>,
    /// The area of each kind beyond its share.
    excess: Vec<i64>,
    /// Energy per squared excess.
    stiffness: i64,
    /// The blocks of all kinds but the last, and where each block is among them.
    minor: Vec<u32>,
    places: Vec<u32>,
}

impl<'a> Annealer<'a> {
    /// Starts with some labels of blocks, given the shares of all points that blocks have. Kinds ascend.
    pub(super) fn new(
        kinds: &'a [Kind],
        presses: &'a [Presses],
        shares: &[f64],
        labels: &[u8],
    ) -> Self {
        let (blocks, count) = (labels.len(), kinds.len());
        let areas = shares.iter().map(|share| (share * WHOLE).round() as i64);
        let areas: Vec<i64> = areas.collect();
        let target = |kind: &Kind| (kind.share * WHOLE).round() as i64;
        let mut excess: Vec<i64> = kinds.iter().map(|kind| -target(kind)).collect();
        let mut fields = vec![0; blocks * count];
        let mut minor = Vec::new();
        let mut places = vec![0; blocks];
        for (block, &label) in labels.iter().enumerate() {
            let label = usize::from(label);
            excess[label] += areas[block];
            if label + 1 < count {
                places[block] = minor.len() as u32;
                minor.push(block as u32);
            }
            let fields = &mut fields[block * count..][..count];
            for (field, kind) in fields.iter_mut().zip(kinds) {
                let own = i64::from(presses[kind.presses].own[block]) / 2;
                let even = 2.0 * kind.even * kind.share * shares[block] * UNIT;
                *field = own - even.round() as i64;
            }
            for (list, presses) in presses.iter().enumerate() {
                for press in presses.of(block) {
                    let other = usize::from(labels[press.to as usize]);
                    if kinds[other].presses == list {
                        fields[other] += i64::from(press.by);
                    }
                }
            }
        }
        Self {
            kinds,
            presses,
            labels: labels.to_vec(),
            fields,
            areas,
            excess,
            stiffness: (STIFFNESS * (blocks * blocks) as f64 * UNIT).round() as i64,
            minor,
            places,
        }
    }

    /// Anneals. Returns the labels, or `None` if the watch stopped the work.
    pub(super) fn run(mut self, meter: &mut Meter<'_>) -> Option<Vec<u8>> {
        let logs: Vec<i64> = (0..LOGS)
            .map(|i| -libm::log((i as f64 + 0.5) / LOGS as f64) * f64::from(1u32 << LOG_UNIT))
            .map(|log| log.round() as i64)
            .collect();
        let cooling = libm::log(HEAT[1] / HEAT[0]) / f64::from(SWEEPS);
        let mut random = SplitMix::new(SEED);
        for sweep in 0..SWEEPS {
            if meter.stop() {
                return None;
            }
            let heat = (HEAT[0] * exp(cooling * f64::from(sweep)) * UNIT).round() as i64;
            for _ in 0..self.minor.len() {
                self.propose(heat, &logs, &mut random);
            }
            if (sweep + 1) % (SWEEPS / STEPS) == 0 {
                meter.advance(None);
            }
        }
        self.settle();
        Some(self.labels)
    }

    /// Proposes a swap of a block that is not of the last kind with one near it or, as often, with any.
    #[inline]
    fn propose(&mut self, heat: i64, logs: &[i64], random: &mut SplitMix) {
        let bits = random.next_u64();
        let a = self.minor[below(bits >> 32, 32, self.minor.len())] as usize;
        let limit = (heat * logs[bits as usize % LOGS]) >> LOG_UNIT;
        let bits = (bits & 0xffff_ffff) >> LOG_BITS;
        if bits & 1 == 0 {
            let near = self.presses[self.kinds[usize::from(self.labels[a])].presses].of(a);
            if near.is_empty() {
                return;
            }
            let press = near[below(bits >> 1, 19, near.len())];
            self.swap(a, press.to as usize, i64::from(press.by), limit);
        } else {
            let b = below(random.next_u64() >> 32, 32, self.labels.len());
            self.swap(a, b, 0, limit);
        }
    }

    /// Swaps two blocks if it costs at most `limit`. They press each other by `press` as the kind of the first;
    /// 0 if that is not known, which is rarely wrong.
    #[inline]
    fn swap(&mut self, a: usize, b: usize, press: i64, limit: i64) {
        let [from, to] = [a, b].map(|block| usize::from(self.labels[block]));
        if from == to {
            return;
        }
        let count = self.kinds.len();
        let (at_a, at_b) = (&self.fields[a * count..], &self.fields[b * count..]);
        let by = self.areas[b] - self.areas[a];
        let cost = at_a[to] - at_a[from] + at_b[from] - at_b[to]
            + self.strain(from, by)
            + self.strain(to, -by);
        // They no longer press each other once they have swapped, which lowers the cost.
        if cost > limit {
            let [p, q] = [from, to].map(|kind| self.kinds[kind].presses);
            let list = &self.presses[q];
            if press == 0 || cost - press - i64::from(list.most[a]) > limit {
                return;
            }
            let other = if p == q {
                press
            } else {
                i64::from(list.between(a, b))
            };
            if cost - press - other > limit {
                return;
            }
        }
        self.turn(a, from, to);
        self.turn(b, to, from);
        self.excess[from] += by;
        self.excess[to] -= by;
        if to + 1 == count {
            self.minor[self.places[a] as usize] = b as u32;
            self.places[b] = self.places[a];
        }
    }

    /// The cost of `by` more area of a kind.
    #[inline]
    fn strain(&self, kind: usize, by: i64) -> i64 {
        let squares = i128::from(by) * i128::from(2 * self.excess[kind] + by);
        ((squares * i128::from(self.stiffness)) >> (2 * AREA_BITS)) as i64
    }

    /// Assigns another kind to a block.
    fn turn(&mut self, block: usize, from: usize, to: usize) {
        let count = self.kinds.len();
        let [p, q] = [from, to].map(|kind| self.kinds[kind].presses);
        for press in self.presses[p].of(block) {
            self.fields[press.to as usize * count + from] -= i64::from(press.by);
        }
        for press in self.presses[q].of(block) {
            self.fields[press.to as usize * count + to] += i64::from(press.by);
        }
        self.labels[block] = to as u8;
    }

    /// Moves blocks from the kind with the greatest excess to that with the least, while a block is small
    /// enough for it to help: the splits of a mix make shares exact only within a block.
    fn settle(&mut self) {
        let count = self.kinds.len();
        for _ in 0..self.labels.len() {
            let most = (0..count).max_by_key(|&kind| self.excess[kind]);
            let least = (0..count).min_by_key(|&kind| self.excess[kind]);
            let (Some(from), Some(to)) = (most, least) else {
                return;
            };
            let amount = self.excess[from].min(-self.excess[to]);
            let field = |block: usize, kind: usize| self.fields[block * count + kind];
            // A block of which at least a third is needed, at the least cost.
            let helps = |&block: &usize| {
                usize::from(self.labels[block]) == from
                    && self.areas[block] > amount / 2
                    && 2 * self.areas[block] < 3 * amount
            };
            let found = (0..self.labels.len())
                .filter(helps)
                .min_by_key(|&block| field(block, to) - field(block, from));
            let Some(block) = found else { return };
            self.turn(block, from, to);
            self.excess[from] -= self.areas[block];
            self.excess[to] += self.areas[block];
        }
    }
}

/// The number of `bits` random bits scaled to a number below `count`.
#[inline]
const fn below(random: u64, bits: u32, count: usize) -> usize {
    ((random * count as u64) >> bits) as usize
}

/// σ in a kind's own spacings. At 0.6 and above dense kinds have more power below ν = 0.5.
const SIGMA: f64 = 0.55;
/// The cut-off of the Gaussian, in σ.
const CUTOFF: f64 = 3.6;
/// Kinds of a smaller share feel a Gaussian as wide as this share does. Their points lie farther apart than
/// blocks determine who is near.
const RAREST: f64 = 1.0 / 24.0;
/// Kinds whose shares differ by no more than this factor feel the same Gaussian.
const ALIKE: f64 = 1.12;

/// The mix of a table for some shares, or `None` if the meter's watch stopped the work. It takes
/// [`STEPS`] steps.
pub(super) fn annealed(
    table: &Table,
    shares: &Shares,
    meter: &mut Meter<'_>,
) -> Result<Option<Mix>, ForgeError> {
    let start = Mix::scattered(table.map(), shares.clone())?;
    let of = each(shares);
    let mut felt: Vec<f64> = Vec::new();
    let lists: Vec<usize> = of
        .iter()
        .map(|&share| {
            let share = share.max(RAREST);
            if felt.last().is_none_or(|&last| share > ALIKE * last) {
                felt.push(share);
            }
            felt.len() - 1
        })
        .collect();
    let range = CUTOFF * SIGMA / felt[0].sqrt();
    let ground = Ground::new(table.map(), range + 2.0 * longest(&moves_of(table)));
    let blocks = ground.shares.len();
    // The densest kind has weight 1 per point.
    let weight = 1.0 / of[of.len() - 1];
    let kernel = |share: f64| Kernel {
        sigma: SIGMA / share.sqrt(),
        range: CUTOFF * SIGMA / share.sqrt(),
    };
    let unit = weight * blocks as f64 * UNIT;
    let presses: Vec<Presses> = felt
        .iter()
        .map(|&share| Presses::new(table, &ground, kernel(share), unit))
        .collect();
    let kinds: Vec<Kind> = of
        .iter()
        .zip(lists)
        .map(|(&share, list)| {
            let sigma = kernel(felt[list]).sigma;
            Kind {
                share,
                presses: list,
                // Half the integral of the Gaussian.
                even: weight * PI * sigma * sigma * blocks as f64,
            }
        })
        .collect();
    let annealer = Annealer::new(&kinds, &presses, &ground.shares, start.labels());
    let Some(labels) = annealer.run(meter) else {
        return Ok(None);
    };
    Ok(Some(Mix::new(table.map(), shares.clone(), labels)?))
}

#[cfg(test)]
mod tests {
    use strew_core::Map;

    use super::*;
    use crate::watch::Stage;

    #[test]
    fn fields_and_areas_stay_what_they_are_from_scratch() {
        let alpha = "(5-sqrt(3))/2".parse().expect("valid");
        let table = Table::undisplaced(alpha, 15, "pattern").expect("small");
        let ground = Ground::new(table.map(), 6.0);
        let kernel = |sigma: f64| Kernel {
            sigma,
            range: 3.0 * sigma,
        };
        let presses = [1.2, 0.8].map(|s| Presses::new(&table, &ground, kernel(s), 4e8));
        let kinds = [(1, 0), (1, 0), (2, 1)].map(|(part, presses)| Kind {
            share: f64::from(part) / 4.0,
            presses,
            even: 100.0,
        });
        let start = Mix::scattered(table.map(), "1:1:2".parse().expect("valid")).expect("near");
        let mut annealer = Annealer::new(&kinds, &presses, &ground.shares, start.labels());
        let logs: Vec<i64> = (0..LOGS as i64).map(|i| i << 6).collect();
        let mut random = SplitMix::new(3);
        for _ in 0..20_000 {
            annealer.propose(3000, &logs, &mut random);
        }
        assert_ne!(annealer.labels, start.labels());
        let fresh = Annealer::new(&kinds, &presses, &ground.shares, &annealer.labels);
        assert_eq!(annealer.fields, fresh.fields);
        assert_eq!(annealer.excess, fresh.excess);
        let sorted = |mut blocks: Vec<u32>| {
            blocks.sort_unstable();
            blocks
        };
        assert_eq!(sorted(annealer.minor.clone()), fresh.minor);
        for (at, &block) in (0..).zip(&annealer.minor) {
            assert_eq!(annealer.places[block as usize], at);
        }
    }

    #[test]
    fn areas_end_within_a_block_of_the_shares() {
        for (shares, radius) in [
            ("1:1", 15),
            ("1:3:10", 20),
            ("1:2:3:4:5", 20),
            ("1:100", 20),
        ] {
            let map = Map::new("(5-sqrt(3))/2".parse().expect("valid"), radius).expect("small");
            let table = Table::undisplaced(map.alpha(), radius, "pattern").expect("small");
            let mut meter = Meter::new(&(), Stage::Optimizing, STEPS);
            let shares = shares.parse().expect("valid");
            let mix = annealed(&table, &shares, &mut meter);
            assert!(mix.expect("near").is_some(), "{shares}");
        }
    }
}
