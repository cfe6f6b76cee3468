//! Two sets compared: whether they share power or phases.
//!
//! Sets of two seeds should be as independent as two sets of white noise. Two figures show what they share,
//! both 0 for independent sets but for chance: the correlation of their powers, mode by mode, and the highest
//! peak of their phase correlation, which finds a part of one set in the other at any translation.

use rustfft::{FftPlanner, num_complex::Complex};

use super::{Sample, nufft::transform};

/// The structure that two sets have in common.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shared {
    /// The correlation coefficient of the powers of equal modes, each relative to the mean of its ring.
    pub power_correlation: f64,
    /// The highest value of the phase correlation, in standard deviations.
    pub phase_peak: f64,
}

/// The frequencies compared: below, many sets have no power.
const LOW_END: f64 = 0.8;

impl Shared {
    /// Compares two windows of equal side, on modes with 0.8 < ν < `nu_max`.
    ///
    /// # Panics
    /// If the sides differ by more than a millionth.
    #[must_use]
    pub fn of(a: &Sample, b: &Sample, nu_max: f64) -> Self {
        assert!((a.side() / b.side() - 1.0).abs() < 1e-6, "equal sides");
        let side = a.side();
        let modes = (nu_max * side) as usize;
        let sums = [a, b].map(|set| sums(set, modes));
        let nu = |kx: i64, ky: i64| ((kx * kx + ky * ky) as f64).sqrt() / side;
        let height = 2 * modes + 1;
        let wanted = |i: usize| {
            let (kx, ky) = ((i / height) as i64, (i % height) as i64 - modes as i64);
            let is_first = kx > 0 || ky > 0;
            let nu = nu(kx, ky);
            (is_first && nu > LOW_END && nu < nu_max).then_some((kx, ky, nu))
        };
        Self {
            power_correlation: power_correlation(&sums, side, wanted),
            phase_peak: phase_peak(&sums, modes, wanted),
        }
    }
}

/// The sums of a window at integer frequencies, where its mean density adds nothing. Without a taper, which
/// would tie neighboring modes to each other.
fn sums(set: &Sample, modes: usize) -> Vec<Complex<f64>> {
    let turns: Vec<[f64; 2]> = set
        .points()
        .iter()
        .map(|p| p.map(|v| v / set.side()))
        .collect();
    transform(&turns, None, modes, |_, _, sum| sum)
}

type Mode = (i64, i64, f64);

fn power_correlation(
    sums: &[Vec<Complex<f64>>; 2],
    side: f64,
    wanted: impl Fn(usize) -> Option<Mode>,
) -> f64 {
    // Rings four modes wide.
    let ring = |nu: f64| (nu * side / 4.0) as usize;
    let mut means: Vec<[f64; 3]> = Vec::new();
    for (i, (a, b)) in sums[0].iter().zip(&sums[1]).enumerate() {
        if let Some((_, _, nu)) = wanted(i) {
            if means.len() <= ring(nu) {
                means.resize(ring(nu) + 1, [0.0; 3]);
            }
            let mean = &mut means[ring(nu)];
            mean[0] += a.norm_sqr();
            mean[1] += b.norm_sqr();
            mean[2] += 1.0;
        }
    }
    let (mut both, mut own) = (0.0, [0.0; 2]);
    for (i, (a, b)) in sums[0].iter().zip(&sums[1]).enumerate() {
        if let Some((_, _, nu)) = wanted(i) {
            let mean = means[ring(nu)];
            let a = a.norm_sqr() * mean[2] / mean[0] - 1.0;
            let b = b.norm_sqr() * mean[2] / mean[1] - 1.0;
            both += a * b;
            own = [own[0] + a * a, own[1] + b * b];
        }
    }
    both / (own[0] * own[1]).sqrt().max(f64::MIN_POSITIVE)
}

fn phase_peak(
    sums: &[Vec<Complex<f64>>; 2],
    modes: usize,
    wanted: impl Fn(usize) -> Option<Mode>,
) -> f64 {
    let size = 2 * (modes + 1);
    let mut grid = vec![Complex::default(); size * size];
    for (i, (a, b)) in sums[0].iter().zip(&sums[1]).enumerate() {
        if let Some((kx, ky, _)) = wanted(i) {
            let cross = a * b.conj();
            let phase = cross / cross.norm().max(f64::MIN_POSITIVE);
            let place = |k: i64| k.rem_euclid(size as i64) as usize;
            grid[place(kx) * size + place(ky)] = phase;
            grid[place(-kx) * size + place(-ky)] = phase.conj();
        }
    }
    let fft = FftPlanner::new().plan_fft_inverse(size);
    for _ in 0..2 {
        grid.chunks_exact_mut(size).for_each(|row| fft.process(row));
        for i in 0..size {
            for j in 0..i {
                grid.swap(i * size + j, j * size + i);
            }
        }
    }
    let squares: f64 = grid.iter().map(|v| v.re * v.re).sum();
    let highest = grid.iter().map(|v| v.re).fold(0.0, f64::max);
    highest / (squares / grid.len() as f64).sqrt().max(f64::MIN_POSITIVE)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::SplitMix;

    fn noise(seed: u64) -> Vec<[f64; 2]> {
        let mut random = SplitMix::new(seed);
        (0..10_000)
            .map(|_| [0, 1].map(|_| random.next_f64() * 100.0))
            .collect()
    }

    #[test]
    fn independent_sets_share_nothing_and_shifted_ones_their_phases() {
        let [a, b] = [1, 2].map(|seed| Sample::window(100.0, 1.0, noise(seed)));
        let shared = Shared::of(&a, &b, 2.0);
        assert!(shared.power_correlation.abs() < 0.03, "{shared:?}");
        assert!((4.0..8.0).contains(&shared.phase_peak), "{shared:?}");
        let moved = noise(1)
            .iter()
            .map(|p| [(p[0] + 7.0) % 100.0, p[1]])
            .collect();
        let moved = Sample::window(100.0, 1.0, moved);
        let shared = Shared::of(&a, &moved, 2.0);
        assert!(shared.power_correlation > 0.2, "{shared:?}");
        assert!(shared.phase_peak > 50.0, "{shared:?}");
    }
}
