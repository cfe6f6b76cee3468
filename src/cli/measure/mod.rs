//! `strew measure`: the figures and curves of a table, of a region, or of a file of points.

mod space;

use std::path::{Path, PathBuf};

use anyhow::{Context as _, anyhow, bail};
use rayon::prelude::*;
use serde_json::{Value, json};
use strew_core::{F64, Plan, PointSet, Table, Twin};
use strew_error::Error;
use strew_forge::{
    Aim, Report, Resolution, Target, figure,
    measure::{Sample, Shared, recurrence, twin_set, window_set},
};
use strew_plan::library::measured::{LEAST_POINTS, MOST_POINTS, Measured, document, measure};
use strew_query::{Draft, parameters::BBOX};

use self::space::Subjects;
use super::{
    Failure, config,
    failure::refused,
    flags::{self, Flags},
    must_be_within,
    output::Output,
    progress::{Progress, Steps},
    query::described,
    refuse,
};

/// Flags of `strew measure`. It measures a table file (`--table`), a file of points (`--points`), or,
/// without either, the points of a query as for `strew sample`.
#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// A table file: measured on periodic twins and on windows of the unbounded pattern.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["points", "bbox"])]
    table: Option<PathBuf>,
    #[command(flatten)]
    subjects: Subjects,
    /// A file of points: csv with the columns x and y, or f64 (little-endian pairs) by its ending;
    /// needs --bbox, the square that the points fill.
    #[arg(long, value_name = "FILE", requires = "bbox")]
    points: Option<PathBuf>,
    /// With --points: the set repeats outside the square.
    #[arg(long, requires = "points")]
    periodic: bool,
    /// With a query: also compare the sets of this number of seeds, beginning with the query's own: the share of a
    /// patch of 12 × 12 spacings that each set repeats (boxes of 300 × 300 spacings compare with those of the
    /// documentation), and the similarity of each two sets.
    #[arg(long, value_name = "N", default_value_t = 0, conflicts_with_all = ["table", "points"],
        value_parser = clap::value_parser!(u64).range(..=16))]
    seeds: u64,
    /// The highest frequency to measure, in units of the square root of the density [default: 4].
    #[arg(long, value_name = "NU")]
    nu_max: Option<f64>,
    /// The width of the rings of radial power, in the same units; 0 is one mode [default: 1/64].
    #[arg(long, value_name = "WIDTH")]
    ring_width: Option<f64>,
    /// An SVG picture to write: points, spectrum, radial power, anisotropy, RDF. With several
    /// subjects that of the first.
    #[arg(long, value_name = "FILE")]
    picture: Option<PathBuf>,
    /// The file to write the figures to, as JSON; - is standard output.
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
    #[command(flatten)]
    flags: Flags<flags::Measured>,
    #[command(flatten)]
    settings: config::Args,
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    must_be_within("--nu-max", args.resolution().nu_max, [0.5, 8.0])?;
    must_be_within("--ring-width", args.resolution().ring_width, [0.0, 0.5])?;
    let nothing = args.table.is_none() && args.points.is_none();
    if nothing && !args.flags.has(&BBOX) {
        let problem = "nothing to measure: --table FILE, --points FILE or --bbox BOX is missing";
        refuse!(problem);
    }
    if let Some(file) = &args.table
        && let Some(table) = in_space(file)?
    {
        let picture = args.picture.as_ref().map(|_| "--picture");
        let nu_max = args.nu_max.map(|_| "--nu-max");
        let ring_width = args.ring_width.map(|_| "--ring-width");
        if let Some(flag) = picture.or(nu_max).or(ring_width) {
            let file = file.display();
            refuse!("{flag} is of points of the plane, and {file} has points in space");
        }
        let output = Output::open(args.output.as_deref())?;
        let text = space::document(&args.subjects, &table)?;
        return output.end_with(format!("{text:#}\n").as_bytes());
    }
    if args.subjects.window_at.is_some() {
        refuse!("--window-at: only windows of tables of points in space have a place");
    }
    let output = Output::open(args.output.as_deref())?;
    let drawing = args.picture.as_deref();
    let drawing = drawing.map(|path| Output::open(Some(path))).transpose()?;
    let Measurement {
        mut reports,
        target,
        seeds,
    } = match (&args.table, &args.points) {
        (Some(file), _) => of_table(args, file)?,
        (None, Some(file)) => of_points(args, file)?,
        (None, None) => of_query(args)?,
    };
    if let Some(target) = &target {
        reports = { reports.into_iter() }
            .map(|report| report.compared(target))
            .collect();
    }
    if let (Some(drawing), Some(report)) = (drawing, reports.first()) {
        let subject = &report.figures.subject;
        let stem = args.table.as_deref().and_then(Path::file_stem);
        let title = stem.map_or_else(
            || subject.clone(),
            |stem| format!("{}: {subject}", stem.display()),
        );
        let svg = figure::report(report, &title, target.as_ref()).to_svg();
        drawing.end_with(svg.as_bytes())?;
    }
    let mut text = json!({ "subjects": reports.iter().map(document).collect::<Vec<_>>() });
    if let Some(seeds) = seeds {
        text["seeds"] = seeds;
    }
    output.end_with(format!("{text:#}\n").as_bytes())
}

