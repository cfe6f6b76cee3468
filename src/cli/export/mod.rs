//! `strew export`: writes a world as files of chunks, under the daemon's paths, in a folder.

mod check;
mod chunks;
mod cost;
mod folder;
mod grid;
mod record;
mod servers;
mod spec;

use std::{
    io,
    path::{Path, PathBuf},
    sync::atomic::Ordering,
};

use anyhow::anyhow;
use rayon::prelude::*;
use strew_config::Config;
use strew_query::Assets;

use self::{
    chunks::Maker,
    cost::Cost,
    folder::Folder,
    record::{Record, documents},
    spec::{Shape, Spec},
};
use super::{
    Failure,
    compression::Compression,
    config,
    flags::{Exported, Flags, WHERE},
    progress::{Progress, Steps},
    refuse,
    signals::stop_flag,
};

/// Flags of `strew export`: a query, its chunks, and the output.
#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// The folder to write: a new one, or that of an interrupted export.
    #[arg(long, short, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Check an export instead: its digests, its names, and points of chunks made again.
    #[arg(long, value_name = "DIR", conflicts_with_all = ["output", "chunk", "levels", "compress"])]
    check: Option<PathBuf>,
    /// With --check: make all chunks again instead of 100.
    #[arg(long, requires = "check")]
    all: bool,
    /// The side of a chunk.
    #[arg(long, value_name = "SIDE", help_heading = WHERE)]
    chunk: Option<f64>,
    /// Levels of detail: chunks of level k are 2ᵏ times as wide and have the share 4⁻ᵏ of the points.
    #[arg(long, value_name = "NUMBER", default_value_t = 1, help_heading = WHERE,
          value_parser = clap::value_parser!(u32).range(1..=i64::from(grid::MOST_LEVELS)))]
    levels: u32,
    /// Compressed files beside the plain ones: gz, zst, both or none [default: gz for text formats, else none]
    #[arg(long, value_name = "NAME,…", value_delimiter = ',')]
    compress: Option<Vec<Compression>>,
    /// The number of threads [default: one for each core]
    #[arg(long, value_name = "NUMBER", value_parser = clap::value_parser!(u32).range(1..=1024))]
    threads: Option<u32>,
    /// Print the cost and write nothing.
    #[arg(long)]
    dry_run: bool,
    /// Print nothing but errors on standard error.
    #[arg(long, short)]
    quiet: bool,
    #[command(flatten)]
    flags: Flags<Exported>,
    #[command(flatten)]
    settings: config::Args,
}

struct Job<'a> {
    spec: Spec,
    maker: Maker,
    catalog: Assets,
    args: &'a Args,
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let config = args.settings.merged(config::Uses::POINTS)?;
    let threads = args
        .threads
        .map_or(config.workers.threads, |threads| threads as usize);
    config::pool(threads)?.install(|| match &args.check {
        Some(path) => check::run(path, args.all, args.quiet, &config),
        None => export(args, &config),
    })
}

fn export(args: &Args, config: &Config) -> Result<(), Failure> {
    let Some(size) = args.chunk else {
        refuse!("the side of a chunk is missing: use --chunk, such as --chunk 64");
    };
    if !(size.is_finite() && size > 0.0) {
        refuse!("--chunk {size}: out of range; allowed: a finite number above 0");
    }
    match &args.output {
        None if !args.dry_run => {
            refuse!("a place to write is missing: use --output DIR, or --dry-run")
        }
        Some(root) if { root.extension() }.is_some_and(|end| end.eq_ignore_ascii_case("zip")) => {
            let (zip, folder) = (root.display(), root.with_extension(""));
            let folder = folder.display();
            refuse!(
                "--output {zip}: an export is a folder, not a zip file; allowed: --output {folder}, and after it \
                 `zip -r {zip} {folder}`"
            );
        }
        _ => {}
    }
    let catalog = config::assets(config)?;
    let shape = Shape {
        size,
        levels: args.levels,
        compressed: args.compress.as_deref().map(compressions).transpose()?,
    };
    let spec = Spec::new(&args.flags, &shape, &catalog, config)?;
    let job = Job {
        maker: Maker::new(&spec, &catalog, config)?,
        spec,
        catalog,
        args,
    };
    match &args.output {
        Some(root) if !args.dry_run => job.to_folder(root),
        _ => job.cost(0, None),
    }
}

