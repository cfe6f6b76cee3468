//! Annealing: labels of blocks, by swaps of two blocks of different kinds.

use super::near::Presses;
use crate::numeric::exp;

/// One mean block's energy, in integer units.
pub(super) const UNIT: f64 = 1_048_576.0;
/// Areas are in units of 2⁻³² of all points.
const AREA_BITS: u32 = 32;
/// Random numbers −ln u in 2⁻¹⁶, for u in the middle of each of these steps.
const STEPS: usize = 4096;

/// A kind to place.
pub(super) struct Kind {
    /// Its share of the points.
    pub(super) share: f64,
    /// Which of the presses its blocks feel.
    pub(super) presses: usize,
    /// The energy that its area would have if it were spread evenly, per squared share, in mean blocks.
    pub(super) even: f64,
}

/// How slowly to cool.
#[derive(Clone, Copy, Debug)]
pub(super) struct Schedule {
    pub(super) sweeps: u32,
    /// The temperatures at the ends, in energies of a mean block.
    pub(super) hot: f64,
    pub(super) cold: f64,
    pub(super) seed: u64,
}

/// One output of the counter generator `SplitMix64`.
#[inline]
const fn mixed(counter: u64) -> u64 {
    let z = counter.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// Labels being annealed.
pub(super) struct Annealer<'a> {
    kinds: &'a [Kind],
    presses: &'a [Presses],
    pub(super) labels: Vec<u8>,
    /// The energy of each block if it were of each kind, kind by kind.
    fields: Vec<i64>,
    areas: Vec<i64>,
    /// Of each kind: its area less its share.
    over: Vec<i64>,
    /// Energy per squared area over, in 2⁻³² units.
    stiff: i64,
    pub(super) accepted: u64,
    /// The blocks of all kinds but the last, and where each block is among them.
    minor: Vec<u32>,
    places: Vec<u32>,
}

impl<'a> Annealer<'a> {
    pub(super) fn new(
        kinds: &'a [Kind],
        presses: &'a [Presses],
        shares: &[f64],
        labels: Vec<u8>,
    ) -> Self {
        let blocks = labels.len();
        let whole = (1u64 << AREA_BITS) as f64;
        let areas: Vec<i64> = shares.iter().map(|s| (s * whole).round() as i64).collect();
        let count = kinds.len();
        let mut over: Vec<i64> = kinds.iter().map(|k| -(k.share * whole).round() as i64).collect();
        let mut fields = vec![0i64; blocks * count];
        for block in 0..blocks {
            over[labels[block] as usize] += areas[block];
            for (c, kind) in kinds.iter().enumerate() {
                let presses = &presses[kind.presses];
                let same = presses.of(block).iter().filter(|p| labels[p.to as usize] == c as u8);
                let sum: i64 = same.map(|p| i64::from(p.by)).sum();
                let even = 2.0 * kind.even * kind.share * shares[block] * UNIT;
                fields[block * count + c] =
                    sum + i64::from(presses.own(block)) / 2 - even.round() as i64;
            }
        }
        // Swaps of unequal blocks shift areas. A kind that is one mean block off costs as much as this.
        let stiff = (2.0 * (blocks * blocks) as f64 * UNIT).round() as i64;
        let minor: Vec<u32> = (0..blocks as u32).filter(|&b| (labels[b as usize] as usize) < count - 1).collect();
        let mut places = vec![0; blocks];
        for (at, &block) in (0..).zip(&minor) { places[block as usize] = at; }
        Self {
            minor, places,
            stiff,
            kinds,
            presses,
            labels,
            fields,
            areas,
            over,
            accepted: 0,
        }
    }

    /// What `by` more area of a kind costs.
    #[inline]
    fn strain(&self, kind: usize, by: i64) -> i64 {
        let squares = i128::from(by * (2 * self.over[kind] + by));
        ((squares * i128::from(self.stiff)) >> (2 * AREA_BITS)) as i64
    }

