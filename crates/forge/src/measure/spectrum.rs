//! The power spectrum of a point set, its rings, and a summary.
//!
//! Frequencies ν are in units of √N: ν = 1 is one cycle per mean spacing. White noise has power 1.
//!
//! The taper of a window is sin⁸(πu) along each axis, a sum of five cosines. So at integer frequencies its transform, and with it
//! the spectrum of the window's mean density, is 0 except for |k| ≤ 4, where it is known exactly and
//! subtracted. Between integers it falls as k⁻⁹, so tall peaks of a quasi-periodic set do not leak.
//!
//! [`Crispness`] is the effective Nyquist frequency and the oscillation of a spectrum, after Heck, Schlömer, Deussen, "Blue
//! Noise Sampling with Controlled Aliasing" (2013).

use super::{Sample, fourier::sums};

/// The power P(k) = |Σ exp(−2πi k·x)|²/N at every integer k up to a largest frequency.
#[derive(Clone, Debug)]
pub struct Spectrum {
    /// The side of the set in mean spacings: ν = |k| / side.
    side: f64,
    /// The largest kx and ky.
    modes: usize,
    /// Indexed by kx in 0..=modes, then ky in −modes..=modes.
    power: Vec<f64>,
}

/// The power of the modes in a ring of frequencies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ring {
    pub nu: f64,
    pub power: f64,
    /// The anisotropy 10·log10(variance / mean²) of the power of the modes, in dB: 0 for a random
    /// isotropic set, at least −200.
    pub anisotropy_db: f64,
    pub tallest: f64,
}

/// A spectrum in five figures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Summary {
    /// Mean power over 0 < ν < 0.5.
    pub low_power: f64,
    /// The largest mean power of a ring.
    pub peak_power: f64,
    /// The frequency of the ring with the largest mean power.
    pub peak_nu: f64,
    /// The largest power of a single mode.
    pub tallest: f64,
    /// The median anisotropy of the rings with 0.8 < ν < 4, as far as they are measured, in dB.
    pub anisotropy_db: f64,
}

/// The upper end of low frequencies.
const LOW_END: f64 = 0.5;
/// The range of ν of the median anisotropy.
const ANISOTROPY_RANGE: std::ops::Range<f64> = 0.8..4.0;

/// The bands of ν in which anisotropy is summarized.
pub const BANDS: [[f64; 2]; 6] = [
    [0.05, 0.2],
    [0.2, 0.4],
    [0.4, 0.6],
    [0.6, 0.8],
    [0.8, 1.2],
    [1.2, 2.0],
];

impl Spectrum {
    /// Computes the spectrum of a set for |k| ≤ `nu_max`·√N along either axis. Memory grows as N·`nu_max`².
    ///
    /// Of a periodic set it is exact but for an error in amplitude of 10⁻¹⁰·√N. Of a window it is an estimate at
    /// frequencies k/side: the taper blurs it over about ±2 modes; less than 10⁻¹² of a mode's power leaks 10 modes
    /// away.
    pub fn of(set: &Sample, nu_max: f64) -> Self {
        let side = set.side();
        let modes = (nu_max * side).floor().max(0.0) as usize;
        if set.is_periodic() {
            let unit = 1.0 / set.points().len().max(1) as f64;
            let power = sums(set, None, modes, |_, sum| Some(sum.norm_sqr() * unit));
            return Self { side, modes, power };
        }
        let turns = set.turns();
        let weights: Vec<f64> = turns.iter().map(|p| taper(p[0]) * taper(p[1])).collect();
        // At unit density a window has side² points on average.
        let area = side * side;
        let unit = 1.0 / (area * MEAN_SQUARE * MEAN_SQUARE);
        let power = sums(set, Some(&weights), modes, |[kx, ky], sum| {
            let mean = area * taper_coefficient(kx) * taper_coefficient(ky);
            Some((sum - mean).norm_sqr() * unit)
        });
        Self { side, modes, power }
    }

    /// The largest frequency along an axis.
    pub fn nu_max(&self) -> f64 {
        self.modes as f64 / self.side
    }

