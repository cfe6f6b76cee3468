//! Makes and judges a table of points in space: `space PROFILE RADIUS FILE`. `space FILE` judges one.

use std::{env, error::Error, fs, sync::Mutex, time::Instant};

use strew_core::space::{SpaceSet, Table};
use strew_forge::{
    Progress, Watch,
    space::{SpaceJob, SpacePower, SpaceProfile, forge, judged, with_ranks},
};

/// Prints every twentieth step.
struct Printer(Mutex<Instant>);

impl Watch for Printer {
    fn progress(&self, progress: &Progress) {
        if progress.step.is_multiple_of(20) {
            let seconds = self
                .0
                .lock()
                .map_or(0.0, |began| began.elapsed().as_secs_f64());
            println!(
                "{} of {}: {:?} ({seconds:.0} s)",
                progress.step, progress.steps, progress.energy
            );
        }
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = env::args().collect();
    if let [_, file] = &arguments[..] {
        return print(&Table::from_bytes(&fs::read(file)?)?);
    }
    let [_, profile, radius, file] = &arguments[..] else {
        return Err("space PROFILE RADIUS FILE, or space FILE".into());
    };
    let profile = SpaceProfile::named(profile).ok_or("blue or spaced")?;
    let job = SpaceJob {
        radius: radius.parse()?,
        ..SpaceJob::new(profile)
    };
    let watch = Printer(Mutex::new(Instant::now()));
    let table = forge(&job, &watch)?.ok_or("stopped")?;
    let table = judged(&with_ranks(&table)?)?;
    fs::write(file, table.to_bytes())?;
    print(&table)
}

/// Prints the figures of a table.
fn print(table: &Table) -> Result<(), Box<dyn Error>> {
    println!("{} {:?}", table.profile(), table.digest());
    println!("least distance {:.4}", table.least_distance().relative());
    for figures in &table.provenance().figures {
        println!("{}: {} points", figures.subject, figures.points);
        for (name, value) in &figures.values {
            println!("  {name} {value:.4e}");
        }
    }
    for share in [1, 2, 4, 8, 16, 32, 64] {
        let set = SpaceSet::new(table.clone())
            .seed(1)
            .keep(1.0 / f64::from(share))?;
        let side = 30.0 * f64::from(share).cbrt();
        let power = SpacePower::of_window(&set, [0.0; 3], side)?;
        println!(
            "kept 1/{share}: {} points, low power {:.3}",
            power.points, power.low
        );
    }
    Ok(())
}
