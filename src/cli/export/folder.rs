//! A folder of chunks. Each chunk is written under a temporary name, renamed, and noted in a journal, so that a killed
//! run resumes where it was.

use std::{
    collections::HashMap,
    fs::{self, File, Metadata},
    io::{self, BufRead as _, BufReader, Write as _},
    path::{Path, PathBuf},
};

use anyhow::{Context as _, anyhow};
use parking_lot::Mutex;

use super::{
    chunks::{Chunk, Maker},
    record::{MANIFEST, Manifest, Record},
    spec::Spec,
};
use crate::cli::{Failure, compression::Compression, refuse};

/// The folder of an incomplete export: the spec, the journal, files under temporary names.
pub(super) const WORK: &str = ".partial";

/// The chunks of earlier runs, by their numbers.
type Done = HashMap<usize, Record>;

pub(super) struct Folder {
    root: PathBuf,
    work: PathBuf,
    journal: Mutex<File>,
    compressions: Vec<Compression>,
    _lock: File,
}

fn is_complete(root: &Path, spec: &Spec) -> Result<bool, Failure> {
    let Ok(bytes) = fs::read(root.join(MANIFEST)) else {
        return Ok(false);
    };
    match Manifest::read(&bytes).is_ok_and(|manifest| manifest.export == *spec) {
        true => Ok(true),
        false => Err(other(root)),
    }
}

fn other(root: &Path) -> Failure {
    Failure::Usage(anyhow!(
        "--output {}: the folder holds an export with other options, of another world, or for --format arrow with \
         another limits.block_bytes: choose another folder",
        root.display()
    ))
}

impl Folder {
    /// Opens a folder for an export, with the chunks of an earlier run; `None` if the export is complete. Refuses a folder
    /// that holds anything else.
    pub(super) fn open(
        root: &Path,
        spec: &Spec,
        maker: &Maker,
    ) -> Result<Option<(Self, Done)>, Failure> {
        let unwritable = || format!("cannot write {}", root.display());
        fs::create_dir_all(root).with_context(unwritable)?;
        let work = root.join(WORK);
        if is_complete(root, spec)? && !work.exists() {
            return Ok(None);
        }
        let is_empty = || -> io::Result<bool> { Ok(fs::read_dir(root)?.next().is_none()) };
        if !work.exists() && !is_empty().with_context(unwritable)? {
            refuse!(
                "--output {}: the folder is not empty; allowed: a new folder, or that of an interrupted export",
                root.display()
            );
        }
        fs::create_dir_all(&work).with_context(unwritable)?;
        let Some(lock) = lock(&work.join("lock")).with_context(unwritable)? else {
            refuse!(
                "--output {}: another process writes this folder",
                root.display()
            );
        };
        // Another process may have ended meanwhile, or was killed after it had written the manifest.
        if is_complete(root, spec)? {
            fs::remove_dir_all(&work)
                .with_context(|| format!("cannot remove {}", work.display()))?;
            return Ok(None);
        }
        let ours = serde_json::to_vec(spec).context("the options cannot be written")?;
        let file = work.join("spec.json");
        match fs::read(&file) {
            Ok(theirs) if theirs == ours => {}
            Ok(_) => return Err(other(root)),
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                replace(&work.join("spec.json.new"), &file, &ours).with_context(unwritable)?;
            }
            Err(error) => return Err(anyhow!(error).context(unwritable()).into()),
        }
        let (path, fresh) = (work.join("journal"), work.join("journal.new"));
        let journal = || {
            let mut options = File::options();
            let opened = options.create(true).read(true).append(true).open(&path);
            opened.with_context(unwritable)
        };
        let done = done(&journal()?, root, maker, &spec.compressions()).with_context(unwritable)?;
        // Without a broken last line, and with each chunk once.
        let lines: String = done.iter().map(|(i, record)| record.line(*i)).collect();
        replace(&fresh, &path, lines.as_bytes()).with_context(unwritable)?;
        let folder = Self {
            root: root.into(),
            journal: Mutex::new(journal()?),
            work,
            compressions: spec.compressions(),
            _lock: lock,
        };
        Ok(Some((folder, done)))
    }

    pub(super) fn put(&self, i: usize, name: &str, chunk: Chunk) -> anyhow::Result<Record> {
        let mut record = Record {
            points: chunk.points,
            files: vec![],
        };
        for compression in &self.compressions {
            let bytes = chunk.packed(*compression)?;
            let length = bytes.len() as u64;
            record.files.push((blake3::hash(&bytes), length));
            self.file(&compression.name(name), &bytes)?;
        }
        let mut journal = self.journal.lock();
        let noted = journal.write_all(record.line(i).as_bytes());
        noted.with_context(|| format!("cannot write {}", self.work.display()))?;
        Ok(record)
    }

    /// Writes a file under a temporary name, and renames it.
    pub(super) fn file(&self, name: &str, bytes: &[u8]) -> anyhow::Result<()> {
        let thread = rayon::current_thread_index().unwrap_or(usize::MAX);
        let (fresh, path) = (self.work.join(format!("{thread}")), self.root.join(name));
        let write = || -> io::Result<()> {
            fs::write(&fresh, bytes)?;
            match fs::rename(&fresh, &path) {
                Err(error) if error.kind() == io::ErrorKind::NotFound => {
                    fs::create_dir_all(path.parent().unwrap_or(&self.root))?;
                    fs::rename(&fresh, &path)
                }
                renamed => renamed,
            }
        };
        write().with_context(|| format!("cannot write {}", path.display()))
    }

    /// Removes the traces of an export that does not begin, so that another one may.
    pub(super) fn abandon(self) {
        // Without the removal, an export without chunks stays.
        let _ = fs::remove_dir_all(&self.work);
    }

    /// Writes the documents. The last one marks the export as complete.
    pub(super) fn finish(self, documents: &[(String, Vec<u8>)]) -> anyhow::Result<()> {
        let Some((last, others)) = documents.split_last() else {
            return Ok(());
        };
        for (name, bytes) in others {
            self.file(name, bytes)?;
        }
        self.sync()?;
        self.file(&last.0, &last.1)?;
        self.sync()?;
        fs::remove_dir_all(&self.work)
            .with_context(|| format!("cannot remove {}", self.work.display()))
    }

    #[cfg(target_os = "linux")]
    fn sync(&self) -> anyhow::Result<()> {
        let all = File::open(&self.root).and_then(|root| Ok(rustix::fs::syncfs(root)?));
        all.with_context(|| format!("cannot write {}", self.root.display()))
    }

    #[cfg(not(target_os = "linux"))]
    fn sync(&self) -> anyhow::Result<()> {
        Ok(())
    }
}

