//! Portraits: what the points of a table look like, measured on a window.
//!
//! A portrait takes a good part of a second to make, so each is made once and kept.

use strew_catalog::Entry;
use strew_error::Error;
use strew_forge::{Report, Resolution, figure, measure::window_set};

/// The number of points in a portrait.
const POINTS: u64 = 20_000;
/// No more portraits are kept; each has about 60 kB.
pub(super) const MOST: u64 = 64;

/// Curves and a picture of a table's points.
#[derive(Clone, Debug)]
pub struct Portrait {
    /// The number of points measured.
    pub points: u64,
    /// ν, radial power, anisotropy in dB.
    pub radial: Vec<[f64; 3]>,
    /// Distance in mean spacings, radial distribution function.
    pub rdf: Vec<[f64; 2]>,
    /// Points, spectrum and curves, as SVG.
    pub svg: String,
}

impl Portrait {
    pub(super) fn new(entry: &Entry) -> Result<Self, Error> {
        let table = entry.table()?;
        let set = window_set(&table, POINTS, 1);
        let report = Report::of("window seed 1".into(), false, &set, Resolution::default());
        let target = entry.aim().and_then(|aim| aim.curve);
        let svg = figure::report(&report, &entry.key.to_string(), target.as_ref()).to_svg();
        Ok(Self {
            points: report.figures.points,
            radial: report
                .rings
                .iter()
                .map(|ring| [ring.nu, ring.power, ring.anisotropy_db])
                .collect(),
            rdf: report.rdf.bins,
            svg,
        })
    }
}
