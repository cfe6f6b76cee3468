//! The figures of periodic sets beside those of the plain twin: what seeds and a warp that wraps cost.
//!
//! `cargo run --release -p strew-forge --example periodic -- TABLE [POINTS [SEEDS]]`

use std::{env, error::Error};

use strew_core::{PeriodicSet, Table};
use strew_forge::measure::{Distances, Spectrum, Torus};

fn main() -> Result<(), Box<dyn Error>> {
    let args: Vec<String> = env::args().skip(1).collect();
    let table = Table::from_bytes(&std::fs::read(args.first().ok_or("no table")?)?)?;
    let number = |i: usize, usual: u64| args.get(i).map_or(Ok(usual), |text| text.parse());
    let (points, seeds) = (number(1, 5000)?, number(2, 4)?);
    let tile = PeriodicSet::new(table, points)?;
    let sizes: Vec<u64> = PeriodicSet::periods(tile.table().map())
        .map(|twin| twin.points())
        .take(12)
        .collect();
    println!("sizes {sizes:?}");
    for seed in 0..=seeds {
        let tile = tile.clone().seed(seed);
        let set = Torus::new(tile.length(), tile.iter().map(|p| p.at()).collect());
        let (distances, spectrum) = (Distances::of_torus(&set), Spectrum::of_torus(&set, 4.0));
        let summary = spectrum.summary(1.0 / 64.0);
        println!(
            "{} points of {}, seed {seed}: delta_min {:.3}, low {:.2e}, peak {:.2}, anisotropy {:.2} dB",
            tile.len(),
            tile.twin(),
            distances.delta_min,
            summary.low_power,
            summary.peak_power,
            summary.anisotropy_db,
        );
    }
    Ok(())
}
