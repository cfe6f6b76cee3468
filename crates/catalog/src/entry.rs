//! A table of the catalog: its description, and the place of its vectors.
//!
//! Built-in tables and the first files of the folder are held as bytes. Files beyond `tables.preload_bytes` stay on
//! disk: of those only the head is read, and the whole by the first query that needs the table. A plain pattern has
//! no file at all.

use std::{
    fs::File,
    io::{self, Read as _, Seek as _, SeekFrom},
    path::{Path, PathBuf},
    sync::{Arc, OnceLock},
};

use bytes::Bytes;
use strew_config::bounded_file;
use strew_core::{
    Table,
    map::Size,
    space,
    table::{Head, MAX_FILE_BYTES, Provenance},
};
use strew_error::Error;
use strew_forge::Aim;

use super::{CatalogError, Dimension, Key, MixKey, Source};

#[derive(Clone, Debug)]
pub struct Entry {
    pub key: Key,
    pub source: Source,
    pub radius: u32,
    /// The intervals of its map per axis.
    pub intervals: usize,
    /// Its digest, in hexadecimal.
    pub digest: String,
    pub provenance: Provenance,
    /// The size of its file, in bytes.
    pub bytes: u64,
    /// A digest of its vectors alone, once it is known.
    vectors: OnceLock<[u8; 32]>,
    content: Content,
}

#[derive(Clone, Debug)]
enum Content {
    /// The bytes of the file, checked.
    Held(Bytes),
    /// In the file: they are read and checked when they are needed.
    OnDisk,
    /// Nowhere: all are zero.
    Zero,
    /// In a table in space, which is small: it is made of these bytes when it is first needed.
    Space(Bytes, OnceLock<Option<Box<space::Table>>>),
}

impl PartialEq for Entry {
    fn eq(&self, other: &Self) -> bool {
        (&self.key, &self.source, &self.digest) == (&other.key, &other.source, &other.digest)
    }
}

impl Entry {
    /// The aim of the forge that made it, if its history records one.
    pub fn aim(&self) -> Option<Aim> {
        Aim::of(&self.key.profile, &self.provenance)
    }

    /// Reads and checks the bytes of a table, which are held.
    pub(super) fn read(bytes: Bytes, source: Source) -> Result<Self, CatalogError> {
        let refused = |error| CatalogError::Table {
            source_name: source.clone(),
            error,
        };
        let length = bytes.len() as u64;
        if head_of(&bytes).is_some_and(|head| head.is_space) {
            let table = space::Table::from_bytes(&bytes).map_err(refused)?;
            return Ok(Self::of_space(table, source, bytes));
        }
        let table = Table::from_bytes(&bytes).map_err(refused)?;
        Ok(Self::of(&table, source, length, Content::Held(bytes)))
    }

    fn of_space(table: space::Table, source: Source, bytes: Bytes) -> Self {
        Self {
            key: Key {
                dimension: Dimension::Space,
                profile: table.profile().into(),
                alpha: table.map().alpha(),
                size: table.map().size(),
                mix: None,
            },
            source,
            radius: table.map().radius(),
            intervals: table.map().intervals(),
            digest: table.digest().to_string(),
            provenance: table.provenance().clone(),
            bytes: bytes.len() as u64,
            vectors: OnceLock::new(),
            content: Content::Space(bytes, Some(Box::new(table)).into()),
        }
    }

    /// The table, if its points lie in space.
    pub fn space(&self) -> Option<&space::Table> {
        match &self.content {
            Content::Space(bytes, table) => {
                let read = || space::Table::from_bytes(bytes).ok().map(Box::new);
                table.get_or_init(read).as_deref()
            }
            _ => None,
        }
    }

    /// A pattern without displacements.
    pub(super) fn pattern(table: &Table) -> Self {
        Self::of(table, Source::Pattern, 0, Content::Zero)
    }

    fn of(table: &Table, source: Source, bytes: u64, content: Content) -> Self {
        let vectors = digest_of_vectors(table);
        let mix = table.mix().map(|mix| MixKey {
            shares: mix.shares().parts().into(),
            vectors,
        });
        Self {
            key: Key {
                dimension: Dimension::Plane,
                profile: table.profile().into(),
                alpha: table.alpha(),
                size: table.map().size(),
                mix: mix.map(Arc::new),
            },
            source,
            radius: table.map().radius(),
            intervals: table.map().intervals(),
            digest: table.digest().to_string(),
            provenance: table.provenance().clone(),
            bytes,
            vectors: vectors.into(),
            content,
        }
    }

    /// Reads a table file, which must be a regular file of the size that tables may have, and holds its bytes.
    pub fn from_file(path: PathBuf) -> Result<Self, CatalogError> {
        let source = Source::File(path.clone());
        match bounded_file::read(&path, MAX_FILE_BYTES) {
            Ok(bytes) => Self::read(bytes.into(), source),
            Err(error) => Err(CatalogError::File { path, error }),
        }
    }

    /// Reads the head of a table file and leaves its vectors on disk. One with kinds or of space is read whole.
    pub(super) fn from_head(path: PathBuf) -> Result<Self, CatalogError> {
        let (head, bytes) = match read_head(&path) {
            Ok(read) => read,
            Err(error) => return Err(CatalogError::File { path, error }),
        };
        let source = Source::File(path.clone());
        let head = head.map_err(|error| CatalogError::Table {
            source_name: source.clone(),
            error,
        })?;
        if head.has_kinds || head.is_space {
            return Self::from_file(path);
        }
        Ok(Self::of_head(head, source, bytes, Content::OnDisk))
    }

