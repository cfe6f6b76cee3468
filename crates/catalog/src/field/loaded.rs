//! The fields that queries may name: those of the configuration and those of a folder.
//!
//! In the folder, a `.json` or `.toml` file is a document, and a raster (`.png`, `.tif`, `.tiff`, `.npy`)
//! is a field of its pixels, unless a document has the same name: then it says how to read the raster. Every
//! field is read and checked once, at the start or when the folder is read again; one whose files are
//! unchanged is kept as it is.

use std::{collections::BTreeMap, io::BufReader, path::Path, sync::Arc};

use strew_config::{
    Fields as Settings, bounded_file,
    name::{ALLOWED, is_name},
};
use strew_core::{field::FieldSpec, server::Stop};
use strew_raster::{Image, Limits, MOST_SIDE, Meaning, Place, RasterError};

use super::{
    Allowance, Document, Sources, build,
    files::{self, Stamp},
    named::NamedField,
    read,
};
use crate::named::{self, Checked, Found, NamedError, Names, Places, Refused, Reread, Source};

const DOCUMENT_BYTES: u64 = 4 << 20;

/// The fields that are built into the program: their names and their documents.
const EMBEDDED: &[(&str, &str)] = &[
    ("forest", include_str!("../../fields/forest.toml")),
    ("portrait", include_str!("../../fields/portrait.toml")),
];

const RASTERS: &[&str] = &["png", "tif", "tiff", "npy"];

pub type Fields = Names<NamedField>;

impl Fields {
    pub fn load(settings: &Settings) -> Result<Self, NamedError> {
        named::all_of(Self::default().reload(settings))
    }

    pub fn reload(&self, settings: &Settings) -> Reread<Self> {
        let places = Places {
            section: "fields",
            named: &settings.named,
            folder: settings.folder(),
            endings: &["json", "toml"],
            rasters: RASTERS,
            most_bytes: DOCUMENT_BYTES,
        };
        let (after, refused) = match places.each(parse) {
            Ok(all) => self.build(all, settings),
            // All of the folder stays.
            Err(error) => (self.clone(), vec![(error, None)]),
        };
        let changes = self.changes_to(&after);
        (after, changes, refused)
    }

    /// Adds a field, in the place of one of the same name.
    pub fn insert(&mut self, field: NamedField) {
        self.0.insert(field.name.clone(), Arc::new(field));
    }

    /// Builds the fields of all documents. A refused document leaves its earlier field in place.
    fn build(&self, all: Vec<Checked<Document>>, settings: &Settings) -> (Self, Vec<Refused>) {
        let mut after = match settings.embedded {
            true => embedded(),
            false => Self::default(),
        };
        let (mut waiting, mut refused) = (vec![], vec![]);
        let mut refuse = |after: &mut Self, name: &str, error| {
            refused.push((error, self.digest(name)));
            if let Some(old) = self.get(name) {
                after.0.insert(name.into(), old.clone());
            }
        };
        for (found, document) in all {
            match document {
                Ok(document) => waiting.push((found, document)),
                Err(error) => refuse(&mut after, &found.name, error),
            }
        }
        let mut room = settings.max_bytes;
        let folder = settings.folder().unwrap_or(Path::new("."));
        // Documents may name other fields, in any order: those that do not yet are built first, and those of which
        // others are missing last.
        while !waiting.is_empty() {
            let is_ready = |(_, document): &(Found, Document)| {
                names(document).all(|name| after.get(name).is_some())
            };
            let (mut ready, mut later): (Vec<_>, _) = waiting.into_iter().partition(is_ready);
            if ready.is_empty() {
                (ready, later) = (later, vec![]);
            }
            for (found, document) in ready {
                let base = match found.source {
                    Source::File(_) => folder,
                    _ => Path::new("."),
                };
                match self.kept_or_built(&found, document, base, &after, room) {
                    Ok(built) => {
                        room = room.saturating_sub(built.bytes);
                        after.0.insert(found.name, built);
                    }
                    Err(error) => refuse(&mut after, &found.name, error),
                }
            }
            waiting = later;
        }
        (after, refused)
    }

