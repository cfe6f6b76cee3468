//! Figures and curves of points.

use std::sync::{Arc, Mutex, PoisonError};

use pyo3::prelude::*;
use strew_forge::{Resolution, figure};
use strew_plan::library::measured::{self, Measured, document};

use crate::{columns::numbers, loaded, work};

/// The measures of a set of points.
#[pyclass(frozen, module = "strew._strew")]
pub struct Report(Arc<Mutex<strew_forge::Report>>);

#[pymethods]
impl Report {
    /// The figures and curves, as in JSON.
    fn document<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        loaded(
            py,
            &document(&self.0.lock().unwrap_or_else(PoisonError::into_inner)),
        )
    }

    /// Points, spectrum and curves as SVG.
    fn svg(&self, py: Python<'_>, title: String) -> PyResult<String> {
        let report = self.0.clone();
        work::done(py, None, move |_| {
            let report = report.lock().unwrap_or_else(PoisonError::into_inner);
            Ok(figure::report(&report, &title, None).to_svg())
        })
    }
}

/// Measures points that fill a square: pairs of `f64` in the order of this machine.
#[pyfunction]
pub fn measure(
    py: Python<'_>,
    points: &[u8],
    bbox: [f64; 4],
    density: Option<f64>,
    is_periodic: bool,
    nu_max: f64,
    ring_width: Option<f64>,
) -> PyResult<Report> {
    let pairs = numbers(points, f64::from_ne_bytes)?.as_chunks().0.to_vec();
    let measured = work::done(py, None, move |library| {
        let plain = Resolution::default();
        let of = Measured {
            bbox,
            density,
            is_periodic,
            resolution: Resolution {
                nu_max,
                ring_width: ring_width.unwrap_or(plain.ring_width),
            },
        };
        measured::measure(pairs, &of, library.work())
    });
    Ok(Report(Arc::new(Mutex::new(measured?))))
}
