//! A field with its name.

use strew_core::field::FieldSpec;

use super::{Document, files::Stamp};
use crate::{
    named::{Loaded, Source},
    sent::Sendable,
};

#[derive(Clone, Debug)]
pub struct NamedField {
    pub name: String,
    pub source: Source,
    pub document: Document,
    pub spec: FieldSpec,
    /// The memory that its pixels take, in bytes.
    pub bytes: usize,
    /// A box around its pixels, if it has any: min x, min y, max x, max y.
    pub bbox: Option<[f64; 4]>,
    /// The code of EPSG of their plane, if a file states it.
    pub epsg: Option<u16>,
    /// The stamp of its files when it was read.
    pub(super) stamp: Stamp,
}

impl NamedField {
    pub fn of_spec(name: &str, spec: FieldSpec) -> Self {
        Self {
            name: name.into(),
            source: Source::Config("fields", name.into()),
            document: Document::Name(name.into()),
            spec,
            bytes: 0,
            bbox: None,
            epsg: None,
            stamp: Stamp::default(),
        }
    }

    /// A field that a client has sent; its name is its digest. Pixels are not held twice.
    pub fn sent(
        mut document: Document,
        spec: FieldSpec,
        bytes: usize,
        bbox: Option<[f64; 4]>,
    ) -> Self {
        document.each_pixels(&mut |pixels| (pixels.png, pixels.f32) = (None, None));
        let name = spec.digest().to_string();
        Self {
            document,
            bytes,
            bbox,
            ..Self::of_spec(&name, spec)
        }
    }

    /// Its digest, in hexadecimal.
    pub fn digest(&self) -> String {
        self.spec.digest().to_string()
    }
}

impl Loaded for NamedField {
    const KIND: &'static str = "field";

    fn digest(&self) -> String {
        self.digest()
    }
}

impl Sendable for NamedField {
    fn name(&self) -> &str {
        &self.name
    }

    fn size(&self) -> usize {
        /// The most bytes of a field besides its pixels: its shapes and vertices.
        const SHAPES: usize = 16 << 10;
        /// The bytes of a vertex, with its place in a tree.
        const VERTEX: usize = 64;
        SHAPES + self.bytes + VERTEX * self.spec.vertices()
    }
}
