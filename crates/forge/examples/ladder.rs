//! Gives a table file ranks, and a ladder if levels are requested. Its vectors stay as they are.
//!
//! `cargo run --release -p strew-forge --example ladder -- TABLE OUT [PER_OCTAVE OCTAVES STEPS]`

use std::{error::Error, path::Path};

use strew_forge::{LadderJob, Progress, Watch, ladder, read_table, with_ranks, write_table};

/// Prints every tenth step.
struct Printed;

impl Watch for Printed {
    fn progress(&self, p: &Progress) {
        if p.step.is_multiple_of(10) {
            eprintln!(
                "{:?} {} of {}, {:.0?} left",
                p.stage, p.step, p.steps, p.left
            );
        }
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [table, out, job @ ..] = &arguments[..] else {
        return Err("which table, and where to?".into());
    };
    let mut table = read_table(Path::new(table))?;
    if !table.least_distance().is_useful() {
        println!(
            "{} guarantees no least distance and gets no ranks",
            table.profile()
        );
        return Ok(());
    }
    if table.ranks().is_none() {
        table = with_ranks(&table)?;
    }
    if let [per_octave, octaves, steps] = job {
        let job = LadderJob {
            per_octave: per_octave.parse()?,
            octaves: octaves.parse()?,
            steps: steps.parse()?,
        };
        let outcome = ladder(&table, &job, None, &Printed)?;
        for figures in &outcome.figures {
            println!("{}: {:?}", figures.subject, figures.values);
        }
        for complaint in &outcome.complaints {
            println!("missed: {complaint}");
        }
        table = outcome.table;
    }
    write_table(Path::new(out), &table)?;
    println!("{out}: {} bytes", table.to_bytes().len());
    Ok(())
}
