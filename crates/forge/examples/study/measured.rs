//! Sets that are measured as a whole: other ways to place points, seeds, periods, thinned twins.

use fast_poisson::Poisson2D;
use strew_core::{PeriodicSet, Placement, PointSet, Seed, Settle, Spacing, Twin, Warp};
use strew_forge::{
    Report, Resolution, ThinnedTwin,
    measure::{BANDS, Sample, Shared, recurrence, square_set, twin_set},
    numeric::SplitMix,
    read_table, with_ranks,
};

use crate::{
    Arguments, Outcome,
    figures::{self, value},
    ground::{HEXAGONAL, places, square},
};

/// The side of the windows of different methods, in mean spacings.
const SIDE: f64 = 300.0;
/// The side of the windows whose recurrence is measured, and the patches of each.
const RECURRENCE: (f64, usize) = (300.0, 64);
/// A small table.
const SMALL: &str = "../catalog/tables/blue-5-sqrt3-over-2-s.strew";

/// The noise of Strew's points beside that of other ways to place them: the figures of `strew_core::comparison`.
pub fn comparison(_: Arguments) -> Outcome {
    // One point at random in each cell of a grid.
    let mut random = SplitMix::new(7);
    let cells = SIDE as i32;
    let jittered = (0..cells * cells).map(|cell| [cell % cells, cell / cells]);
    let jittered = jittered.map(|cell| cell.map(|v| f64::from(v) + random.next_f64()));
    let jittered = jittered.collect();
    let independent = SplitMix::new(7).places((cells * cells) as usize, SIDE);
    // A radius of 0.84 makes about one point a unit of area.
    let disks = Poisson2D::new().with_dimensions([SIDE, SIDE], 0.84);
    let strew = square(&PointSet::blue().seed(7), [0.0; 2], SIDE)?;
    figures::head_of_sets("");
    for (name, points) in [
        ("Strew, blue, seed 7", places(&strew)),
        ("fast_poisson", disks.with_seed(7).generate()),
        ("jittered grid", jittered),
        ("a repeated tile", tiled()?),
        ("random", independent),
    ] {
        let density = points.len() as f64 / (SIDE * SIDE);
        let set = Sample::window(SIDE, density, points);
        let report = Report::of(name.into(), false, &set, Resolution::default());
        figures::set(&report.figures, &[]);
    }
    Ok(())
}

/// A toroidal tile of 5,041 blue points, repeated.
fn tiled() -> Outcome<Vec<[f64; 2]>> {
    let table = read_table(&std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(SMALL))?;
    let tile = twin_set(&table, Twin::new(183, 112).ok_or("no fraction")?).ok_or("no twin")?;
    let repeats = (SIDE / tile.side()).ceil() as i32;
    let corners = (0..repeats).flat_map(|j| (0..repeats).map(move |i| [i, j].map(f64::from)));
    let mut points = Vec::new();
    for corner in corners {
        let moved = |p: &[f64; 2]| [0, 1].map(|i| p[i] + corner[i] * tile.side());
        points.extend(tile.points().iter().map(moved));
    }
    points.retain(|at| at.iter().all(|v| (0.0..SIDE).contains(v)));
    Ok(points)
}

/// The sets of several seeds of a table: distances, isotropy by bands and recurrence of each; of each pair the shared
/// power and phases, and the recurrence of one in the other, which for different symmetries is that of chance. Seeds 7
/// and 10 have the same symmetry.
pub fn seeds(mut arguments: Arguments) -> Outcome {
    let warp = Warp::new(arguments.value("--warp", "1")?)?;
    let settle = Settle::new(arguments.value("--settle", "0")?)?;
    let seeds: u64 = arguments.value("--seeds", "4")?;
    let side: f64 = arguments.value("--side", "362")?;
    let table = arguments.table()?;
    let least = table.least_distance();
    figures::head("warp | guaranteed | without warp");
    let guaranteed = least.with_warp(warp) / HEXAGONAL;
    figures::row(warp.strength(), &[guaranteed, least.relative()]);
    let bands = BANDS.map(|[from, to]| format!(" | dB {from} to {to}"));
    figures::head_of_sets(&format!(" | recurrence{}", bands.concat()));
    let recurrence = |set: &Sample, other: Option<&Sample>, seed: u64| match side <= 400.0 {
        true => recurrence(set, other, RECURRENCE.1, seed),
        false => f64::NAN,
    };
    let (nu_max, ring_width) = (2.0, Resolution::default().ring_width);
    let at = Resolution { nu_max, ring_width };
    let mut windows = Vec::new();
    for seed in 7..7 + seeds {
        let placement = Placement::new(Spacing::ONE, Seed(seed));
        let placement = placement.with_warp(warp).with_settle(settle);
        let set = PointSet::new(table.clone()).placed(placement);
        let window = |side: f64| square_set(&set, [0.0; 2], side, 1.0);
        let (wide, small) = (window(side)?, window(RECURRENCE.0)?);
        let report = Report::of(format!("seed {seed}"), false, &wide, at);
        let found = recurrence(&small, None, seed);
        let more = [&[found], &report.anisotropy_by_band[..]].concat();
        figures::set(&report.figures, &more);
        windows.push((seed, wide, small));
    }
    figures::head("seeds | power | phase | recurrence");
    for (i, (seed, wide, small)) in windows.iter().enumerate() {
        for (other, other_wide, other_small) in &windows[..i] {
            let shared = Shared::of(wide, other_wide, 2.0);
            let found = recurrence(small, Some(other_small), *seed);
            let numbers = [shared.power_correlation, shared.phase_peak, found];
            figures::row(format!("{other} and {seed}"), &numbers);
        }
    }
    Ok(())
}

