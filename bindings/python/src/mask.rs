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
    let total = Mask::steps(size).into();
    let made = work::done(py, Some(total), move |library| {
        let entry = chosen(&parse_pairs(&address, groups::TABLES), library.catalog())?;
        let goes_on = |pixels| library.work().goes_on(pixels);
        let made = Mask::new_while(&entry.table()?, size, seed, goes_on);
        let detail = "no mask can be made";
        let made =
            made.map_err(|error| Fault::new(&error.field, error.value, detail, error.allowed))?;
        made.ok_or(Error::Internal("the mask was stopped"))
    })?;
    let bytes = made.ranks().iter().flat_map(|rank| rank.to_ne_bytes());
    Ok(PyBytes::new(py, &bytes.collect::<Vec<u8>>()))
}
