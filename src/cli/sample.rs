//! `strew sample`: the answers of `GET /v1/points`, to a file or standard output, without a server.

use std::path::{Path, PathBuf};

use anyhow::anyhow;
use bytemuck::cast_slice;
use rayon::prelude::*;
use strew_config::Config;
use strew_core::{F32, F64, Plan, Tile};
use strew_encode::{Answer, Encoding, Output, Plain, Scalars, to_little_endian, write_number};
use strew_error::Error;
use strew_plan::Planned;

use super::{
    Failure,
    compression::Compression,
    config::{self, Uses},
    flags::Answered,
    output::{Output as Target, must_not_be_terminal},
    progress::Progress,
    query::{QueryArgs, described},
    refuse,
};

/// Flags of `strew sample`: a query, and where to write.
#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// The file to write; - is standard output. It is compressed if its name ends with .gz or .zst.
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Print nothing but errors on standard error.
    #[arg(long, short)]
    quiet: bool,
    /// Parquet: the level of zstd, 1 to 22; 0 does not compress [default: 1]
    #[arg(long, value_name = "LEVEL", help_heading = "Output", value_parser = clap::value_parser!(u8).range(..=22))]
    zstd: Option<u8>,
    #[command(flatten)]
    query: QueryArgs<Answered>,
}

/// The format of an output by the ending of its name; JSON without one.
pub(super) fn encoding_of(output: Option<&Path>) -> Result<Encoding, Failure> {
    // The format stands before the compression: points.csv.gz.
    let inner = output.map(|path| Compression::of(path).1);
    let Some(ending) = inner.and_then(Path::extension) else {
        return Ok(Encoding::Json);
    };
    let ending = ending.to_string_lossy();
    Encoding::of_ending(&ending).ok_or_else(|| {
        Failure::Usage(anyhow!(
            "--output ends with .{ending}, which is no format: use --format, or one of the endings \
             {}, arrows",
            Encoding::names()
        ))
    })
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let config = args.query.settings.merged(Uses::POINTS)?;
    let output = Target::open(args.output.as_deref())?;
    let ask = args.query.plan(&config)?;
    let (planned, mut options) = (&ask.planned, ask.options);
    options.crs = ask.crs.or(options.crs);
    let (count, limit) = (planned.count(), config.limits.max_points);
    if count > limit.into() {
        return Err(ask.source.refused(Error::TooManyPoints { count, limit }));
    }
    let encoding = match options.encoding {
        Some(encoding) => encoding,
        None => encoding_of(args.output.as_deref())?,
    };
    if !encoding.traits().is_text {
        must_not_be_terminal(args.output.as_deref(), encoding.name())?;
    }
    check_packing(args, encoding)?;
    let looks = options.output(encoding).map(|looks| Output {
        relative_to: planned.query.region.corner,
        zstd: args.zstd.unwrap_or(looks.zstd),
        ..looks
    });
    let looks = looks.map_err(|error| ask.source.refused(error))?;
    let refused = |error| ask.source.refused(error);
    write(
        planned,
        &looks,
        &config,
        output,
        (args.quiet, "points"),
        refused,
    )
}

/// Refuses to compress what is compressed already, or would not be.
fn check_packing(args: &Args, encoding: Encoding) -> Result<(), Failure> {
    let is_parquet = encoding == Encoding::Parquet;
    if let Some(level) = args.zstd.filter(|_| !is_parquet) {
        refuse!(
            "--zstd {level}: has no effect in the format {}; allowed: the format parquet; other files are compressed \
             if their names end with .gz or .zst",
            encoding.name()
        );
    }
    let output = args.output.as_deref().filter(|_| is_parquet);
    match output.filter(|path| Compression::of(path).0 != Compression::Plain) {
        None => Ok(()),
        Some(path) => refuse!(
            "--output {}: Parquet is compressed inside, and no reader opens a file of it that is compressed as a \
             whole; allowed: a name that ends in .parquet, with --zstd LEVEL",
            path.display()
        ),
    }
}

