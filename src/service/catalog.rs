//! The tables that are loaded: the built-in ones and those of a folder.
//!
//! Every table is read and checked once, at the start or when the folder is read again (`reload`), so
//! that a damaged file is an error then and not during a query. What stays is the file's bytes, a few
//! kilobytes each, and what is to be said about it; a ready sampler is made from the bytes when a
//! query needs one.

mod reload;

use std::{
    cell::Cell,
    cmp::Ordering,
    collections::BTreeMap,
    fmt, fs, io,
    path::{Path, PathBuf},
    sync::Arc,
};

use bytes::Bytes;
use strew_core::{
    Alpha, Table,
    field::FieldSpec,
    map::Size,
    table::{BLUE, MAX_FILE_BYTES, Provenance},
};

use strew_forge::Aim;

use super::{
    Error,
    field::{self, Document, Fields, NamedField, Sent},
    query::Checked,
};
use crate::bounded_file;
pub use reload::{Refusal, Reload};

/// The tables that are built into the program beside the library's: (file name, content).
static EMBEDDED: &[(&str, &[u8])] = include!(concat!(env!("OUT_DIR"), "/tables.rs"));

/// The table that is built into the library.
const DEFAULT: (&str, &[u8]) = ("blue-5-sqrt3-over-2-m.strew", BLUE);

/// What a table is found by. Keys are in the order of their names, then of their numbers.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Key {
    /// The name of the noise profile.
    pub profile: Arc<str>,
    /// The number α.
    pub alpha: Alpha,
    /// The size of its map.
    pub size: Size,
    /// The mix of kinds, if it has one.
    pub mix: Option<Arc<MixKey>>,
}

/// What tells the mixes of one table apart.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct MixKey {
    /// The shares of its kinds.
    pub shares: Box<[u16]>,
    /// What its vectors are: those of the plain table, or others.
    pub vectors: [u8; 32],
}

impl Ord for Key {
    fn cmp(&self, other: &Self) -> Ordering {
        let rank = |key: &Self| (key.alpha.half(), key.alpha, key.size);
        let by_name = self.profile.cmp(&other.profile);
        by_name
            .then_with(|| rank(self).cmp(&rank(other)))
            .then_with(|| self.mix.cmp(&other.mix))
    }
}

impl PartialOrd for Key {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl MixKey {
    /// The shares as text, such as `1:3`.
    #[must_use]
    pub fn text(&self) -> String {
        let parts: Vec<String> = self.shares.iter().map(ToString::to_string).collect();
        parts.join(":")
    }
}

impl fmt::Display for Key {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "profile `{}`, alpha {}, map {}",
            self.profile, self.alpha, self.size
        )?;
        match &self.mix {
            Some(mix) => write!(f, ", kinds {}", mix.text()),
            None => Ok(()),
        }
    }
}

/// Where a table comes from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Source {
    /// Built into the program, under this file name.
    Embedded(&'static str),
    /// A file.
    File(PathBuf),
}

impl fmt::Display for Source {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Embedded(name) => write!(f, "built-in {name}"),
            Self::File(path) => path.display().fmt(f),
        }
    }
}

/// A loaded table.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// What it is found by.
    pub key: Key,
    /// Where it comes from.
    pub source: Source,
    /// The half-width R of its map.
    pub radius: u32,
    /// The intervals of its map per axis.
    pub intervals: usize,
    /// Its digest, in hexadecimal.
    pub digest: String,
    /// How it was made and what was measured on it.
    pub provenance: Provenance,
    /// A digest of its vectors alone.
    vectors: [u8; 32],
    bytes: Bytes,
}

impl Entry {
    /// What it was made to be, if its history tells.
    #[must_use]
    pub fn aim(&self) -> Option<Aim> {
        Aim::of(&self.key.profile, &self.provenance)
    }

    fn read(bytes: Bytes, source: Source) -> Result<Self, CatalogError> {
        let table = Table::from_bytes(&bytes).map_err(|error| CatalogError::Table {
            source_name: source.clone(),
            error,
        })?;
        let vectors = table.displacements().as_flattened();
        let vectors: Vec<u8> = vectors.iter().flat_map(|v| v.to_le_bytes()).collect();
        let vectors = *blake3::hash(&vectors).as_bytes();
        let mix = table.mix().map(|mix| MixKey {
            shares: mix.shares().parts().into(),
            vectors,
        });
        Ok(Self {
            key: Key {
                profile: table.profile().into(),
                alpha: table.alpha(),
                size: table.map().size(),
                mix: mix.map(Arc::new),
            },
            vectors,
            source,
            radius: table.map().radius(),
            intervals: table.map().intervals(),
            digest: table.digest().to_string(),
            provenance: table.provenance().clone(),
            bytes,
        })
    }

