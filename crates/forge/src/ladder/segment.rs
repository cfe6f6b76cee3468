//! The energy of the sets along one segment of a ladder.

use super::climb::{Blocks, Climb};
use crate::numeric::exp32;

/// Lists have whole groups of this many pairs, so that the compiler can vectorize sums over them. The
/// number also fixes the order of summation, so ladders depend on it.
const LANES: usize = 8;
/// The reach of lists beyond the cut-off, in mean spacings of the thinned set.
const SKIN: f64 = 0.4;

/// The energy of a pair: exp(−d²/2σ²) + strength·max(0, 1 − d²/guard²)³, in mean spacings of the thinned
/// set.
#[derive(Clone, Copy, Debug)]
pub(super) struct Energy {
    pub(super) sigma: f64,
    pub(super) guard: f64,
    pub(super) strength: f64,
}

impl Energy {
    /// The cut-off of the Gaussian, in σ.
    const CUTOFF: f64 = 4.6;
    /// The cut-off of the energy, in mean spacings of the thinned set.
    pub(super) fn cutoff(&self) -> f64 {
        Self::CUTOFF * self.sigma
    }
}

/// A pair of positions that may come near each other on a segment.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pair {
    pub(super) to: u32,
    pub(super) i: i16,
    pub(super) j: i16,
    pub(super) weight: f32,
}

/// The neighbors of each position that is left at the start of a segment.
pub(super) struct Lists {
    starts: Vec<usize>,
    pairs: Vec<Pair>,
}

impl Lists {
    /// The pairs that come within `range`, in mean spacings of the set at the segment's end.
    pub(super) fn new(blocks: &Blocks, climb: &Climb, segment: usize, range: f64) -> Self {
        let count = climb.counts[segment + 1];
        let spacing = 1.0 / climb.shares[segment + 1].sqrt();
        let range = (range + SKIN) * spacing;
        let ends = [&climb.moves[segment], &climb.moves[segment + 1]];
        let longest = ends
            .iter()
            .flat_map(|level| &level[..count])
            .map(|m| m[0] * m[0] + m[1] * m[1])
            .fold(0.0, f64::max)
            .sqrt();
        let scale = blocks.ground.scale();
        let mut lists = Self {
            starts: vec![0],
            pairs: Vec::new(),
        };
        for own in 0..count {
            let block = blocks.at[own] as usize;
            let [a, b] = ends.map(|level| level[own]);
            let farther = |v: [f64; 2]| (v[0] * v[0] + v[1] * v[1]).sqrt();
            let reach = range + longest + farther(a).max(farther(b));
            let alive = |to: usize| (blocks.position[to] as usize) < count;
            blocks.ground.neighbors(block, reach, alive, |neighbor| {
                let to = blocks.position[neighbor.to as usize];
                let [c, d] = ends.map(|level| level[to as usize]);
                let [x, y] = [neighbor.i, neighbor.j].map(|v| scale * f64::from(v));
                let from = [x + c[0] - a[0], y + c[1] - a[1]];
                let to_end = [x + d[0] - b[0], y + d[1] - b[1]];
                let middle = [0, 1].map(|axis| 0.5 * (from[axis] + to_end[axis]));
                let is_near = |v: [f64; 2]| v[0] * v[0] + v[1] * v[1] < range * range;
                if is_near(from) || is_near(middle) || is_near(to_end) {
                    lists.pairs.push(Pair {
                        to,
                        i: neighbor.i,
                        j: neighbor.j,
                        weight: neighbor.weight,
                    });
                }
            });
            let filler = Pair {
                to: own as u32,
                i: 0,
                j: 0,
                weight: 0.0,
            };
            let start = lists.starts[own];
            let whole = (lists.pairs.len() - start).next_multiple_of(LANES);
            lists.pairs.resize(start + whole, filler);
            lists.starts.push(lists.pairs.len());
        }
        lists
    }

    /// The pairs of a position, with some of weight 0.
    pub(super) fn of(&self, position: usize) -> &[Pair] {
        &self.pairs[self.starts[position]..self.starts[position + 1]]
    }
}