/// The table of a file, if its points are in space.
fn in_space(file: &Path) -> Result<Option<strew_core::space::Table>, Failure> {
    Ok(strew_forge::space::read_table(file).map_err(anyhow::Error::from)?)
}

struct Measurement {
    reports: Vec<Report>,
    /// The power curve that the subjects should follow.
    target: Option<Target>,
    /// How the sets of several seeds compare.
    seeds: Option<Value>,
}

fn of_table(args: &Args, file: &Path) -> Result<Measurement, Failure> {
    let table = strew_forge::read_table(file).map_err(anyhow::Error::from)?;
    let twins = args.twins(&table).map_err(Failure::Usage)?;
    let mut subjects = vec![];
    for twin in twins {
        let other = || anyhow!("--twin {twin} has another map than the table's alpha");
        let set = twin_set(&table, twin).ok_or_else(|| Failure::Usage(other()))?;
        let seen = table.provenance().twins.contains(&twin);
        subjects.push((format!("twin {twin}"), seen, set));
    }
    let seeds = match args.subjects.window_seed.as_slice() {
        [] => &[1, 2],
        seeds => seeds,
    };
    for &seed in seeds {
        let set = window_set(&table, args.subjects.window_points.unwrap_or(80_000), seed);
        subjects.push((format!("window seed {seed}"), false, set));
    }
    let progress = Progress::new("point sets measured", subjects.len() as u64, false);
    let steps = Steps::new(progress, 0);
    let reports = subjects.into_par_iter().map(|(name, seen, set)| {
        let report = Report::of(name, seen, &set, args.resolution());
        steps.step();
        report
    });
    let reports = reports.collect();
    steps.finish();
    let aim = Aim::of(table.profile(), table.provenance());
    Ok(Measurement {
        reports,
        target: aim.and_then(|aim| aim.curve),
        seeds: None,
    })
}

impl Args {
    fn resolution(&self) -> Resolution {
        let usual = Resolution::default();
        Resolution {
            nu_max: self.nu_max.unwrap_or(usual.nu_max),
            ring_width: self.ring_width.unwrap_or(usual.ring_width),
        }
    }

    /// Measures the points of a square.
    fn measured(
        &self,
        subject: String,
        bbox: [f64; 4],
        density: Option<f64>,
        points: Vec<[f64; 2]>,
    ) -> Result<Report, Failure> {
        let of = Measured {
            bbox,
            density,
            is_periodic: self.periodic,
            resolution: self.resolution(),
        };
        let mut report = measure(points, &of, &Default::default()).map_err(refused)?;
        report.figures.subject = subject;
        Ok(report)
    }

    fn twins(&self, table: &Table) -> anyhow::Result<Vec<Twin>> {
        if self.subjects.twin.is_empty() {
            let seen = &table.provenance().twins;
            let large =
                |twin: &Twin| twin.points() >= 70_225 && twin.is_uniform() && !seen.contains(twin);
            return Ok(table.map().twins().filter(large).take(2).collect());
        }
        let read = |&twin: &Twin| match u128::from(twin.points()) {
            0..=MOST_POINTS => Ok(twin),
            points => {
                bail!("--twin {twin} has {points} points; at most {MOST_POINTS} are measured")
            }
        };
        self.subjects.twin.iter().map(read).collect()
    }
}

