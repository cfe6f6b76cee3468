//! `strew forge --ladder-of TABLE`: makes a ladder for a table, judges it, writes the table with it.

use std::{fs, path::Path, time::Duration};

use anyhow::{Context as _, anyhow};
use strew_forge::{Checkpoint, ForgeError, LadderJob, file_name, ladder, read_table, write_table};

use super::{Args, checkpoint_path, gravest};
use crate::cli::{Failure, output, watcher::Watcher};

/// Makes the ladder of a table file.
pub(super) fn run(args: &Args, of: &Path) -> Result<(), Failure> {
    let usage = |error: ForgeError| Failure::Usage(error.into());
    let table = read_table(of).map_err(usage)?;
    let job = LadderJob {
        per_octave: args.per_octave,
        octaves: args.octaves,
        steps: args.steps.unwrap_or(LadderJob::default().steps),
    };
    let name = file_name(table.profile(), table.alpha(), table.map().radius());
    let usual = || args.out_dir.clone().unwrap_or_default().join(name);
    let path = args.output.clone().unwrap_or_else(usual);
    if path.exists() && !args.force {
        let problem = anyhow!("{} is there already; --force replaces it", path.display());
        return Err(Failure::Usage(problem));
    }
    output::check(&path)?;
    let kept = checkpoint_path(&path);
    let found = match args.restart {
        true => None,
        false => Checkpoint::read_file(&kept).map_err(usage)?,
    };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(args.threads);
    let pool = pool.build().context("cannot start threads")?;
    let every = Duration::from_secs(args.checkpoint_every);
    let watcher = Watcher::new(&kept, every, args.quiet);
    let outcome = pool.install(|| ladder(&table, &job, found, &watcher));
    watcher.finish();
    let outcome = outcome.map_err(usage)?;
    if outcome.interrupted {
        let goes_on = format!("; the same command goes on from {}", kept.display());
        let goes_on = if watcher.has_kept() { &*goes_on } else { "" };
        return Err(Failure::Interrupted(anyhow!("interrupted{goes_on}")));
    }
    let complaints = gravest(&outcome.complaints);
    if !outcome.accepted && !args.keep_rejected {
        return Err(Failure::Other(anyhow!(
            "the ladder is rejected and not written (the same command with --keep-rejected writes it): \
             {}",
            complaints.join("; ")
        )));
    }
    write_table(&path, &outcome.table).map_err(|error| Failure::Other(error.into()))?;
    println!("{}  {}", outcome.table.digest(), path.display());
    if !args.quiet {
        for figures in &outcome.figures {
            let values = figures.values.iter();
            let values = values.map(|(name, value)| format!("{name} {value:.3e}"));
            eprintln!(
                "{}: {}",
                figures.subject,
                values.collect::<Vec<_>>().join(", ")
            );
        }
    }
    for complaint in complaints {
        eprintln!("kept although rejected: {complaint}");
    }
    // The table is there, so the checkpoint is of no more use.
    match fs::remove_file(&kept) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
            let problem = anyhow!(error).context(format!("cannot remove {}", kept.display()));
            Err(Failure::Other(problem))
        }
        _ => Ok(()),
    }
}
