//! What seeds do to a table: distances, isotropy by bands, recurrence, and what two seeds share: of each pair also the
//! recurrence of the one in the other, which for different symmetries is that of chance. Seeds 7 and 10 have the same
//! one.
//!
//! `cargo run --release -p strew-forge --example seeds -- TABLE [STRENGTH [SEEDS [SIDE [SETTLE]]]]`

use std::{env, error::Error};

use strew_core::{F64, Placement, PointSet, Region, Seed, Settle, Spacing, Table, Warp};
use strew_forge::measure::{Distances, Shared, Spectrum, Window, recurrence};

fn window(
    table: &Table,
    seed: u64,
    (warp, settle): (Warp, Settle),
    side: f64,
) -> Result<Window, Box<dyn Error>> {
    let placement = Placement::new(Spacing::ONE, Seed(seed));
    let placement = placement.with_warp(warp).with_settle(settle);
    let set = PointSet::new(table.clone()).placed(placement);
    let plan = set.within(Region::new([0.0; 2], [side; 2])?)?;
    let mut points = vec![[0.0; 2]; plan.count() as usize];
    plan.blocks::<F64>().fill(&mut points);
    Ok(Window::new(side, 1.0, points))
}

fn main() -> Result<(), Box<dyn Error>> {
    let args: Vec<String> = env::args().skip(1).collect();
    let number = |i: usize, usual: f64| args.get(i).map_or(Ok(usual), |text| text.parse::<f64>());
    let file = args.first().ok_or("no table")?;
    let table = Table::from_bytes(&std::fs::read(file)?)?;
    let warp = Warp::new(number(1, 1.0)?)?;
    let (seeds, side) = (number(2, 4.0)? as u64, number(3, 362.0)?);
    let moved = (warp, Settle::new(number(4, 0.0)? as u32)?);
    let least = table.least_distance();
    println!(
        "{file}, warp {}: guaranteed {:.3} of {:.3}",
        warp.strength(),
        least.with_warp(warp) / 1.074_569_931_823_542,
        least.relative()
    );
    let all: Vec<u64> = (7..7 + seeds).collect();
    let mut windows = Vec::new();
    for &seed in &all {
        let wide = window(&table, seed, moved, side)?;
        let spectrum = Spectrum::of_window(&wide, 2.0);
        let summary = spectrum.summary(1.0 / 64.0);
        let bands = spectrum.anisotropy_by_band(1.0 / 64.0);
        let bands: Vec<String> = bands.iter().map(|db| format!("{db:.1}")).collect();
        let small = window(&table, seed, moved, 300.0)?;
        let found = if side <= 400.0 {
            recurrence(&small, None, 64, seed)
        } else {
            0.0
        };
        println!(
            "seed {seed}: delta_min {:.3}, low {:.2e}, peak {:.2}, dB {}, recurrence {found:.2}",
            Distances::of_window(&wide).delta_min,
            summary.low_power,
            summary.peak_power,
            bands.join(" "),
        );
        windows.push((wide, small));
    }
    for (i, a) in windows.iter().enumerate() {
        for (j, b) in windows[..i].iter().enumerate() {
            let shared = Shared::of_windows(&a.0, &b.0, 2.0);
            let found = if side <= 400.0 {
                recurrence(&a.1, Some(&b.1), 64, all[i])
            } else {
                0.0
            };
            println!(
                "seeds {} and {}: power {:.4}, phase {:.1}, recurrence {found:.2}",
                all[j], all[i], shared.power_correlation, shared.phase_peak
            );
        }
    }
    Ok(())
}
