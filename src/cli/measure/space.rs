//! What is measured of a table: twins, and windows at seeds and places; and `strew measure` of a table of points in space:
//! twins, served windows plain and seeded, thinned sets, pairs of seeds.

use anyhow::anyhow;
use serde_json::{Map, Value, json};
use strew_core::{
    Twin,
    space::{SpaceSet, Table},
};
use strew_forge::measure::{Sample, Shared};
use strew_forge::space::{
    PLACES, SIDE, SpacePower, SpaceReport, is_uniform_in_space, twin_set, unseen_twins, window_set,
};

use crate::cli::{Failure, refuse};

/// The least and the greatest number of points of a set. The spectrum of the largest takes 800 MB.
const POINTS: [u64; 2] = [1_000, 1_000_000];
/// The least number of points of the twins that are measured unless some are named, and their number.
const TWINS: (u64, usize) = (70_225, 2);
/// The seeds of the windows unless some are named: the plain set and two others.
const SEEDS: [u64; 3] = [0, 1, 2];
/// The shares that are kept, as fractions of 1.
const KEPT: [u32; 6] = [2, 4, 8, 16, 32, 64];
/// The greatest side of windows of thinned sets, in spacings of what is left, and of windows that are compared.
const THINNED_SIDE: f64 = 30.0;
const SHARED_SIDE: f64 = 40.0;

pub(super) fn document(args: &Subjects, table: &Table) -> Result<Value, Failure> {
    let side = match args.window_points {
        None => SIDE,
        Some(points) if (POINTS[0]..=POINTS[1]).contains(&points) => (points as f64).cbrt(),
        Some(points) => refuse!(
            "--window-points {points}: allowed in space: an integer from {} to {}",
            POINTS[0],
            POINTS[1]
        ),
    };
    let at = args.window_at.map_or([0.0; 3], |Corner(at)| at);
    let seeds = match args.window_seed.as_slice() {
        [] => SEEDS.to_vec(),
        seeds => seeds.to_vec(),
    };
    let set = |seed: u64| SpaceSet::new(table.clone()).seed(seed);
    let mut subjects = Vec::new();
    for (twin, points) in twins(args, table)? {
        let report = SpaceReport::of(format!("twin {twin}"), &points, None);
        subjects.push(shown(&report));
    }
    for &seed in &seeds {
        let report = SpaceReport::of_window(&set(seed), at, side, PLACES, args.places_seed);
        subjects.push(shown(&report.map_err(Failure::usage)?));
    }
    let mut thinned = Vec::new();
    for &seed in seeds.iter().filter(|seed| **seed != 0) {
        for part in KEPT.map(f64::from) {
            let share = 1.0 / part;
            let kept = set(seed).keep(share).map_err(Failure::usage)?;
            let side = side.min(THINNED_SIDE) * part.cbrt();
            let points = window_set(&kept, at, side).map_err(Failure::usage)?;
            let low = SpacePower::of(&points).summary.low_power;
            thinned.push(json!([seed, share, points.points().len(), low]));
        }
    }
    let windows: Result<Vec<Sample<3>>, strew_core::Error> = { seeds.iter() }
        .map(|&seed| window_set(&set(seed), at, side.min(SHARED_SIDE)))
        .collect();
    let windows = windows.map_err(Failure::usage)?;
    let mut pairs = Vec::new();
    for (i, (a, first)) in seeds.iter().zip(&windows).enumerate() {
        for (b, second) in seeds.iter().zip(&windows).skip(i + 1) {
            let shared = Shared::of(first, second, 1.6);
            let power = [shared.power_correlation, shared.power_by_chance];
            let phase = [shared.phase_peak, shared.phase_by_chance];
            pairs.push(json!([a, b, power[0], power[1], phase[0], phase[1]]));
        }
    }
    let [power, phase] = ["power", "phase"].map(|of| format!("{of}_by_chance"));
    let compared = json!(["a", "b", "power_correlation", power, "phase_peak", phase]);
    Ok(json!({
        "subjects": subjects,
        "thinned": { "columns": ["seed", "share", "points", "low_power"], "sets": thinned },
        "shared": { "columns": compared, "pairs": pairs },
    }))
}

