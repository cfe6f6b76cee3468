//! Points in space to measure, a cube of an unbounded set or one period of a twin, and their power over frequencies; that of
//! small windows shows a leftover local lattice.

use strew_core::{
    Error, Twin,
    space::{Region, SpaceSet, Table},
};

use crate::{
    measure::{Ring, Sample, Summary, rings_of, sums},
    numeric::SplitMix,
};

/// The power of a set, from its spectrum.
#[derive(Clone, Debug, PartialEq)]
pub struct SpacePower {
    pub summary: Summary,
    /// Shells of 0.04 from 0 to 1.6.
    pub rings: Vec<Ring>,
}

/// The highest frequency that is measured.
const HIGHEST: f64 = 1.6;
/// The width of a shell.
const SHELL: f64 = 0.04;

/// The powers of the modes of points with some weights, |Σ w exp(−2πi k·x)|² over `total`, after their frequencies; of those
/// with a component of more than `least`.
fn powers(set: &Sample<3>, weights: Option<&[f64]>, total: f64, least: i64) -> Vec<(f64, f64)> {
    let modes = (HIGHEST * set.side()).ceil() as usize;
    sums(set, weights, modes, |k, sum| {
        let squared: i64 = k.iter().map(|k| k * k).sum();
        let frequency = (squared as f64).sqrt() / set.side();
        let is_wanted = k > [0; 3] && frequency < HIGHEST && k.iter().any(|k| k.abs() > least);
        is_wanted.then(|| (frequency, sum.norm_sqr() / total.max(f64::MIN_POSITIVE)))
    })
}

/// The Hann window of the places of a window's points, and the sum of its squares.
fn taper(set: &Sample<3>) -> (Vec<f64>, f64) {
    let turn = 2.0 * std::f64::consts::PI;
    let weight = |p: [f64; 3]| p.map(|v| 1.0 - libm::cos(turn * v)).iter().product();
    let weights: Vec<f64> = set.turns().into_iter().map(weight).collect();
    let total = weights.iter().map(|w| w * w).sum();
    (weights, total)
}

impl SpacePower {
    /// The power of points: of a periodic set as it is, of a window of a larger set tapered.
    pub fn of(set: &Sample<3>) -> Self {
        let all = match set.is_periodic() {
            true => powers(set, None, set.points().len() as f64, 0),
            false => {
                let (weights, total) = taper(set);
                // A taper spreads the mean to the next modes.
                powers(set, Some(&weights), total, 1)
            }
        };
        let modes = || all.iter().copied();
        let rings = rings_of(modes(), SHELL, HIGHEST);
        Self {
            summary: Summary::of(modes(), &rings),
            rings,
        }
    }
}

/// The power in small windows, averaged over many places: a leftover local lattice shows as spots in the ring of the peak.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LocalPower {
    /// The mean power in the ring of the peak.
    pub peak: f64,
    /// The deviation of its frequencies, divided by that mean.
    pub deviation: f64,
    /// The greatest power of one of its frequencies.
    pub largest: f64,
}

/// The side of a small window, in mean spacings.
const SIDE: f64 = 12.0;
/// The width of a ring.
const RING: f64 = 0.08;
/// The peak lies beyond.
const PEAK_FROM: f64 = 0.64;
/// The side of the cube in which places are chosen, in mean spacings.
const AROUND: f64 = 400.0;

impl LocalPower {
    /// The power of cubes of 12 spacings at `places` places of a set, chosen by `seed` in a cube of 400 spacings from `at` on.
    /// `at` is in mean spacings of the whole set.
    pub fn of(set: &SpaceSet, at: [f64; 3], places: u32, seed: u64) -> Result<Self, Error> {
        let side = SIDE / libm::cbrt(set.placement().keep.get());
        let mut random = SplitMix::new(seed);
        let mut means: Vec<(f64, f64)> = Vec::new();
        for _ in 0..places {
            let at = at.map(|v| v + AROUND * random.next_f64());
            let points = window_set(set, at, side)?;
            let (weights, total) = taper(&points);
            let all = powers(&points, Some(&weights), total * f64::from(places), 0);
            means.resize(all.len(), (0.0, 0.0));
            for (mean, (frequency, power)) in means.iter_mut().zip(all) {
                *mean = (frequency, mean.1 + power);
            }
        }
        let rings = rings_of(means.into_iter(), RING, HIGHEST);
        let outer = rings.iter().filter(|ring| ring.nu > PEAK_FROM);
        let peak = outer.max_by(|a, b| a.power.total_cmp(&b.power));
        Ok(peak.map_or(Self::default(), |ring| Self {
            peak: ring.power,
            deviation: libm::pow(10.0, ring.anisotropy_db / 20.0),
            largest: ring.tallest,
        }))
    }
}

/// The points of a cube of a set. `at`, its least corner, and `side` are in mean spacings of the whole set, as if none had
/// been left out by [`keep`](SpaceSet::keep).
pub fn window_set(set: &SpaceSet, at: [f64; 3], side: f64) -> Result<Sample<3>, Error> {
    let placement = set.placement();
    let spacing = placement.spacing.get();
    let min = at.map(|v| v * spacing);
    let plan = set.within(Region::new(min, at.map(|v| (v + side) * spacing))?)?;
    let place = |p: [f64; 3]| [0, 1, 2].map(|i| p[i] / spacing - at[i]);
    let points = plan.iter().map(|point| place(point.at())).collect();
    Ok(Sample::window(side, placement.keep.get(), points))
}