    /// Anneals.
    pub(super) fn run(&mut self, schedule: &Schedule) {
        let logs: Vec<i64> = (0..STEPS)
            .map(|i| (-libm::log((i as f64 + 0.5) / STEPS as f64) * 65_536.0).round() as i64)
            .collect();
        let blocks = self.labels.len();
        let ratio = libm::log(schedule.cold / schedule.hot);
        let mut counter = schedule.seed;
        let minor = self.minor.len();
        for sweep in 0..schedule.sweeps {
            let way = f64::from(sweep) / f64::from(schedule.sweeps);
            let heat = (schedule.hot * exp(ratio * way) * UNIT).round() as i64;
            for _ in 0..minor {
                counter = counter.wrapping_add(1);
                let bits = mixed(counter);
                let a = self.minor[(((bits >> 32) * minor as u64) >> 32) as usize] as usize;
                let limit = (heat * logs[bits as usize % STEPS]) >> 16;
                if bits & 4096 == 0 {
                    let kind = &self.kinds[self.labels[a] as usize];
                    let near = self.presses[kind.presses].of(a);
                    if near.is_empty() {
                        continue;
                    }
                    let at = (((bits >> 13) & 0x7ffff) * near.len() as u64) >> 19;
                    let b = near[at as usize].to as usize;
                    self.swap(a, b, limit, true);
                } else {
                    let b = ((mixed(!counter) >> 32) * blocks as u64) >> 32;
                    self.swap(a, b as usize, limit, false);
                }
            }
        }
    }

    /// Swaps two blocks if it costs at most `limit`.
    #[inline]
    fn swap(&mut self, a: usize, b: usize, limit: i64, near: bool) {
        let [from, to] = [a, b].map(|block| self.labels[block] as usize);
        if from == to {
            return;
        }
        let count = self.kinds.len();
        let (at_a, at_b) = (&self.fields[a * count..], &self.fields[b * count..]);
        let mut cost = at_a[to] - at_a[from] + at_b[from] - at_b[to];
        let by = self.areas[b] - self.areas[a];
        if cost > limit + 4 * UNIT as i64 {
            return;
        }
        cost += self.strain(from, by) + self.strain(to, -by);
        if cost > limit {
            if !near {
                return;
            }
            // They no longer press each other once they have swapped.
            let [p, q] = [from, to].map(|kind| self.kinds[kind].presses);
            let between = self.presses[p].between(a, b);
            cost -= i64::from(between);
            cost -= i64::from(if p == q { between } else { self.presses[q].between(a, b) });
            if cost > limit {
                return;
            }
        }
        self.accepted += 1;
        self.turn(a, from, to);
        self.turn(b, to, from);
        self.over[from] += by;
        self.over[to] -= by;
        if to == count - 1 {
            let at = self.places[a];
            self.minor[at as usize] = b as u32;
            self.places[b] = at;
        }
    }

    /// Gives a block another kind.
    fn turn(&mut self, block: usize, from: usize, to: usize) {
        let count = self.kinds.len();
        let [p, q] = [from, to].map(|kind| self.kinds[kind].presses);
        if p == q {
            for press in self.presses[p].of(block) {
                let at = press.to as usize * count;
                let by = i64::from(press.by);
                self.fields[at + from] -= by;
                self.fields[at + to] += by;
            }
        } else {
            for press in self.presses[p].of(block) {
                self.fields[press.to as usize * count + from] -= i64::from(press.by);
            }
            for press in self.presses[q].of(block) {
                self.fields[press.to as usize * count + to] += i64::from(press.by);
            }
        }
        self.labels[block] = to as u8;
    }

    /// The areas of the kinds, less their shares.
    pub(super) fn over(&self) -> Vec<f64> {
        let whole = (1u64 << AREA_BITS) as f64;
        self.over.iter().map(|&v| v as f64 / whole).collect()
    }
}
