//! How files look from outside: names, lengths, times of change.

use std::{
    fs,
    path::{Path, PathBuf},
    time::{Duration, SystemTime},
};

/// File systems keep times in steps of up to two seconds: a file that was changed this short a time
/// ago can be changed again without looking different.
const YOUNG: Duration = Duration::from_secs(3);

/// How a folder of tables and a file of keys looked at some moment.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Look {
    /// Each file with its length and time of change, as far as the system tells.
    files: Vec<(PathBuf, Option<(u64, SystemTime)>)>,
    /// Whether a file had just been changed.
    is_young: bool,
}

impl Look {
    /// Looks at the tables of a folder, and at a file.
    pub(super) fn at(folder: Option<&Path>, file: Option<&Path>) -> Self {
        let listed = folder.and_then(|folder| fs::read_dir(folder).ok());
        let names = listed.into_iter().flatten().filter_map(|file| {
            let path = file.ok()?.path();
            path.extension()
                .is_some_and(|e| e == "strew")
                .then_some(path)
        });
        let now = SystemTime::now();
        let mut is_young = false;
        let mut files: Vec<_> = names
            .chain(file.map(Into::into))
            .map(|path| {
                // Follows links: orchestrators change what a link points to.
                let state = fs::metadata(&path).and_then(|data| Ok((data.len(), data.modified()?)));
                let state = state.ok();
                // A time in the future, after a clock was set back, counts as young, too.
                is_young |= state.is_some_and(|(_, changed)| {
                    now.duration_since(changed).is_ok_and(|age| age < YOUNG)
                        || now.duration_since(changed).is_err()
                });
                (path, state)
            })
            .collect();
        files.sort();
        Self { files, is_young }
    }

    /// Whether nothing can have changed since an earlier look.
    pub(super) fn is_surely(&self, earlier: &Self) -> bool {
        self.files == earlier.files && !earlier.is_young
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_change_shows_also_if_the_file_looks_the_same() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("a.strew");
        let aged = || {
            let file = fs::File::options().write(true).open(&path).expect("there");
            let then = SystemTime::now() - Duration::from_secs(60);
            file.set_modified(then).expect("settable");
        };
        let look = || Look::at(Some(folder.path()), Some(&folder.path().join("keys.toml")));
        let none = look();
        assert!(look().is_surely(&none));
        fs::write(&path, "one").expect("writable");
        let young = look();
        assert!(!young.is_surely(&none));
        // It may have been written again within the same step of the clock.
        assert!(!look().is_surely(&young));
        aged();
        let old = look();
        assert!(look().is_surely(&old));
        fs::write(&path, "three").expect("writable");
        aged();
        assert!(!look().is_surely(&old));
        fs::write(folder.path().join("notes.txt"), "no table").expect("writable");
        fs::remove_file(&path).expect("removable");
        assert!(look().is_surely(&none));
    }
}
