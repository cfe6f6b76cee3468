//! Reports: everything that is measured on a point set, for readers and plots.

use strew_core::table::Figures;

use crate::{
    Target,
    judge::{RING_WIDTH, curve_figures, figures_of_spectrum},
    measure::{Distances, Rdf, Ring, Spectrum, Torus, Voronoi, Window},
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
///
/// ```
/// use strew_core::Table;
/// use strew_forge::{Report, Resolution, measure::window_set};
///
/// // The AA pattern itself, in a window of about 2,000 points.
/// let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let window = window_set(&table, 2000, 1);
/// let report = Report::of_window("pattern".into(), false, &window, Resolution::default());
/// assert!(report.figures.value("delta_min").is_some_and(|delta| delta > 0.6));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
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
    /// Measures a periodic set. `subject` is its name in the figures, `seen` says whether its table
    /// was optimized on it.
    #[must_use]
    pub fn of_torus(subject: String, seen: bool, set: &Torus, at: Resolution) -> Self {
        let spectrum = Spectrum::of_torus(set, at.nu_max);
        let named = figures_of_spectrum(
            &spectrum,
            at.ring_width,
            Distances::of_torus(set),
            Voronoi::of_torus(set),
        );
        Self::new(
            subject,
            seen,
            named,
            (spectrum, at),
            Rdf::of_torus(set),
            set.points(),
        )
    }

    /// Measures a window of an unbounded set. `subject` is its name in the figures, `seen` says
    /// whether its table was optimized on it.
    #[must_use]
    pub fn of_window(subject: String, seen: bool, set: &Window, at: Resolution) -> Self {
        let spectrum = Spectrum::of_window(set, at.nu_max);
        let named = figures_of_spectrum(
            &spectrum,
            at.ring_width,
            Distances::of_window(set),
            Voronoi::of_window(set),
        );
        Self::new(
            subject,
            seen,
            named,
            (spectrum, at),
            Rdf::of_window(set),
            set.points(),
        )
    }

    fn new(
        subject: String,
        seen: bool,
        values: Vec<(String, f64)>,
        (spectrum, at): (Spectrum, Resolution),
        rdf: Rdf,
        points: &[[f64; 2]],
    ) -> Self {
        let figures = Figures {
            subject,
            seen,
            points: points.len() as u64,
            values,
        };
        Self {
            figures,
            rings: spectrum.rings(at.ring_width),
            anisotropy_by_band: spectrum.anisotropy_by_band(at.ring_width),
            rdf,
            spectrum,
            points: points.to_vec(),
        }
    }

    /// Returns this report with the figures of a curve that the radial power should follow.
    #[must_use]
    pub fn compared(mut self, target: &Target) -> Self {
        let more = curve_figures(&self.spectrum, target);
        self.figures.values.extend(more);
        self
    }
}
