//! Reports: everything that is measured on a point set, for readers and plots.

use strew_core::table::Figures;

use crate::{
    Target,
    judge::{RING_WIDTH, curve_figures, figures},
    measure::{Rdf, Ring, Sample, Spectrum},
};

/// The range and the ring width of a report's spectrum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Resolution {
    /// The largest ν that is measured.
    pub nu_max: f64,
    /// The width of rings in ν; 0 for rings one mode wide.
    pub ring_width: f64,
}

impl Default for Resolution {
    /// Up to ν = 4, in rings of [`RING_WIDTH`].
    fn default() -> Self {
        Self {
            nu_max: 4.0,
            ring_width: RING_WIDTH,
        }
    }
}

/// A point set at unit density with all its figures and curves.
#[derive(Clone, Debug)]
pub struct Report {
    /// The named figures, rounded to four significant digits.
    pub figures: Figures,
    /// Radial power and anisotropy, in the rings that the figures are taken over.
    pub rings: Vec<Ring>,
    /// The median anisotropy in each of the [`BANDS`](crate::measure::BANDS) that are measured, in dB.
    pub anisotropy_by_band: Vec<f64>,
    /// The radial distribution function.
    pub rdf: Rdf,
    /// The power of every mode.
    pub spectrum: Spectrum,
    /// The points, in mean spacings.
    pub points: Vec<[f64; 2]>,
}

impl Report {
    /// Measures a set. `subject` is its name in the figures, `seen` says whether its table was optimized on it.
    pub fn of(subject: String, seen: bool, set: &Sample, at: Resolution) -> Self {
        let spectrum = Spectrum::of(set, at.nu_max);
        Self {
            figures: figures(subject, seen, set, &spectrum, at.ring_width),
            rings: spectrum.rings(at.ring_width),
            anisotropy_by_band: spectrum.anisotropy_by_band(at.ring_width),
            rdf: Rdf::of(set),
            spectrum,
            points: set.points().to_vec(),
        }
    }

    /// Returns this report with the figures of a curve that the radial power should follow.
    pub fn compared(mut self, target: &Target) -> Self {
        let more = curve_figures(&self.spectrum, target);
        self.figures.values.extend(more);
        self
    }
}
