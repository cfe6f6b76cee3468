//! The power of a set over frequencies, in shells.

use super::{
    points::SpacePoints,
    shells::{Shell, Shells},
    transform::Sums,
};

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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::SplitMix;

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
