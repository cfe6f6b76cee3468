//! Makes mixes and prints how long that takes and what was measured on twins they were not made with.
//!
//! `cargo run --release -p strew-forge --example kinds -- TABLE [--joint] [--time] [1:3 1:1:2 …]`. With
//! `--time` nothing is measured.

use std::{error::Error, path::Path, time::Instant};

use strew_forge::{MixJob, labels, mix, read_table};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let has = |name: &str| arguments.iter().any(|a| a == name);
    let mut plain = arguments.iter().filter(|a| !a.starts_with("--"));
    let table = read_table(Path::new(plain.next().ok_or("which table?")?))?;
    for shares in plain {
        let shares: strew_core::table::Shares = shares.parse()?;
        let began = Instant::now();
        if has("--time") {
            labels(&table, &shares, &())?;
            println!("{shares}: {:.2?}", began.elapsed());
            continue;
        }
        let job = match has("--joint") {
            true => MixJob::joint(shares),
            false => MixJob::labels(shares),
        };
        let made = mix(&table, &job, &())?.ok_or("stopped")?;
        println!(
            "{}: accepted {}, {:.2?}, {}",
            job.shares,
            made.accepted,
            began.elapsed(),
            made.table.digest()
        );
        for figures in &made.figures {
            let values = figures.values.iter();
            let values = values.map(|(name, value)| format!("{name} {value:.3e}"));
            println!(
                "  {} ({}): {}",
                figures.subject,
                figures.points,
                values.collect::<Vec<_>>().join(" ")
            );
        }
        for complaint in &made.complaints {
            println!("  missed: {complaint}");
        }
    }
    Ok(())
}
