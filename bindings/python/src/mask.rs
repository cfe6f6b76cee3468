//! Threshold masks as arrays.

use pyo3::{prelude::*, types::PyBytes};
use strew_error::{Error, Fault};
use strew_forge::mask::{Mask, MaskError};
use strew_query::{chosen, groups, parse_pairs};

use crate::{failure::raised, library};

/// The ranks of a mask's pixels, row by row, as `u32` in the order of this machine. `address` chooses the table, as of
/// `GET /v1/mask.png`.
#[pyfunction]
pub fn mask<'py>(
    py: Python<'py>,
    size: u32,
    seed: u64,
    address: &str,
) -> PyResult<Bound<'py, PyBytes>> {
    let library = library()?;
    let made = py.detach(|| {
        let entry = chosen(&parse_pairs(address, groups::TABLES), library.catalog())?;
        Mask::new(&entry.table()?, size, seed).map_err(refused)
    });
    let made = made.map_err(|error| raised(py, &error))?;
    let bytes: Vec<u8> = made
        .ranks()
        .iter()
        .flat_map(|rank| rank.to_ne_bytes())
        .collect();
    Ok(PyBytes::new(py, &bytes))
}

fn refused(error: MaskError) -> Error {
    let MaskError {
        field,
        value,
        allowed,
    } = error;
    Fault::new(&field, value, "no mask can be made", allowed).into()
}
