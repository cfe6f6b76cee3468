//! The power of small windows, which shows a leftover local lattice.

use strew_core::{Error, space::SpaceSet};

use super::{points::SpacePoints, power::HIGHEST, shells::Shells, transform::Sums};
use crate::numeric::SplitMix;

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

/// The side of a window, in mean spacings.
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
