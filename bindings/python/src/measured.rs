//! Figures and curves of points.

use std::sync::Mutex;

use pyo3::{exceptions::PyValueError, prelude::*};
use strew_forge::{Resolution, figure};
use strew_plan::library::measured::{self, Measured, document};

use crate::{failure::raised, json};

/// The measures of a set of points.
#[pyclass(frozen, module = "strew._strew")]
pub struct Report(Mutex<strew_forge::Report>);

#[pymethods]
impl Report {
    /// The figures and curves as JSON.
    fn document(&self) -> PyResult<String> {
        let report = self
            .0
            .lock()
            .map_err(|error| PyValueError::new_err(error.to_string()))?;
        json(&document(&report))
    }

    /// Points, spectrum and curves as SVG.
    fn svg(&self, title: &str) -> PyResult<String> {
        let report = self
            .0
            .lock()
            .map_err(|error| PyValueError::new_err(error.to_string()))?;
        Ok(figure::report(&report, title, None).to_svg())
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
    let (pairs, []) = points.as_chunks::<16>() else {
        return Err(PyValueError::new_err("points must be pairs of numbers"));
    };
    let number = |bytes: &[u8]| bytes.try_into().map_or(f64::NAN, f64::from_ne_bytes);
    let pair = |pair: &[u8; 16]| [number(&pair[..8]), number(&pair[8..])];
    let measured = py.detach(|| {
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
        measured::measure(pairs.iter().map(pair).collect(), &of)
    });
    let report = measured.map_err(|error| raised(py, &error))?;
    Ok(Report(Mutex::new(report)))
}