/// The figures of periodic sets beside those of the plain twin, seed 0: what seeds and a warp that wraps cost.
pub fn periodic(mut arguments: Arguments) -> Outcome {
    let points: u64 = arguments.value("--points", "5000")?;
    let seeds: u64 = arguments.value("--seeds", "4")?;
    let tile = PeriodicSet::new(arguments.table()?, points)?;
    let sizes = PeriodicSet::periods(tile.table().map()).map(|twin| twin.points());
    println!("Sizes {:?}", sizes.take(12).collect::<Vec<_>>());
    figures::head_of_sets("");
    for seed in 0..=seeds {
        let tile = tile.clone().seed(seed);
        let set = Sample::torus(tile.length(), tile.iter().map(|p| p.at()).collect());
        figures::torus(format!("{}, seed {seed}", tile.twin()), &set, &[]);
    }
    Ok(())
}

/// Measures thinned twins of a table at `per` shares an octave, the first 2^(−phase/per), and sums octaves up.
/// `--ranks` makes ranks where the table has none, `--quiet` prints octaves alone.
pub fn thinned(mut arguments: Arguments) -> Outcome {
    let [makes_ranks, is_quiet] = ["--ranks", "--quiet"].map(|flag| arguments.has(flag));
    let twin: String = arguments.value("--twin", "683/418")?;
    let per: f64 = arguments.value("--per", "1")?;
    let octaves: f64 = arguments.value("--octaves", "6")?;
    let phase: f64 = arguments.value("--phase", "0")?;
    let nu_max: f64 = arguments.value("--nu", "2.5")?;
    let mut table = arguments.table()?;
    if table.ranks().is_none() && makes_ranks {
        table = with_ranks(&table)?;
    }
    let (p, q) = twin.split_once('/').ok_or("a twin is p/q")?;
    let twin = Twin::new(p.parse()?, q.parse()?).ok_or("no twin")?;
    let thinned = ThinnedTwin::new(&table, twin).ok_or("no twin of this table")?;
    if !is_quiet {
        figures::head_of_sets("");
    }
    let downs = (0..).map(|i| (f64::from(i) + phase) / per);
    let mut found = Vec::new();
    for down in downs.take_while(|&down| down <= octaves) {
        let share = (-down).exp2();
        let set = thinned.at(share, None);
        let few = set.points().len() < 4000;
        let ring_width = if few { 0.08 } else { 0.04 };
        let at = Resolution { nu_max, ring_width };
        let measured = Report::of(format!("{share:.5}"), false, &set, at).figures;
        if !is_quiet {
            figures::set(&measured, &[]);
        }
        let [low, delta] = ["low_power", "delta_min"].map(|name| value(&measured, name));
        found.push((down as usize, low, delta));
    }
    figures::head("octave | shares | mean low power | the most | δ_min | below 0.5");
    for octave in found.chunk_by(|a, b| a.0 == b.0) {
        let lows = || octave.iter().map(|(_, low, _)| *low);
        let deltas = || octave.iter().map(|(.., delta)| *delta);
        let numbers = [
            octave.len() as f64,
            lows().sum::<f64>() / octave.len() as f64,
            lows().fold(0.0, f64::max),
            deltas().fold(f64::INFINITY, f64::min),
            deltas().filter(|&delta| delta < 0.5).count() as f64,
        ];
        figures::row(octave[0].0, &numbers);
    }
    Ok(())
}
