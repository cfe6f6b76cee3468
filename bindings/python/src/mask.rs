//! Threshold masks as arrays.

use pyo3::{prelude::*, types::PyBytes};
use strew_error::{Error, Fault};
use strew_forge::mask::Mask;
use strew_query::{chosen, groups, parse_pairs};

use crate::work;

/// The ranks of a mask's pixels, row by row, as `u32` in the order of this machine. `address` chooses the table, as of
/// `GET /v1/mask.png`.
#[pyfunction]
pub fn mask<'py>(
    py: Python<'py>,
    size: u32,
    seed: u64,
    address: String,
) -> PyResult<Bound<'py, PyBytes>> {
    // The pixels that turn on, and those of the clusters that turn off before.
    let total = u128::from(size) * u128::from(size) * 60 / 56;
    let made = work::done(py, Some(total), move |library| {
        let entry = chosen(&parse_pairs(&address, groups::TABLES), library.catalog())?;
        let goes_on = || library.work().goes_on(1000);
        let made = Mask::new_while(&entry.table()?, size, seed, goes_on);
        let made = made.map_err(|error| {
            Fault::new(
                &error.field,
                error.value,
                "no mask can be made",
                error.allowed,
            )
        })?;
        made.ok_or(Error::Internal("the mask was stopped"))
    })?;
    let bytes: Vec<u8> = made
        .ranks()
        .iter()
        .flat_map(|rank| rank.to_ne_bytes())
        .collect();
    Ok(PyBytes::new(py, &bytes))
}
