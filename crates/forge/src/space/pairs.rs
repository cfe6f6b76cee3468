//! The pairs of blocks whose points are near each other, with their exact frequencies in the unbounded set: products of
//! [overlaps] along three axes, since the index of a point is uniform over the set region. The Gaussian energy of a table
//! is a sum over these pairs.
//!
//! By void and cluster on these frequencies blocks get the order in which they leave: the set starts full, and the block whose
//! points are in the densest surroundings leaves first. Surroundings are sums of Gaussians over the neighbors that are left, at
//! the scale of the spacing that the set then has.

use rayon::prelude::*;
use strew_core::{Alpha, Error, Map, space::Table, table::Ranks};

use crate::{
    numeric::exp32,
    optimize::overlaps,
    order::{Surroundings, positions},
};

/// Pairs within a distance, by the block of their first point.
#[derive(Clone, Debug, Default)]
pub(super) struct Pairs {
    /// Where the pairs of each block begin, and the end of the last.
    pub(super) starts: Vec<usize>,
    /// The block of the second point.
    pub(super) blocks: Vec<u16>,
    /// The offset of the lattice from the first point to the second.
    pub(super) offsets: Vec<[i8; 3]>,
    /// How often the pair occurs, per point of the whole set.
    pub(super) shares: Vec<f32>,
}

/// The greatest displacement, in mean spacings, that the components of a table can express.
pub const LONGEST: f64 = 2.5;

/// The geometry of a map's blocks.
pub(super) struct Blocks {
    pub(super) intervals: usize,
    /// The share of points of each block.
    pub(super) shares: Vec<f64>,
    /// The intervals that meet across each offset along an axis from −`far` on, of each parity of those along the others: from,
    /// to, and the part of the set region from which they meet.
    meetings: Vec<Vec<(usize, usize, f32)>>,
    /// The largest offset.
    far: i64,
    /// Mean spacings per grid unit.
    pub(super) step: f64,
    /// The greatest displacement, in mean spacings.
    pub(super) longest: f64,
}

/// The reach of a component of a table, in grid units.
pub(super) const COMPONENT: f64 = 7.99;

/// The greatest displacement at an α, in mean spacings: [`LONGEST`], or what a component of a table reaches.
pub(super) fn longest(alpha: Alpha) -> f64 {
    LONGEST.min(COMPONENT * alpha.set_side_f64())
}

impl Blocks {
    /// The blocks of a map, with pairs up to `reach` mean spacings.
    pub(super) fn new(map: &Map, reach: f64) -> Self {
        let (n, side) = (map.intervals(), map.alpha().set_side() as f64);
        let length = |i: usize| {
            let interval = map.interval(i);
            (interval.end - interval.start) as f64 / side
        };
        let share = |b: usize| length(b % n) * length(b / n % n) * length(b / (n * n));
        let step = map.alpha().set_side_f64();
        let longest = longest(map.alpha());
        let far = ((reach + 2.0 * longest) / step) as i64 + 1;
        let meetings = |own, others| {
            let all = overlaps(map, own, others);
            let part = |length: f64| (length / step) as f32;
            all.iter().map(|o| (o.from, o.to, part(o.length))).collect()
        };
        Self {
            intervals: n,
            shares: (0..n.pow(3)).map(share).collect(),
            meetings: (-far..=far)
                .flat_map(|own| [meetings(own, 0), meetings(own, 1)])
                .collect(),
            far,
            step,
            longest,
        }
    }

    /// The intervals that meet across an offset along an axis, given the sum of those along the others.
    fn meetings(&self, own: i64, others: i64) -> &[(usize, usize, f32)] {
        &self.meetings[((own + self.far) * 2 + (others & 1)) as usize]
    }

