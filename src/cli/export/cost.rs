//! The cost of an export, reported before it begins: chunks, points, bytes and time, from a short trial; and whether
//! the disk has room.

use std::{
    fs::{self, File},
    io::{self, Write as _},
    path::Path,
    time::{Duration, Instant},
};

use anyhow::anyhow;
use indicatif::{HumanBytes, HumanDuration};
use rayon::prelude::*;

use super::{
    chunks::{Maker, variants},
    spec::Spec,
};
use crate::cli::{Failure, compression::Compression, signals::Incomplete};

/// The most chunks of a trial, evenly spread over all of them.
const TRIED: usize = 32;
/// A trial of few chunks takes one in this number.
const SHARE: usize = 8;
/// A trial begins no chunk after this time.
const TRIAL: Duration = Duration::from_secs(2);
/// Files occupy multiples of this on a disk.
const BLOCK: u64 = 4096;

/// A trial of the disk is worth its time for more bytes than this,
const WORTH: f64 = (1u64 << 20) as f64;
/// and if it has more free.
const ROOM: u64 = 1 << 30;

/// The expected cost.
#[derive(Clone, Debug)]
pub(super) struct Cost {
    chunks: usize,
    /// The number of existing chunks.
    done: usize,
    points: f64,
    /// Whether the number of points was counted, not estimated.
    is_counted: bool,
    bytes: f64,
    /// The bytes that are still to be written, on the disk.
    disk: f64,
    files: f64,
    time: Duration,
}

/// A chunk of the trial.
struct Tried {
    points: f64,
    bytes: f64,
    disk: f64,
    seconds: f64,
}

impl Cost {
    /// Tries some chunks, and counts points where that is quick. `done` chunks exist.
    pub(super) fn of(maker: &Maker, spec: &Spec, done: usize) -> Result<Self, Failure> {
        let compressions = spec.compressions();
        let chunks = maker.grid.chunks();
        let began = Instant::now();
        let number = chunks.div_ceil(SHARE).min(TRIED);
        let tried = (0..number).into_par_iter().map(|k| {
            if k > 0 && began.elapsed() > TRIAL {
                return Ok(None);
            }
            // The middle chunk of each of `number` parts.
            let i = (2 * k + 1) * chunks / (2 * number);
            try_out(maker, &compressions, i).map(Some)
        });
        let tried: Vec<Option<Tried>> = tried.collect::<Result<_, Failure>>()?;
        let tried: Vec<Tried> = tried.into_iter().flatten().collect();
        let mean =
            |of: fn(&Tried) -> f64| tried.iter().map(of).sum::<f64>() / tried.len().max(1) as f64;
        let counted = maker.count().map(|count| count as f64);
        let all = chunks as f64;
        let points = counted.unwrap_or_else(|| all * mean(|t| t.points));
        // Chunks of more points than those of the trial are larger, too.
        let scale = match mean(|t| t.points) {
            few if few > 0.0 => points / (all * few),
            _ => 1.0,
        };
        let left = (chunks - done) as f64;
        let seconds = left * mean(|t| t.seconds) * scale / rayon::current_num_threads() as f64;
        Ok(Self {
            chunks,
            done,
            points,
            is_counted: counted.is_some(),
            bytes: all * mean(|t| t.bytes) * scale,
            disk: left * mean(|t| t.disk) * scale,
            files: left * (1 + compressions.len()) as f64,
            time: Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX),
        })
    }

    /// Adds the time that the disk of a folder takes, if it has ample room for a trial.
    pub(super) fn written_to(self, folder: &Path) -> Self {
        let has_room = free(folder).is_some_and(|(bytes, _)| bytes > ROOM);
        let speed = (has_room && self.disk > WORTH).then(|| Speed::of(folder));
        let Some(speed) = speed.flatten() else {
            return self;
        };
        let writing = speed.time(self.files, self.disk);
        let writing = Duration::try_from_secs_f64(writing).unwrap_or(Duration::MAX);
        Self {
            time: self.time.saturating_add(writing),
            ..self
        }
    }

    /// One line.
    pub(super) fn line(&self) -> String {
        let about = if self.is_counted { "" } else { "about " };
        format!(
            "{} chunks, {about}{:.0} points, about {}, {} on the disk; about {} on {} threads",
            self.chunks,
            self.points,
            HumanBytes(self.bytes as u64),
            HumanBytes(self.disk as u64),
            HumanDuration(self.time),
            rayon::current_num_threads(),
        )
    }

    /// Refuses an export that does not fit the disk of a folder.
    pub(super) fn check(&self, folder: &Path) -> Result<(), Failure> {
        let Some((bytes, files)) = free(folder) else {
            return Ok(());
        };
        let place = folder.display();
        let more = if self.done > 0 { " more" } else { "" };
        // An export that has begun keeps its options.
        let advise = |otherwise: &str| match self.done {
            0 => format!(": {otherwise}"),
            done => format!("; {}", go_on(done, self.chunks)),
        };
        if self.disk > bytes as f64 {
            return Err(Failure::Other(anyhow!(
                "the export takes about {}{more}, and the disk of {place} has {} free{}",
                HumanBytes(self.disk as u64),
                HumanBytes(bytes),
                advise("choose a smaller box, another format, fewer points or another disk")
            )));
        }
        // Some file systems do not count files.
        if files > 0 && self.files > files as f64 {
            return Err(Failure::Other(anyhow!(
                "the export takes {:.0} files{more}, and the disk of {place} has room for {files}{}",
                self.files,
                advise("choose larger chunks")
            )));
        }
        Ok(())
    }
}