fn compared(plan: &Plan, side: f64, density: f64, seeds: u64) -> anyhow::Result<Value> {
    const PATCHES: usize = 64;
    let sets = (0..seeds).map(|i| {
        let mut placement = plan.placement();
        placement.seed.0 = placement.seed.0.wrapping_add(i);
        let set = PointSet::new(plan.table().clone());
        let plan = set.placed(placement).within(plan.region())?;
        let mut points = vec![[0.0; 2]; plan.count() as usize];
        plan.blocks::<F64>().fill(&mut points);
        let [x, y] = plan.origin();
        let points = points.into_iter().map(|p| [p[0] - x, p[1] - y]).collect();
        Ok((placement.seed.0, Sample::window(side, density, points)))
    });
    let sets: Vec<(u64, Sample)> = sets.collect::<anyhow::Result<_>>()?;
    let recurrences: Vec<Value> = sets
        .iter()
        .map(|(seed, set)| json!([seed, recurrence(set, None, PATCHES, *seed)]))
        .collect();
    let chance = match sets.as_slice() {
        [(seed, a), (_, b), ..] => Some(recurrence(a, Some(b), PATCHES, *seed)),
        _ => None,
    };
    let mut pairs = vec![];
    for (i, (a, first)) in sets.iter().enumerate() {
        for (b, second) in &sets[i + 1..] {
            let shared = Shared::of(first, second, 2.0);
            pairs.push(json!([a, b, shared.power_correlation, shared.phase_peak]));
        }
    }
    Ok(json!({
        "recurrence": { "columns": ["seed", "share"], "sets": recurrences, "by_chance": chance },
        "shared": { "columns": ["a", "b", "power_correlation", "phase_peak"], "pairs": pairs },
    }))
}

fn of_query(args: &Args) -> Result<Measurement, Failure> {
    let config = args.settings.merged(config::Uses::QUERIES)?;
    let catalog = config::tables(&config)?;
    let planned = config::planned(&config, &Draft::of(args.flags.values()), &catalog.into());
    let (planned, _) = planned.map_err(refused)?;
    let count = planned.count();
    if !(LEAST_POINTS..=MOST_POINTS).contains(&count) {
        refuse!("--bbox holds {count} points; from {LEAST_POINTS} to {MOST_POINTS} are measured");
    }
    let mut points = vec![[0.0; 2]; count as usize];
    let set = &planned.sets[0];
    let Some(plan) = set.plan.plane() else {
        refuse!("only points of the plane are measured here");
    };
    plan.blocks_f64().fill(&mut points);
    let bbox = planned.query.region.bbox();
    let density = set.density * planned.query.sets[0].share();
    let report = args.measured(described(&planned), bbox, Some(density), points)?;
    Ok(Measurement {
        reports: vec![report],
        target: set.entry.aim().and_then(|aim| aim.curve),
        seeds: match args.seeds {
            0 => None,
            seeds => Some(compared(plan, bbox[2] - bbox[0], density, seeds)?),
        },
    })
}

fn of_points(args: &Args, file: &Path) -> Result<Measurement, Failure> {
    let bbox = args.flags.values().require(&BBOX);
    let bbox = bbox.map_err(|faults| Failure::usage(Error::from(faults)))?;
    let bytes = std::fs::read(file).with_context(|| format!("cannot read {}", file.display()))?;
    let is_packed = file.extension().is_some_and(|ending| ending == "f64");
    let points = if is_packed {
        packed(&bytes)
    } else {
        csv(&bytes)
    };
    let points = points.with_context(|| format!("{} is not a file of points", file.display()))?;
    Ok(Measurement {
        reports: vec![args.measured(file.display().to_string(), bbox, None, points)?],
        target: None,
        seeds: None,
    })
}

fn packed(bytes: &[u8]) -> anyhow::Result<Vec<[f64; 2]>> {
    if !bytes.len().is_multiple_of(16) {
        bail!("{} bytes are no whole number of f64 pairs", bytes.len());
    }
    let number = |bytes: &[u8]| bytes.try_into().map(f64::from_le_bytes).unwrap_or(f64::NAN);
    Ok(bytes
        .chunks_exact(16)
        .map(|pair| [number(&pair[..8]), number(&pair[8..])])
        .collect())
}

fn csv(bytes: &[u8]) -> anyhow::Result<Vec<[f64; 2]>> {
    let text = std::str::from_utf8(bytes).context("it is not UTF-8")?;
    let mut lines = text.lines().enumerate();
    let (_, header) = lines.next().ok_or_else(|| anyhow!("it is empty"))?;
    let column = |name: &str| {
        let found = header.split(',').position(|column| column.trim() == name);
        found.ok_or_else(|| anyhow!("its header `{header}` has no column `{name}`"))
    };
    let columns = [column("x")?, column("y")?];
    let read = |(i, line): (usize, &str)| {
        let fields: Vec<&str> = line.split(',').collect();
        let mut point = [0.0; 2];
        for (value, column) in point.iter_mut().zip(columns) {
            let field = fields.get(column).map_or("", |field| field.trim());
            *value = field
                .parse()
                .map_err(|_| anyhow!("line {}: `{field}` is not a number", i + 1))?;
        }
        Ok(point)
    };
    lines
        .filter(|(_, line)| !line.trim().is_empty())
        .map(read)
        .collect()
}