/// Writes an answer of things that are called `what`. The caller knows the names of its flags, by which `refused`
/// explains errors of the service.
pub(super) fn write(
    planned: &Planned,
    looks: &Output,
    config: &Config,
    mut output: Target,
    (quiet, what): (bool, &'static str),
    refused: impl Fn(Error) -> Failure,
) -> Result<(), Failure> {
    let answer = planned.answer(looks, config.limits.block_bytes);
    let answer = answer.map_err(refused)?;
    let count = planned.count();
    let Ok(count) = u64::try_from(count) else {
        refuse!("the region holds {count} points, too many to write");
    };
    if !quiet {
        announce(planned, looks, &answer);
    }
    let pool = config::pool(config.workers.threads)?;
    let mut progress = Progress::new(what, count, quiet);
    let written = pool.install(|| match answer.plain().cloned() {
        Some(plain) => packed(&plain, &mut output, &mut progress),
        None => blocks(answer, &mut output, &mut progress),
    });
    progress.finish();
    written?;
    Ok(output.finish()?)
}

/// Announces the answer on standard error, with the facts for which packed formats have no room.
fn announce(planned: &Planned, looks: &Output, answer: &Answer) {
    let (encoding, crs) = (looks.encoding, &looks.crs);
    let size = answer
        .size()
        .map_or(String::new(), |size| format!(", {size} bytes"));
    eprintln!(
        "{} points as {}{size}: {}",
        planned.count(),
        encoding.name(),
        described(planned)
    );
    if let Some(next) = planned.next() {
        eprintln!("the rest begins at the cursor {next}");
    }
    if let Some(origin) = answer.origin() {
        let texts = origin.as_slice().iter().map(|&v| {
            let mut text = vec![];
            write_number(v, &mut text);
            String::from_utf8_lossy(&text).into_owned()
        });
        let place = texts.collect::<Vec<_>>().join(",");
        eprintln!("coordinates are relative to the origin {place}");
    }
    if let Some(columns) = answer.legend() {
        eprintln!("columns: {columns}");
    }
    if let (0, Some(crs)) = (planned.count(), crs) {
        eprintln!(
            "warning: there are no points; is the region in {crs}, the plane of its file or raster?"
        );
    }
    if let Some(warning) = answer.warning() {
        eprintln!("warning: {warning}");
    }
}

fn blocks(mut answer: Answer, output: &mut Target, progress: &mut Progress) -> anyhow::Result<()> {
    while let Some(block) = answer.next() {
        output.write(&block?)?;
        progress.reach(answer.points(), "");
    }
    Ok(())
}

/// Points of a tile: large enough that a tall band's templates are made once for many rows.
const TILE_POINTS: usize = 1 << 19;

/// Writes plain packed points on all threads.
fn packed(plain: &Plain, output: &mut Target, progress: &mut Progress) -> anyhow::Result<()> {
    if let Some(head) = &plain.head {
        output.write(head)?;
    }
    if plain.is_f32 {
        tiles::<F32>(&plain.plan, output, progress)
    } else {
        tiles::<F64>(&plain.plan, output, progress)
    }
}

/// Fills tiles on all threads, a batch ahead of what is being written.
fn tiles<F: Scalars>(
    plan: &Plan,
    output: &mut Target,
    progress: &mut Progress,
) -> anyhow::Result<()>
where
    F::Item: Sync,
{
    let mut tiles = plan.tiles(TILE_POINTS);
    let batch = 2 * rayon::current_num_threads();
    let (mut ready, mut next) = (Filled::<F>::new(batch), Filled::<F>::new(batch));
    let mut points = 0;
    loop {
        let (written, ()) = rayon::join(
            || {
                for block in ready.blocks() {
                    output.write(cast_slice(block))?;
                    points += block.len() as u64;
                    progress.reach(points, "");
                }
                anyhow::Ok(())
            },
            || next.fill(plan, &mut tiles),
        );
        written?;
        if next.tiles.is_empty() {
            return Ok(());
        }
        std::mem::swap(&mut ready, &mut next);
    }
}

struct Filled<F: Scalars> {
    tiles: Vec<Tile>,
    buffers: Vec<(Vec<F::Item>, usize)>,
}

impl<F: Scalars> Filled<F>
where
    F::Item: Sync,
{
    fn new(batch: usize) -> Self {
        let buffers = (0..batch).map(|_| (vec![], 0)).collect();
        Self {
            tiles: vec![],
            buffers,
        }
    }

    fn fill(&mut self, plan: &Plan, tiles: &mut (impl Iterator<Item = Tile> + Send)) {
        self.tiles.clear();
        self.tiles.extend(tiles.take(self.buffers.len()));
        self.tiles
            .par_iter()
            .zip(&mut self.buffers)
            .for_each(|(tile, (buffer, filled))| {
                if buffer.is_empty() {
                    *buffer = vec![F::Item::default(); TILE_POINTS];
                }
                *filled = plan.tile_blocks::<F>(tile).fill(buffer);
                to_little_endian(&mut buffer[..*filled], 2);
            });
    }

    fn blocks(&self) -> impl Iterator<Item = &[F::Item]> {
        self.buffers
            .iter()
            .take(self.tiles.len())
            .map(|(buffer, filled)| &buffer[..*filled])
    }
}