/// The chunks of a journal whose files exist and have their lengths.
fn done(
    journal: &File,
    root: &Path,
    maker: &Maker,
    compressions: &[Compression],
) -> io::Result<Done> {
    let chunks = maker.grid.chunks();
    let is_there = |(i, record): &(usize, Record)| {
        let is_of_export = *i < chunks && record.files.len() == compressions.len();
        is_of_export && {
            let name = maker.grid.name(*i);
            compressions
                .iter()
                .zip(&record.files)
                .all(|(packed, (_, length))| {
                    let file = fs::metadata(root.join(packed.name(&name)));
                    file.is_ok_and(|file| file.len() == *length)
                })
        }
    };
    let mut done = HashMap::new();
    let mut lines = BufReader::new(journal);
    let mut line = String::new();
    while lines.read_line(&mut line)? > 0 {
        done.extend(Record::read(&line).filter(is_there));
        line.clear();
    }
    Ok(done)
}

/// Writes a file under another name, and renames it.
fn replace(fresh: &Path, path: &Path, bytes: &[u8]) -> io::Result<()> {
    fs::write(fresh, bytes)?;
    fs::rename(fresh, path)
}

/// Opens and locks a file, and makes it if it is missing; `None` if another process holds it.
///
/// The process that held it may have renamed or removed it between the opening and the lock. Then the name is opened
/// again, so the file that is returned is the one that has the name now.
fn lock(path: &Path) -> io::Result<Option<File>> {
    loop {
        let mut options = File::options();
        options.create(true).truncate(false).read(true).write(true);
        let file = options.open(path)?;
        match file.try_lock() {
            Ok(()) => {}
            Err(fs::TryLockError::WouldBlock) => return Ok(None),
            Err(fs::TryLockError::Error(error)) => return Err(error),
        }
        match fs::metadata(path) {
            Ok(named) if is_same(&file.metadata()?, &named) => return Ok(Some(file)),
            Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
            _ => {}
        }
    }
}

#[cfg(unix)]
fn is_same(one: &Metadata, other: &Metadata) -> bool {
    use std::os::unix::fs::MetadataExt as _;
    (one.dev(), one.ino()) == (other.dev(), other.ino())
}

/// Other systems rename and remove no file that is open.
#[cfg(not(unix))]
fn is_same(_: &Metadata, _: &Metadata) -> bool {
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_holder_at_a_time_has_the_file_of_the_name() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("lock");
        let first = lock(&path).expect("writable").expect("free");
        assert!(lock(&path).expect("writable").is_none());
        // The holder renames its file: the name is free, and the lock is another file's.
        fs::rename(&path, folder.path().join("done")).expect("there");
        let second = lock(&path).expect("writable").expect("free");
        assert!(lock(&path).expect("writable").is_none());
        drop((first, second));
        assert!(lock(&path).expect("writable").is_some());
    }
}
