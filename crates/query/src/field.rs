//! The field of a set: by name, or as the query describes it.

use std::cell::{Cell, RefCell};

use strew_catalog::{
    Catalog, Dimension,
    field::{Allowance, Document},
};
use strew_core::field::FieldSpec;
use strew_error::{Checked, Error, Fault};

use super::{Values, parameters::FIELD};

#[derive(Clone, Debug, PartialEq)]
pub struct SetField {
    /// Its name, if it is one that is loaded.
    pub name: Option<String>,
    /// Whether it is, or is made of, fields that are loaded, which may change.
    pub has_names: bool,
    pub spec: FieldSpec,
    /// Its digest, in hexadecimal.
    pub digest: String,
    /// The code of EPSG of its plane, if a raster states it.
    pub epsg: Option<u16>,
}

impl SetField {
    /// Refuses one with places of three numbers.
    pub(super) fn of_plane(self, path: &str) -> Checked<Self> {
        match self.spec.is_in_space() {
            true => {
                let (detail, allowed) =
                    ("a place has a z: for points in space", "places of x and y");
                Err(Fault::new(path, "", detail, allowed).into())
            }
            false => Ok(self),
        }
    }
}

/// The loaded fields, and the pixels and memory that the fields of a query may still take.
pub(super) struct Loaded<'a> {
    pub(super) catalog: &'a Catalog,
    pixels: Cell<usize>,
    allowance: Allowance<'a>,
    refused: RefCell<Option<Error>>,
}

impl<'a> Loaded<'a> {
    pub(super) fn new(catalog: &'a Catalog, allowance: Allowance<'a>) -> Self {
        Self {
            allowance,
            refused: RefCell::new(None),
            catalog,
            pixels: Cell::new(catalog.most_pixels()),
        }
    }

    /// The field of some values, if they have one.
    pub(super) fn field(&self, values: &Values) -> Checked<Option<SetField>> {
        let Some(document) = values.get::<std::sync::Arc<Document>>(&FIELD)? else {
            return Ok(None);
        };
        let path = format!("{}{}", values.path(), FIELD.name);
        let field = self.built(&path, &document)?;
        match values.dimension() {
            Dimension::Plane => field.of_plane(&path).map(Some),
            Dimension::Space => Ok(Some(field)),
        }
    }

    pub(super) fn built(&self, path: &str, document: &Document) -> Checked<SetField> {
        let (pixels, allowance) = (self.pixels.get(), self.allowance);
        let (spec, sources) = self.catalog.build_field(path, document, pixels, allowance);
        self.pixels.set(sources.left);
        let epsg = sources.epsg;
        if sources.refused.is_some() {
            self.refused.replace(sources.refused);
        }
        let spec = spec?;
        Ok(SetField {
            name: match document {
                Document::Name(name) => Some(name.clone()),
                _ => None,
            },
            has_names: document.has_names(),
            digest: spec.digest().to_string(),
            epsg,
            spec,
        })
    }
    /// Whether there was memory for all fields. If not, the faults of fields follow from that.
    pub(super) fn had_room(&self) -> Result<(), Error> {
        self.refused.take().map_or(Ok(()), Err)
    }
}
