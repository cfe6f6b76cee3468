//! The fields that queries may name: those of the configuration and those of a folder.
//!
//! In the folder, a `.json` or `.toml` file is a document, and a raster (`.png`, `.tif`, `.tiff`, `.npy`)
//! is a field of its pixels, unless a document has the same name: then it says how to read the raster. Every
//! field is read and checked once, at the start or when the folder is read again; one whose files are
//! unchanged is kept as it is.

use std::{
    cell::{Cell, RefCell},
    collections::BTreeMap,
    io::BufReader,
    path::{Path, PathBuf},
    sync::Arc,
};

use strew_config::{
    Fields as Settings, bounded_file,
    name::{ALLOWED, is_name},
};
use strew_core::{field::FieldSpec, server::Stop};
use strew_raster::{Image, Limits, MOST_SIDE, Meaning, Place, RasterError};

use super::{
    Allowance, Document, Sources, build,
    document::Pixels,
    files::{self, Stamp},
    named::NamedField,
    read,
};
use crate::named::{self, Changes, Refused, Source};

const DOCUMENT_BYTES: u64 = 4 << 20;

/// The fields that are built into the program: their names and their documents.
const EMBEDDED: &[(&str, &str)] = &[
    ("forest", include_str!("../../fields/forest.toml")),
    ("portrait", include_str!("../../fields/portrait.toml")),
];

/// Why fields cannot be loaded.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("the field {source_name} is not valid: {detail}")]
pub struct FieldError {
    pub source_name: String,
    pub detail: String,
}

#[derive(Clone, Debug, Default)]
pub struct Fields {
    entries: BTreeMap<String, Arc<NamedField>>,
}

impl Fields {
    pub fn load(settings: &Settings) -> Result<Self, FieldError> {
        let (fields, refused) = Self::default().read(settings);
        match refused.into_iter().next() {
            Some((error, _)) => Err(error),
            None => Ok(fields),
        }
    }

    /// The fields after reading all documents again, the changes, and the refused documents, each with the digest of
    /// the field that stays in its place.
    pub fn reload(&self, settings: &Settings) -> (Self, Changes, Vec<Refused<FieldError>>) {
        let (after, refused) = self.read(settings);
        let changes = Changes::between(&self.entries, &after.entries, NamedField::digest);
        (after, changes, refused)
    }

    pub fn get(&self, name: &str) -> Option<&Arc<NamedField>> {
        self.entries.get(name)
    }

    pub fn iter(&self) -> impl ExactSizeIterator<Item = &Arc<NamedField>> {
        self.entries.values()
    }

    /// Adds a field, in the place of one of the same name.
    pub fn insert(&mut self, field: NamedField) {
        self.entries.insert(field.name.clone(), Arc::new(field));
    }

    /// The names, for faults: not all of a long list.
    pub fn names(&self) -> String {
        named::listed("field", self.entries.keys().map(String::as_str))
    }

    /// Reads all documents. A refused document leaves its earlier field in place.
    fn read(&self, settings: &Settings) -> (Self, Vec<Refused<FieldError>>) {
        let mut refused = vec![];
        let mut open: Vec<Unbuilt> = vec![];
        let base = settings.folder().unwrap_or(Path::new("."));
        let mut after = Self::default();
        if settings.embedded {
            after.insert_embedded();
        }
        for (name, table) in &settings.named {
            let source = Source::Config("fields", name.clone());
            let document = read::read_toml(&format!("fields.{name}"), table);
            let document = document.map_err(|faults| super::listed(&faults));
            open.push(Unbuilt::new(name.clone(), source, document, Path::new(".")));
        }
        if let Some(folder) = settings.folder() {
            match files::of_folder(folder) {
                Ok(paths) => open.extend(
                    paths
                        .into_iter()
                        .map(|path| Unbuilt::of_file(path, base, None)),
                ),
                Err(detail) => {
                    let source_name = format!("folder {}", folder.display());
                    refused.push((
                        FieldError {
                            source_name,
                            detail,
                        },
                        None,
                    ));
                    // All of the folder stays.
                    return (self.clone(), refused);
                }
            }
        }
        let mut seen: BTreeMap<String, String> = BTreeMap::new();
        open.retain(|field| match seen.get(&field.name) {
            Some(first) => {
                let detail = format!("{first} has the name `{}`, too: keep one", field.name);
                refused.push((field.error(detail), self.digest(&field.name)));
                false
            }
            None => {
                seen.insert(field.name.clone(), field.source.to_string());
                true
            }
        });
        let mut room = settings.max_bytes;
        // Documents may name other fields, in any order: those that do not yet are built first.
        loop {
            let before = open.len();
            open = open
                .into_iter()
                .filter_map(|field| self.settle(field, &mut after, &mut room, &mut refused, false))
                .collect();
            if open.len() == before {
                break;
            }
        }
        for field in open {
            let _ = self.settle(field, &mut after, &mut room, &mut refused, true);
        }
        (after, refused)
    }