    /// Reads a table file, which must be a regular file of the size that tables may have.
    ///
    /// # Errors
    /// [`CatalogError::File`] or [`CatalogError::Table`], naming the file.
    pub fn from_file(path: PathBuf) -> Result<Self, CatalogError> {
        let source = Source::File(path.clone());
        match bounded_file::read(&path, MAX_FILE_BYTES) {
            Ok(bytes) => Self::read(bytes.into(), source),
            Err(error) => Err(CatalogError::File { path, error }),
        }
    }

    /// How many blocks the table has, one vector each.
    #[must_use]
    pub const fn blocks(&self) -> usize {
        self.intervals * self.intervals
    }

    /// The table file.
    #[must_use]
    pub const fn bytes(&self) -> &Bytes {
        &self.bytes
    }

    /// The table.
    ///
    /// # Errors
    /// [`Error::Internal`] only if memory has been damaged since the table was checked.
    pub fn table(&self) -> Result<Table, Error> {
        Table::from_bytes(&self.bytes).map_err(|error| {
            tracing::error!(source = %self.source, %error, "a checked table is not valid any more");
            Error::Internal("a table is not valid any more")
        })
    }

    /// A figure that was measured on the first set that the table was not made on, if it was.
    #[must_use]
    pub fn measured(&self, name: &str) -> Option<f64> {
        let unseen = self
            .provenance
            .figures
            .iter()
            .find(|figures| !figures.seen)?;
        let mut values = unseen.values.iter();
        values
            .find(|(known, _)| known == name)
            .map(|(_, value)| *value)
    }
}

/// Why the tables cannot be loaded.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CatalogError {
    /// The folder cannot be listed.
    #[error("cannot list the tables folder {}: {error}", path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
        /// Why.
        error: io::Error,
    },
    /// A file cannot be read.
    #[error("cannot read the table {}: {error}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// Why.
        error: io::Error,
    },
    /// A file is not a valid table.
    #[error("the table {source_name} is not valid: {error}")]
    Table {
        /// Where it is.
        source_name: Source,
        /// What is wrong where.
        error: strew_core::Error,
    },
    /// Two tables of one place answer the same queries.
    #[error("the tables {first} and {second} are both for {key}: keep one")]
    Twice {
        /// What both are found by.
        key: Key,
        /// One.
        first: Source,
        /// The other.
        second: Source,
    },
}

/// The tables that are loaded, by key.
#[derive(Clone, Debug, Default)]
pub struct Catalog {
    entries: BTreeMap<Key, Arc<Entry>>,
    /// The built-in ones, also where a file's table stands in the place of one.
    built_in: BTreeMap<Key, Arc<Entry>>,
    /// The fields that queries may name.
    fields: Arc<Fields>,
    /// The fields that clients have sent.
    sent: Arc<Sent>,
}

/// What building a field has left and taken.
#[derive(Clone, Copy, Debug)]
pub struct Built {
    /// How many pixels the query may still bring along.
    pub left: usize,
    /// The memory that the field's pixels take, in bytes.
    pub bytes: usize,
    /// A box around them.
    pub frame: Option<[f64; 4]>,
}

impl Catalog {
    /// Loads the built-in tables, if asked for, and those of a folder, if there is one. A table of
    /// the folder replaces a built-in one with the same key.
    ///
    /// # Errors
    /// [`CatalogError`], naming the file.
    pub fn load(embedded: bool, folder: Option<&Path>) -> Result<Self, CatalogError> {
        let mut catalog = Self::default();
        if embedded {
            catalog.add([DEFAULT].iter().chain(EMBEDDED).map(|&(name, bytes)| {
                Entry::read(Bytes::from_static(bytes), Source::Embedded(name))
            }))?;
            catalog.built_in.clone_from(&catalog.entries);
        }
        if let Some(folder) = folder {
            let files = table_files(folder)?;
            catalog.add(files.into_iter().map(Entry::from_file))?;
        }
        Ok(catalog)
    }

    /// The same with these fields.
    #[must_use]
    pub fn with_fields(mut self, fields: Fields) -> Self {
        self.fields = Arc::new(fields);
        self
    }

    /// The fields that queries may name.
    #[must_use]
    pub fn fields(&self) -> &Fields {
        &self.fields
    }

    /// The same with room for fields that clients send, in bytes.
    #[must_use]
    pub fn with_room(mut self, bytes: usize) -> Self {
        self.sent = Arc::new(Sent::new(bytes));
        self
    }

    /// The fields that clients have sent.
    #[must_use]
    pub fn sent(&self) -> &Sent {
        &self.sent
    }

