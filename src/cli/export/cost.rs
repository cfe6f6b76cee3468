//! The cost of an export, reported before it begins: chunks, points and bytes, from a few chunks; and whether the disk has
//! room.

use std::path::Path;

use anyhow::anyhow;
use indicatif::HumanBytes;
use rayon::prelude::*;

use super::{chunks::Maker, spec::Spec};
use crate::cli::Failure;

/// The most chunks that are tried, evenly spread over all of them, and of few chunks one in this number.
const TRIED: usize = 16;
const SHARE: usize = 8;
/// Files occupy multiples of this on a disk.
const BLOCK: u64 = 4096;

#[derive(Clone, Debug)]
pub(super) struct Cost {
    chunks: usize,
    /// The number of existing chunks.
    done: usize,
    points: f64,
    is_counted: bool,
    bytes: f64,
    /// The bytes and the files that are still to be written, on the disk.
    disk: f64,
    files: f64,
}

impl Cost {
    /// Tries some chunks, and counts points where that is quick. `done` chunks exist.
    pub(super) fn of(maker: &Maker, spec: &Spec, done: usize) -> Result<Self, Failure> {
        let compressions = spec.compressions();
        let chunks = maker.grid.chunks();
        let number = chunks.div_ceil(SHARE).min(TRIED);
        // The points, the bytes and those on the disk of the middle chunk of each of `number` parts.
        let tried = (0..number).into_par_iter().map(|k| {
            let chunk = maker.make((2 * k + 1) * chunks / (2 * number))?;
            let (mut bytes, mut disk) = (0, 0);
            for compression in &compressions {
                let size = chunk.packed(*compression)?.len() as u64;
                bytes += size;
                disk += size.next_multiple_of(BLOCK);
            }
            Ok([chunk.points, bytes, disk])
        });
        let tried: Vec<[u64; 3]> = tried.collect::<Result<_, Failure>>()?;
        let mean = |of: usize| {
            tried.iter().map(|all| all[of] as f64).sum::<f64>() / tried.len().max(1) as f64
        };
        let counted = maker.count().map(|count| count as f64);
        let (all, left) = (chunks as f64, (chunks - done) as f64);
        let points = counted.unwrap_or_else(|| all * mean(0));
        // Chunks of more points than those of the trial are larger, too.
        let scale = match mean(0) {
            few if few > 0.0 => points / (all * few),
            _ => 1.0,
        };
        Ok(Self {
            chunks,
            done,
            points,
            is_counted: counted.is_some(),
            bytes: all * mean(1) * scale,
            disk: left * mean(2) * scale,
            files: left * compressions.len() as f64,
        })
    }

    pub(super) fn line(&self) -> String {
        let about = if self.is_counted { "" } else { "about " };
        format!(
            "{} chunks, {about}{:.0} points, about {}, {} on the disk",
            self.chunks,
            self.points,
            HumanBytes(self.bytes as u64),
            HumanBytes(self.disk as u64),
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
            done => format!("; {}", go_on(done as u64, self.chunks)),
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

pub(super) fn go_on(done: u64, chunks: usize) -> String {
    format!("{done} of {chunks} chunks exist: make room, and the same command resumes there")
}

#[cfg(unix)]
fn free(folder: &Path) -> Option<(u64, u64)> {
    let disk = rustix::fs::statvfs(folder).ok()?;
    Some((disk.f_bavail.saturating_mul(disk.f_frsize), disk.f_favail))
}

#[cfg(not(unix))]
fn free(_: &Path) -> Option<(u64, u64)> {
    None
}
