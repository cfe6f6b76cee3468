//! The files that are watched, and what they contain.

use std::{
    fs,
    io::{self, Read as _, Seek as _, SeekFrom},
    path::{Path, PathBuf},
    sync::Arc,
    time::UNIX_EPOCH,
};

use strew_catalog::field::{self, Stamp};
use strew_config::{Config, bounded_file};
use strew_core::table::MAX_FILE_BYTES;

#[derive(Clone, Debug, PartialEq)]
pub struct Watched {
    config: Arc<Config>,
    /// The configuration, keys and certificates.
    files: Vec<PathBuf>,
}

impl Watched {
    pub fn of(config: &Config) -> Self {
        let files = config.access.keys_file().into_iter();
        Self {
            config: Arc::new(config.clone()),
            files: (files.chain(config.tls.files()).map(Into::into))
                .chain(config.layers.files.iter().cloned())
                .collect(),
        }
    }

    pub(super) fn config(&self) -> &Config {
        &self.config
    }

    pub(super) fn is_empty(&self) -> bool {
        let config = &self.config;
        let has_folder = config.tables.folder().is_some()
            || config.fields.folder().is_some()
            || config.worlds.folder().is_some()
            || config.except.folder().is_some();
        !has_folder && self.files.is_empty() && config.fields.named.is_empty()
    }

    /// Reads all of them. Links are followed: orchestrators change what a link points to.
    pub fn look(&self) -> Fingerprint {
        let folder = self.config.tables.folder();
        let listed = folder.and_then(|folder| fs::read_dir(folder).ok());
        let listed = listed.into_iter().flatten().flatten();
        let mut tables: Vec<PathBuf> = listed.map(|file| file.path()).collect();
        tables.retain(|path| path.extension().is_some_and(|e| e == "strew"));
        tables.sort();
        // A reload may have added fields, whose files are watched from then on.
        let now = self.config.read_again();
        let now = now.as_ref().map_or(&*self.config, |(now, _)| now);
        let fields = field::stamp(&now.fields);
        let worlds = field::stamp_of(self.config.worlds.folder());
        let except = field::stamp_of(self.config.except.folder());
        Fingerprint::of(&tables, &self.files, &[fields, worlds, except])
    }
}

/// A hash of the names and contents of files. Errors of reading count as content. Of a table, which there may be
/// thousands of, only what stands for its content: its ends, the last of which is its digest, its size, its time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fingerprint(blake3::Hash);

impl Fingerprint {
    fn of(tables: &[PathBuf], files: &[PathBuf], stamps: &[Stamp]) -> Self {
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
        for stamp in stamps {
            stamp.add_to(&mut hasher);
        }
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
        let layers = strew_config::Layers::new().expect("built in");
        let folder = folder.path();
        let tables = folder.display().to_string();
        let layers = layers.flag("--tables", "tables.folder", &tables);
        let mut config = layers
            .and_then(strew_config::Layers::finish)
            .expect("valid");
        config.layers.files = vec![folder.join("keys.toml")];
        let watched = Watched::of(&config);
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
        fs::write(folder.join("notes.txt"), "no table").expect("writable");
        assert_eq!(look(), one);
        fs::write(folder.join("keys.toml"), "").expect("writable");
        assert_ne!(look(), one);
    }

    #[test]
    fn files_of_fields_that_the_configuration_names_later_are_watched() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let file = folder.path().join("strew.toml");
        fs::write(&file, "").expect("writable");
        let layers = strew_config::Layers::new().and_then(|layers| layers.file(&file));
        let config = layers.and_then(strew_config::Layers::finish);
        let watched = Watched::of(&config.expect("valid"));
        let picture = folder.path().join("hill.png");
        let place = "bbox = [0, 0, 1, 1]";
        let named = format!(
            "[fields.hill.raster]\nfile = '{}'\n{place}\n",
            picture.display()
        );
        fs::write(&file, named).expect("writable");
        let before = watched.look();
        fs::write(picture, "a picture").expect("writable");
        assert_ne!(watched.look(), before);
    }
}
