//! Spectra of thresholded masks: how even the pixels are that are on at a level.

use rustfft::{FftPlanner, num_complex::Complex};

use super::Mask;
use crate::measure::{Summary, ring_sums};

/// The spectrum of the pixels of a mask that are on at a level.
#[derive(Clone, Debug, PartialEq)]
pub struct LevelSpectrum {
    /// The share of pixels that are on.
    pub level: f64,
    /// The mean power over 0 < ν < 0.5, ν in units of √N of the N pixels that are on, or off if those are fewer.
    /// Pixels in a random order have 1.
    pub low_power: f64,
    /// The tallest single peak.
    pub peak: f64,
    /// The mean power over rings of width 0.05 of ν from 0 up to 2, or to the corner of the spectrum.
    pub rings: Vec<f64>,
}

impl LevelSpectrum {
    /// The width of a ring.
    pub const RING: f64 = 0.05;
    /// The number of rings.
    const RINGS: usize = 40;
}

impl Mask {
    /// The spectrum of the pixels whose rank is below a share of all, from 0 to 1: the mean over frequencies of
    /// |Σ (on − share) exp(−2πi k·x)|² ÷ (size²·share·(1 − share)).
    #[must_use]
    pub fn spectrum(&self, level: f64) -> LevelSpectrum {
        let size = self.size as usize;
        let pixels = size * size;
        let on = ((level.clamp(0.0, 1.0) * pixels as f64).round() as usize).clamp(1, pixels - 1);
        let share = on as f64 / pixels as f64;
        let values = self.ranks.iter().map(|&rank| {
            let is_on = f64::from(u8::from((rank as usize) < on));
            Complex::new(is_on - share, 0.0)
        });
        let mut values: Vec<Complex<f64>> = values.collect();
        let fft = FftPlanner::new().plan_fft_forward(size);
        // Rows, then columns, which are rows of the transposed square.
        for _ in 0..2 {
            fft.process(&mut values);
            for y in 0..size {
                for x in 0..y {
                    values.swap(y * size + x, x * size + y);
                }
            }
        }
        let unit = (pixels as f64 * share.min(1.0 - share)).sqrt();
        let scale = pixels as f64 * share * (1.0 - share);
        let modes = values.iter().enumerate().skip(1);
        let modes = modes.map(|(i, value)| {
            let frequency = |k: usize| k.min(size - k) as f64;
            let nu = frequency(i % size).hypot(frequency(i / size)) / unit;
            (nu, value.norm_sqr() / scale)
        });
        let summary = Summary::of(modes.clone(), &[]);
        let rings = ring_sums(modes, LevelSpectrum::RING, LevelSpectrum::RINGS);
        let mean = |[count, _, total, ..]: [f64; 5]| total / count.max(1.0);
        LevelSpectrum {
            level: share,
            low_power: summary.low_power,
            peak: summary.tallest,
            rings: rings.into_iter().map(mean).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::SplitMix;

    /// Ranks in an order hashed by SplitMix64.
    fn white(size: u32) -> Mask {
        let hashed = |x, y| SplitMix::new(u64::from(y * size + x)).next_u64();
        Mask::by_key(size, hashed)
    }

    #[test]
    fn random_pixels_have_power_one() {
        for level in [0.125, 0.25, 0.5] {
            let spectrum = white(128).spectrum(level);
            assert!((spectrum.low_power - 1.0).abs() < 0.25, "{spectrum:?}");
            assert!(spectrum.peak < 30.0);
        }
    }

    #[test]
    fn a_lattice_is_nothing_but_peaks() {
        // Every second pixel of every second row comes first.
        let mask = Mask::by_key(32, |x, y| x % 2 + 2 * (y % 2));
        let spectrum = mask.spectrum(0.25);
        assert!(spectrum.low_power < 1e-20);
        // Three peaks share all of the variance.
        assert!((spectrum.peak - 1024.0 / 3.0).abs() < 1e-6);
    }
}
