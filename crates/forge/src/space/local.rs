//! The power of a set over frequencies, and that of small windows, which shows a leftover local lattice.

use strew_core::{Error, space::SpaceSet};

use super::points::window_set;
use crate::{
    measure::{Ring, Sample, Summary, rings_of, waves},
    numeric::SplitMix,
};

/// The power of a set, from its spectrum.
#[derive(Clone, Debug, PartialEq)]
pub struct SpacePower {
    /// The spectrum in figures.
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
    waves(set, weights, modes, |k, [re, im]| {
        let squared: i64 = k.iter().map(|k| k * k).sum();
        let frequency = (squared as f64).sqrt() / set.side();
        let is_wanted = frequency < HIGHEST && k.iter().any(|k| k.abs() > least);
        let power = (re * re + im * im) / total.max(f64::MIN_POSITIVE);
        is_wanted.then_some((frequency, power))
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
    #[must_use]
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
    ///
    /// # Errors
    /// As [`SpaceSet::within`].
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

#[cfg(test)]
mod tests {
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
}