    /// A table that the program is built with, and whose files tests check: only its head is read, unless it has kinds.
    pub(super) fn embedded(name: &'static str, bytes: &'static [u8]) -> Result<Self, CatalogError> {
        let (source, held) = (Source::Embedded(name), Bytes::from_static(bytes));
        match head_of(bytes) {
            Some(head) if !head.has_kinds => {
                let content = match head.is_space {
                    true => Content::Space(held, OnceLock::new()),
                    false => Content::Held(held),
                };
                Ok(Self::of_head(head, source, bytes.len() as u64, content))
            }
            _ => Self::read(held, source),
        }
    }

    fn of_head(head: Head, source: Source, bytes: u64, content: Content) -> Self {
        Self {
            key: Key {
                dimension: match head.is_space {
                    true => Dimension::Space,
                    false => Dimension::Plane,
                },
                profile: head.profile.into(),
                alpha: head.alpha,
                size: Size::of_radius(head.radius),
                mix: None,
            },
            source,
            radius: head.radius,
            intervals: head.intervals as usize,
            digest: head.digest.to_string(),
            provenance: head.provenance,
            bytes,
            vectors: OnceLock::new(),
            content,
        }
    }

    pub const fn blocks(&self) -> usize {
        self.intervals.pow(self.key.dimension.axes())
    }

    pub const fn is_on_disk(&self) -> bool {
        matches!(self.content, Content::OnDisk)
    }

    /// The table of a set of the plane. Waits for the disk if its vectors are on disk.
    pub fn table(&self) -> Result<Table, Error> {
        let damaged = |error: strew_core::Error| {
            tracing::error!(source = %self.source, %error, "a checked table is not valid any more");
            Error::Internal("a table is not valid any more")
        };
        match (&self.content, &self.source) {
            (Content::Held(bytes), _) => Table::from_bytes(bytes).map_err(damaged),
            (Content::OnDisk, Source::File(path)) => self.table_of(path),
            (Content::Space(..), _) => {
                Err(Error::Internal("a table in space for a set of the plane"))
            }
            _ => {
                let table = Table::undisplaced(self.key.alpha, self.radius, &self.key.profile);
                table.map_err(damaged)
            }
        }
    }

    fn table_of(&self, path: &Path) -> Result<Table, Error> {
        let read = Self::from_file(path.to_owned()).map_err(|error| error.to_string());
        let table = read.and_then(|read| match read.digest == self.digest {
            true => read.table().map_err(|error| error.to_string()),
            false => Err(format!("its digest is {} now", read.digest)),
        });
        table.map_err(|error| {
            tracing::error!(source = %self.source, digest = self.digest, error, "a table cannot be read");
            Error::TableUnreadable {
                table: self.key.to_string(),
            }
        })
    }

    /// A digest of its vectors alone; `None` if they cannot be read.
    pub(super) fn vectors(&self) -> Option<[u8; 32]> {
        if let Some(known) = self.vectors.get() {
            return Some(*known);
        }
        let digest = digest_of_vectors(&self.table().ok()?);
        Some(*self.vectors.get_or_init(|| digest))
    }

    /// A figure that was measured on the first set that the table was not made on, if it was.
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

fn digest_of_vectors(table: &Table) -> [u8; 32] {
    let vectors = table.displacements().as_flattened();
    let mut bytes = vec![0; size_of_val(vectors)];
    for (place, vector) in bytes.chunks_exact_mut(size_of::<f32>()).zip(vectors) {
        place.copy_from_slice(&vector.to_le_bytes());
    }
    *blake3::hash(&bytes).as_bytes()
}

/// The head of a table file, if it can be read.
fn head_of(bytes: &[u8]) -> Option<Head> {
    let part = |at: u64, part: &mut [u8]| {
        let start = usize::try_from(at).unwrap_or(usize::MAX);
        let whole = start
            .checked_add(part.len())
            .and_then(|end| bytes.get(start..end));
        part.copy_from_slice(whole.ok_or(io::ErrorKind::UnexpectedEof)?);
        Ok::<_, io::Error>(())
    };
    Head::read(bytes.len() as u64, part).ok()?.ok()
}

/// The head of a table file, and the size of the file.
fn read_head(path: &Path) -> io::Result<(Result<Head, strew_core::Error>, u64)> {
    let mut file = bounded_file::open_regular(path)?;
    let bytes = file.metadata()?.len();
    let head = Head::read(bytes, |at, part| fill(&mut file, at, part))?;
    Ok((head, bytes))
}

fn fill(file: &mut File, at: u64, part: &mut [u8]) -> io::Result<()> {
    file.seek(SeekFrom::Start(at))?;
    file.read_exact(part)
}

/// A table that is ready to answer.
#[derive(Clone, Debug)]
pub struct Ready {
    pub entry: Arc<Entry>,
    /// The table; its least distances have been computed.
    pub table: Table,
    /// The table with its second order, if the set has kinds whose shares vary.
    pub second: Option<Table>,
}

impl Ready {
    /// Reads a table: microseconds to milliseconds, by its size.
    pub fn load(entry: &Arc<Entry>) -> Result<Self, Error> {
        Ok(Self::new(entry.clone(), entry.table()?))
    }

    /// A table, once its least distances are computed.
    pub fn new(entry: Arc<Entry>, table: Table) -> Self {
        let _ = (table.least_distance(), table.least_distance_of(0, 0));
        Self {
            entry,
            table,
            second: None,
        }
    }
}
