//! The cost of an export, reported before it begins: chunks, points, bytes and time, from a short trial; and whether
//! the disk has room.

use std::{
    path::Path,
    time::{Duration, Instant},
};

use anyhow::anyhow;
use indicatif::{HumanBytes, HumanDuration};
use rayon::prelude::*;

use super::{
    chunks::{Maker, variants},
    disk::Speed,
    spec::{DEFLATE, Spec},
};
use crate::cli::{Failure, compression::Compression};

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
    /// Tries some chunks, and counts points where that is quick. `done` chunks exist; in an archive
    /// files lie side by side.
    pub(super) fn of(maker: &Maker, spec: &Spec, done: usize) -> Result<Self, Failure> {
        let is_archive = spec.archive.is_some();
        let compressions = match spec.archive.as_deref() {
            Some(DEFLATE) => vec![Compression::Gzip],
            _ => spec.compressions(),
        };
        let chunks = maker.grid.chunks();
        let began = Instant::now();
        let number = chunks.div_ceil(SHARE).min(TRIED);
        let tried = (0..number).into_par_iter().map(|k| {
            if k > 0 && began.elapsed() > TRIAL {
                return Ok(None);
            }
            // The middle chunk of each of `number` parts.
            let i = (2 * k + 1) * chunks / (2 * number);
            try_out(maker, &compressions, i, is_archive).map(Some)
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
    pub(super) fn check(&self, folder: &Path, is_archive: bool) -> Result<(), Failure> {
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
        if !is_archive && files > 0 && self.files > files as f64 {
            return Err(Failure::Other(anyhow!(
                "the export takes {:.0} files{more}, and the disk of {place} has room for {files}{}",
                self.files,
                advise("choose larger chunks, or --archive")
            )));
        }
        Ok(())
    }
}

/// The advice for an export that lacks room.
pub(super) fn go_on(done: usize, chunks: usize) -> String {
    format!("{done} of {chunks} chunks exist: make room, and the same command resumes there")
}

fn try_out(
    maker: &Maker,
    compressions: &[Compression],
    i: usize,
    is_archive: bool,
) -> Result<Tried, Failure> {
    let began = Instant::now();
    let chunk = maker.make(i)?;
    let points = chunk.points as f64;
    let files = variants(chunk.bytes, compressions)?;
    let sizes: Vec<u64> = files.iter().map(|(_, bytes)| bytes.len() as u64).collect();
    let (bytes, disk) = match is_archive {
        // One file is stored; the rest is heads and indices.
        true => {
            let stored = sizes.last().copied().unwrap_or(0);
            (stored, stored + 512)
        }
        false => {
            let on_disk = sizes.iter().map(|size| size.next_multiple_of(BLOCK));
            (sizes.iter().sum(), on_disk.sum())
        }
    };
    Ok(Tried {
        points,
        bytes: bytes as f64,
        disk: disk as f64,
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
