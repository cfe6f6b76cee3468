//! The references of field documents: other fields, and files.

use std::cell::{Cell, RefCell};

use strew_core::{field::FieldSpec, server::Stop};
use strew_error::{Checked, Error, Fault};
use strew_raster::{Image, Meaning, Price, RasterError};

use super::read::FIELD;

/// Reads a file by the name that a document has for it; the size is that of bare floats.
pub type ReadFile<'a> =
    dyn Fn(&str, Meaning, Option<[usize; 2]>) -> Result<Image, RasterError> + 'a;

/// The most pixels that a query may include, over all its layers.
pub const MOST_PIXELS: usize = 1 << 20;

#[derive(Clone, Copy)]
pub struct Allowance<'a> {
    /// Raised when the field is no longer wanted.
    pub stop: &'a Stop,
    /// Takes this many bytes of memory, before pixels are decoded.
    pub hold: &'a dyn Fn(usize) -> Result<(), Error>,
}

impl Allowance<'_> {
    pub const UNLIMITED: Allowance<'static> = Allowance {
        stop: &NEVER,
        hold: &|_| Ok(()),
    };
}

static NEVER: Stop = Stop::NEVER;

pub type Known = (FieldSpec, Option<u16>);

pub struct Sources<'a> {
    /// The field of a name, with the code of EPSG of its plane.
    pub named: &'a dyn Fn(&str) -> Option<Known>,
    pub names: &'a dyn Fn() -> String,
    /// Reads files; `None` where documents may not name any.
    pub files: Option<&'a ReadFile<'a>>,
    pub allowance: Allowance<'a>,
    /// Why there was no memory, if there was none.
    pub refused: RefCell<Option<Error>>,
    /// The number of pixels that documents may still hold.
    pub pixels: Cell<usize>,
    pub frame: Cell<Option<[f64; 4]>>,
    /// The code of EPSG of the plane that files of pixels state.
    pub epsg: Cell<Option<u16>>,
    /// The memory that all pixels take, in bytes.
    pub bytes: Cell<usize>,
}

impl<'a> Sources<'a> {
    /// Sources without files, of which documents may hold this number of pixels.
    pub fn new(
        named: &'a dyn Fn(&str) -> Option<Known>,
        names: &'a dyn Fn() -> String,
        allowance: Allowance<'a>,
        pixels: usize,
    ) -> Self {
        Self {
            named,
            names,
            files: None,
            allowance,
            refused: RefCell::new(None),
            pixels: Cell::new(pixels),
            frame: Cell::new(None),
            epsg: Cell::new(None),
            bytes: Cell::new(0),
        }
    }

    /// Takes what decoding pixels takes, also if nothing comes of it.
    pub(super) fn take(&self, path: &str, price: Price) -> Checked<()> {
        self.go_on(path)?;
        let left = self.pixels.get();
        if price.pixels > left {
            // Its size is refused where its header is read.
            return Ok(());
        }
        self.pixels.set(left - price.pixels);
        (self.allowance.hold)(price.bytes).map_err(|error| {
            let fault = Fault::new(path, "", error.to_string(), "fewer pixels");
            self.refused.replace(Some(error));
            fault.into()
        })
    }

    /// Takes the plane of a part.
    pub(super) fn meet(&self, path: &str, epsg: Option<u16>) -> Checked<()> {
        match (self.epsg.get(), epsg) {
            (Some(first), Some(other)) if first != other => {
                let detail = "another plane than that of an earlier part: places are not converted";
                let (other, first) = (format!("EPSG:{other}"), format!("EPSG:{first}"));
                Err(Fault::new(path, other, detail, first).into())
            }
            (first, other) => {
                self.epsg.set(first.or(other));
                Ok(())
            }
        }
    }

    pub(super) fn go_on(&self, path: &str) -> Checked<()> {
        match self.allowance.stop.is_raised() {
            true => Err(Fault::new(path, "", "not wanted any more", FIELD).into()),
            false => Ok(()),
        }
    }
}

/// The problem in words. It is often empty, since the value shows it.
pub(super) fn problem(error: &strew_core::Error) -> &str {
    match error.problem() {
        "" => "not allowed",
        problem => problem,
    }
}
