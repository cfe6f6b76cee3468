//! Where names and files of documents lead, and what building takes.

use std::cell::Cell;

use strew_core::field::FieldSpec;

use crate::raster::{Image, RasterError};

/// Reads a file by the name that a document has for it; the size is that of bare floats.
pub type ReadFile<'a> = dyn Fn(&str, Option<[usize; 2]>) -> Result<Image, RasterError> + 'a;

/// Where names and files of documents lead.
pub struct Sources<'a> {
    /// The field of a name.
    pub named: &'a dyn Fn(&str) -> Option<FieldSpec>,
    /// The names that there are, for faults.
    pub names: &'a dyn Fn() -> String,
    /// Reads files; `None` where documents may not name any.
    pub files: Option<&'a ReadFile<'a>>,
    /// How many pixels documents may still hold.
    pub pixels: Cell<usize>,
    /// A box around all pixels that were read.
    pub frame: Cell<Option<[f64; 4]>>,
    /// The memory that all pixels take, in bytes.
    pub bytes: Cell<usize>,
}

/// What the library says is wrong; often the value says it all.
pub(super) fn problem(error: &strew_core::Error) -> &str {
    match error.problem() {
        "" => "not allowed",
        problem => problem,
    }
}
