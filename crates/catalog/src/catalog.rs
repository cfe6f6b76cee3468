//! The tables that are loaded: the built-in ones and those of a folder.
//!
//! Tables are found by profile, α, map and kinds. The built-in ones and the first `tables.preload_bytes` of the folder
//! are read and checked whole, at the start or when the folder is read again (`reload`), so that a damaged file is an
//! error then and not during a query. Of further files only the heads are read, a few hundred bytes each; such a table
//! is read by the first query that needs it. Ready samplers are made of either by the cache.

use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
    sync::Arc,
};

use strew_core::{
    Alpha,
    field::FieldSpec,
    map::Size,
    space,
    table::{BLUE, joint_files},
};
use strew_error::{Audience, Checked, Error};

use crate::{
    entry::Entry,
    error::CatalogError,
    except::Lists,
    field::{self, Allowance, Document, Fields, NamedField},
    key::{Dimension, Key, MixKey, Source},
    named::files_of,
    patterns::Patterns,
    sent::Sent,
};

/// The tables that are built into the program beside the library's: (file name, content).
static EMBEDDED: &[(&str, &[u8])] = include!(concat!(env!("OUT_DIR"), "/tables.rs"));

/// The tables that are built into the library, beside its joint ones.
const LIBRARY: [(&str, &[u8]); 2] = [
    ("blue-5-sqrt3-over-2-m.strew", BLUE),
    ("space-blue-5-sqrt3-over-2-r16.strew", space::BLUE),
];

#[derive(Clone, Debug, Default)]
pub struct Catalog {
    pub(crate) entries: BTreeMap<Key, Arc<Entry>>,
    /// The built-in ones, also where a file's table stands in the place of one.
    pub(crate) built_in: BTreeMap<Key, Arc<Entry>>,
    pub(crate) fields: Arc<Fields>,
    pub(crate) except: Arc<Lists>,
    sent: Arc<Sent<NamedField>>,
    patterns: Arc<Patterns>,
    /// The bytes of files that are held.
    pub(crate) preload_bytes: u64,
    /// Who reads its errors, by default a daemon's clients.
    audience: Option<&'static Audience>,
    /// The most pixels that a query may include, if not the default.
    most_pixels: Option<usize>,
}

/// The result of building a field: the room that is left, and the memory it takes.
#[derive(Clone, Debug)]
pub struct Built {
    pub left: usize,
    /// The memory that the field's pixels take, in bytes.
    pub bytes: usize,
    pub frame: Option<[f64; 4]>,
    /// The code of EPSG of the plane of loaded fields that it names.
    pub epsg: Option<u16>,
    /// Why there was no memory for its pixels, if there was none.
    pub refused: Option<Error>,
}

impl Catalog {
    /// Loads the tables of a folder, if there is one, and with `embedded` the built-in ones. A table of the folder
    /// replaces a built-in one with the same key.
    pub fn load(embedded: bool, folder: Option<&Path>) -> Result<Self, CatalogError> {
        Self::preloading(u64::MAX, embedded, folder)
    }

    /// Loads like [`load`](Self::load), but reads only the heads of files beyond `preload_bytes`. Damage of those shows
    /// when they are used.
    pub fn preloading(
        preload_bytes: u64,
        embedded: bool,
        folder: Option<&Path>,
    ) -> Result<Self, CatalogError> {
        let mut catalog = Self {
            preload_bytes,
            ..Self::default()
        };
        if embedded {
            let files = LIBRARY.iter().chain(EMBEDDED).copied().chain(joint_files());
            catalog.add(files.map(|(name, bytes)| Entry::embedded(name, bytes)))?;
            catalog.built_in.clone_from(&catalog.entries);
        }
        if let Some(folder) = folder {
            let files = table_files(folder)?;
            let mut preload = Preload(preload_bytes);
            catalog.add(files.into_iter().map(|file| preload.read(file)))?;
        }
        Ok(catalog)
    }

    /// The tables of these files, which a program has in memory, and no others.
    pub fn of_files(files: impl IntoIterator<Item = Vec<u8>>) -> Result<Self, CatalogError> {
        let mut catalog = Self::default();
        let files = files.into_iter().enumerate();
        catalog.add(files.map(|(i, file)| Entry::read(file.into(), Source::Memory(i))))?;
        Ok(catalog)
    }

    pub fn with_fields(mut self, fields: Fields) -> Self {
        self.fields = Arc::new(fields);
        self
    }

    pub fn with_except(mut self, lists: Lists) -> Self {
        self.except = Arc::new(lists);
        self
    }

    pub fn except(&self) -> &Lists {
        &self.except
    }

    /// The catalog with the audience of its errors.
    pub const fn with_audience(mut self, audience: &'static Audience) -> Self {
        self.audience = Some(audience);
        self
    }