/// The slopes of the energy over the vectors of a segment's two levels, and the weights they count with.
pub(super) struct Slopes {
    pub(super) energy: f64,
    /// For the level above and the level below, by position: two slopes and a weight.
    pub(super) of: [Vec<[f64; 3]>; 2],
}

/// The mean energy of a segment's sets at some parts of the way, and its slopes.
pub(super) fn slopes(
    blocks: &Blocks,
    climb: &Climb,
    segment: usize,
    lists: &Lists,
    energy: &Energy,
    ways: &[f64],
) -> Slopes {
    let count = climb.counts[segment + 1];
    let mut all = Slopes {
        energy: 0.0,
        of: [vec![[0.0; 3]; count], vec![[0.0; 3]; count]],
    };
    let mut places = vec![[0f32; 2]; count];
    let mut weights = vec![0f32; count];
    for &way in ways {
        let share = climb.share_at(segment, way);
        let alive = blocks.alive(share);
        for position in 0..count {
            places[position] = climb.vector(segment, position, way).map(|v| v as f32);
            weights[position] = blocks.left(position, share) as f32;
        }
        let spacing = 1.0 / share.sqrt();
        let law = Law::new(energy, spacing);
        let scale = blocks.ground.scale() as f32;
        let mut total = 0.0;
        for own in 0..alive {
            let [value, x, y] = law.sum(lists.of(own), &places, &weights, scale, own);
            let weight = f64::from(weights[own]);
            total += blocks.ground.share(blocks.at[own] as usize) * weight * value;
            let part = climb.part(segment, own, way);
            for (level, part) in [1.0 - part, part].into_iter().enumerate() {
                let by = weight * part;
                let sum = &mut all.of[level][own];
                // Slopes per unit of local spacing, so that one rate serves all levels.
                let squared = spacing * spacing;
                *sum = [
                    sum[0] + by * squared * x,
                    sum[1] + by * squared * y,
                    sum[2] + by,
                ];
            }
        }
        all.energy += 0.5 * total / share / ways.len() as f64;
    }
    all
}

/// The energy at one spacing, in single precision.
struct Law {
    rate: f32,
    cutoff_squared: f32,
    guard_rate: f32,
    strength: f32,
}

impl Law {
    fn new(energy: &Energy, spacing: f64) -> Self {
        let square = |v: f64| v * spacing * v * spacing;
        Self {
            rate: (-0.5 / square(energy.sigma)) as f32,
            cutoff_squared: square(energy.cutoff()) as f32,
            guard_rate: (1.0 / square(energy.guard)) as f32,
            strength: energy.strength as f32,
        }
    }

    /// The energy of an instance of a position, and its slopes.
    fn sum(
        &self,
        list: &[Pair],
        places: &[[f32; 2]],
        weights: &[f32],
        scale: f32,
        own: usize,
    ) -> [f64; 3] {
        let own = places[own];
        let (mut energy, mut gx, mut gy) = ([0f32; LANES], [0f32; LANES], [0f32; LANES]);
        for group in list.chunks_exact(LANES) {
            let (mut dx, mut dy, mut weight) = ([0f32; LANES], [0f32; LANES], [0f32; LANES]);
            for (lane, pair) in group.iter().enumerate() {
                let to = places[pair.to as usize];
                dx[lane] = own[0] - (scale * f32::from(pair.i) + to[0]);
                dy[lane] = own[1] - (scale * f32::from(pair.j) + to[1]);
                weight[lane] = pair.weight * weights[pair.to as usize];
            }
            for lane in 0..LANES {
                let squared = dx[lane] * dx[lane] + dy[lane] * dy[lane];
                let x = (self.rate * squared).max(-80.0);
                let value = if squared < self.cutoff_squared {
                    exp32(x)
                } else {
                    0.0
                };
                let depth = (1.0 - squared * self.guard_rate).max(0.0);
                let pressed = self.strength * depth * depth;
                energy[lane] += weight[lane] * (value + pressed * depth);
                let slope =
                    weight[lane] * (2.0 * self.rate * value - 6.0 * self.guard_rate * pressed);
                gx[lane] += slope * dx[lane];
                gy[lane] += slope * dy[lane];
            }
        }
        [energy, gx, gy].map(|lanes| lanes.iter().map(|&v| f64::from(v)).sum())
    }
}
