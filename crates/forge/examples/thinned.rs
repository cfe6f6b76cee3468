//! Measures thinned twins of a table: low power, peak, anisotropy and distances at some shares.
//!
//! `cargo run --release -p strew-forge --example thinned -- TABLE [--ranks] [--twin 265/153]
//! [--per 4] [--octaves 6] [--phase 0]` looks at `per` shares an octave, the first 2^(−phase/per).

use std::{error::Error, path::Path};

use strew_core::Twin;
use strew_forge::{
    ThinnedTwin,
    measure::{Distances, Spectrum},
    read_table, with_ranks,
};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let text = |name: &str, default: &str| {
        let at = arguments.iter().position(|a| a == name);
        let found = at.and_then(|at| arguments.get(at + 1));
        found.map_or(default.to_owned(), Clone::clone)
    };
    let number = |name: &str, default: &str| text(name, default).parse::<f64>();
    let file = arguments.first().ok_or("which table?")?;
    let mut table = read_table(Path::new(file))?;
    if table.ranks().is_none() && arguments.iter().any(|a| a == "--ranks") {
        table = with_ranks(&table)?;
    }
    let twin = text("--twin", "265/153");
    let (t, r) = twin.split_once('/').ok_or("a twin is t/r")?;
    let (t, r): (u64, u64) = (t.parse()?, r.parse()?);
    let twin = Twin::new(r + 2 * t, t + r).ok_or("no twin")?;
    let thinned = ThinnedTwin::new(&table, twin).ok_or("no twin of this table")?;
    let (per, octaves, phase) = (
        number("--per", "1")?,
        number("--octaves", "6")?,
        number("--phase", "0")?,
    );
    let quiet = arguments.iter().any(|a| a == "--quiet");
    println!("share points low peak peak_nu tallest anisotropy_db delta_min delta_avg");
    let mut octave = Octave::default();
    for i in 0.. {
        let down = (f64::from(i) + phase) / per;
        if down > octaves {
            break;
        }
        let share = (-down).exp2();
        let set = thinned.at(share);
        let spectrum = Spectrum::of_torus(&set, number("--nu", "2.5")?);
        let s = spectrum.summary(if set.points().len() < 4000 {
            0.08
        } else {
            0.04
        });
        let d = Distances::of_torus(&set);
        if !quiet {
            println!(
                "{share:.5} {} {:.2e} {:.2} {:.2} {:.1} {:.2} {:.3} {:.3}",
                set.points().len(),
                s.low_power,
                s.peak_power,
                s.peak_nu,
                s.tallest,
                s.anisotropy_db,
                d.delta_min,
                d.delta_avg
            );
        }
        octave.add(down as usize, s.low_power, d.delta_min);
    }
    octave.print();
    Ok(())
}

/// Sums over the shares of an octave, and of all.
#[derive(Default)]
struct Octave(Vec<(u32, f64, f64, f64, u32)>);

impl Octave {
    fn add(&mut self, octave: usize, low: f64, delta: f64) {
        let none = (0, 0.0, 0.0, f64::INFINITY, 0);
        self.0.resize(self.0.len().max(octave + 1), none);
        let (count, sum, most, least, missed) = &mut self.0[octave];
        *count += 1;
        *sum += low;
        *most = most.max(low);
        *least = least.min(delta);
        *missed += u32::from(delta < 0.5);
    }

    fn print(&self) {
        for (octave, (count, sum, most, least, missed)) in self.0.iter().enumerate() {
            let mean = sum / f64::from(*count);
            println!(
                "octave {octave}: {count} shares, low mean {mean:.2e} max {most:.2e}, delta_min {least:.3}, \
                 {missed} below 0.5"
            );
        }
    }
}