    pub fn audience(&self) -> &'static Audience {
        self.audience.unwrap_or(&Audience::DAEMON)
    }

    pub fn fields(&self) -> &Fields {
        &self.fields
    }

    /// The catalog with room for fields that clients send, in bytes.
    pub fn with_room(mut self, bytes: usize) -> Self {
        self.sent = Arc::new(Sent::new(bytes));
        self
    }

    /// The catalog for queries of up to this number of pixels, instead of [`field::MOST_PIXELS`].
    pub const fn with_pixels(mut self, most: usize) -> Self {
        self.most_pixels = Some(most);
        self
    }

    pub fn most_pixels(&self) -> usize {
        self.most_pixels.unwrap_or(field::MOST_PIXELS)
    }

    pub fn sent(&self) -> &Sent<NamedField> {
        &self.sent
    }

    /// The field of a name, or of the digest of one that was sent.
    pub fn field(&self, name: &str) -> Option<Arc<NamedField>> {
        let loaded = self.fields.get(name).cloned();
        loaded.or_else(|| self.sent.get(name))
    }

    /// Makes the field of a document that a client has written, of a limited number of pixels.
    pub fn build_field(
        &self,
        path: &str,
        document: &Document,
        pixels: usize,
        allowance: Allowance<'_>,
    ) -> (Checked<FieldSpec>, Built) {
        let named = |name: &str| {
            let field = self.field(name)?;
            Some((field.spec.clone(), field.epsg))
        };
        let names = || self.fields.names();
        let sources = field::Sources::new(&named, &names, allowance, pixels);
        let spec = field::build(path, document, &sources);
        let built = Built {
            left: sources.pixels.get(),
            bytes: sources.bytes.get(),
            frame: sources.frame.get(),
            epsg: sources.epsg.get(),
            refused: sources.refused.take(),
        };
        (spec, built)
    }

    /// Adds the tables of one place over the present ones; no two of them may have the same key.
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

    pub fn entry(&self, key: &Key) -> Option<Arc<Entry>> {
        self.entries.get(key).cloned()
    }

    /// The plain pattern of an α, derived; `None` for a larger map than patterns have.
    pub fn pattern(&self, alpha: Alpha, size: Size) -> Option<Arc<Entry>> {
        self.patterns.get(alpha, size)
    }

    /// All tables of the plane without kinds, by profile, then α.
    pub fn entries(&self) -> impl Iterator<Item = &Arc<Entry>> {
        self.of(Dimension::Plane)
    }

    pub fn in_space(&self) -> impl Iterator<Item = &Arc<Entry>> {
        self.of(Dimension::Space)
    }

    /// All tables of a dimension without kinds.
    fn of(&self, dimension: Dimension) -> impl Iterator<Item = &Arc<Entry>> {
        let all = self.entries.values();
        all.filter(move |entry| entry.key.mix.is_none() && entry.key.dimension == dimension)
    }

    /// The mixes of a table: those whose points are its own, or those whose points were moved.
    pub fn mixes(
        &self,
        of: &Entry,
        are_moved: bool,
    ) -> impl Iterator<Item = (&MixKey, &Arc<Entry>)> {
        self.entries.iter().filter_map(move |(key, entry)| {
            let mix = key.mix.as_deref()?;
            let same = |key: &Key| (key.dimension, key.profile.clone(), key.alpha, key.size);
            let is_same = same(key) == same(&of.key);
            // Only then the vectors matter, which may be on disk.
            let is_moved = || Some(mix.vectors) != of.vectors();
            (is_same && is_moved() == are_moved).then_some((mix, entry))
        })
    }

    /// The shares for which a table has joint kinds.
    pub fn joint_kinds(&self, of: &Entry) -> Vec<String> {
        self.mixes(of, true).map(|(mix, _)| mix.text()).collect()
    }

    /// All tables: of the plane and in space, built in and of the folder, those with kinds among them.
    pub fn tables(&self) -> impl ExactSizeIterator<Item = &Arc<Entry>> {
        self.entries.values()
    }

    /// The names of the profiles, without repetition.
    pub fn profiles(&self, dimension: Dimension) -> Vec<&str> {
        let of = self.of(dimension);
        let mut names: Vec<&str> = of.map(|entry| &*entry.key.profile).collect();
        names.dedup();
        names
    }

    /// The values of α that a profile is loaded for, without repetition.
    pub fn alphas(&self, dimension: Dimension, profile: &str) -> Vec<Alpha> {
        let keys = self.of_profile(dimension, profile);
        let mut alphas: Vec<Alpha> = keys.map(|key| key.alpha).collect();
        alphas.dedup();
        alphas
    }

    /// The sizes of map that a profile is loaded with for an α, smallest first.
    pub fn sizes(&self, dimension: Dimension, profile: &str, alpha: Alpha) -> Vec<Size> {
        let keys = self.of_profile(dimension, profile);
        let keys = keys.filter(|key| key.alpha == alpha);
        keys.map(|key| key.size).collect()
    }

    pub fn has_profile(&self, dimension: Dimension, profile: &str) -> bool {
        self.of_profile(dimension, profile).next().is_some()
    }

    fn of_profile(&self, dimension: Dimension, profile: &str) -> impl Iterator<Item = &Key> {
        self.of(dimension)
            .map(|entry| &entry.key)
            .filter(move |key| &*key.profile == profile)
    }
}

/// The bytes of files that may still be held.
#[derive(Debug)]
pub(crate) struct Preload(pub(crate) u64);

impl Preload {
    /// Reads a file whole if there is room for it, else its head.
    pub(crate) fn read(&mut self, path: PathBuf) -> Result<Entry, CatalogError> {
        let bytes = fs::metadata(&path).map_or(0, |file| file.len());
        if bytes > self.0 {
            return Entry::from_head(path);
        }
        self.0 -= bytes;
        Entry::from_file(path)
    }
}

/// The `*.strew` files of a folder, in the order of their names.
pub(crate) fn table_files(folder: &Path) -> Result<Vec<PathBuf>, CatalogError> {
    let mut files = files_of(folder).map_err(|error| CatalogError::Folder {
        path: folder.into(),
        error,
    })?;
    files.retain(|file| file.extension().is_some_and(|e| e == "strew"));
    Ok(files)
}