    /// The field of a name, or of the digest of one that was sent.
    #[must_use]
    pub fn field(&self, name: &str) -> Option<Arc<NamedField>> {
        let loaded = self.fields.get(name).cloned();
        loaded.or_else(|| self.sent.get(name))
    }

    /// Makes the field of a document that a client has written, with at most so many pixels in it.
    pub fn build_field(
        &self,
        path: &str,
        document: &Document,
        pixels: usize,
    ) -> (Checked<FieldSpec>, Built) {
        let sources = field::Sources {
            named: &|name| Some(self.field(name)?.spec.clone()),
            names: &|| self.fields.names(),
            files: None,
            pixels: Cell::new(pixels),
            frame: Cell::new(None),
            bytes: Cell::new(0),
        };
        let spec = field::build(path, document, &sources);
        let built = Built {
            left: sources.pixels.get(),
            bytes: sources.bytes.get(),
            frame: sources.frame.get(),
        };
        (spec, built)
    }

    /// Adds the tables of one place over what is there; no two of them may have the same key.
    fn add(
        &mut self,
        entries: impl Iterator<Item = Result<Entry, CatalogError>>,
    ) -> Result<(), CatalogError> {
        let mut added: BTreeMap<Key, Arc<Entry>> = BTreeMap::new();
        for entry in entries {
            let entry = Arc::new(entry?);
            if let Some(first) = added.insert(entry.key.clone(), entry.clone()) {
                return Err(CatalogError::Twice {
                    key: entry.key.clone(),
                    first: first.source.clone(),
                    second: entry.source.clone(),
                });
            }
        }
        self.entries.extend(added);
        Ok(())
    }

    /// The table of a key.
    #[must_use]
    pub fn entry(&self, key: &Key) -> Option<Arc<Entry>> {
        self.entries.get(key).cloned()
    }

    /// All tables without kinds, by profile, then α.
    pub fn entries(&self) -> impl Iterator<Item = &Arc<Entry>> {
        self.entries
            .values()
            .filter(|entry| entry.key.mix.is_none())
    }

    /// The mixes of a table: those whose points are its own, or those whose points were moved.
    pub fn mixes(
        &self,
        of: &Entry,
        are_moved: bool,
    ) -> impl Iterator<Item = (&MixKey, &Arc<Entry>)> {
        self.entries.iter().filter_map(move |(key, entry)| {
            let mix = key.mix.as_deref()?;
            let is_same =
                (&key.profile, key.alpha, key.size) == (&of.key.profile, of.key.alpha, of.key.size);
            let is_moved = mix.vectors != of.vectors;
            (is_same && is_moved == are_moved).then_some((mix, entry))
        })
    }

    /// The shares for which a table has joint kinds.
    #[must_use]
    pub fn joint_kinds(&self, of: &Entry) -> Vec<String> {
        self.mixes(of, true).map(|(mix, _)| mix.text()).collect()
    }

    /// The digests of all tables.
    pub fn digests(&self) -> impl Iterator<Item = &str> {
        self.entries.values().map(|entry| entry.digest.as_str())
    }

    /// The names of the profiles, without repetition.
    pub fn profiles(&self) -> Vec<&str> {
        let mut names: Vec<&str> = self.entries().map(|entry| &*entry.key.profile).collect();
        names.dedup();
        names
    }

    /// The values of α that a profile is loaded for, without repetition.
    pub fn alphas(&self, profile: &str) -> Vec<Alpha> {
        let mut alphas: Vec<Alpha> = self.of_profile(profile).map(|key| key.alpha).collect();
        alphas.dedup();
        alphas
    }

    /// The sizes of map that a profile is loaded with for an α, smallest first.
    pub fn sizes(&self, profile: &str, alpha: Alpha) -> Vec<Size> {
        let keys = self.of_profile(profile).filter(|key| key.alpha == alpha);
        keys.map(|key| key.size).collect()
    }

    fn of_profile(&self, profile: &str) -> impl Iterator<Item = &Key> {
        self.entries()
            .map(|entry| &entry.key)
            .filter(move |key| &*key.profile == profile)
    }
}

/// The `*.strew` files of a folder, in the order of their names.
fn table_files(folder: &Path) -> Result<Vec<PathBuf>, CatalogError> {
    let problem = |error| CatalogError::Folder {
        path: folder.into(),
        error,
    };
    let mut files = fs::read_dir(folder)
        .map_err(problem)?
        .map(|entry| entry.map(|entry| entry.path()))
        .collect::<Result<Vec<_>, _>>()
        .map_err(problem)?;
    files.retain(|file| file.extension().is_some_and(|e| e == "strew"));
    files.sort();
    Ok(files)
}
