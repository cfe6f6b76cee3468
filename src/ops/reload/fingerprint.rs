//! What watched files contain.

use std::{
    fs,
    path::{Path, PathBuf},
};

use strew_core::table::MAX_FILE_BYTES;

use crate::bounded_file;

/// A hash of the names and contents of files. Errors of reading count as content.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Fingerprint(blake3::Hash);

impl Fingerprint {
    /// Reads the tables of a folder, and further files. Links are followed: orchestrators change what
    /// a link points to.
    pub(super) fn of(folder: Option<&Path>, mut files: Vec<PathBuf>) -> Self {
        let listed = folder.and_then(|folder| fs::read_dir(folder).ok());
        let tables = listed.into_iter().flatten().filter_map(|file| {
            let path = file.ok()?.path();
            let is_table = path.extension().is_some_and(|e| e == "strew");
            is_table.then_some(path)
        });
        files.extend(tables);
        files.sort();
        let mut hasher = blake3::Hasher::new();
        for path in files {
            let content = bounded_file::read(&path, MAX_FILE_BYTES);
            let content = content.unwrap_or_else(|error| error.to_string().into_bytes());
            for part in [path.as_os_str().as_encoded_bytes(), &content] {
                hasher.update(&(part.len() as u64).to_le_bytes());
                hasher.update(part);
            }
        }
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
        let look = || Fingerprint::of(Some(folder.path()), vec![folder.path().join("keys.toml")]);
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