    fn insert_embedded(&mut self) {
        for &(name, text) in EMBEDDED {
            let table = text.parse::<toml::Table>().ok();
            let document = table.and_then(|table| read::read_toml("field", &table).ok());
            let document = document.ok_or_else(|| "the built-in field does not read".into());
            let field = Unbuilt::new(name.into(), Source::Embedded, document, Path::new(""));
            if let Ok(field) = field.build(self, 0, Stamp::default()) {
                self.insert(field);
            }
        }
    }

    fn digest(&self, name: &str) -> Option<String> {
        self.entries.get(name).map(|field| field.digest())
    }

    /// Builds a field, keeps it, or refuses it; `None` if it is done. A field that names others that are not
    /// there yet waits, unless it is the last chance.
    fn settle(
        &self,
        field: Unbuilt,
        after: &mut Self,
        room: &mut usize,
        refused: &mut Vec<Refused<FieldError>>,
        is_last: bool,
    ) -> Option<Unbuilt> {
        let waits = match &field.document {
            Ok(document) => !is_last && names(document).any(|name| after.get(name).is_none()),
            Err(_) => false,
        };
        if waits {
            return Some(field);
        }
        let old = self.entries.get(&field.name);
        let stamp = field.stamp();
        let unchanged = old.filter(|old| {
            let is_alone = names(&old.document).next().is_none();
            is_alone && old.source == field.source && old.stamp == stamp
        });
        let built = match unchanged {
            Some(old) if field.document.as_ref() == Ok(&old.document) => Ok(Arc::clone(old)),
            _ => field.build(after, *room, stamp).map(Arc::new),
        };
        match built {
            Ok(built) => {
                *room = room.saturating_sub(built.bytes);
                after.entries.insert(built.name.clone(), built);
            }
            Err(detail) => {
                refused.push((field.error(detail), old.map(|old| old.digest())));
                if let Some(old) = old {
                    after.entries.insert(old.name.clone(), Arc::clone(old));
                }
            }
        }
        None
    }
}

/// A field that is read, but not built.
struct Unbuilt {
    name: String,
    source: Source,
    document: Result<Document, String>,
    base: PathBuf,
}

impl Unbuilt {
    fn new(name: String, source: Source, document: Result<Document, String>, base: &Path) -> Self {
        let document = match is_name(&name) {
            true => document,
            false => Err(format!("`{name}` is no name; allowed: {ALLOWED}")),
        };
        Self {
            name,
            source,
            document,
            base: base.into(),
        }
    }