    /// Calls `each` for the pairs of blocks that can meet within `reach` mean spacings: with the block numbers, the
    /// offset and the frequency. Every pair comes in both directions, and no point meets itself.
    pub(super) fn each_pair(
        &self,
        moves: &[[f32; 3]],
        reach: f64,
        mut each: impl FnMut(usize, usize, [i8; 3], f32),
    ) {
        let (n, far) = (self.intervals, self.far);
        let longest = moves
            .iter()
            .map(|v| v.iter().map(|v| f64::from(*v).powi(2)).sum::<f64>())
            .fold(0.0, f64::max)
            .sqrt();
        let widest = reach + 2.0 * longest;
        let (limit, step) = ((reach * reach) as f32, self.step as f32);
        for z in -far..=far {
            for y in -far..=far {
                for x in -far..=far {
                    let squared = (x * x + y * y + z * z) as f64 * self.step * self.step;
                    if squared > widest * widest || (x, y, z) == (0, 0, 0) {
                        continue;
                    }
                    let [along_x, along_y, along_z] = [(x, y + z), (y, x + z), (z, x + y)]
                        .map(|(own, others)| self.meetings(own, others));
                    let offset = [x, y, z].map(|v| v as f32 * step);
                    for &(from_z, to_z, share_z) in along_z {
                        for &(from_y, to_y, share_y) in along_y {
                            let share = share_z * share_y;
                            let (from, to) = ((from_z * n + from_y) * n, (to_z * n + to_y) * n);
                            let (from_row, to_row) = (&moves[from..from + n], &moves[to..to + n]);
                            for &(from_x, to_x, share_x) in along_x {
                                let (a, b) = (&from_row[from_x], &to_row[to_x]);
                                let d = [0, 1, 2].map(|axis| offset[axis] + b[axis] - a[axis]);
                                if d[0] * d[0] + d[1] * d[1] + d[2] * d[2] < limit {
                                    let at = [x as i8, y as i8, z as i8];
                                    each(from + from_x, to + to_x, at, share * share_x);
                                }
                            }
                        }
                    }
                }
            }
        }
    }

    /// The pairs within `reach` mean spacings.
    pub(super) fn pairs(&self, moves: &[[f32; 3]], reach: f64) -> Pairs {
        let mut starts = vec![0usize; moves.len() + 1];
        self.each_pair(moves, reach, |from, _, _, _| starts[from + 1] += 1);
        for block in 0..moves.len() {
            starts[block + 1] += starts[block];
        }
        let count = starts[moves.len()];
        let mut pairs = Pairs {
            blocks: vec![0; count],
            offsets: vec![[0; 3]; count],
            shares: vec![0.0; count],
            starts: Vec::new(),
        };
        let mut next = starts.clone();
        self.each_pair(moves, reach, |from, to, offset, share| {
            let at = next[from];
            next[from] += 1;
            pairs.blocks[at] = to as u16;
            pairs.offsets[at] = offset;
            pairs.shares[at] = share;
        });
        pairs.starts = starts;
        pairs
    }
}

/// The number of pairs that are evaluated together.
const LANES: usize = 16;

/// Repulsion by exp(−d²/2σ²), cut off and shifted to 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Gaussian {
    /// σ, in mean spacings.
    pub(super) sigma: f64,
}

impl Gaussian {
    /// The distance beyond which pairs count as 0, in mean spacings.
    pub(super) fn reach(self) -> f64 {
        5.0 * self.sigma
    }

    /// The energy per point, and the gradient of each block per point of the block, times σ²: the sum of w·d over the
    /// pairs of its points, with d from the other point.
    pub(super) fn evaluate(
        self,
        blocks: &Blocks,
        pairs: &Pairs,
        moves: &[[f32; 3]],
        forces: &mut [[f64; 3]],
    ) -> f64 {
        let scale = (-0.5 / (self.sigma * self.sigma)) as f32;
        let limit = (self.reach() * self.reach()) as f32;
        let shift = exp32(scale * limit);
        let one = |block: usize, force: &mut [f64; 3]| {
            let all = pairs.starts[block]..pairs.starts[block + 1];
            let own = moves[block];
            let (mut sum, mut total) = ([0.0f64; 3], 0.0f64);
            let mut at = all.start;
            while at < all.end {
                let part = at..all.end.min(at + LANES);
                let mut places = [[0.0f32; LANES]; 3];
                let mut shares = [0.0f32; LANES];
                for (lane, pair) in part.clone().enumerate() {
                    let other = moves[usize::from(pairs.blocks[pair])];
                    let offset = pairs.offsets[pair];
                    for axis in 0..3 {
                        let by = f32::from(offset[axis]) * blocks.step as f32;
                        places[axis][lane] = own[axis] - other[axis] - by;
                    }
                    shares[lane] = pairs.shares[pair];
                }
                let mut weights = [0.0f32; LANES];
                for lane in 0..LANES {
                    let [x, y, z] = [places[0][lane], places[1][lane], places[2][lane]];
                    let squared = (x * x + y * y + z * z).min(limit);
                    weights[lane] = (exp32(scale * squared) - shift) * shares[lane];
                }
                for lane in 0..LANES {
                    let weight = weights[lane];
                    total += f64::from(weight);
                    for axis in 0..3 {
                        sum[axis] += f64::from(weight * places[axis][lane]);
                    }
                }
                at = part.end;
            }
            let share = blocks.shares[block];
            *force = sum.map(|v| v / share);
            total
        };
        // Each sum is of one thread, and they are added in order.
        let all = forces.par_iter_mut().enumerate();
        let totals: Vec<f64> = all.map(|(block, force)| one(block, force)).collect();
        totals.iter().sum()
    }
}