impl Job<'_> {
    /// Reports the cost. Fails if the disk has no room for it.
    fn cost(&self, done: usize, place: Option<&Path>) -> Result<(), Failure> {
        let cost = Cost::of(&self.maker, &self.spec, done)?;
        if !self.args.quiet {
            eprintln!("{}", cost.line());
            if done > 0 {
                eprintln!("{done} chunks exist already");
            }
        }
        place.map_or(Ok(()), |place| cost.check(place))
    }

    fn to_folder(&self, root: &Path) -> Result<(), Failure> {
        // The existing chunks are not counted yet.
        let advice = "make room, and the same command resumes there";
        let to_open = |failure| with_advice(failure, advice);
        let opened = Folder::open(root, &self.spec, &self.maker).map_err(to_open)?;
        let Some((folder, mut done)) = opened else {
            if !self.args.quiet {
                eprintln!("{} is complete: nothing to do", root.display());
            }
            return Ok(());
        };
        if let Err(failure) = self.cost(done.len(), Some(root)) {
            if done.is_empty() {
                folder.abandon();
            }
            return Err(failure);
        }
        let stop = stop_flag();
        let chunks = self.maker.grid.chunks();
        let progress = Progress::new("chunks", chunks as u64, self.args.quiet);
        let steps = Steps::new(progress, done.len() as u64);
        let made = (0..chunks)
            .into_par_iter()
            .filter(|i| !done.contains_key(i))
            .map(|i| {
                if stop.load(Ordering::Relaxed) {
                    return Err(stopped(steps.done(), chunks));
                }
                let record = folder.put(i, &self.maker.grid.name(i), self.maker.make(i)?)?;
                steps.step();
                Ok((i, record))
            });
        let made: Result<Vec<(usize, Record)>, Failure> = made.collect();
        let advice = cost::go_on(steps.done(), chunks);
        steps.finish();
        done.extend(made.map_err(|failure| with_advice(failure, &advice))?);
        let mut records: Vec<(usize, Record)> = done.into_iter().collect();
        records.sort_unstable_by_key(|(i, _)| *i);
        let records: Vec<Record> = records.into_iter().map(|(_, record)| record).collect();
        let documents = documents(&self.spec, &self.maker, &self.catalog, &records)?;
        let finished = folder.finish(&documents);
        finished.map_err(|failure| with_advice(failure.into(), &advice))?;
        self.report(root, &records);
        Ok(())
    }

    fn report(&self, place: &Path, records: &[Record]) {
        if self.args.quiet {
            return;
        }
        let points: u64 = records.iter().map(|record| record.points).sum();
        let bytes: u64 = records
            .iter()
            .flat_map(|record| &record.files)
            .map(|(_, length)| length)
            .sum();
        eprintln!(
            "{}: {} chunks, {points} points, {bytes} bytes",
            place.display(),
            records.len()
        );
    }
}

fn stopped(done: u64, chunks: usize) -> Failure {
    Failure::Interrupted(anyhow!(
        "interrupted after {done} of {chunks} chunks; the same command resumes there"
    ))
}

/// Adds advice if the disk is full, or a quota or a limit of files is reached.
fn with_advice(failure: Failure, advice: &str) -> Failure {
    use io::ErrorKind::{FileTooLarge, QuotaExceeded, StorageFull};
    let Failure::Other(error) = failure else {
        return failure;
    };
    let mut causes = error.chain().filter_map(|cause| cause.downcast_ref());
    let is_room =
        |cause: &io::Error| matches!(cause.kind(), StorageFull | QuotaExceeded | FileTooLarge);
    if !causes.any(is_room) {
        return Failure::Other(error);
    }
    Failure::Other(anyhow!("{error:#}; {advice}"))
}

/// The compressions of some names, each once. `none` stands alone.
fn compressions(names: &[Compression]) -> Result<Vec<Compression>, Failure> {
    let mut all = names.to_vec();
    all.sort();
    all.dedup();
    if names.len() > 1 && all[0] == Compression::Plain {
        refuse!("--compress none stands alone; allowed: none, gz, zst, gz,zst");
    }
    all.retain(|one| *one != Compression::Plain);
    Ok(all)
}