    /// The field of a file, named after it, unless another name is there for names that fields cannot have.
    fn of_file(path: PathBuf, base: &Path, other: Option<&str>) -> Self {
        let part = |part: Option<&std::ffi::OsStr>| {
            part.unwrap_or_default().to_string_lossy().into_owned()
        };
        let (mut name, file) = (part(path.file_stem()), part(path.file_name()));
        if let Some(other) = other.filter(|_| !is_name(&name)) {
            name = other.into();
        }
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

    fn error(&self, detail: String) -> FieldError {
        FieldError {
            source_name: self.source.to_string(),
            detail,
        }
    }

    fn stamp(&self) -> Stamp {
        let mut stamp = Stamp::default();
        if let Ok(document) = &self.document {
            files::of_document(document, &mut |file| {
                stamp.add_raster(&self.base.join(file))
            });
        }
        stamp
    }

    fn build(&self, fields: &Fields, room: usize, stamp: Stamp) -> Result<NamedField, String> {
        let document = self.document.clone()?;
        let field = match &self.source {
            Source::Config(_, name) => format!("fields.{name}"),
            Source::File(_) | Source::Embedded => "field".into(),
        };
        let (spec, bytes, bbox, epsg) = of_files(&field, &document, &self.base, fields, room)?;
        Ok(NamedField {
            name: self.name.clone(),
            source: self.source.clone(),
            document,
            spec,
            bytes,
            bbox,
            epsg,
            stamp,
        })
    }
}

/// The field of a document that may name files and fields, with the memory, the box and the plane of its pixels. `room`
/// bounds the memory.
fn of_files(
    path: &str,
    document: &Document,
    base: &Path,
    fields: &Fields,
    room: usize,
) -> Result<Built, String> {
    let read = |file: &str, meaning, size: Option<[usize; 2]>| {
        read_file(&base.join(file), meaning, size, room)
    };
    let sources = Sources {
        allowance: Allowance::UNLIMITED,
        refused: RefCell::new(None),
        named: &|name| {
            fields
                .get(name)
                .map(|field| (field.spec.clone(), field.epsg))
        },
        names: &|| fields.names(),
        files: Some(&read),
        pixels: Cell::new(room),
        frame: Cell::new(None),
        epsg: Cell::new(None),
        bytes: Cell::new(0),
    };
    let spec = build(path, document, &sources).map_err(|faults| super::listed(&faults))?;
    let taken = sources.bytes.get();
    if taken > room {
        return Err(format!(
            "its pixels take {taken} bytes and {room} are left; allowed: fields.max_bytes for all fields"
        ));
    }
    Ok((spec, taken, sources.frame.get(), sources.epsg.get()))
}

/// The field of a file that a command names: a document or a raster. A document may name others in its folder.
pub fn from_file(path: &Path, fields: &Fields) -> Result<NamedField, FieldError> {
    let base = path.parent().unwrap_or(Path::new(""));
    let field = Unbuilt::of_file(path.into(), base, Some("file"));
    let is_known = |name: &str| fields.get(name).is_some();
    let has_others = (field.document.as_ref()).is_ok_and(|document| !names(document).all(is_known));
    let mut all = fields.clone();
    if has_others {
        let (beside, _) = Fields::default().read(&Settings {
            embedded: false,
            folder: match base.as_os_str().is_empty() {
                true => Path::new(".").into(),
                false => base.into(),
            },
            max_bytes: usize::MAX,
            max_sent_bytes: 0,
            named: BTreeMap::new(),
        });
        for (name, other) in beside.entries {
            all.entries.entry(name).or_insert(other);
        }
    }
    let built = field.build(&all, usize::MAX, Stamp::default());
    built.map_err(|detail| field.error(detail))
}

/// The least and the greatest height in a file of numbers: the ground of a command is at the height that it says. None
/// of a picture, whose light is a share, and of what is no raster.
pub fn heights(path: &Path) -> Result<Option<[f64; 2]>, RasterError> {
    let ending = path.extension().unwrap_or_default().to_ascii_lowercase();
    if ["tif", "tiff", "npy"].iter().all(|known| ending != *known) {
        return Ok(None);
    }
    let image = read_file(path, Meaning::Numbers, None, usize::MAX)?;
    let has_height = |i: &usize| image.missing.as_ref().is_none_or(|missing| !missing[*i]);
    let all = (0..image.samples.len())
        .filter(has_height)
        .map(|i| image.samples.get(i));
    let [low, high] = all.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| {
        [low.min(v), high.max(v)]
    });
    Ok((!image.is_picture && low <= high).then_some([low, high]))
}

pub fn from_document(
    name: &str,
    document: Document,
    fields: &Fields,
) -> Result<NamedField, FieldError> {
    let source = Source::Config("fields", name.into());
    let field = Unbuilt::new(name.into(), source, Ok(document), Path::new(""));
    let built = field.build(fields, usize::MAX, Stamp::default());
    built.map_err(|detail| field.error(detail))
}

pub(super) fn read_file(
    path: &Path,
    meaning: Meaning,
    size: Option<[usize; 2]>,
    room: usize,
) -> Result<Image, RasterError> {
    let limits = Limits {
        side: MOST_SIDE,
        pixels: room.min(Limits::FILES.pixels),
    };
    let file = bounded_file::open_regular(path)?;
    let stop = Stop::default();
    let image = match size {
        Some(size) if path.extension().is_some_and(|e| e == "f32") => {
            Image::read_floats(file, size, limits, &stop)
        }
        _ => Image::read(
            BufReader::with_capacity(1 << 16, file),
            meaning,
            limits,
            &stop,
        ),
    }?;
    match image.place {
        Place::Box(_) => Ok(image),
        _ => files::placed(image, path),
    }
}

/// A field, the memory of its pixels, a box around them, and the code of their plane.
type Built = (FieldSpec, usize, Option<[f64; 4]>, Option<u16>);

fn names(document: &Document) -> Box<dyn Iterator<Item = &str> + '_> {
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

#[cfg(test)]
mod tests;
