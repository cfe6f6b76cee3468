//! Locks: one process writes an export.

use std::{
    fs::{self, File, Metadata},
    io,
    path::Path,
};

/// Opens and locks a file, and makes it if it is missing; `None` if another process holds it.
///
/// The process that held it may have renamed or removed it between the opening and the lock. Then the name is opened
/// again, so the file that is returned is the one that has the name now.
///
/// # Errors
/// The error of the file system.
pub(super) fn lock(path: &Path) -> io::Result<Option<File>> {
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
