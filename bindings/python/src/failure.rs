//! Errors of the library as `strew.StrewError`.

use pyo3::{prelude::*, types::PyDict};
use strew_error::Error;

/// The Python exception of an error.
pub fn raised(py: Python<'_>, error: &Error) -> PyErr {
    exception(py, error).unwrap_or_else(|failed| failed)
}

fn exception(py: Python<'_>, error: &Error) -> PyResult<PyErr> {
    let faults = error.faults().iter().map(|fault| {
        let told = PyDict::new(py);
        told.set_item("field", &fault.field)?;
        told.set_item("value", &fault.value)?;
        told.set_item("detail", &fault.detail)?;
        told.set_item("allowed", &fault.allowed)?;
        Ok(told)
    });
    let faults = faults.collect::<PyResult<Vec<_>>>()?;
    // Limits are those of this process here.
    let message = error.to_string().replace("this server", "this process");
    let refusal = py.import("strew._errors")?.getattr("refusal")?;
    let made = refusal.call1((message, error.kind().slug(), faults))?;
    Ok(PyErr::from_value(made))
}
