//! Two sets compared: whether they share power or phases.
//!
//! Sets of two seeds should be as independent as two sets of white noise. Two figures show what they share: the correlation
//! of their powers, mode by mode, and the highest peak of their phase correlation, which finds a part of one set in the other
//! at any translation. With each comes what two independent sets have.

use rustfft::num_complex::Complex;

use super::{
    Sample,
    fourier::{of_grid, size_from, sums},
};

/// The structure that two windows have in common.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shared {
    /// The correlation coefficient of the powers of equal modes, each relative to the mean of its ring.
    pub power_correlation: f64,
    /// The deviation that it has by chance.
    pub power_by_chance: f64,
    /// The highest value of the phase correlation, in standard deviations.
    pub phase_peak: f64,
    /// The height that half of all peaks by chance stay below.
    pub phase_by_chance: f64,
}

/// The frequencies that are compared: below, many sets have no power.
const LOW_END: f64 = 0.8;
/// The width of a ring, in modes.
const RING: f64 = 4.0;

/// A mode, and the sums of both sets.
type Mode<const D: usize> = ([i64; D], [Complex<f64>; 2]);

impl Shared {
    /// Compares two windows of equal side, of the plane or in space, on modes with 0.8 < ν < `nu_max`.
    ///
    /// # Panics
    /// If the sides differ by more than a millionth.
    pub fn of<const D: usize>(a: &Sample<D>, b: &Sample<D>, nu_max: f64) -> Self {
        assert!((a.side() / b.side() - 1.0).abs() < 1e-6, "equal sides");
        let side = a.side();
        let modes = (nu_max * side) as usize;
        // Without a taper, which would tie neighboring modes to each other.
        let size = |k: [i64; D]| (k.iter().map(|k| k * k).sum::<i64>() as f64).sqrt();
        let sizes = LOW_END * side..nu_max * side;
        let [first, second] = [a, b].map(|set| {
            sums(set, None, modes, |k, sum| {
                (k > [0; D] && sizes.contains(&size(k))).then_some((k, sum))
            })
        });
        let both = first.into_iter().zip(second);
        let all: Vec<Mode<D>> = both.map(|((k, a), (_, b))| (k, [a, b])).collect();
        let ring = |k: [i64; D]| (size(k) / RING) as usize;
        let mut means = vec![[0.0f64; 3]; ring([modes as i64 + 1; D]) + 1];
        for (k, [a, b]) in &all {
            let more = [a.norm_sqr(), b.norm_sqr(), 1.0];
            for (sum, more) in means[ring(*k)].iter_mut().zip(more) {
                *sum += more;
            }
        }
        let (mut shared, mut own) = (0.0, [0.0; 2]);
        for (k, [a, b]) in &all {
            let mean = means[ring(*k)];
            let a = a.norm_sqr() * mean[2] / mean[0] - 1.0;
            let b = b.norm_sqr() * mean[2] / mean[1] - 1.0;
            shared += a * b;
            own = [own[0] + a * a, own[1] + b * b];
        }
        let (phase_peak, places) = phase_peak(&all, modes);
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

/// The highest peak of the phase correlation, in deviations, and the number of translations.
fn phase_peak<const D: usize>(all: &[Mode<D>], modes: usize) -> (f64, f64) {
    let size = size_from(2 * (modes + 1));
    let mut grid = vec![Complex::default(); size.pow(D as u32)];
    let place = |k: [i64; D]| {
        let slots = k.iter().map(|k| k.rem_euclid(size as i64) as usize);
        slots.rev().fold(0, |place, slot| place * size + slot)
    };
    for (k, [a, b]) in all {
        let cross = a * b.conj();
        let phase = cross / cross.norm().max(f64::MIN_POSITIVE);
        grid[place(*k)] = phase;
        grid[place(k.map(|k| -k))] = phase.conj();
    }
    let grid = of_grid(grid, size, D);
    let highest = grid.iter().map(|v| v.re).fold(0.0, f64::max);
    let places = grid.len() as f64;
    let deviation = (grid.iter().map(|v| v.re * v.re).sum::<f64>() / places).sqrt();
    (highest / deviation.max(f64::MIN_POSITIVE), places)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::SplitMix;

    /// Independent sets share nothing, and shifted ones their phases.
    fn check<const D: usize>(count: usize) {
        let set = |points| Sample::window(1.0, count as f64, points);
        let [a, b] = [1, 2].map(|seed| set(SplitMix::new(seed).places(count, 1.0)));
        let shared = Shared::of(&a, &b, 1.6);
        let correlation = shared.power_correlation.abs();
        assert!(correlation < 4.0 * shared.power_by_chance, "{shared:?}");
        let peak = shared.phase_peak / shared.phase_by_chance;
        assert!((peak - 1.0).abs() < 0.3, "{shared:?}");
        let mut moved: Vec<[f64; D]> = SplitMix::new(1).places(count, 1.0);
        moved.iter_mut().for_each(|p| p[0] = (p[0] + 0.1) % 1.0);
        let shared = Shared::of(&a, &set(moved), 1.6);
        assert!(shared.power_correlation > 0.2, "{shared:?}");
        let peak = shared.phase_peak / shared.phase_by_chance;
        assert!(peak > 5.0, "{shared:?}");
    }

    #[test]
    fn independent_sets_share_nothing_and_shifted_ones_their_phases() {
        check::<2>(10_000);
        check::<3>(8000);
    }
}
