//! The files that are watched, and what they contain.

use std::{
    fs,
    io::{self, Read as _, Seek as _, SeekFrom},
    path::{Path, PathBuf},
    time::UNIX_EPOCH,
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
        let mut tables: Vec<PathBuf> = tables.collect();
        tables.sort();
        Fingerprint::of(&tables, &self.files, &field::stamp(&self.fields))
    }
}

/// A hash of the names and contents of files. Errors of reading count as content. Of a table, which there may be
/// thousands of, only what stands for its content: its ends, the last of which is its digest, its size, its time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fingerprint(blake3::Hash);

impl Fingerprint {
    fn of(tables: &[PathBuf], files: &[PathBuf], fields: &Stamp) -> Self {
        let mut hasher = blake3::Hasher::new();
        let tables = tables.iter().map(|path| (path, ends(path)));
        let files = files
            .iter()
            .map(|path| (path, bounded_file::read(path, MAX_FILE_BYTES)));
        for (path, content) in tables.chain(files) {
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

/// The first and the last bytes of a file, its size, its time of change and, where there is one, its number.
fn ends(path: &Path) -> io::Result<Vec<u8>> {
    const END: u64 = 64;
    let mut file = bounded_file::open_regular(path)?;
    let about = file.metadata()?;
    let mut content = vec![];
    (&mut file).take(END).read_to_end(&mut content)?;
    file.seek(SeekFrom::Start(about.len().saturating_sub(END)))?;
    file.take(END).read_to_end(&mut content)?;
    content.extend(about.len().to_le_bytes());
    if let Ok(since) = about.modified()?.duration_since(UNIX_EPOCH) {
        content.extend(since.as_nanos().to_le_bytes());
    }
    #[cfg(unix)]
    content.extend(std::os::unix::fs::MetadataExt::ino(&about).to_le_bytes());
    Ok(content)
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
