//! Errors of the library as `strew.StrewError`, in words for Python: limits are those of this process, which has no
//! folder of tables.

use pyo3::prelude::*;
use strew_error::{Error, Fault, Kind};

use crate::loaded;

/// Words of faults that a limit causes, and the limit.
const CAUSED: [(&str, &str); 3] = [
    ("take a spacing below", "rows"),
    ("too many vertices", "vertices"),
    ("pixels", "pixels"),
];

/// The Python exception of an error.
pub fn raised(py: Python<'_>, error: &Error) -> PyErr {
    exception(py, error).unwrap_or_else(|failed| failed)
}

fn exception(py: Python<'_>, error: &Error) -> PyResult<PyErr> {
    let faults: Vec<Fault> = error.faults().iter().cloned().map(reworded).collect();
    let plain = error.to_string().replace("this server", "this process");
    let message = match error.kind() {
        Kind::Invalid => faults
            .iter()
            .map(Fault::to_string)
            .collect::<Vec<_>>()
            .join("; "),
        Kind::TooManyPoints => plain + ", or raise strew.limits(points=…)",
        Kind::TooManyRows => plain + ", or raise strew.limits(rows=…)",
        _ => plain,
    };
    let refusal = py.import("strew._errors")?.getattr("refusal")?;
    let made = refusal.call1((message, error.kind().slug(), loaded(py, &faults)?))?;
    Ok(PyErr::from_value(made))
}

fn reworded(mut fault: Fault) -> Fault {
    if let Some(at) = fault.detail.find("; it can be made with strew forge") {
        fault.detail.truncate(at);
        fault.detail +=
            "; other tables than the built-in ones take a daemon that has them: strew.connect(url)";
    }
    let limit = CAUSED
        .iter()
        .find(|(words, _)| fault.detail.contains(words));
    if let Some((_, limit)) = limit {
        fault.allowed += &format!(", or strew.limits({limit}=…) raised");
    }
    fault
}
