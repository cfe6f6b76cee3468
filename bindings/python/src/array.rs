//! Memory of the library that numpy looks at without a copy, by its array interface.

use std::sync::Arc;

use pyo3::{prelude::*, types::PyDict};
use strew_plan::{Columns, library::FurtherValues};

/// The owner of an array's memory.
#[derive(Clone)]
pub enum Owner {
    /// Coordinates, this number of them for each point.
    Coordinates(Arc<Vec<f64>>, usize),
    /// The ids of columns.
    Ids(Arc<Columns>),
    /// The coordinates of columns.
    At(Arc<Columns>),
    /// The values of one further column.
    Further(Arc<Columns>, usize),
}

/// An array that numpy can look at: `numpy.asarray(array)`.
#[pyclass(frozen, module = "strew._strew")]
pub struct Array(pub Owner);

#[pymethods]
impl Array {
    /// <https://numpy.org/doc/stable/reference/arrays.interface.html>; read only.
    #[getter]
    fn __array_interface__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let (address, shape, kind) = match &self.0 {
            Owner::Coordinates(at, axes) => {
                (at.as_ptr().addr(), vec![at.len() / axes, *axes], "f8")
            }
            Owner::Ids(columns) => (
                columns.ids.as_ptr().addr(),
                vec![columns.len(), columns.axes],
                "i8",
            ),
            Owner::At(columns) => (
                columns.at.as_ptr().addr(),
                vec![columns.len(), columns.axes],
                "f8",
            ),
            Owner::Further(columns, i) => match &columns.further[*i].values {
                FurtherValues::Numbers(v) => (v.as_ptr().addr(), vec![v.len()], "f8"),
                FurtherValues::Names(_, v) => (v.as_ptr().addr(), vec![v.len()], "i4"),
            },
        };
        let order = if cfg!(target_endian = "big") {
            ">"
        } else {
            "<"
        };
        let interface = PyDict::new(py);
        interface.set_item("version", 3)?;
        interface.set_item("data", (address, true))?;
        interface.set_item("shape", pyo3::types::PyTuple::new(py, shape)?)?;
        interface.set_item("typestr", format!("{order}{kind}"))?;
        Ok(interface)
    }
}
