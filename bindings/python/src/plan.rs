//! A planned query: counted exactly, and made when its points are wanted.

use std::sync::Arc;

use pyo3::{prelude::*, types::PyBytes};
use strew_encode::{Crs, Encoding};
use strew_plan::Planned;
use strew_query::{Options, Values, groups, options};

use crate::{
    array::{Array, Owner},
    columns::Columns,
    failure::raised,
    json, library,
};

/// A planned query, and the plane that it is in.
#[pyclass(frozen, module = "strew._strew")]
pub struct Plan(Planned, Option<Crs>);

impl Plan {
    pub fn new((planned, options): (Planned, Options)) -> Self {
        Self(planned, options.plane)
    }
}

#[pymethods]
impl Plan {
    /// The exact number of points.
    fn count(&self) -> u128 {
        self.0.count()
    }

    /// The query with everything filled in, as JSON.
    fn query(&self) -> PyResult<String> {
        json(&self.0.resolved())
    }

    /// The digests of its tables.
    fn tables(&self) -> Vec<String> {
        let tables = self.0.query.tables();
        tables.into_iter().map(Into::into).collect()
    }

    /// The cursor of the points after these, if there are any.
    fn next(&self) -> Option<String> {
        self.0.next().map(|token| token.to_string())
    }

    /// All columns.
    fn columns(&self, py: Python<'_>) -> PyResult<Columns> {
        let library = library()?;
        let made = py.detach(|| library.columns(&self.0));
        let made = made.map_err(|error| raised(py, &error))?;
        Ok(Columns(Arc::new(made)))
    }

    /// The coordinates alone.
    fn coordinates(&self, py: Python<'_>) -> PyResult<Array> {
        let library = library()?;
        let made = py.detach(|| library.coordinates(&self.0));
        let made = made.map_err(|error| raised(py, &error))?;
        let axes = self.0.axes();
        Ok(Array(Owner::Coordinates(Arc::new(made), axes)))
    }

    /// The parts: the cursor at which each begins, and its count.
    fn split(&self, py: Python<'_>, parts: &str) -> PyResult<Vec<(String, u64)>> {
        let library = library()?;
        let parts = py.detach(|| library.split(&self.0, parts));
        let parts = parts.map_err(|error| raised(py, &error))?;
        let text = parts
            .into_iter()
            .map(|(token, count)| (token.to_string(), count));
        Ok(text.collect())
    }

    /// The points as a document; options are pairs of names and texts.
    fn document<'py>(
        &self,
        py: Python<'py>,
        given: Vec<(String, String)>,
    ) -> PyResult<Bound<'py, PyBytes>> {
        let library = library()?;
        let write = || {
            let mut values = Values::new(groups::OUTPUT, "");
            for (name, text) in &given {
                values.add_text(name, text);
            }
            values.read()?;
            let options = options(&values)?.of_plane(self.1.clone())?;
            let answer = library.document(&self.0, options, Encoding::Json)?;
            let mut whole = vec![];
            for block in answer {
                whole.extend_from_slice(&block?);
            }
            Ok::<_, strew_error::Error>(whole)
        };
        let written = py.detach(write).map_err(|error| raised(py, &error))?;
        Ok(PyBytes::new(py, &written))
    }
}
