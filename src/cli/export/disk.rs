//! The speed of a disk, by a short trial: in the end an export waits for the disk.

use std::{
    fs::{self, File},
    io::{self, Write as _},
    path::Path,
    time::{Duration, Instant},
};

use crate::cli::signals::Incomplete;

/// The most bytes of the trial.
const BYTES: u64 = 32 << 20;
/// The trial writes nothing more after this time.
const TRIAL: Duration = Duration::from_millis(300);
/// The number of files of the trial.
const FILES: u32 = 32;

/// The seconds that a disk takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Speed {
    per_byte: f64,
    per_file: f64,
}

impl Speed {
    /// Tries the disk of a folder. `None` if it cannot be written, which the export itself reports.
    pub(super) fn of(folder: &Path) -> Option<Self> {
        let path = folder.join(format!(".strew-trial-{}", std::process::id()));
        let (mut file, trial) = Incomplete::make(&path, |path| File::create(path)).ok()?;
        let speed = written(&mut file).and_then(|per_byte| {
            let per_file = named(&path)?;
            Ok(Self { per_byte, per_file })
        });
        drop(trial);
        speed.ok()
    }

    /// The time that some files of some bytes take.
    pub(super) fn time(self, files: f64, bytes: f64) -> f64 {
        files * self.per_file + bytes * self.per_byte
    }
}

/// Seconds per byte, until the bytes are on the disk.
fn written(file: &mut File) -> io::Result<f64> {
    // File systems that compress must not see zeros.
    let mut block = vec![0; 1 << 20];
    blake3::Hasher::new().finalize_xof().fill(&mut block);
    let (began, mut bytes) = (Instant::now(), 0);
    while bytes < BYTES && began.elapsed() < TRIAL {
        file.write_all(&block)?;
        bytes += block.len() as u64;
    }
    file.sync_all()?;
    Ok(began.elapsed().as_secs_f64() / bytes as f64)
}

/// Seconds for each file that is made and renamed.
fn named(path: &Path) -> io::Result<f64> {
    let fresh = path.with_extension("new");
    let began = Instant::now();
    for _ in 0..FILES {
        fs::write(&fresh, b"x").and_then(|()| fs::rename(&fresh, path))?;
    }
    Ok(began.elapsed().as_secs_f64() / f64::from(FILES))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_trial_takes_time_and_leaves_nothing() {
        let folder = tempfile::tempdir().expect("a folder");
        let speed = Speed::of(folder.path()).expect("writable");
        assert!(speed.per_byte > 0.0 && speed.per_file > 0.0, "{speed:?}");
        assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 0);
        assert_eq!(Speed::of(&folder.path().join("none")), None);
        let known = Speed {
            per_byte: 2.0,
            per_file: 10.0,
        };
        assert_eq!(known.time(3.0, 4.0), 38.0);
    }
}
