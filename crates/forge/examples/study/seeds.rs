//! What seeds do to a table: distances, isotropy by bands, recurrence, and what two seeds share: of each pair also the
//! recurrence of the one in the other, which for different symmetries is that of chance. Seeds 7 and 10 have the same
//! one. And the figures of periodic sets beside those of the plain twin, seed 0: what seeds and a warp that wraps cost.

use strew_core::{PeriodicSet, Placement, PointSet, Seed, Settle, Spacing, Warp};
use strew_forge::{
    Report, Resolution,
    measure::{BANDS, Shared, Torus, Window, recurrence},
};

use crate::{
    Outcome,
    arguments::Arguments,
    figures,
    ground::HEXAGONAL,
    sets::{places, square},
};

pub const USAGE: &str = "TABLE [--warp 1] [--seeds 4] [--side 362] [--settle 0]";
/// The side of the windows whose recurrence is measured, and the patches of each.
const RECURRENCE: (f64, usize) = (300.0, 64);

pub fn unbounded(mut arguments: Arguments) -> Outcome {
    let warp = Warp::new(arguments.value("--warp", "1")?)?;
    let seeds: u64 = arguments.value("--seeds", "4")?;
    let side: f64 = arguments.value("--side", "362")?;
    let settle = Settle::new(arguments.value("--settle", "0")?)?;
    let table = arguments.table()?;
    let least = table.least_distance();
    println!(
        "{}\n{}\n",
        figures::head("warp | guaranteed | without warp"),
        figures::row(
            warp.strength(),
            &[least.with_warp(warp) / HEXAGONAL, least.relative()]
        )
    );
    let bands = BANDS.map(|[from, to]| format!("dB {from} to {to}"));
    let more = ["recurrence"]
        .into_iter()
        .chain(bands.iter().map(String::as_str));
    figures::print_head(&more.collect::<Vec<_>>());
    let recurrence = |set: &Window, other: Option<&Window>, seed: u64| match side <= 400.0 {
        true => recurrence(set, other, RECURRENCE.1, seed),
        false => f64::NAN,
    };
    let at = Resolution {
        nu_max: 2.0,
        ..Resolution::default()
    };
    let mut windows = Vec::new();
    for seed in 7..7 + seeds {
        let placement = Placement::new(Spacing::ONE, Seed(seed));
        let placement = placement.with_warp(warp).with_settle(settle);
        let set = PointSet::new(table.clone()).placed(placement);
        let window = |side: f64| -> Outcome<Window> {
            let points = places(&square(&set, [0.0; 2], side)?);
            Ok(Window::new(side, 1.0, points))
        };
        let (wide, small) = (window(side)?, window(RECURRENCE.0)?);
        let report = Report::of_window(format!("seed {seed}"), false, &wide, at);
        let found = recurrence(&small, None, seed);
        figures::print(
            &report.figures,
            &[&[found], &report.anisotropy_by_band[..]].concat(),
        );
        windows.push((seed, wide, small));
    }
    println!("\n{}", figures::head("seeds | power | phase | recurrence"));
    for (i, (seed, wide, small)) in windows.iter().enumerate() {
        for (other, other_wide, other_small) in &windows[..i] {
            let shared = Shared::of_windows(wide, other_wide, 2.0);
            let found = recurrence(small, Some(other_small), *seed);
            let numbers = [shared.power_correlation, shared.phase_peak, found];
            println!("{}", figures::row(format!("{other} and {seed}"), &numbers));
        }
    }
    Ok(())
}

pub fn periodic(mut arguments: Arguments) -> Outcome {
    let points: u64 = arguments.value("--points", "5000")?;
    let seeds: u64 = arguments.value("--seeds", "4")?;
    let tile = PeriodicSet::new(arguments.table()?, points)?;
    let sizes = PeriodicSet::periods(tile.table().map()).map(|twin| twin.points());
    println!("Sizes {:?}\n", sizes.take(12).collect::<Vec<_>>());
    figures::print_head(&[]);
    for seed in 0..=seeds {
        let tile = tile.clone().seed(seed);
        let set = Torus::new(tile.length(), tile.iter().map(|p| p.at()).collect());
        let subject = format!("{}, seed {seed}", tile.twin());
        let report = Report::of_torus(subject, false, &set, Resolution::default());
        figures::print(&report.figures, &[]);
    }
    Ok(())
}