/// The advice for an export that lacks room.
pub(super) fn go_on(done: usize, chunks: usize) -> String {
    format!("{done} of {chunks} chunks exist: make room, and the same command resumes there")
}

fn try_out(maker: &Maker, compressions: &[Compression], i: usize) -> Result<Tried, Failure> {
    let began = Instant::now();
    let chunk = maker.make(i)?;
    let points = chunk.points as f64;
    let files = variants(chunk.bytes, compressions)?;
    let sizes = files.iter().map(|(_, bytes)| bytes.len() as u64);
    Ok(Tried {
        points,
        bytes: sizes.clone().sum::<u64>() as f64,
        disk: sizes.map(|size| size.next_multiple_of(BLOCK)).sum::<u64>() as f64,
        seconds: began.elapsed().as_secs_f64(),
    })
}

/// The free bytes and files of the disk of a folder, if known.
#[cfg(unix)]
fn free(folder: &Path) -> Option<(u64, u64)> {
    let disk = rustix::fs::statvfs(folder).ok()?;
    Some((disk.f_bavail.saturating_mul(disk.f_frsize), disk.f_favail))
}

#[cfg(not(unix))]
fn free(_: &Path) -> Option<(u64, u64)> {
    None
}

/// The most bytes of a trial of the disk.
const TRIED_BYTES: u64 = 32 << 20;
/// It writes nothing more after this time.
const WRITING: Duration = Duration::from_millis(300);
/// The number of its files.
const TRIED_FILES: u32 = 32;

/// The seconds that a disk takes, by a short trial: in the end an export waits for the disk.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Speed {
    per_byte: f64,
    per_file: f64,
}

impl Speed {
    /// Tries the disk of a folder. `None` if it cannot be written, which the export itself reports.
    fn of(folder: &Path) -> Option<Self> {
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
    fn time(self, files: f64, bytes: f64) -> f64 {
        files * self.per_file + bytes * self.per_byte
    }
}

/// Seconds per byte, until the bytes are on the disk.
fn written(file: &mut File) -> io::Result<f64> {
    // File systems that compress must not see zeros.
    let mut block = vec![0; 1 << 20];
    blake3::Hasher::new().finalize_xof().fill(&mut block);
    let (began, mut bytes) = (Instant::now(), 0);
    while bytes < TRIED_BYTES && began.elapsed() < WRITING {
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
    for _ in 0..TRIED_FILES {
        fs::write(&fresh, b"x").and_then(|()| fs::rename(&fresh, path))?;
    }
    Ok(began.elapsed().as_secs_f64() / f64::from(TRIED_FILES))
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