/// Below this share of the points neighbors are farther apart than pairs are listed.
const FEW: f64 = 1.0 / 24.0;

/// The table with an order in which its points leave.
pub fn with_ranks(table: &Table) -> Result<Table, Error> {
    let map = table.map();
    let units = map.alpha().set_side_f64() / 4096.0;
    let moves: Vec<[f32; 3]> = table
        .vectors()
        .iter()
        .map(|v| v.map(|v| (f64::from(v) * units) as f32))
        .collect();
    let blocks = Blocks::new(map, RANKS_REACH);
    let pairs = blocks.pairs(&moves, RANKS_REACH);
    let mut left = Left {
        blocks: &blocks,
        pairs: &pairs,
        moves: &moves,
        scale: 0.0,
    };
    let found = positions(&mut left, &vec![0; moves.len()], &[1.0], KEPT, 0);
    table.with_ranks(Ranks::new(found.unwrap_or_default())?)
}

/// Pairs are listed up to this distance, in spacings of the whole set.
const RANKS_REACH: f64 = 4.6;
/// The scale of surroundings, in spacings of what is left.
const SCALE: f64 = 0.55;
/// The part of what was left that is left when surroundings are summed up anew, at another scale.
const KEPT: f64 = 0.93;

/// The blocks that are left, and how they press each other.
struct Left<'a> {
    blocks: &'a Blocks,
    pairs: &'a Pairs,
    moves: &'a [[f32; 3]],
    /// The exponent per squared distance.
    scale: f64,
}

impl Left<'_> {
    /// The pairs of a block: the other block, and the frequency of the pair times the Gaussian of its distance.
    fn of(&self, block: usize) -> impl Iterator<Item = (usize, f64, f64)> + '_ {
        let Self { pairs, moves, .. } = self;
        (pairs.starts[block]..pairs.starts[block + 1]).map(move |pair| {
            let other = usize::from(pairs.blocks[pair]);
            let squared: f64 = (0..3)
                .map(|axis| {
                    let by = f64::from(pairs.offsets[pair][axis]) * self.blocks.step;
                    let d = by + f64::from(moves[other][axis]) - f64::from(moves[block][axis]);
                    d * d
                })
                .sum();
            let exponent = (self.scale * squared).max(-40.0) as f32;
            (
                other,
                f64::from(pairs.shares[pair]),
                f64::from(exp32(exponent)),
            )
        })
    }
}

impl Surroundings for Left<'_> {
    fn share(&self, block: usize) -> f64 {
        self.blocks.shares[block]
    }

    fn potentials(&mut self, is_left: &[bool], left: f64, _: f64) -> Option<Vec<f64>> {
        let sigma = SCALE * libm::cbrt(left.max(FEW)).recip();
        self.scale = -0.5 / (sigma * sigma);
        let mut density = vec![0.0f64; is_left.len()];
        for block in (0..is_left.len()).filter(|&block| is_left[block]) {
            for (other, share, near) in self.of(block) {
                if is_left[other] {
                    density[block] += share / self.share(block) * near;
                }
            }
        }
        Some(density)
    }

    fn leave(&self, block: usize, mut lose: impl FnMut(usize, f64)) {
        // The pair seen from the other point has the same frequency and distance.
        for (other, share, near) in self.of(block) {
            lose(other, share / self.share(other) * near);
        }
    }
}
