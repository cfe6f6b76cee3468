//! Everything that is measured on one point set, for people and for plots.

use strew_core::table::Figures;

use crate::{
    judge::{RING_WIDTH, figures_of_spectrum},
    measure::{Distances, Rdf, Ring, Spectrum, Torus, Voronoi, Window},
};

/// A point set with all its figures and curves, at unit density.
#[derive(Clone, Debug)]
pub struct Report {
    /// The named figures, rounded to four significant digits.
    pub figures: Figures,
    /// Radial power and anisotropy, in rings of [`RING_WIDTH`].
    pub rings: Vec<Ring>,
    /// The radial distribution function.
    pub rdf: Rdf,
    /// The power of every mode.
    pub spectrum: Spectrum,
    /// The points, in mean spacings.
    pub points: Vec<[f64; 2]>,
}

impl Report {
    /// Of a periodic set, up to the frequency `nu_max`.
    #[must_use]
    pub fn of_torus(subject: String, seen: bool, set: &Torus, nu_max: f64) -> Self {
        let spectrum = Spectrum::of_torus(set, nu_max);
        let named =
            figures_of_spectrum(&spectrum, Distances::of_torus(set), Voronoi::of_torus(set));
        Self::new(
            subject,
            seen,
            named,
            spectrum,
            Rdf::of_torus(set),
            set.points(),
        )
    }

    /// Of a window of an unbounded set, up to the frequency `nu_max`.
    #[must_use]
    pub fn of_window(subject: String, seen: bool, set: &Window, nu_max: f64) -> Self {
        let spectrum = Spectrum::of_window(set, nu_max);
        let named = figures_of_spectrum(
            &spectrum,
            Distances::of_window(set),
            Voronoi::of_window(set),
        );
        Self::new(
            subject,
            seen,
            named,
            spectrum,
            Rdf::of_window(set),
            set.points(),
        )
    }

    fn new(
        subject: String,
        seen: bool,
        values: Vec<(String, f64)>,
        spectrum: Spectrum,
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
            rings: spectrum.rings(RING_WIDTH),
            rdf,
            spectrum,
            points: points.to_vec(),
        }
    }
}