    /// The least width of a ring in ν: one mode.
    pub fn finest_ring(&self) -> f64 {
        1.0 / self.side
    }

    /// The power at k = (`kx`, `ky`) cycles per side, or `None` beyond the largest frequency.
    pub fn at(&self, kx: i64, ky: i64) -> Option<f64> {
        // P(−k) = P(k).
        let (kx, ky) = if kx < 0 { (-kx, -ky) } else { (kx, ky) };
        let modes = self.modes as i64;
        (kx <= modes && ky.abs() <= modes)
            .then(|| self.power[(kx * (2 * modes + 1) + ky + modes) as usize])
    }

    /// (ν, power) of one mode of every pair k, −k within the circle ν ≤ ν_max, without k = 0.
    fn half_plane(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        let modes = self.modes as i64;
        let rows = self.power.chunks_exact(2 * self.modes + 1);
        rows.enumerate().flat_map(move |(kx, row)| {
            let kx = kx as i64;
            let first = if kx == 0 { 1 } else { -modes };
            (first..=modes).filter_map(move |ky| {
                let squared = kx * kx + ky * ky;
                (squared <= modes * modes).then(|| {
                    (
                        (squared as f64).sqrt() / self.side,
                        row[(ky + modes) as usize],
                    )
                })
            })
        })
    }

    /// Returns the rings of width `width` in ν, or one mode if that is wider, from ν = 0 outwards
    /// up to the last whole one. Rings without modes are left out.
    pub fn rings(&self, width: f64) -> Vec<Ring> {
        let width = width.max(self.finest_ring());
        rings_of(self.half_plane(), width, self.nu_max())
    }

    /// Returns the median anisotropy of the rings of each of the [`BANDS`], in dB, as far as they are
    /// measured. Where a set has hardly any power, it is that of the floor.
    pub fn anisotropy_by_band(&self, width: f64) -> Vec<f64> {
        let rings = self.rings(width);
        let measured = BANDS.iter().filter(|band| band[1] <= self.nu_max());
        measured
            .map(|band| median_anisotropy(&rings, band[0]..band[1]))
            .collect()
    }

    /// Returns the summary, with rings of width `width` in ν.
    pub fn summary(&self, width: f64) -> Summary {
        Summary::of(self.half_plane(), &self.rings(width))
    }
}

/// The sums over the modes (ν, power) of some rings of a width: their number, ν, power, squared power, and the tallest.
pub(crate) fn ring_sums(
    modes: impl Iterator<Item = (f64, f64)>,
    width: f64,
    rings: usize,
) -> Vec<[f64; 5]> {
    let mut sums = vec![[0.0f64; 5]; rings];
    for (nu, power) in modes {
        if let Some([count, nus, total, squares, tallest]) = sums.get_mut((nu / width) as usize) {
            *count += 1.0;
            *nus += nu;
            *total += power;
            *squares += power * power;
            *tallest = tallest.max(power);
        }
    }
    sums
}

/// The rings of modes (ν, power), each of a width, from ν = 0 to the last whole one before `end`; without empty ones.
pub(crate) fn rings_of(modes: impl Iterator<Item = (f64, f64)>, width: f64, end: f64) -> Vec<Ring> {
    let sums = ring_sums(modes, width, (end / width) as usize);
    let filled = sums.into_iter().filter(|sum| sum[0] > 0.0);
    let ring = |[count, nus, total, squares, tallest]: [f64; 5]| {
        let mean = total / count;
        let variance = squares / count - mean * mean;
        Ring {
            nu: nus / count,
            power: mean,
            anisotropy_db: 10.0 * libm::log10((variance / (mean * mean)).max(1e-20)),
            tallest,
        }
    };
    filled.map(ring).collect()
}

/// The median anisotropy of the rings of a band; 0 if there are none.
fn median_anisotropy(rings: &[Ring], band: std::ops::Range<f64>) -> f64 {
    let inside = rings.iter().filter(|ring| band.contains(&ring.nu));
    let mut all: Vec<f64> = inside.map(|ring| ring.anisotropy_db).collect();
    all.sort_by(f64::total_cmp);
    all.get(all.len() / 2).copied().unwrap_or(0.0)
}

