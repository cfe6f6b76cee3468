//! `strew sample`: the answers of `GET /v1/points`, to a file or standard output, without a server.

use std::path::PathBuf;

use anyhow::anyhow;
use bytemuck::cast_slice;
use rayon::prelude::*;
use strew_core::{
    Plan,
    sample::{F32, F64, Tile},
};

use super::{
    Failure,
    output::Output,
    progress::Progress,
    query::{Query, described},
};
use crate::{
    config::Config,
    service::{
        Answer, Encoding, Planned,
        encode::{Scalars, write_number},
    },
};

/// Flags of `strew sample`: the parameters of `GET /v1/points`, and where to write.
#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// json, ndjson, csv, f32 or f64 [default: what the output's name ends with, or json].
    #[arg(long)]
    format: Option<String>,
    /// The file to write; - is standard output.
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Say nothing on standard error but errors.
    #[arg(long, short)]
    quiet: bool,
    #[command(flatten)]
    query: Query,
}

impl Args {
    /// The format that the output's name asks for.
    fn by_extension(&self) -> Option<Encoding> {
        Encoding::from_name(self.output.as_ref()?.extension()?.to_str()?)
    }
}

/// Writes the points.
pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let config = args.query.settings()?;
    let (planned, named) = args.query.planned(&config, args.format.as_deref())?;
    let encoding = named
        .or_else(|| args.by_extension())
        .unwrap_or(Encoding::Json);
    let count = u64::try_from(planned.count()).map_err(|_| {
        Failure::Usage(anyhow!(
            "bbox holds {} points, too many to write",
            planned.count()
        ))
    })?;
    if !args.quiet {
        announce(&planned, encoding);
    }
    let pool = workers(&config)?;
    let mut output = Output::open(args.output.as_deref())?;
    let mut progress = Progress::new("points", count, args.quiet);
    let plan = &planned.plan;
    let written = pool.install(|| match encoding {
        Encoding::F32 => packed::<F32>(plan, &mut output, &mut progress),
        Encoding::F64 => packed::<F64>(plan, &mut output, &mut progress),
        Encoding::Json | Encoding::Ndjson | Encoding::Csv => {
            let answer = Answer::new(&planned, encoding, config.limits.block_bytes);
            text(answer, &mut output, &mut progress)
        }
    });
    progress.finish();
    written?;
    Ok(output.finish()?)
}

/// Says on standard error what comes, and what the packed formats have no room for.
fn announce(planned: &Planned, encoding: Encoding) {
    let size =
        Answer::size(planned, encoding).map_or(String::new(), |size| format!(", {size} bytes"));
    eprintln!(
        "{} points{size}: {}, table {}",
        planned.count(),
        described(planned),
        planned.entry.digest
    );
    if encoding == Encoding::F32 {
        let [x, y] = planned.plan.origin().map(|v| {
            let mut text = vec![];
            write_number(v, &mut text);
            String::from_utf8_lossy(&text).into_owned()
        });
        eprintln!("coordinates are relative to the origin {x},{y}");
    }
}

fn workers(config: &Config) -> anyhow::Result<rayon::ThreadPool> {
    Ok(rayon::ThreadPoolBuilder::new()
        .num_threads(config.workers.threads)
        .build()?)
}

fn text(mut answer: Answer, output: &mut Output, progress: &mut Progress) -> anyhow::Result<()> {
    while let Some(block) = answer.next() {
        output.write(&block)?;
        progress.reach(answer.points(), "");
    }
    Ok(())
}

/// Points of a tile: large enough that a tall band's templates are made once for many rows.
const TILE_POINTS: usize = 1 << 19;

/// Fills tiles on all threads, a batch ahead of what is being written.
fn packed<F: Scalars>(
    plan: &Plan,
    output: &mut Output,
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

/// Tiles with their points, in buffers that are used again.
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

    /// Takes the next tiles and fills them.
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
                if cfg!(target_endian = "big") {
                    for item in &mut buffer[..*filled] {
                        *item = F::to_little_endian(*item);
                    }
                }
            });
    }

    fn blocks(&self) -> impl Iterator<Item = &[F::Item]> {
        self.buffers
            .iter()
            .take(self.tiles.len())
            .map(|(buffer, filled)| &buffer[..*filled])
    }
}
