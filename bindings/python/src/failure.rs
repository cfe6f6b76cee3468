//! Errors of the library as `strew.StrewError`, in words for Python: limits are those of this process, which has no
//! folder of tables.

use pyo3::prelude::*;
use strew_error::{Error, Fault, Kind};

use crate::loaded;

/// Words of faults that a limit causes, and the limit.
const CAUSED: [(&str, &str); 3] = [
    ("take a spacing below", "rows"),
    ("too many vertices", "vertices"),
    (" × ", "pixels"),
];

/// What errors advise users of daemons, up to its end.
const ADVICE: [(&str, &str); 2] = [
    ("it can be made with strew forge", "(tables.folder)"),
    ("a list that the server", "(POST /v1/except)"),
];

/// The Python exception of an error.
pub fn raised(py: Python<'_>, error: &Error) -> PyErr {
    exception(py, error).unwrap_or_else(|failed| failed)
}

fn exception(py: Python<'_>, error: &Error) -> PyResult<PyErr> {
    let faults: Vec<Fault> = error.faults().iter().cloned().map(reworded).collect();
    let plain = error.to_string().replace("this server", "this process");
    let told: Vec<String> = faults.iter().map(Fault::to_string).collect();
    let message = match error.kind() {
        Kind::Invalid => told.join("; "),
        Kind::TooManyPoints => plain + ", or raise strew.limits(points=…)",
        Kind::TooManyRows => plain + ", or raise strew.limits(rows=…)",
        _ => plain,
    };
    let refusal = py.import("strew._errors")?.getattr("refusal")?;
    let made = refusal.call1((message, error.kind().slug(), loaded(py, &faults)?))?;
    Ok(PyErr::from_value(made))
}

fn reworded(mut fault: Fault) -> Fault {
    for text in [&mut fault.detail, &mut fault.allowed] {
        for (advice, end) in ADVICE {
            if let Some(at) = text.find(advice) {
                let end = text.find(end).map_or(text.len(), |found| found + end.len());
                text.replace_range(at..end, "a daemon may have others: strew.connect(url)");
            }
        }
    }
    let is_cause = |(words, _): &&(&str, &str)| fault.detail.contains(words);
    if let Some((_, limit)) = CAUSED.iter().find(is_cause) {
        fault.allowed += &format!(", or strew.limits({limit}=…) raised");
    }
    fault
}