impl Summary {
    /// The summary of modes (ν, power) and their rings.
    pub(crate) fn of(modes: impl Iterator<Item = (f64, f64)>, rings: &[Ring]) -> Self {
        let (mut low, mut low_count, mut tallest) = (0.0, 0u64, 0.0f64);
        for (nu, power) in modes {
            if nu < LOW_END {
                low += power;
                low_count += 1;
            }
            tallest = tallest.max(power);
        }
        let peak = rings.iter().max_by(|a, b| a.power.total_cmp(&b.power));
        Self {
            low_power: low / low_count.max(1) as f64,
            peak_power: peak.map_or(0.0, |ring| ring.power),
            peak_nu: peak.map_or(0.0, |ring| ring.nu),
            tallest,
            anisotropy_db: median_anisotropy(rings, ANISOTROPY_RANGE),
        }
    }
}

/// The mean of the taper's square: C(16, 8)/2¹⁶.
pub(super) const MEAN_SQUARE: f64 = 12_870.0 / 65_536.0;

/// The taper at u in [0, 1].
pub(super) fn taper(u: f64) -> f64 {
    let sine = (std::f64::consts::PI * u).sin();
    let fourth = (sine * sine) * (sine * sine);
    fourth * fourth
}

/// The Fourier taper_coefficient of the taper at integer k: (−1)ᵏ·C(8, 4 + k)/2⁸.
pub(super) fn taper_coefficient(k: i64) -> f64 {
    let binomial = match k.unsigned_abs() {
        0 => 70.0,
        1 => -56.0,
        2 => 28.0,
        3 => -8.0,
        4 => 1.0,
        _ => 0.0,
    };
    binomial / 256.0
}

/// The two figures of Heck et al.: how far a spectrum is empty, and how much it oscillates beyond.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crispness {
    /// The effective Nyquist frequency ν_eff: the radius in ν of the largest disc around 0 whose
    /// mean power is at most 0.1. The square lattice has about 1. Frequencies up to ν_eff/2 are
    /// sampled nearly without aliasing.
    pub nu_eff: f64,
    /// The oscillation Ω: ten times the root mean square of P − 1, of five units of ν from the
    /// frequency where the power first reaches 1, or fewer where the rings end.
    pub omega: f64,
}

/// The largest mean power of the disc of ν_eff.
const MAX_DISC_POWER: f64 = 0.1;
/// The mean power of a disc at which the search for a larger one ends: the spectrum has risen.
const RISEN: f64 = 0.5;
/// The power, about 1, at which the range of Ω begins.
const ABOUT_ONE: f64 = 0.98;
/// The length of the range of Ω, in ν.
const OSCILLATION_RANGE: f64 = 5.0;

impl Crispness {
    /// Computes the figures from rings of the given width in ν, from 0 outwards. Within a ring the
    /// power is taken as constant.
    pub fn of_rings(rings: &[Ring], width: f64) -> Self {
        Self {
            nu_eff: effective_nyquist(rings, width),
            omega: oscillation(rings),
        }
    }
}

fn effective_nyquist(rings: &[Ring], width: f64) -> f64 {
    // `sum` over the squared radius is the mean power of the disc up to the edge of a ring. From
    // one edge to the next the disc grows with the power of the ring.
    let (mut found, mut inner, mut sum) = (0.0, 0.0f64, 0.0);
    for ring in rings {
        let outer = ((ring.nu / width).floor() + 1.0) * width;
        let next = sum + ring.power * (outer * outer - inner * inner);
        if sum <= MAX_DISC_POWER * inner * inner && next > MAX_DISC_POWER * outer * outer {
            // sum + P·(x² − inner²) = MAX_DISC_POWER·x²
            found = ((ring.power * inner * inner - sum) / (ring.power - MAX_DISC_POWER)).sqrt();
        } else if next <= MAX_DISC_POWER * outer * outer {
            found = outer;
        }
        (inner, sum) = (outer, next);
        if sum > RISEN * outer * outer {
            break;
        }
    }
    found
}

