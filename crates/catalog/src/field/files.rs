//! The files of fields: which there are, and whether they have changed.

use std::{
    fs,
    path::{Path, PathBuf},
};

use strew_config::bounded_file;
use strew_core::server::Stop;
use strew_raster::{Image, RasterError};

use super::Document;
use crate::named::files_of;

/// Files up to this size are compared by content.
const COMPARED: u64 = 4 << 20;

/// The longest world file: six numbers.
const WORLD_BYTES: u64 = 4096;

/// The world file of a raster, if there is one: beside `a.tif` that is `a.tfw`, `a.tifw` or `a.wld`.
fn world_file(path: &Path) -> Option<PathBuf> {
    let ending = path.extension()?.to_str()?;
    let (first, last) = (ending.chars().next()?, ending.chars().next_back()?);
    let short = format!("{first}{last}w");
    let endings = [short.clone(), format!("{ending}w"), "wld".into()];
    let endings = endings
        .into_iter()
        .flat_map(|ending| [ending.to_uppercase(), ending]);
    let mut all = endings.map(|ending| path.with_extension(ending));
    all.find(|file| file.is_file())
}

/// The image of a file, where its world file places it: six numbers, those of the center of the first pixel last.
pub(super) fn placed(image: Image, path: &Path) -> Result<Image, RasterError> {
    let Some(file) = world_file(path) else {
        return Ok(image);
    };
    let text = bounded_file::read_text(&file, WORLD_BYTES).ok();
    let numbers = text.map(|text| text.split_whitespace().map(str::parse).collect());
    match numbers
        .as_ref()
        .map(|all: &Result<Vec<f64>, _>| all.as_deref())
    {
        Some(Ok(&[a, d, b, e, x, y])) => {
            let corner = [x - 0.5 * (a + b), y - 0.5 * (d + e)];
            image.at([a, b, corner[0], d, e, corner[1]], &Stop::NEVER)
        }
        _ => Err(RasterError::Unsupported {
            found: format!("its world file {} is not read", file.display()),
            allowed: "six numbers: a, d, b, e and the center of the first pixel",
        }),
    }
}

pub(super) fn of_document(document: &Document, visit: &mut impl FnMut(&str)) {
    document.for_each_pixels(&mut |pixels| {
        if let Some(file) = &pixels.file {
            visit(file);
        }
    });
}

/// A stamp of the contents of some files: of small files their bytes, of others their size, time of change and place on
/// the disk. Reading gigabytes every few seconds would add nothing.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Stamp(Vec<blake3::Hash>);

impl Stamp {
    pub fn add_to(&self, hasher: &mut blake3::Hasher) {
        for file in &self.0 {
            hasher.update(file.as_bytes());
        }
    }

    pub(super) fn add_raster(&mut self, path: &Path) {
        self.add(path);
        if let Some(world) = world_file(path) {
            self.add(&world);
        }
    }

    pub(crate) fn add(&mut self, path: &Path) {
        let mut hasher = blake3::Hasher::new();
        let name = path.as_os_str().as_encoded_bytes();
        hasher.update(&(name.len() as u64).to_le_bytes());
        hasher.update(name);
        match fs::metadata(path) {
            Ok(metadata) if metadata.len() > COMPARED => {
                hasher.update(&metadata.len().to_le_bytes());
                hasher.update(
                    format!("{:?} {}", metadata.modified().ok(), place(&metadata)).as_bytes(),
                );
            }
            Ok(_) => match bounded_file::read(path, COMPARED) {
                Ok(content) => drop(hasher.update(&content)),
                Err(error) => drop(hasher.update(error.to_string().as_bytes())),
            },
            Err(error) => drop(hasher.update(error.to_string().as_bytes())),
        }
        self.0.push(hasher.finalize());
    }
}

/// The number of a file on its disk: another file in its place has another one.
#[cfg(unix)]
fn place(metadata: &fs::Metadata) -> u64 {
    std::os::unix::fs::MetadataExt::ino(metadata)
}

#[cfg(not(unix))]
const fn place(_: &fs::Metadata) -> u64 {
    0
}

pub fn stamp_of(folder: Option<&Path>) -> Stamp {
    let mut stamp = Stamp::default();
    let files = folder.and_then(|folder| files_of(folder).ok());
    for path in files.unwrap_or_default() {
        stamp.add(&path);
    }
    stamp
}

/// A stamp of the present fields of some settings, whether they are valid or not.
pub fn stamp(settings: &strew_config::Fields) -> Stamp {
    let mut stamp = stamp_of(settings.folder());
    for (name, table) in &settings.named {
        let text = serde_json::to_string(table).unwrap_or_default();
        if let Ok(document) = super::read_json(name, &text) {
            of_document(&document, &mut |file| stamp.add_raster(Path::new(file)));
        }
    }
    stamp
}
