//! The power of a set over frequencies, in shells, and that of small windows, which shows a leftover local lattice.

use strew_core::{Error, space::SpaceSet};

use super::{points::SpacePoints, transform::Sums};
use crate::numeric::SplitMix;

/// The power of a set, from its spectrum.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SpacePower {
    /// Mean power at 0 < ν < 0.5.
    pub low: f64,
    /// The greatest mean power of a shell of the spectrum.
    pub peak: f64,
    /// The middle of that shell.
    pub peak_at: f64,
    /// The median of the shells' anisotropy beyond ν 0.8, in decibels.
    pub anisotropy: f64,
    /// Shells of 0.04 from 0 to 1.6.
    pub shells: Vec<Shell>,
}

/// The highest frequency that is measured.
pub(super) const HIGHEST: f64 = 1.6;
/// The width of a shell.
const SHELL: f64 = 0.04;
/// The end of the band of low power.
const LOW_END: f64 = 0.5;
/// Where the shells of the anisotropy begin.
const UNEVEN_FROM: f64 = 0.8;

impl SpacePower {
    /// The power of points: of a periodic set as it is, of a window of a larger set tapered.
    #[must_use]
    pub fn of(set: &SpacePoints) -> Self {
        let (side, taper) = (set.side(), set.taper());
        let total = match &taper {
            Some(weights) => weights.iter().map(|w| w * w).sum(),
            None => set.points().len() as f64,
        };
        let sums = Sums::new(
            set.points(),
            taper.as_deref(),
            (HIGHEST * side).ceil() as usize,
        );
        // A taper spreads the mean to the next frequencies.
        let spread = if set.is_torus() { 0 } else { 1 };
        let mut shells = Shells::new(SHELL, HIGHEST);
        let (mut low, mut number) = (0.0, 0.0);
        for (k, [re, im]) in sums.each() {
            if k.iter().all(|k| k.abs() <= spread) {
                continue;
            }
            let squared: i64 = k.iter().map(|k| k * k).sum();
            let frequency = (squared as f64).sqrt() / side;
            let (re, im) = (f64::from(re), f64::from(im));
            let power = (re * re + im * im) / total;
            if frequency < LOW_END {
                low += power;
                number += 1.0;
            }
            shells.add(frequency, power);
        }
        let shells: Vec<Shell> = shells.each().collect();
        let peak = shells.iter().max_by(|a, b| a.power.total_cmp(&b.power));
        let outer = shells.iter().filter(|shell| shell.frequency > UNEVEN_FROM);
        let mut uneven: Vec<f64> = outer.map(Shell::anisotropy).collect();
        uneven.sort_by(f64::total_cmp);
        Self {
            low: low / f64::max(number, 1.0),
            peak: peak.map_or(0.0, |shell| shell.power),
            peak_at: peak.map_or(0.0, |shell| shell.frequency),
            anisotropy: uneven.get(uneven.len() / 2).copied().unwrap_or(0.0),
            shells,
        }
    }
}

/// The power of the frequencies in a shell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shell {
    /// The middle of the shell.
    pub frequency: f64,
    /// The mean power.
    pub power: f64,
    /// The deviation over the mean.
    pub deviation: f64,
    /// The greatest power.
    pub largest: f64,
}

impl Shell {
    /// The anisotropy 10·log10(variance / mean²), in decibels: 0 for random phases.
    #[must_use]
    pub fn anisotropy(&self) -> f64 {
        20.0 * libm::log10(self.deviation.max(1e-9))
    }
}

/// The sums over shells of a spectrum.
pub(super) struct Shells {
    width: f64,
    sums: Vec<[f64; 4]>,
}

impl Shells {
    /// Shells of a width, from 0 to `highest`.
    pub(super) fn new(width: f64, highest: f64) -> Self {
        let count = (highest / width + 0.5) as usize;
        Self {
            width,
            sums: vec![[0.0; 4]; count],
        }
    }

    pub(super) fn add(&mut self, frequency: f64, power: f64) {
        if let Some(sum) = self.sums.get_mut((frequency / self.width) as usize) {
            let [number, total, squares, largest] = *sum;
            *sum = [
                number + 1.0,
                total + power,
                squares + power * power,
                largest.max(power),
            ];
        }
    }

    /// The shells that have frequencies.
    pub(super) fn each(&self) -> impl Iterator<Item = Shell> + '_ {
        let all = self.sums.iter().enumerate();
        let filled = all.filter(|(_, sum)| sum[0] > 0.0);
        filled.map(|(i, &[number, total, squares, largest])| {
            let mean = total / number;
            let variance = (squares / number - mean * mean).max(0.0);
            Shell {
                frequency: (i as f64 + 0.5) * self.width,
                power: mean,
                deviation: variance.sqrt() / mean.max(1e-12),
                largest,
            }
        })
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
        let modes = (HIGHEST * SIDE).ceil() as usize;
        let mut random = SplitMix::new(seed);
        let mut means: Vec<f64> = Vec::new();
        let mut frequencies = Vec::new();
        for _ in 0..places {
            let at = at.map(|v| v + AROUND * random.next_f64());
            let points = SpacePoints::of_window(set, at, side)?;
            let weights = points.taper().unwrap_or_default();
            let total = weights.iter().map(|w| w * w).sum::<f64>() * f64::from(places);
            let sums = Sums::new(points.points(), Some(&weights), modes);
            if means.is_empty() {
                means = vec![0.0; sums.each().count()];
                frequencies.extend(sums.each().map(|(k, _)| {
                    let squared: i64 = k.iter().map(|k| k * k).sum();
                    (squared as f64).sqrt() / SIDE
                }));
            }
            for (mean, (_, [re, im])) in means.iter_mut().zip(sums.each()) {
                let (re, im) = (f64::from(re), f64::from(im));
                *mean += (re * re + im * im) / total.max(f64::MIN_POSITIVE);
            }
        }
        let mut shells = Shells::new(RING, HIGHEST);
        for (frequency, power) in frequencies.into_iter().zip(means) {
            shells.add(frequency, power);
        }
        let rings = shells.each().filter(|ring| ring.frequency > PEAK_FROM);
        let peak = rings.max_by(|a, b| a.power.total_cmp(&b.power));
        Ok(peak.map_or(Self::default(), |ring| Self {
            peak: ring.power,
            deviation: ring.deviation,
            largest: ring.largest,
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_noise_has_power_one_and_a_lattice_has_peaks() {
        let mut random = SplitMix::new(1);
        let mut next = || random.next_f64();
        let noise: Vec<[f64; 3]> = (0..8000).map(|_| [next(), next(), next()]).collect();
        for is_torus in [true, false] {
            let power = SpacePower::of(&SpacePoints::new(noise.clone(), is_torus));
            assert!((power.low - 1.0).abs() < 0.1, "{power:?}");
            assert!(power.anisotropy.abs() < 0.5, "{power:?}");
        }
        let lattice =
            (0..1000).map(|i| [i % 10, i / 10 % 10, i / 100].map(|v| f64::from(v) / 10.0));
        let power = SpacePower::of(&SpacePoints::new(lattice.collect(), true));
        assert!(power.low < 1e-6, "{power:?}");
        // At 1 and √2, and nowhere else.
        for shell in &power.shells {
            let is_peak = [1.02, 1.42]
                .iter()
                .any(|v| (shell.frequency - v).abs() < 0.01);
            assert_eq!(shell.power > 1e-6, is_peak, "{shell:?}");
            assert!(!is_peak || shell.anisotropy() > 10.0, "{shell:?}");
        }
    }
}
