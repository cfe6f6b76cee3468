//! The files that are watched, and what they contain.

use std::{
    fs,
    path::{Path, PathBuf},
};

use strew_core::table::MAX_FILE_BYTES;

use crate::{
    bounded_file,
    config::{Config, Fields},
    service::field::{self, Stamp},
};

/// The files that are watched.
#[derive(Clone, Debug, PartialEq)]
pub struct Watched {
    /// The folder of tables.
    folder: Option<PathBuf>,
    /// The fields.
    fields: Fields,
    /// Keys and certificates.
    files: Vec<PathBuf>,
}

impl Watched {
    /// The files that the settings name.
    pub fn of(config: &Config) -> Self {
        let files = config.access.keys_file().into_iter();
        Self {
            folder: config.tables.folder().map(Into::into),
            fields: config.fields.clone(),
            files: files.chain(config.tls.files()).map(Into::into).collect(),
        }
    }

    /// The folder of tables, if there is one.
    pub(super) fn folder(&self) -> Option<&Path> {
        self.folder.as_deref()
    }

    /// The fields.
    pub(super) const fn fields(&self) -> &Fields {
        &self.fields
    }

    pub(super) fn is_empty(&self) -> bool {
        let has_fields = self.fields.folder().is_some() || !self.fields.named.is_empty();
        self.folder.is_none() && self.files.is_empty() && !has_fields
    }

    /// Reads all of them. Links are followed: orchestrators change what a link points to.
    pub fn look(&self) -> Fingerprint {
        let listed = self.folder().and_then(|folder| fs::read_dir(folder).ok());
        let tables = listed.into_iter().flatten().filter_map(|file| {
            let path = file.ok()?.path();
            let is_table = path.extension().is_some_and(|e| e == "strew");
            is_table.then_some(path)
        });
        let mut files: Vec<PathBuf> = tables.chain(self.files.iter().cloned()).collect();
        files.sort();
        Fingerprint::of(&files, &field::stamp(&self.fields))
    }
}

/// A hash of the names and contents of files. Errors of reading count as content.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fingerprint(blake3::Hash);

impl Fingerprint {
    fn of(files: &[PathBuf], fields: &Stamp) -> Self {
        let mut hasher = blake3::Hasher::new();
        for path in files {
            let content = bounded_file::read(path, MAX_FILE_BYTES);
            let content = content.unwrap_or_else(|error| error.to_string().into_bytes());
            for part in [path.as_os_str().as_encoded_bytes(), &content] {
                hasher.update(&(part.len() as u64).to_le_bytes());
                hasher.update(part);
            }
        }
        fields.hash(&mut hasher);
        Self(hasher.finalize())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn changes_show_also_if_length_and_time_stay_the_same() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("a.strew");
        let then = std::time::SystemTime::now();
        let write = |text: &str| {
            fs::write(&path, text).expect("writable");
            let file = fs::File::options().write(true).open(&path).expect("there");
            file.set_modified(then).expect("settable");
        };
        let watched = Watched {
            folder: Some(folder.path().into()),
            fields: Fields {
                embedded: false,
                folder: PathBuf::new(),
                max_bytes: 0,
                max_sent_bytes: 0,
                named: Default::default(),
            },
            files: vec![folder.path().join("keys.toml")],
        };
        let look = || watched.look();
        let none = look();
        assert_eq!(look(), none);
        write("one");
        let one = look();
        assert!(one != none && look() == one);
        write("two");
        assert_ne!(look(), one);
        write("one");
        assert_eq!(look(), one);
        fs::write(folder.path().join("notes.txt"), "no table").expect("writable");
        assert_eq!(look(), one);
        fs::write(folder.path().join("keys.toml"), "").expect("writable");
        assert_ne!(look(), one);
    }
}
