//! A planned query: counted exactly, and made when its points are wanted.

use std::sync::Arc;

use pyo3::{prelude::*, types::PyBytes};
use strew_encode::{Crs, Encoding};
use strew_error::Error;
use strew_plan::{Library, Planned};
use strew_query::{Options, Values, groups};

use crate::{
    array::{Array, Owner},
    columns::Columns,
    loaded, work,
};

/// A planned query, and the plane that it is in.
#[pyclass(frozen, module = "strew._strew")]
pub struct Plan(Arc<Planned>, Option<Crs>);

impl Plan {
    pub fn new((planned, options): (Planned, Options)) -> Self {
        Self(planned.into(), options.plane)
    }

    /// Work on the planned query that can be stopped; whether it `makes` the points.
    fn done<T: Send + 'static>(
        &self,
        py: Python<'_>,
        makes: bool,
        work: impl FnOnce(&Library, &Planned) -> Result<T, Error> + Send + 'static,
    ) -> PyResult<T> {
        let planned = self.0.clone();
        work::done(py, makes.then(|| planned.count()), move |library| {
            let stop = &library.work().stop;
            work(library, &Planned::clone(&planned).stopped_by(stop))
        })
    }
}

#[pymethods]
impl Plan {
    /// The exact number of points.
    fn count(&self) -> u128 {
        self.0.count()
    }

    /// The query with everything filled in, as a `dict`.
    fn query<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        loaded(py, &self.0.resolved())
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
        let made = self.done(py, true, Library::columns)?;
        Ok(Columns(Arc::new(made)))
    }

    /// The coordinates alone.
    fn coordinates(&self, py: Python<'_>) -> PyResult<Array> {
        let made = self.done(py, true, Library::coordinates)?;
        let axes = self.0.axes();
        Ok(Array(Owner::Coordinates(Arc::new(made), axes)))
    }

    /// The parts: the cursor at which each begins, and its count.
    fn split(&self, py: Python<'_>, parts: &Bound<'_, PyAny>) -> PyResult<Vec<(String, u64)>> {
        let parts = parts.str()?.to_string();
        let parts = self.done(py, false, move |library, planned| {
            library.split(planned, &parts)
        })?;
        let text = parts
            .into_iter()
            .map(|(token, count)| (token.to_string(), count));
        Ok(text.collect())
    }

    /// The points as a document; options are pairs of names and texts.
    fn document<'py>(
        &self,
        py: Python<'py>,
        options: Vec<(String, String)>,
    ) -> PyResult<Bound<'py, PyBytes>> {
        let plane = self.1.clone();
        let written = self.done(py, false, move |library, planned| {
            let mut values = Values::new(groups::OUTPUT, "");
            for (name, text) in &options {
                values.add_text(name, text);
            }
            values.read()?;
            let options = strew_query::options(&values)?.of_plane(plane)?;
            let answer = library.document(planned, options, Encoding::Json)?;
            let mut whole = vec![];
            for block in answer {
                whole.extend_from_slice(&block?);
                if library.work().stop.is_raised() {
                    break;
                }
            }
            Ok(whole)
        })?;
        Ok(PyBytes::new(py, &written))
    }
}
