//! A radial power curve as an energy in table space: no point set, only frequencies of pairs.
//!
//! The histogram of distances that decides the radial power (see [`Rings`]) comes exactly from the
//! frequencies of block pairs (see [`Pairs`]): of the unbounded pattern, not of a sample of it. One
//! evaluation is a pass over the pairs for the histogram, a product with a table of J₀, and a second
//! pass with the resulting force, a function of the distance alone.
//!
//! A map serves an interval of α, on which the frequencies of far pairs change altogether: blocks
//! shrink to nothing, others meet. A table that follows its curve at one α alone misses it at the
//! interval's ends, where some twins lie. So the error is taken of several α apart, never of the mean
//! of their histograms, in which opposite errors would cancel.

use rayon::prelude::*;
use strew_core::Map;

use super::{
    Objective, Pairs,
    pairs::{CHUNK, LANES, Pair},
    rings::{BINS, RINGS, Rings},
};
use crate::{curve::Target, energy::PairEnergy};

/// The cost of the squared excess of a vector's length over the leash.
const PULL: f64 = 0.3;

/// What a curve's error costs; see [`Radial`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RadialWeights {
    /// Pairs up to this distance count, in mean spacings. Resolution is about 1/reach; cost grows
    /// as its square or faster.
    pub reach: f64,
    /// The largest ν that is fitted.
    pub nu_max: f64,
    /// The cost of the squared error, per unit of ν; where the target T is above 1, over T: between
    /// the absolute and the relative error.
    pub fit: f64,
    /// The cost of power as such, per unit area of the (νx, νy) plane, where the target is 0; more
    /// at the lowest ν. The square alone would lose its slope long before such power is gone.
    pub quiet: f64,
    /// Vectors longer than this, in mean spacings, are pulled back: what samples the set looks that
    /// far around every region.
    pub leash: f64,
    /// Power as such costs less and less over this width in ν before the target leaves 0.
    pub edge: f64,
}

/// The error of a radial power curve: Σ fit·(P − T)² + quiet·P over rings, the mean over patterns.
pub struct Radial {
    patterns: Vec<One>,
    masses: Vec<f64>,
    leash: f64,
    rings: Rings,
}

/// The map at one α.
struct One {
    pairs: Pairs<Reach>,
    /// Its own mean spacings per mean spacing of the table.
    stretch: f64,
    share: f64,
}

/// No energy of its own; it tells how far pairs matter.
pub struct Reach(pub f64);

impl PairEnergy for Reach {
    fn cutoff(&self) -> f64 {
        self.0
    }

    fn pair(&self, _: f64) -> (f64, f64) {
        (0.0, 0.0)
    }
}

impl Radial {
    /// The error of `target`, the mean over the patterns of `maps` with their shares, which sum
    /// to 1. They are one map for slightly different α; the first one's mean spacing is the unit.
    #[must_use]
    pub fn new(maps: &[(Map, f64)], target: &Target, weights: &RadialWeights) -> Self {
        let scale = maps[0].0.alpha().set_side_f64();
        let one = |(map, share): &(Map, f64)| One {
            pairs: Pairs::new(Reach(weights.reach), std::slice::from_ref(map), scale),
            stretch: map.alpha().set_side_f64() / scale,
            share: *share,
        };
        let patterns: Vec<One> = maps.iter().map(one).collect();
        let mut masses = vec![0.0; patterns[0].pairs.masses().len()];
        for one in &patterns {
            for (sum, mass) in masses.iter_mut().zip(one.pairs.masses()) {
                *sum += one.share * mass;
            }
        }
        Self {
            patterns,
            masses,
            leash: weights.leash,
            rings: Rings::new(target, weights),
        }
    }

    /// The blurred target and the blurred power for the given moves, of the first map:
    /// (ν, target, power).
    pub fn curves(&mut self, moves: &[[f64; 2]]) -> Vec<[f64; 3]> {
        let one = &mut self.patterns[0];
        one.pairs.refresh(moves);
        let power = self.rings.power(&one.histogram(&self.rings, moves));
        let nus = (0..power.len()).map(|ring| ring as f64 / RINGS);
        nus.zip(self.rings.targets())
            .zip(power)
            .map(|((nu, target), power)| [nu, target, power])
            .collect()
    }