fn oscillation(rings: &[Ring]) -> f64 {
    let Some(first) = rings.iter().position(|ring| ring.power >= ABOUT_ONE) else {
        return 0.0;
    };
    let end = rings[first].nu + OSCILLATION_RANGE;
    let (mut sum, mut weight) = (0.0, 0.0);
    for ring in rings[first..].iter().take_while(|ring| ring.nu <= end) {
        sum += ring.nu * (ring.power - 1.0) * (ring.power - 1.0);
        weight += ring.nu;
    }
    10.0 * f64::sqrt(sum / f64::max(weight, f64::MIN_POSITIVE))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::numeric::SplitMix;

    fn noise(count: usize, seed: u64) -> Vec<[f64; 2]> {
        SplitMix::new(seed).places(count, 1.0)
    }

    /// A random point in every cell of a square grid.
    fn jittered(per_axis: usize, seed: u64) -> Vec<[f64; 2]> {
        let corners = (0..per_axis).flat_map(|j| (0..per_axis).map(move |i| [i as f64, j as f64]));
        corners
            .zip(noise(per_axis * per_axis, seed))
            .map(|(c, p)| [c[0] + p[0], c[1] + p[1]])
            .collect()
    }

    #[test]
    fn white_noise_has_power_one_and_no_anisotropy() {
        let summary = Spectrum::of(&Sample::torus(1.0, noise(10_000, 1)), 4.0).summary(0.02);
        assert!((summary.low_power - 1.0).abs() < 0.05, "{summary:?}");
        assert!(summary.peak_power < 2.0, "{summary:?}");
        assert!(summary.anisotropy_db.abs() < 0.15, "{summary:?}");
        let window = Sample::window(1.0, 10_000.0, noise(10_000, 2));
        let summary = Spectrum::of(&window, 4.0).summary(0.02);
        assert!((summary.low_power - 1.0).abs() < 0.15, "{summary:?}");
        assert!(summary.anisotropy_db.abs() < 0.5, "{summary:?}");
    }

    #[test]
    fn a_jittered_grid_has_its_analytic_spectrum() {
        // 1 − sinc²(νx)·sinc²(νy), averaged over ten sets of 64² points.
        let sinc = |v: f64| (PI * v).sin() / (PI * v);
        let sets: Vec<Spectrum> = (0..10)
            .map(|seed| Spectrum::of(&Sample::torus(64.0, jittered(64, seed)), 2.0))
            .collect();
        let sum = |kx, ky| -> f64 {
            let each = sets.iter().map(|s| s.at(kx, ky).expect("measured"));
            each.sum()
        };
        let mut worst: f64 = 0.0;
        for ring in 1..30 {
            // Means over rectangles of modes, clear of the peaks of the lattice.
            let (mut found, mut expected, mut modes) = (0.0, 0.0, 0.0);
            for kx in ring * 4 + 1..ring * 4 + 4 {
                for ky in 65..=120 {
                    found += sum(kx, ky);
                    let shape = sinc(kx as f64 / 64.0) * sinc(ky as f64 / 64.0);
                    expected += 10.0 * (1.0 - shape * shape);
                    modes += 10.0;
                }
            }
            worst = worst.max((found - expected).abs() / modes);
        }
        assert!(worst < 0.1, "{worst}");
        let low = sum(3, 2) / 10.0;
        let shape = sinc(3.0 / 64.0) * sinc(2.0 / 64.0);
        assert!(low < 5.0 * (1.0 - shape * shape), "{low}");
    }

    #[test]
    fn a_lattice_has_its_peaks_and_nothing_else() {
        let lattice = (0..32).flat_map(|j| (0..32).map(move |i| [f64::from(i), f64::from(j)]));
        let spectrum = Spectrum::of(&Sample::torus(32.0, lattice.collect()), 2.5);
        for kx in -80..=80i64 {
            for ky in -80..=80i64 {
                let is_peak = kx % 32 == 0 && ky % 32 == 0;
                let expected = if is_peak { 1024.0 } else { 0.0 };
                let found = spectrum.at(kx, ky).expect("measured");
                assert!((found - expected).abs() < 1e-7, "({kx}, {ky}): {found}");
            }
        }
        assert!(spectrum.at(81, 0).is_none());
        assert!((spectrum.summary(0.0).tallest - 1024.0).abs() < 1e-6);
    }

    #[test]
    fn a_window_resolves_a_power_of_a_millionth() {
        // A lattice has no power below ν = 0.5. Neither its tall peaks nor the edge of the window
        // may leak there.
        let lattice: Vec<[f64; 2]> = (-1..102)
            .flat_map(|j| (-1..102).map(move |i| [f64::from(i) + 0.3, f64::from(j) + 0.8]))
            .collect();
        let window = Sample::window(100.5, 1.0, lattice);
        let summary = Spectrum::of(&window, 0.9).summary(0.02);
        assert!(summary.low_power < 1e-12, "{summary:?}");
        // With a wrong density the mean is not subtracted exactly.
        let wrong = Sample::window(100.5, 1.01, window.points().to_vec());
        assert!(Spectrum::of(&wrong, 0.9).summary(0.02).low_power > 1e-6);
    }

    #[test]
    fn rings_are_whole_and_sorted() {
        let spectrum = Spectrum::of(&Sample::torus(1.0, noise(400, 3)), 1.0);
        let rings = spectrum.rings(0.0);
        assert_eq!(rings.len(), 19); // 1 ≤ |k| < 20
        assert!(rings.is_sorted_by(|a, b| a.nu < b.nu));
        let none = Spectrum::of(&Sample::torus(1.0, vec![]), 1.0);
        assert!(none.rings(0.1).is_empty());
    }

    #[test]
    fn coefficients_and_mean_square_are_those_of_the_taper() {
        let nodes = 64;
        let mean = |f: &dyn Fn(f64) -> f64| -> f64 {
            (0..nodes)
                .map(|i| f(f64::from(i) / f64::from(nodes)))
                .sum::<f64>()
                / f64::from(nodes)
        };
        for k in 0..7 {
            let turn = 2.0 * std::f64::consts::PI * k as f64;
            let found = mean(&|u| taper(u) * (turn * u).cos());
            assert!((found - taper_coefficient(k)).abs() < 1e-15, "{k}");
        }
        assert!((mean(&|u| taper(u) * taper(u)) - MEAN_SQUARE).abs() < 1e-15);
    }

    /// Rings of a radial power.
    fn rings(power: impl Fn(f64) -> f64) -> Vec<Ring> {
        let ring = |at: u32| {
            let nu = (f64::from(at) + 0.5) / 64.0;
            Ring {
                nu,
                power: power(nu),
                anisotropy_db: 0.0,
                tallest: 0.0,
            }
        };
        (0..512).map(ring).collect()
    }

    #[test]
    fn a_step_at_half_has_its_known_figures() {
        // The mean power of the disc, 1 − 0.25/ν², is 0.1 at ν = 0.5/√0.9.
        let step = rings(|nu| if nu < 0.5 { 0.0 } else { 1.0 });
        let found = Crispness::of_rings(&step, 1.0 / 64.0);
        assert!(
            (found.nu_eff - 0.5 / 0.9f64.sqrt()).abs() < 1e-12,
            "{found:?}"
        );
        assert_eq!(found.omega, 0.0);
    }

    #[test]
    fn oscillations_are_measured_from_where_the_power_reaches_one() {
        let wave = |nu: f64| match nu {
            nu if nu < 1.0 => 0.0,
            nu if nu < 3.0 => 1.5,
            _ => 1.0,
        };
        let found = Crispness::of_rings(&rings(wave), 1.0 / 64.0);
        // (P − 1)² is 0.25 over 1..3 and 0 over 3..6: 10·√(0.25·8/35).
        let expected = 10.0 * (0.25f64 * 8.0 / 35.0).sqrt();
        assert!((found.omega - expected).abs() < 0.03, "{found:?}");
        assert!(found.nu_eff > 1.0 && found.nu_eff < 1.05, "{found:?}");
    }

    #[test]
    fn white_noise_has_neither() {
        let found = Crispness::of_rings(&rings(|_| 1.0), 1.0 / 64.0);
        assert_eq!(
            found,
            Crispness {
                nu_eff: 0.0,
                omega: 0.0
            }
        );
    }
}
