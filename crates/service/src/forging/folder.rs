//! The forge's files: the folder `forge` of the folder of tables, with a document for each job and its checkpoint.
//!
//! Names are ids, which are hashes: no text of a client becomes part of a path.

use std::{
    ffi::OsStr,
    fs::{self, File},
    io::{self, Write as _},
    path::{Path, PathBuf},
};

use strew_config::bounded_file;
use strew_core::Table;
use strew_forge::{EXTENSION, Job, file_name, read_table, write_table};

use super::job::Kept;

/// The largest document of a job: its curve most of all.
const MAX_BYTES: u64 = 1 << 20;

/// The folders of tables and of jobs.
#[derive(Debug)]
pub(super) struct Folder {
    tables: PathBuf,
    jobs: PathBuf,
}

impl Folder {
    pub(super) fn new(tables: PathBuf) -> Self {
        let jobs = tables.join("forge");
        Self { tables, jobs }
    }

    fn document(&self, id: &str) -> PathBuf {
        self.jobs.join(format!("{id}.json"))
    }

    /// Where the checkpoint of a job is.
    pub(super) fn checkpoint(&self, id: &str) -> PathBuf {
        self.jobs.join(format!("{id}.checkpoint"))
    }

    /// The jobs that were kept, in the order they came. What cannot be read is left alone.
    pub(super) fn read(&self) -> Vec<Kept> {
        let listed = fs::read_dir(&self.jobs).into_iter().flatten();
        let mut kept = vec![];
        for path in listed.filter_map(|file| Some(file.ok()?.path())) {
            if path.extension() == Some(OsStr::new("part")) {
                // Left by a crash.
                remove(&path);
            }
            if path.extension() != Some(OsStr::new("json")) {
                continue;
            }
            let read = bounded_file::read(&path, MAX_BYTES).map_err(|error| error.to_string());
            let read = read.and_then(|bytes| {
                serde_json::from_slice(&bytes).map_err(|error| error.to_string())
            });
            match read {
                Ok(job) => kept.push(job),
                Err(error) => {
                    tracing::warn!(path = %path.display(), error, "not a job of the forge");
                }
            }
        }
        kept.sort_by_key(|job: &Kept| job.number);
        kept
    }

    /// Writes down a job, whole or not at all.
    pub(super) fn keep(&self, kept: &Kept) -> io::Result<()> {
        fs::create_dir_all(&self.jobs)?;
        let path = self.document(&kept.status.id);
        let part = path.with_extension("part");
        let mut file = File::create(&part)?;
        file.write_all(&serde_json::to_vec(kept).map_err(io::Error::other)?)?;
        file.sync_all()?;
        fs::rename(part, path)
    }

    /// Removes the files of a job except its table.
    pub(super) fn forget(&self, id: &str) {
        remove(&self.document(id));
        self.remove_checkpoint(id);
    }

    /// Removes the checkpoint of a job.
    pub(super) fn remove_checkpoint(&self, id: &str) {
        remove(&self.checkpoint(id));
    }

    /// The number of tables in the folder, and the bytes of their files.
    pub(super) fn holds(&self) -> io::Result<(usize, u64)> {
        let mut holds = (0, 0);
        for entry in fs::read_dir(&self.tables)? {
            let entry = entry?;
            if entry.path().extension().is_some_and(|own| own == EXTENSION) {
                holds = (holds.0 + 1, holds.1 + entry.metadata()?.len());
            }
        }
        Ok(holds)
    }

    /// Writes a finished table, under its usual name if that is free. Returns where it is.
    pub(super) fn store(&self, job: &Job, id: &str, table: &Table) -> Result<PathBuf, String> {
        let usual = file_name(&job.profile, job.alpha, job.radius);
        let usual = self.tables.join(usual);
        let is_there = usual.exists();
        let is_this = |there: Table| there.digest() == table.digest();
        if is_there && read_table(&usual).is_ok_and(is_this) {
            // From before a crash.
            return Ok(usual);
        }
        let path = match is_there {
            // A table of another key, or a file that was refused.
            true => usual.with_extension(format!("{id}.{EXTENSION}")),
            false => usual,
        };
        write_table(&path, table).map_err(|error| error.to_string())?;
        Ok(path)
    }
}

fn remove(path: &Path) {
    match fs::remove_file(path) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => {
            tracing::warn!(path = %path.display(), %error, "a file of the forge cannot be removed");
        }
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::{super::Spec, *};

    #[test]
    fn a_table_that_is_stored_again_after_a_crash_is_one_file() {
        let tables = tempfile::tempdir().expect("a temporary folder");
        let folder = Folder::new(tables.path().to_owned());
        let spec = Spec {
            profile: "blue".into(),
            alpha: "sqrt(3)".into(),
            map: "r4".into(),
            target: None,
        };
        let job = spec.job().expect("valid");
        let table = |profile| Table::undisplaced(job.alpha, 4, profile).expect("valid");
        let store = |table: &Table| folder.store(&job, "a0", table).expect("stored");
        let usual = store(&table("blue"));
        assert_eq!(store(&table("blue")), usual);
        assert_ne!(store(&table("other")), usual);
        assert_eq!(folder.holds().expect("read").0, 2);
    }
}
