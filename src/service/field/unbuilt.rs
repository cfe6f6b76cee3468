//! Fields that are read from documents and rasters, but not built yet.

use std::{
    cell::Cell,
    collections::BTreeMap,
    io::BufReader,
    path::{Path, PathBuf},
    sync::Arc,
};

use strew_core::field::FieldSpec;

use super::{
    Document, Sources, build,
    document::Pixels,
    files::{self, Stamp},
    named::{FieldError, NamedField, Source},
    read,
};
use crate::{
    bounded_file,
    raster::{Image, Limits, MOST_SIDE, Meaning, RasterError},
};

/// The longest document.
const DOCUMENT_BYTES: u64 = 4 << 20;

/// A field that is read, but not built.
pub(super) struct Unbuilt {
    pub(super) name: String,
    pub(super) source: Source,
    pub(super) document: Result<Document, String>,
    /// Where the files that it names are.
    base: PathBuf,
}

impl Unbuilt {
    pub(super) fn new(
        name: String,
        source: Source,
        document: Result<Document, String>,
        base: &Path,
    ) -> Self {
        let is_allowed = |c: char| c.is_ascii_alphanumeric() || "_-.".contains(c);
        let is_name = (1..=64).contains(&name.len()) && name.chars().all(is_allowed);
        let document = match is_name {
            true => document,
            false => Err(format!(
                "`{name}` is no name; allowed: 1 to 64 ASCII letters, digits, _, - and ."
            )),
        };
        Self {
            name,
            source,
            document,
            base: base.into(),
        }
    }

    pub(super) fn of_file(path: PathBuf, base: &Path) -> Self {
        let part = |part: Option<&std::ffi::OsStr>| {
            part.unwrap_or_default().to_string_lossy().into_owned()
        };
        let (name, file) = (part(path.file_stem()), part(path.file_name()));
        let text = |path: &Path| {
            bounded_file::read_text(path, DOCUMENT_BYTES).map_err(|error| error.to_string())
        };
        let listed = |faults| super::listed(&faults);
        let document = match part(path.extension()).as_str() {
            "json" => text(&path).and_then(|text| read::read_json("field", &text).map_err(listed)),
            "toml" => text(&path).and_then(|text| {
                let table = text
                    .parse()
                    .map_err(|error: toml::de::Error| error.to_string())?;
                read::read_toml("field", &table).map_err(listed)
            }),
            _ => Ok(Document::Raster(Box::new(Pixels {
                file: Some(file),
                ..Pixels::default()
            }))),
        };
        Self::new(name, Source::File(path), document, base)
    }

    pub(super) fn error(&self, detail: String) -> FieldError {
        FieldError {
            source_name: self.source.to_string(),
            detail,
        }
    }

    /// What its files hold.
    pub(super) fn stamp(&self) -> Stamp {
        let mut stamp = Stamp::default();
        if let Ok(document) = &self.document {
            files::of_document(document, &mut |file| stamp.add(&self.base.join(file)));
        }
        stamp
    }

    pub(super) fn build(
        &self,
        fields: &Named,
        room: usize,
        stamp: Stamp,
    ) -> Result<NamedField, String> {
        let document = self.document.clone()?;
        let field = match &self.source {
            Source::Config(name) => format!("fields.{name}"),
            Source::File(_) | Source::Embedded => "field".into(),
        };
        let (spec, bytes, bbox) = of_files(&field, &document, &self.base, fields, room)?;
        Ok(NamedField {
            name: self.name.clone(),
            source: self.source.clone(),
            document,
            spec,
            bytes,
            bbox,
            stamp,
        })
    }
}

/// The field of a document that may name files and fields, the memory that its pixels take and a box around
/// them. `room`
/// bounds it.
fn of_files(
    path: &str,
    document: &Document,
    base: &Path,
    fields: &Named,
    room: usize,
) -> Result<Built, String> {
    let read = |file: &str, size: Option<[usize; 2]>| read_file(&base.join(file), size, room);
    let sources = Sources {
        named: &|name| Some(fields.get(name)?.spec.clone()),
        names: &|| listed(fields),
        files: Some(&read),
        pixels: Cell::new(room),
        frame: Cell::new(None),
        bytes: Cell::new(0),
    };
    let spec = build(path, document, &sources).map_err(|faults| super::listed(&faults))?;
    let taken = sources.bytes.get();
    if taken > room {
        return Err(format!(
            "its pixels take {taken} bytes and {room} are left; allowed: fields.max_bytes for all fields"
        ));
    }
    Ok((spec, taken, sources.frame.get()))
}

fn read_file(path: &Path, size: Option<[usize; 2]>, room: usize) -> Result<Image, RasterError> {
    let limits = Limits {
        side: MOST_SIDE,
        pixels: room.min(Limits::FILES.pixels),
    };
    let file = bounded_file::open_regular(path)?;
    match size {
        Some(size) if path.extension().is_some_and(|e| e == "f32") => {
            Image::read_floats(file, size, limits)
        }
        _ => Image::read(
            BufReader::with_capacity(1 << 16, file),
            Meaning::Data,
            limits,
        ),
    }
}

/// A field, the memory of its pixels, and a box around them.
type Built = (FieldSpec, usize, Option<[f64; 4]>);

/// The names of the fields that a document is made of.
pub(super) fn names(document: &Document) -> Box<dyn Iterator<Item = &str> + '_> {
    match document {
        Document::Name(name) => Box::new(std::iter::once(name.as_str())),
        Document::Multiply(parts) | Document::Min(parts) | Document::Max(parts) => {
            Box::new(parts.0.iter().flat_map(names))
        }
        Document::Invert(of) => names(of),
        Document::Curve(curve) => names(&curve.of),
        _ => Box::new(std::iter::empty()),
    }
}

/// Fields by name.
pub(super) type Named = BTreeMap<String, Arc<NamedField>>;

/// Names, for faults: not all of a long list.
pub(super) fn listed(fields: &Named) -> String {
    const SHOWN: usize = 16;
    let mut names: Vec<&str> = fields.keys().map(String::as_str).collect();
    let more = names.len().saturating_sub(SHOWN);
    names.truncate(SHOWN);
    match (names.as_slice(), more) {
        ([], _) => "nothing: no field is loaded".into(),
        (names, 0) => names.join(", "),
        (names, more) => format!(
            "{}, and {more} more (see the list of fields)",
            names.join(", ")
        ),
    }
}