    /// The cost of vectors that are too long; adds its slope.
    fn pull(&self, moves: &[[f64; 2]], gradient: &mut [[f64; 2]]) -> f64 {
        let mut cost = 0.0;
        for ((m, slope), mass) in moves.iter().zip(gradient).zip(&self.masses) {
            let length = (m[0] * m[0] + m[1] * m[1]).sqrt();
            let excess = length - self.leash;
            if excess > 0.0 {
                cost += mass * PULL * excess * excess;
                let factor = 2.0 * PULL * excess / length;
                slope[0] += factor * m[0];
                slope[1] += factor * m[1];
            }
        }
        cost
    }
}

impl One {
    /// Neighbors per point and bin, in excess of a uniform density.
    fn histogram(&self, rings: &Rings, moves: &[[f64; 2]]) -> Vec<f64> {
        let masses = self.pairs.masses();
        let partial: Vec<Vec<f64>> = moves
            .par_chunks(CHUNK)
            .enumerate()
            .map(|(chunk, own)| {
                let mut bins = vec![0.0; rings.bins() + 1];
                for (at, &own) in own.iter().enumerate() {
                    let block = chunk * CHUNK + at;
                    let list = self.pairs.list(block);
                    // A pair stands in the lists of both its blocks, with opposite offsets.
                    let half = list.partition_point(|pair| (pair.j, pair.i) < (0, 0));
                    let mass = 2.0 * masses[block];
                    self.each_pair(
                        &list[half..],
                        own,
                        moves,
                        rings.bins(),
                        |weight, at, _, _| {
                            let (bin, share) = (at as usize, at - (at as usize) as f64);
                            let weight = weight * mass;
                            bins[bin] += weight * (1.0 - share);
                            bins[bin + 1] += weight * share;
                        },
                    );
                }
                bins
            })
            .collect();
        let mut sum = rings.empty();
        for bins in partial {
            sum.iter_mut().zip(bins).for_each(|(sum, bin)| *sum += bin);
        }
        sum
    }

    /// Adds the slope under a force, by bin, to that of all blocks, whose mean masses are given.
    fn add_slope(&self, force: &[f64], moves: &[[f64; 2]], mean: &[f64], to: &mut [[f64; 2]]) {
        let masses = self.pairs.masses();
        to.par_chunks_mut(CHUNK)
            .enumerate()
            .for_each(|(chunk, out)| {
                for (at, out) in out.iter_mut().enumerate() {
                    let block = chunk * CHUNK + at;
                    let mut slope = [0.0; 2];
                    let list = self.pairs.list(block);
                    self.each_pair(
                        list,
                        moves[block],
                        moves,
                        force.len(),
                        |weight, at, dx, dy| {
                            let along = weight * force[at as usize] / at.max(1e-6);
                            slope[0] += along * dx;
                            slope[1] += along * dy;
                        },
                    );
                    let part = self.share * masses[block] / mean[block];
                    // The distance is `stretch` times that of the moves.
                    let part = part * BINS * self.stretch * self.stretch;
                    out[0] += part * slope[0];
                    out[1] += part * slope[1];
                }
            });
    }

    /// Calls `visit` with the weight of each pair of a point, its distance in bins, and the vector
    /// from the neighbor to the point. Whatever is beyond the last bin is told to be in it, where
    /// nothing counts any more.
    #[inline]
    fn each_pair(
        &self,
        list: &[Pair],
        own: [f64; 2],
        moves: &[[f64; 2]],
        bins: usize,
        mut visit: impl FnMut(f64, f64, f64, f64),
    ) {
        let scale = self.pairs.scale();
        let (per_spacing, last) = (BINS * self.stretch, (bins - 1) as f64);
        let apart = |pair: &Pair| {
            let to = moves[pair.to as usize];
            let dx = own[0] - (scale * f64::from(pair.i) + to[0]);
            let dy = own[1] - (scale * f64::from(pair.j) + to[1]);
            [dx, dy]
        };
        let distance = |[dx, dy]: [f64; 2]| ((dx * dx + dy * dy).sqrt() * per_spacing).min(last);
        // In groups, so that the compiler can vectorize.
        let (groups, rest) = list.as_chunks::<LANES>();
        for group in groups {
            let apart = group.each_ref().map(apart);
            let at = apart.map(distance);
            for ((pair, at), [dx, dy]) in group.iter().zip(at).zip(apart) {
                visit(f64::from(pair.weight), at, dx, dy);
            }
        }
        for pair in rest {
            let [dx, dy] = apart(pair);
            visit(f64::from(pair.weight), distance([dx, dy]), dx, dy);
        }
    }
}

impl Objective for Radial {
    fn masses(&self) -> &[f64] {
        &self.masses
    }

