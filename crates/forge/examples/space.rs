//! Makes and judges a table of points in space: `space PROFILE RADIUS FILE`. `space FILE` judges one.

use std::{env, error::Error, fs, sync::Mutex, time::Instant};

use strew_core::space::{SpaceSet, Table};
use strew_forge::{
    Progress, Watch,
    space::{LocalPower, SpaceDistances, SpaceJob, SpacePower, SpaceProfile, forge},
};

/// Prints every twentieth step.
struct Printer(Mutex<Instant>);

impl Watch for Printer {
    fn progress(&self, progress: &Progress) {
        if progress.step.is_multiple_of(20) {
            let seconds = self.0.lock().map_or(0.0, |began| began.elapsed().as_secs_f64());
            println!("{} of {}: {:?} ({seconds:.0} s)", progress.step, progress.steps, progress.energy);
        }
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = env::args().collect();
    if let [_, file] = &arguments[..] {
        return judge(&Table::from_bytes(&fs::read(file)?)?);
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
    fs::write(file, table.to_bytes())?;
    judge(&table)
}

/// Prints the figures of a table.
fn judge(table: &Table) -> Result<(), Box<dyn Error>> {
    println!("least distance {:.4}", table.least_distance().relative());
    for seed in [0, 1, 2] {
        let set = SpaceSet::new(table.clone()).seed(seed);
        let distances = SpaceDistances::of_window(&set, [100.0, -50.0, 20.0], 60.0)?;
        println!("seed {seed}: {distances:?}");
        println!("  {:?}", LocalPower::of(&set, 60)?);
        println!("  {:?}", SpacePower::of_window(&set, [100.0, -50.0, 20.0], 68.0)?);
    }
    Ok(())
}
