//! The native part of the Python package: the library's answers as Python objects, and nothing else.
//!
//! Queries come in as the text that REST takes, and refusals leave as a `StrewError`. Work is done without
//! the interpreter's lock, and Ctrl-C ends it.

mod array;
mod arrow;
mod columns;
mod failure;
mod mask;
mod measured;
mod plan;
mod work;

use std::sync::OnceLock;

use pyo3::{
    exceptions::{PyRuntimeError, PyValueError},
    prelude::*,
    types::PyBytes,
};
use strew_plan::Library;
use strew_raster::{Image, Limits};

use columns::Columns;
use measured::Report;
use plan::Plan;

/// The library, which is made when it is first used.
fn library() -> PyResult<&'static Library> {
    static LIBRARY: OnceLock<Result<Library, String>> = OnceLock::new();
    let library = LIBRARY.get_or_init(|| Library::new().map_err(|error| error.to_string()));
    let failed = |error: &String| PyRuntimeError::new_err(error.clone());
    library.as_ref().map_err(failed)
}

/// Plans the query of a body of `POST /v1/points:query`, or of `POST /v1/space/points`.
#[pyfunction]
#[pyo3(name = "plan")]
fn planned(py: Python<'_>, body: String, in_space: bool) -> PyResult<Plan> {
    let plan = if in_space {
        Library::plan_in_space
    } else {
        Library::plan
    };
    work::done(py, None, move |library| plan(library, body.as_bytes())).map(Plan::new)
}

/// The document of `GET /v1/points/{id}`, or of `GET /v1/space/points/{id}`, without its query.
#[pyfunction]
fn point(
    py: Python<'_>,
    id: String,
    address: String,
    in_space: bool,
) -> PyResult<Bound<'_, PyAny>> {
    let find = if in_space {
        Library::point_in_space
    } else {
        Library::point
    };
    loaded(
        py,
        &work::done(py, None, move |library| find(library, &id, &address))?,
    )
}

/// The list of `GET /v1/nearest`, or of `GET /v1/space/nearest`.
#[pyfunction]
fn nearest(py: Python<'_>, address: String, in_space: bool) -> PyResult<Bound<'_, PyAny>> {
    let find = if in_space {
        Library::nearest_in_space
    } else {
        Library::nearest
    };
    loaded(
        py,
        &work::done(py, None, move |library| find(library, &address))?,
    )
}

/// Holds a field, a body of `POST /v1/fields`, and returns its digest.
#[pyfunction]
fn hold_field(py: Python<'_>, body: String) -> PyResult<String> {
    work::done(py, None, move |library| library.hold_field(&body))
}

/// A picture's width, height and darkness in linear light, as 16-bit words, row by row from the top.
#[pyfunction]
fn darkness<'py>(
    py: Python<'py>,
    picture: Vec<u8>,
    invert: bool,
) -> PyResult<(usize, usize, Bound<'py, PyBytes>)> {
    let read = work::done(py, None, move |_| {
        let image = Image::read_picture(std::io::Cursor::new(picture), Limits::FILES);
        Ok(image.map(|image| {
            let words = image.darkness(invert);
            let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_ne_bytes()).collect();
            (image.size, bytes)
        }))
    });
    let ([width, height], bytes) = read?
        .map_err(|error| PyValueError::new_err(format!("the picture cannot be read: {error}")))?;
    Ok((width, height, PyBytes::new(py, &bytes)))
}

/// A value as what `json.loads` makes of it.
fn loaded<'py>(py: Python<'py>, value: &impl serde::Serialize) -> PyResult<Bound<'py, PyAny>> {
    let text = serde_json::to_string(value);
    let text = text.map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
    py.import("json")?.call_method1("loads", (text,))
}

#[pymodule]
fn _strew(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<Plan>()?;
    module.add_class::<Columns>()?;
    module.add_class::<array::Array>()?;
    module.add_class::<Report>()?;
    module.add_function(wrap_pyfunction!(planned, module)?)?;
    module.add_function(wrap_pyfunction!(point, module)?)?;
    module.add_function(wrap_pyfunction!(nearest, module)?)?;
    module.add_function(wrap_pyfunction!(hold_field, module)?)?;
    module.add_function(wrap_pyfunction!(darkness, module)?)?;
    module.add_function(wrap_pyfunction!(work::limits, module)?)?;
    module.add_function(wrap_pyfunction!(mask::mask, module)?)?;
    module.add_function(wrap_pyfunction!(measured::measure, module)?)
}
