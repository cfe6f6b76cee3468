//! Named figures and the bounds on them.

use strew_core::table::Figures;

use crate::measure::{Crispness, Distances, Spectrum, Torus, Voronoi, Window};

/// The width of the rings that radial figures are taken on, in ν: as fine as the smallest twin of
/// the default map resolves, and the same for sets of all sizes, so that their peaks compare.
pub const RING_WIDTH: f64 = 1.0 / 64.0;

/// The largest frequency measured.
pub(super) const NU_MAX: f64 = 4.0;

/// A figure measured on a point set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Figure {
    /// Mean power where the target is 0, up to 0.9 of where that ends.
    QuietPower,
    /// The root of the mean squared error of the radial power, ring by ring.
    TargetRms,
    /// The same, of the error over the target, as far as the curve is drawn.
    TargetRelative,
    /// The largest error of a ring.
    TargetWorst,
    /// Where that ring is.
    TargetWorstNu,
    /// The largest difference from 1 of a ring beyond the end of the curve.
    TailWorst,
    /// Mean power over 0 < ν < 0.5.
    LowPower,
    /// The largest radial power.
    PeakPower,
    /// The frequency of the largest radial power.
    PeakNu,
    /// Median anisotropy over 0.8 < ν < 4, in dB.
    Anisotropy,
    /// The largest power of a single frequency.
    Tallest,
    /// The smallest nearest-neighbor distance, over that of the hexagonal lattice.
    DeltaMin,
    /// The mean nearest-neighbor distance, over that of the hexagonal lattice.
    DeltaAvg,
    /// The effective Nyquist frequency after Heck et al. (see [`Crispness`]).
    NuEff,
    /// The oscillation after Heck et al.
    Omega,
    /// The largest relative deviation of a Voronoi cell's area (see [`Voronoi`]).
    AreaDeviation,
    /// The radius of the largest empty circle, over the hexagonal lattice's distance of neighbors.
    LargestHole,
    /// Bond-orientational order.
    Q6,
}

impl Figure {
    /// The name in table files and messages.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::QuietPower => "quiet_power",
            Self::TargetRms => "target_rms",
            Self::TargetRelative => "target_relative_rms",
            Self::TargetWorst => "target_worst",
            Self::TargetWorstNu => "target_worst_nu",
            Self::TailWorst => "tail_worst",
            Self::LowPower => "low_power",
            Self::PeakPower => "peak_power",
            Self::PeakNu => "peak_nu",
            Self::Anisotropy => "anisotropy_db",
            Self::Tallest => "tallest_peak",
            Self::DeltaMin => "delta_min",
            Self::DeltaAvg => "delta_avg",
            Self::NuEff => "nu_eff",
            Self::Omega => "omega",
            Self::AreaDeviation => "area_deviation",
            Self::LargestHole => "largest_hole",
            Self::Q6 => "q6",
        }
    }
}

/// All figures of a set, radial ones on rings of width `ring_width`, rounded to four significant
/// digits: far more than they mean, and few enough that another order of a sum inside an FFT does
/// not show.
pub(crate) fn figures_of_spectrum(
    spectrum: &Spectrum,
    ring_width: f64,
    distances: Distances,
    cells: Voronoi,
) -> Vec<(String, f64)> {
    let ring_width = ring_width.max(spectrum.finest_ring());
    let summary = spectrum.summary(ring_width);
    let crispness = Crispness::of_rings(&spectrum.rings(ring_width), ring_width);
    [
        (Figure::LowPower, summary.low_power),
        (Figure::PeakPower, summary.peak_power),
        (Figure::PeakNu, summary.peak_nu),
        (Figure::Anisotropy, summary.anisotropy_db),
        (Figure::Tallest, summary.tallest),
        (Figure::DeltaMin, distances.delta_min),
        (Figure::DeltaAvg, distances.delta_avg),
        (Figure::NuEff, crispness.nu_eff),
        (Figure::Omega, crispness.omega),
        (Figure::AreaDeviation, cells.area_deviation),
        (Figure::LargestHole, cells.largest_hole),
        (Figure::Q6, cells.q6),
    ]
    .map(|(figure, value)| (figure.name().to_owned(), round(value)))
    .into()
}

/// The nearest decimal of four significant digits.
pub(super) fn round(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(0.0)
}

/// Measures a periodic set up to the frequency `nu_max`.
#[must_use]
pub fn figures_of_torus(subject: String, seen: bool, set: &Torus, nu_max: f64) -> Figures {
    Figures {
        subject,
        seen,
        points: set.points().len() as u64,
        values: figures_of_spectrum(
            &Spectrum::of_torus(set, nu_max),
            RING_WIDTH,
            Distances::of_torus(set),
            Voronoi::of_torus(set),
        ),
    }
}

/// Measures a window up to the frequency `nu_max`.
#[must_use]
pub fn figures_of_window(subject: String, seen: bool, set: &Window, nu_max: f64) -> Figures {
    Figures {
        subject,
        seen,
        points: set.points().len() as u64,
        values: figures_of_spectrum(
            &Spectrum::of_window(set, nu_max),
            RING_WIDTH,
            Distances::of_window(set),
            Voronoi::of_window(set),
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_keep_four_digits() {
        assert_eq!(round(0.123_456), 0.1235);
        assert_eq!(round(5.555_55e-6), 5.556e-6);
        assert_eq!(round(0.0), 0.0);
        assert_eq!(round(-12.345_6), -12.35);
    }
}
