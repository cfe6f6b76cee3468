//! `strew arrangement`: whether a set of offsets occurs in a pattern, how often, and where.

use std::fmt::Write as _;

use anyhow::anyhow;
use serde::Serialize;
use strew_core::{Alpha, Pattern, Seed, pattern::Arrangement};

use super::{Failure, offsets::Offsets, output, output::Output};

/// Flags of `strew arrangement`.
#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// The offsets of the other points from the first, in grid units: pairs of integers, such as "2,1 3,3".
    #[arg(value_name = "OFFSETS", allow_hyphen_values = true)]
    offsets: Offsets,
    /// α: a decimal, a fraction or a quadratic irrational, between 1 and 2.
    #[arg(long, value_name = "ALPHA", default_value = "(5-sqrt(3))/2")]
    alpha: Alpha,
    /// The seed that moves the pattern; occurrences are at the ids that its points have.
    #[arg(long, value_name = "NUMBER", default_value_t = 0)]
    seed: u64,
    /// Count the occurrences whose first point is in this box of the grid: columns and rows from min up to, but
    /// not including, max.
    #[arg(
        long,
        value_name = "INTEGER",
        num_args = 4,
        value_names = ["MIN_X", "MIN_Y", "MAX_X", "MAX_Y"],
        allow_hyphen_values = true
    )]
    grid: Option<Vec<i64>>,
    /// List the occurrences instead, as CSV: column and row of the first point of each.
    #[arg(long, requires = "grid")]
    list: bool,
}

/// What is known of an arrangement. Lengths are in turns of the index torus.
#[derive(Serialize)]
struct Facts {
    alpha: String,
    offsets: Vec<(i64, i64)>,
    exists: bool,
    /// The extent of the image along dX and dY.
    image: [[f64; 2]; 2],
    /// The ranges of dX and dY that are left.
    margin: Option<[[f64; 2]; 2]>,
    /// Occurrences for each grid point.
    density: f64,
    /// Occurrences for each point of the pattern.
    frequency: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    count: Option<u128>,
}

/// Occurrences that are written at once.
const BATCH: usize = 4096;

/// Prints the facts, or the occurrences.
pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let pattern = Pattern::with_origin(args.alpha, Seed(args.seed).origin());
    let found = Arrangement::new(pattern, args.offsets.as_slice());
    let found = found.map_err(|error| Failure::Usage(anyhow!("{error}")))?;
    let grid = args.grid.as_deref().map(|ends| match *ends {
        [min_x, min_y, max_x, max_y] if min_x <= max_x && min_y <= max_y => {
            Ok([min_x..max_x, min_y..max_y])
        }
        _ => Err(Failure::Usage(anyhow!(
            "--grid: max is below min; allowed: MIN_X MIN_Y MAX_X MAX_Y with min <= max"
        ))),
    });
    let grid = grid.transpose()?;
    if let (true, Some([x, y])) = (args.list, &grid) {
        return list(&found, x.clone(), y.clone());
    }
    const TURN: f64 = 18_446_744_073_709_551_616.0;
    let signed = found.image();
    let facts = Facts {
        alpha: args.alpha.to_string(),
        offsets: found.offsets().to_vec(),
        exists: found.exists(),
        image: signed.map(|range| [*range.start() as f64 / TURN, *range.end() as f64 / TURN]),
        margin: found
            .margin()
            .map(|m| m.map(|range| [range.start as f64 / TURN, range.end as f64 / TURN])),
        density: found.density(),
        frequency: found.frequency(),
        count: grid.map(|[x, y]| found.count(x, y)),
    };
    output::print_json([facts])
}

fn list(
    found: &Arrangement,
    x: std::ops::Range<i64>,
    y: std::ops::Range<i64>,
) -> Result<(), Failure> {
    let mut output = Output::open(None)?;
    let mut text = String::from("x,y\n");
    for (i, (x, y)) in found.occurrences(x, y).enumerate() {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{x},{y}");
        if i % BATCH == BATCH - 1 {
            output.write(text.as_bytes())?;
            text.clear();
        }
    }
    output.write(text.as_bytes())?;
    Ok(output.finish()?)
}
