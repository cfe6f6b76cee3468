//! Points as columns, of the library or of a daemon.

use std::sync::Arc;

use pyo3::{
    exceptions::PyValueError,
    prelude::*,
    pybacked::PyBackedBytes,
    types::{PyCapsule, PyDict},
};
use strew_plan::library::{Further, FurtherValues};

use crate::{
    array::{Array, Owner},
    arrow,
};

/// Points as columns of the same length.
#[pyclass(frozen, module = "strew._strew")]
pub struct Columns(pub Arc<strew_plan::Columns>);

/// A column as it comes from a daemon: name, whether it may be missing, bytes, names.
type Received = (String, bool, PyBackedBytes, Option<Vec<String>>);

#[pymethods]
impl Columns {
    /// Columns that a daemon has sent, as bytes in the order of this machine, for their stream. Points have `axes`
    /// coordinates, 2 or 3.
    #[staticmethod]
    fn received(axes: usize, ids: &[u8], at: &[u8], further: Vec<Received>) -> PyResult<Self> {
        let ids = numbers(ids, i64::from_ne_bytes)?;
        let at = numbers(at, f64::from_ne_bytes)?;
        if !(2..=3).contains(&axes) || at.len() % axes != 0 || ids.len() != at.len() {
            return Err(damaged());
        }
        let count = at.len() / axes;
        let column = |(name, is_optional, bytes, names): Received| -> PyResult<Further> {
            let values = match names {
                None => FurtherValues::Numbers(numbers(&bytes, f64::from_ne_bytes)?),
                Some(names) => {
                    FurtherValues::Names(names.into(), numbers(&bytes, i32::from_ne_bytes)?)
                }
            };
            let (length, is_known) = match &values {
                FurtherValues::Numbers(values) => (values.len(), true),
                FurtherValues::Names(names, values) => {
                    let known = -1..i32::try_from(names.len()).unwrap_or(i32::MAX);
                    (values.len(), values.iter().all(|i| known.contains(i)))
                }
            };
            if length != count || !is_known {
                return Err(damaged());
            }
            Ok(Further {
                name,
                is_optional,
                values,
            })
        };
        let columns = strew_plan::Columns {
            axes,
            origin: None,
            ids,
            at,
            further: further.into_iter().map(column).collect::<PyResult<_>>()?,
        };
        Ok(Self(Arc::new(columns)))
    }

    fn __len__(&self) -> usize {
        self.0.len()
    }

    fn __repr__(&self) -> String {
        format!(
            "<{} points: id, coordinates, {:?}>",
            self.0.len(),
            self.names()
        )
    }

    /// The place that coordinates are relative to, if it is not the world's origin.
    #[getter]
    fn origin(&self) -> Option<Vec<f64>> {
        self.0.origin.map(|origin| origin.as_slice().to_vec())
    }

    /// The ids, two integers each, three in space.
    fn ids(&self) -> Array {
        Array(Owner::Ids(self.0.clone()))
    }

    /// The coordinates, two numbers each, three in space.
    fn at(&self) -> Array {
        Array(Owner::At(self.0.clone()))
    }

    /// The names of the further columns.
    fn names(&self) -> Vec<String> {
        let further = self.0.further.iter();
        further.map(|column| column.name.clone()).collect()
    }

    /// The values of a further column, and the names that they are indices into, if they are.
    fn further(&self, i: usize) -> PyResult<(Array, Option<Vec<String>>)> {
        let column = self.0.further.get(i);
        let column = column.ok_or_else(|| PyValueError::new_err("no such column"))?;
        let names = match &column.values {
            FurtherValues::Numbers(_) => None,
            FurtherValues::Names(names, _) => Some(names.to_vec()),
        };
        Ok((Array(Owner::Further(self.0.clone(), i)), names))
    }

    /// A capsule with an Arrow stream of all columns; `metadata` becomes that of the schema.
    fn arrow_stream<'py>(
        &self,
        py: Python<'py>,
        metadata: &Bound<'py, PyDict>,
    ) -> PyResult<Bound<'py, PyCapsule>> {
        let stream = arrow::Stream::new(self.0.clone(), metadata.extract()?);
        PyCapsule::new_with_value(py, stream, c"arrow_array_stream")
    }
}

fn damaged() -> PyErr {
    PyValueError::new_err("columns of different lengths")
}

pub fn numbers<T, const N: usize>(bytes: &[u8], read: fn([u8; N]) -> T) -> PyResult<Vec<T>> {
    let (whole, []) = bytes.as_chunks::<N>() else {
        return Err(damaged());
    };
    Ok(whole.iter().map(|bytes| read(*bytes)).collect())
}
