//! Two sets compared: whether they share power or phases.
//!
//! Sets of two seeds should be as independent as two sets of white noise. As in the plane, two figures show what they
//! share: the correlation of their powers, frequency by frequency, and the highest peak of their phase correlation, which
//! finds a part of one set in the other at any translation. With each comes what two independent sets have.

use super::{
    fourier::{Fourier, Plane},
    points::SpacePoints,
    transform::Sums,
};

/// The structure that two windows have in common.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpaceShared {
    /// The correlation coefficient of the powers of equal frequencies, each relative to the mean of its shell.
    pub power_correlation: f64,
    /// The deviation that it has by chance.
    pub power_by_chance: f64,
    /// The highest value of the phase correlation, in standard deviations.
    pub phase_peak: f64,
    /// The height that half of all peaks by chance stay below.
    pub phase_by_chance: f64,
}

/// The frequencies that are compared: below, most sets have no power.
const FROM: f64 = 0.8;
const TO: f64 = 1.6;
/// The width of a shell, in frequencies.
const SHELL: f64 = 4.0;

impl SpaceShared {
    /// Compares two windows of equal side, on frequencies from 0.8 to 1.6.
    ///
    /// # Panics
    /// If the sides differ.
    #[must_use]
    pub fn of(a: &SpacePoints, b: &SpacePoints) -> Self {
        assert!((a.side() / b.side() - 1.0).abs() < 1e-6, "equal sides");
        let side = a.side();
        // Without a taper, which would tie neighboring frequencies to each other.
        let modes = (TO * side) as usize;
        let [first, second] = [a, b].map(|set| Sums::new(set.points(), None, modes));
        let frequency = |k: [i64; 3]| (k.iter().map(|k| k * k).sum::<i64>() as f64).sqrt();
        let both = first.each().zip(second.each());
        let wanted = both.filter(|((k, _), _)| (FROM * side..TO * side).contains(&frequency(*k)));
        let all: Vec<([i64; 3], [[f64; 2]; 2])> = wanted
            .map(|((k, a), (_, b))| (k, [a, b].map(|v| v.map(f64::from))))
            .collect();
        let shell = |k: [i64; 3]| (frequency(k) / SHELL) as usize;
        let mut means = vec![[0.0f64; 3]; shell([modes as i64 + 1; 3]) + 1];
        for (k, [a, b]) in &all {
            let mean = &mut means[shell(*k)];
            *mean = [mean[0] + squared(*a), mean[1] + squared(*b), mean[2] + 1.0];
        }
        let (mut shared, mut own) = (0.0, [0.0; 2]);
        for (k, [a, b]) in &all {
            let mean = means[shell(*k)];
            let a = squared(*a) * mean[2] / mean[0] - 1.0;
            let b = squared(*b) * mean[2] / mean[1] - 1.0;
            shared += a * b;
            own = [own[0] + a * a, own[1] + b * b];
        }
        let (phase_peak, places) = phase_peak(&all, first.modes() as usize);
        Self {
            power_correlation: shared / (own[0] * own[1]).sqrt().max(f64::MIN_POSITIVE),
            power_by_chance: 1.0 / (all.len().max(1) as f64).sqrt(),
            phase_peak,
            // The median of the greatest of this number of normal variables, to leading order.
            phase_by_chance: {
                let spread = (2.0 * libm::log(places)).sqrt();
                let lower = libm::log(libm::log(places)) + libm::log(4.0 * std::f64::consts::PI);
                spread - (lower / 2.0 + libm::log(std::f64::consts::LN_2)) / spread
            },
        }
    }
}

fn squared([re, im]: [f64; 2]) -> f64 {
    re * re + im * im
}

/// The highest peak of the phase correlation, in deviations, and the number of translations.
fn phase_peak(all: &[([i64; 3], [[f64; 2]; 2])], modes: usize) -> (f64, f64) {
    let fourier = Fourier::new(Fourier::size_from(2 * (modes + 1)));
    let (size, mut other) = (fourier.size(), Plane::default());
    let mut grid = Plane::new(size.pow(3));
    let slot = |k: i64| k.rem_euclid(size as i64) as usize;
    let place = |k: [i64; 3]| (slot(k[2]) * size + slot(k[1])) * size + slot(k[0]);
    for (k, [a, b]) in all {
        let cross = [a[0] * b[0] + a[1] * b[1], a[1] * b[0] - a[0] * b[1]];
        let length = squared(cross).sqrt().max(f64::MIN_POSITIVE);
        let [re, im] = cross.map(|v| (v / length) as f32);
        for (at, im) in [(place(*k), im), (place(k.map(|k| -k)), -im)] {
            (grid.re[at], grid.im[at]) = (re, im);
        }
    }
    // Along the slowest axis, then with the axes in turn, three times.
    for _ in 0..3 {
        fourier.columns(&mut grid, &mut other);
        for (to, from) in [(&mut other.re, &grid.re), (&mut other.im, &grid.im)] {
            to.resize(from.len(), 0.0);
            for (z, plane) in from.chunks_exact(size * size).enumerate() {
                for (i, v) in plane.iter().enumerate() {
                    to[i * size + z] = *v;
                }
            }
        }
        std::mem::swap(&mut grid, &mut other);
    }
    let squares: f64 = grid.re.iter().map(|v| f64::from(*v) * f64::from(*v)).sum();
    let highest = grid
        .re
        .iter()
        .fold(0.0, |most, v| f64::max(most, f64::from(*v)));
    let places = grid.re.len() as f64;
    let deviation = (squares / places).sqrt().max(f64::MIN_POSITIVE);
    (highest / deviation, places)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::SplitMix;

    fn noise(seed: u64) -> Vec<[f64; 3]> {
        let mut random = SplitMix::new(seed);
        let mut next = || random.next_f64();
        (0..8000).map(|_| [next(), next(), next()]).collect()
    }

    #[test]
    fn independent_sets_share_nothing_and_shifted_ones_their_phases() {
        let set = |points| SpacePoints::new(points, false);
        let [a, b] = [1, 2].map(|seed| set(noise(seed)));
        let shared = SpaceShared::of(&a, &b);
        let correlation = shared.power_correlation.abs();
        assert!(correlation < 4.0 * shared.power_by_chance, "{shared:?}");
        assert!(
            (shared.phase_peak / shared.phase_by_chance - 1.0).abs() < 0.2,
            "{shared:?}"
        );
        let moved = noise(1)
            .into_iter()
            .map(|p| [(p[0] + 0.1) % 1.0, p[1], p[2]]);
        let shared = SpaceShared::of(&a, &set(moved.collect()));
        assert!(shared.power_correlation > 0.5, "{shared:?}");
        assert!(
            shared.phase_peak > 5.0 * shared.phase_by_chance,
            "{shared:?}"
        );
    }
}