fn twins(args: &Subjects, table: &Table) -> Result<Vec<(Twin, Sample<3>)>, Failure> {
    let points = |twin: Twin| Some((twin, twin_set(table, twin)?));
    if args.twin.is_empty() {
        let (least, number) = TWINS;
        let all = unseen_twins(table.map(), least).take_while(|twin| twin.t().pow(3) <= POINTS[1]);
        return Ok(all.filter_map(points).take(number).collect());
    }
    let read = |&twin: &Twin| {
        if !is_uniform_in_space(twin) {
            refuse!(
                "--twin {twin}: its points are on a sublattice; allowed in space: p - q odd and q even"
            );
        }
        let count = u128::from(twin.t()).pow(3);
        if count > u128::from(POINTS[1]) {
            let most = POINTS[1];
            refuse!("--twin {twin} has {count} points; at most {most} are measured in space");
        }
        let other = || anyhow!("--twin {twin} has another map than the table's alpha");
        points(twin).ok_or_else(|| Failure::Usage(other()))
    };
    args.twin.iter().map(read).collect()
}

/// A report as JSON, as of sets of the plane.
fn shown(report: &SpaceReport) -> Value {
    let figures = &report.figures;
    let values: Map<String, Value> = { figures.values.iter() }
        .map(|(name, value)| (name.clone(), json!(value)))
        .collect();
    let shells: Vec<Value> = { report.shells.iter() }
        .map(|shell| json!([shell.nu, shell.power, shell.anisotropy_db]))
        .collect();
    json!({
        "subject": figures.subject,
        "made_on_it": figures.seen,
        "points": figures.points,
        "figures": values,
        "radial": { "columns": ["nu", "power", "anisotropy_db"], "rings": shells },
    })
}

/// Flags of the sets of a table.
#[derive(Debug, clap::Args)]
#[group(skip)]
pub(super) struct Subjects {
    /// With --table: a twin p/q; may be repeated [default: the first unseen ones with 70,225 points
    /// or more].
    #[arg(long, value_name = "P/Q", requires = "table", value_parser = twin)]
    pub(super) twin: Vec<Twin>,
    /// With --table: the approximate number of points of a window [default: 80000; in space 314432].
    #[arg(long, value_name = "N", requires = "table")]
    pub(super) window_points: Option<u64>,
    /// With --table: the seed of a window; may be repeated. In the plane it chooses a place, by default 1 and
    /// 2; in space it is that of the set, by default 0, which is the plain set, 1 and 2.
    #[arg(long, value_name = "SEED", requires = "table")]
    pub(super) window_seed: Vec<u64>,
    /// With --table of points in space: the least corner of the windows, in mean spacings [default: 0,0,0].
    #[arg(long, value_name = "X,Y,Z", requires = "table")]
    pub(super) window_at: Option<Corner>,
    /// With --table of points in space: the seed of the 60 places whose small windows show a local lattice.
    #[arg(long, value_name = "SEED", requires = "table", default_value_t = 12)]
    pub(super) places_seed: u64,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Corner(pub(super) [f64; 3]);

fn twin(text: &str) -> Result<Twin, String> {
    let twin =
        { text.split_once('/') }.and_then(|(p, q)| Twin::new(p.parse().ok()?, q.parse().ok()?));
    twin.ok_or_else(|| "allowed: coprime integers p/q with q < p < 2q".into())
}

impl std::str::FromStr for Corner {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers: Vec<f64> = text
            .split(',')
            .map_while(|v| v.trim().parse().ok())
            .filter(|v: &f64| v.abs() <= 1e6)
            .collect();
        match <[f64; 3]>::try_from(numbers) {
            Ok(at) if text.split(',').count() == 3 => Ok(Self(at)),
            _ => Err("allowed: three numbers X,Y,Z from -1000000 to 1000000".into()),
        }
    }
}