/// One period of a twin of a table's map, or `None` if it is none, or has points on a sublattice only (see
/// [`is_uniform_in_space`]).
pub fn twin_set(table: &Table, twin: Twin) -> Option<Sample<3>> {
    let (map, n) = (table.map(), table.map().intervals());
    if !is_uniform_in_space(twin) {
        return None;
    }
    // Along each axis a coordinate and the parity of the sum of the others decide the block, as in the plane.
    let mut blocks = [
        vec![None; twin.period() as usize],
        vec![None; twin.period() as usize],
    ];
    for site in twin.sites(map)? {
        blocks[site.y as usize % 2][site.x as usize] = Some(site.block_x as usize);
    }
    let members = |own: usize, others: usize| -> Vec<(usize, usize)> {
        let all = blocks[others].iter().enumerate();
        let own = all.filter(|(v, _)| v % 2 == own);
        own.filter_map(|(v, block)| Some((v, (*block)?))).collect()
    };
    let mut points = Vec::with_capacity(twin.t().pow(3) as usize);
    for class in 0..8usize {
        let parities = [class & 1, class >> 1 & 1, class >> 2];
        let [xs, ys, zs] = [0, 1, 2].map(|axis| {
            let own = parities[axis];
            members(own, (parities.iter().sum::<usize>() - own) % 2)
        });
        for &(z, k) in &zs {
            for &(y, j) in &ys {
                for &(x, i) in &xs {
                    let vector = table.vectors()[(k * n + j) * n + i];
                    let at = [x, y, z];
                    let by = vector.map(|v| f64::from(v) / 4096.0);
                    points.push([0, 1, 2].map(|axis| at[axis] as f64 + by[axis]));
                }
            }
        }
    }
    Some(Sample::torus(twin.period() as f64, points))
}

/// Whether a period of a twin has each triple of indices in space once: t = p − q is odd, and q is even. The points of
/// other twins lie on a sublattice of indices, so they do not show what a table is worth.
pub const fn is_uniform_in_space(twin: Twin) -> bool {
    !twin.t().is_multiple_of(2) && twin.q().is_multiple_of(2)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use strew_core::{Map, table::Provenance};

    use super::*;

    #[test]
    fn white_noise_has_power_one_and_a_lattice_has_peaks() {
        let noise = SplitMix::new(1).places(8000, 1.0);
        let window = Sample::window(1.0, 8000.0, noise.clone());
        for set in [Sample::torus(1.0, noise), window] {
            let summary = SpacePower::of(&set).summary;
            assert!((summary.low_power - 1.0).abs() < 0.1, "{summary:?}");
            assert!(summary.anisotropy_db.abs() < 0.5, "{summary:?}");
        }
        let lattice = (0..1000).map(|i| [i % 10, i / 10 % 10, i / 100].map(f64::from));
        let power = SpacePower::of(&Sample::torus(10.0, lattice.collect()));
        assert!(power.summary.low_power < 1e-6, "{power:?}");
        // At 1 and √2, and nowhere else.
        for ring in &power.rings {
            let is_peak = [1.02, 1.42].iter().any(|v| (ring.nu - v).abs() < 0.02);
            assert_eq!(ring.power > 1e-6, is_peak, "{ring:?}");
            assert!(!is_peak || ring.anisotropy_db > 10.0, "{ring:?}");
        }
    }

    #[test]
    fn a_twin_has_the_points_that_the_definition_has() {
        let map = Map::new("(5-sqrt(3))/2".parse().expect("valid"), 6).expect("small");
        let n = map.intervals();
        let mut random = SplitMix::new(3);
        let mut next = || (random.next_u64() % 8000) as i16 - 4000;
        let vectors = (0..n.pow(3)).map(|_| [next(), next(), next()]).collect();
        let table = Table::new(map, "mine", vectors, Provenance::default(), None).expect("valid");
        let all = table.map().twins();
        let twin = all
            .into_iter()
            .find(|t| is_uniform_in_space(*t) && t.t() > 6);
        let twin = twin.expect("endless");
        let points = twin_set(&table, twin).expect("a twin");
        assert_eq!(points.points().len() as u64, twin.t().pow(3));
        // {(αv + others)/2}, in units of 1/2q; its block is the rank of the index among all thresholds.
        let (p, q, t) = (twin.p() as i64, twin.q() as i64, twin.t() as i64);
        let index = |v: i64, others: i64| (p * v + q * others).rem_euclid(2 * q);
        let r = i64::from(table.map().radius());
        let mut bounds: Vec<i64> = (-r - 1..=r)
            .flat_map(|k| [0, 1].map(|b| index(-k, b)))
            .filter(|bound| (1..t).contains(bound))
            .collect();
        bounds.sort_unstable();
        bounds.dedup();
        assert_eq!(bounds.len() + 1, n);
        let block = |index: i64| bounds.iter().filter(|bound| **bound <= index).count();
        let mut expected = BTreeMap::new();
        // Off the middles between two keys, where rounding would decide.
        let key = |p: [f64; 3]| p.map(|v| (v * 1e9 + 0.3137) as i64 % 1_000_000_000);
        for z in 0..2 * q {
            for y in 0..2 * q {
                for x in 0..2 * q {
                    let d = [index(x, y + z), index(y, x + z), index(z, x + y)];
                    if d.iter().all(|d| *d < t) {
                        let [i, j, k] = d.map(block);
                        let v = table.vectors()[(k * n + j) * n + i];
                        let at = [0, 1, 2].map(|axis| {
                            let place = [x, y, z][axis] as f64 + f64::from(v[axis]) / 4096.0;
                            (place / (2 * q) as f64).rem_euclid(1.0)
                        });
                        *expected.entry(key(at)).or_insert(0) += 1;
                    }
                }
            }
        }
        let mut found = BTreeMap::new();
        for point in points.points() {
            let turns = point.map(|v| (v / points.side()).rem_euclid(1.0));
            *found.entry(key(turns)).or_insert(0) += 1;
        }
        assert_eq!(found, expected);
    }
}