    /// The field of a document; the one before, if nothing of it has changed.
    fn kept_or_built(
        &self,
        found: &Found,
        document: Document,
        base: &Path,
        fields: &Self,
        room: usize,
    ) -> Result<Arc<NamedField>, NamedError> {
        let mut stamp = Stamp::default();
        files::of_document(&document, &mut |file| stamp.add_raster(&base.join(file)));
        let old = self.get(&found.name).filter(|old| {
            let is_same = old.document == document && old.source == found.source;
            is_same && old.stamp == stamp && names(&document).next().is_none()
        });
        match old {
            Some(old) => Ok(old.clone()),
            None => built(found, document, base, fields, room, stamp).map(Arc::new),
        }
    }
}

/// The built-in fields. A test builds them.
fn embedded() -> Fields {
    let mut fields = Fields::default();
    for &(name, text) in EMBEDDED {
        let found = Found {
            name: name.into(),
            source: Source::Embedded,
            text: named::json_of(text),
        };
        let document = found
            .text
            .as_ref()
            .ok()
            .and_then(|text| parse(&found, text).ok());
        let field = document.map(|document| {
            built(
                &found,
                document,
                Path::new(""),
                &fields,
                0,
                Stamp::default(),
            )
        });
        if let Some(Ok(field)) = field {
            fields.insert(field);
        }
    }
    fields
}

/// The path of a field in faults.
fn path_of(source: &Source) -> String {
    match source {
        Source::Config(_, name) => format!("fields.{name}"),
        Source::File(_) | Source::Embedded => "field".into(),
    }
}

fn parse(found: &Found, text: &str) -> Result<Document, String> {
    read::read_json(&path_of(&found.source), text).map_err(|faults| super::listed(&faults))
}

fn built(
    found: &Found,
    document: Document,
    base: &Path,
    fields: &Fields,
    room: usize,
    stamp: Stamp,
) -> Result<NamedField, NamedError> {
    let of_files = of_files(&path_of(&found.source), &document, base, fields, room);
    let (spec, bytes, bbox, epsg) = of_files.map_err(|detail| found.error(detail))?;
    Ok(NamedField {
        name: found.name.clone(),
        source: found.source.clone(),
        document,
        spec,
        bytes,
        bbox,
        epsg,
        stamp,
    })
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
    let named = |name: &str| {
        let field = fields.get(name)?;
        Some((field.spec.clone(), field.epsg))
    };
    let names = || fields.names();
    let sources = Sources {
        files: Some(&read),
        ..Sources::new(&named, &names, Allowance::UNLIMITED, room)
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
pub fn from_file(path: &Path, fields: &Fields) -> Result<NamedField, NamedError> {
    let base = path.parent().unwrap_or(Path::new(""));
    let mut found = Found::of_file(path, RASTERS, DOCUMENT_BYTES);
    if !is_name(&found.name) {
        found.name = "file".into();
    }
    let text = found.text.clone().map_err(|detail| found.error(detail))?;
    let document = parse(&found, &text).map_err(|detail| found.error(detail))?;
    let mut all = fields.clone();
    if !names(&document).all(|name| fields.get(name).is_some()) {
        let (beside, ..) = Fields::default().reload(&Settings {
            embedded: false,
            folder: match base.as_os_str().is_empty() {
                true => Path::new(".").into(),
                false => base.into(),
            },
            max_bytes: usize::MAX,
            max_sent_bytes: 0,
            named: BTreeMap::new(),
        });
        for (name, other) in beside.0 {
            all.0.entry(name).or_insert(other);
        }
    }
    built(&found, document, base, &all, usize::MAX, Stamp::default())
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
) -> Result<NamedField, NamedError> {
    let found = Found {
        name: name.into(),
        source: Source::Config("fields", name.into()),
        text: Ok(String::new()),
    };
    if !is_name(name) {
        return Err(found.error(format!("`{name}` is no name; allowed: {ALLOWED}")));
    }
    built(
        &found,
        document,
        Path::new(""),
        fields,
        usize::MAX,
        Stamp::default(),
    )
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