    fn evaluate(&mut self, moves: &[[f64; 2]], gradient: &mut [[f64; 2]]) -> f64 {
        gradient.fill([0.0; 2]);
        let mut cost = 0.0;
        for one in &mut self.patterns {
            one.pairs.refresh(moves);
            let power = self.rings.power(&one.histogram(&self.rings, moves));
            cost += one.share * self.rings.cost(&power);
            let force = self.rings.force(&power);
            one.add_slope(&force, moves, &self.masses, gradient);
        }
        cost + self.pull(moves, gradient)
    }

    /// The patterns make their lists for the same moves.
    fn prepared_for(&self) -> &[[f64; 2]] {
        self.patterns[0].pairs.prepared_for()
    }

    fn prepare_for(&mut self, moves: &[[f64; 2]]) {
        for one in &mut self.patterns {
            one.pairs.prepare_for(moves);
        }
    }

    fn pairs(&self) -> usize {
        self.patterns.iter().map(|one| one.pairs.pairs()).sum()
    }
}

#[cfg(test)]
mod tests {
    use strew_core::{Alpha, Map, Table, Twin, table::Provenance, table::from_grid_units};

    use super::*;
    use crate::{
        measure::{Spectrum, twin_set},
        optimize::jitter,
    };

    const WEIGHTS: RadialWeights = RadialWeights {
        reach: 9.0,
        nu_max: 2.0,
        fit: 1.0,
        quiet: 0.5,
        leash: 0.5,
        edge: 0.1,
    };

    fn step() -> Target {
        "0 0\n0.5 0\n0.5 1".parse().expect("valid")
    }

    fn map() -> Map {
        Map::new("(5-sqrt(3))/2".parse().expect("valid"), 20).expect("small")
    }

    fn objective(map: &Map) -> Radial {
        Radial::new(&[(map.clone(), 1.0)], &step(), &WEIGHTS)
    }

    #[test]
    fn its_gradient_is_that_of_its_energy() {
        let map = map();
        let far = Alpha::from_fraction(265 + 419, 419).expect("in range");
        let far = Map::new(far, map.radius()).expect("small");
        let blocks = map.intervals() * map.intervals();
        assert_eq!(far.intervals(), map.intervals());
        for maps in [vec![(map.clone(), 1.0)], vec![(map, 0.6), (far, 0.4)]] {
            let mut radial = Radial::new(&maps, &step(), &WEIGHTS);
            let moves = jitter(blocks, 0.8, 3);
            let mut gradient = vec![[0.0; 2]; blocks];
            radial.evaluate(&moves, &mut gradient);
            for block in [7, 200, 431] {
                for axis in 0..2 {
                    let mut at = |by: f64| {
                        let mut moves = moves.clone();
                        moves[block][axis] += by;
                        radial.evaluate(&moves, &mut vec![[0.0; 2]; blocks])
                    };
                    let numeric = (at(1e-6) - at(-1e-6)) / 2e-6;
                    let found = gradient[block][axis] * radial.masses()[block];
                    assert!(
                        (found - numeric).abs() < 1e-4 * numeric.abs().max(1e-4),
                        "{found} {numeric}"
                    );
                }
            }
        }
    }

    #[test]
    fn its_power_is_that_of_the_points() {
        let map = map();
        let scale = map.alpha().set_side_f64();
        let moves = jitter(map.intervals() * map.intervals(), 1.5, 5);
        let curves = objective(&map).curves(&moves);
        let grid = |v: f64| from_grid_units(v / scale).expect("short");
        let vectors = moves.iter().map(|m| m.map(grid)).collect();
        let table = Table::new(map, "some", vectors, Provenance::default()).expect("valid");
        let twin = Twin::new(265 + 418, 418).expect("coprime");
        let set = twin_set(&table, twin).expect("a twin");
        let rings = Spectrum::of_torus(&set, 2.1).rings(0.1);
        // Both blurred to about the same width, where neither the mean density nor the end shows.
        for ring in rings.iter().filter(|r| (0.3..1.9).contains(&r.nu)) {
            let near = curves.iter().filter(|c| (c[0] - ring.nu).abs() < 0.05);
            let (sum, count) = near.fold((0.0, 0.0), |(s, n), c| (s + c[2], n + 1.0));
            let found: f64 = sum / count;
            assert!(
                (found - ring.power).abs() < 0.15 * ring.power.max(0.5),
                "{ring:?} {found}"
            );
        }
    }
}
