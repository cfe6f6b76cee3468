//! `strew arrangement`: whether a set of offsets occurs in a pattern, how often, and where.
//!
//! The flags are the parameters of GET /v1/pattern/arrangements, and so are the answers.

use super::{Failure, config, output, output::Output, refusal::Source};
use crate::service::{
    Error, Placed,
    pattern::{ArrangementQuery, Listing},
    query::{Values, groups},
};

/// Flags of `strew arrangement`.
#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// The offsets of the other points from the first, in grid units: pairs of integers, such as "2,1 3,3".
    #[arg(value_name = "OFFSETS", allow_hyphen_values = true)]
    offsets: String,
    /// α: a decimal, a fraction or a quadratic irrational, between 1 and 2.
    #[arg(long, value_name = "ALPHA", default_value = "(5-sqrt(3))/2")]
    alpha: String,
    /// The seed that moves the pattern; occurrences are at the ids that its points have.
    #[arg(long, value_name = "NUMBER")]
    seed: Option<String>,
    /// Count the occurrences whose first point is in this box of the grid: columns and rows from min up to, but
    /// not including, max.
    #[arg(
        long,
        num_args = 4,
        value_names = ["MIN_X", "MIN_Y", "MAX_X", "MAX_Y"],
        allow_hyphen_values = true
    )]
    grid: Option<Vec<String>>,
    /// List the occurrences instead: column and row of the first point of each, and with an amount the places of
    /// its points. The format is csv unless =json or =ndjson follows.
    #[arg(
        long,
        value_name = "FORMAT",
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = "csv"
    )]
    list: Option<String>,
    /// The greatest number of occurrences in the list.
    #[arg(long, value_name = "NUMBER")]
    limit: Option<String>,
    /// Where an earlier list ended: the column and the row of the next occurrence, such as 3:-7.
    #[arg(long, value_name = "COLUMN:ROW", allow_hyphen_values = true)]
    cursor: Option<String>,
    /// List the places of points, too, at this density.
    #[arg(long, value_name = "NUMBER")]
    density: Option<String>,
    /// List the places of points, too, at this mean spacing.
    #[arg(long, value_name = "NUMBER")]
    spacing: Option<String>,
    /// List the places of points, too, at the density that guarantees this least distance.
    #[arg(long, value_name = "NUMBER")]
    min_distance: Option<String>,
    /// The profile whose table displaces the points [default: blue].
    #[arg(long, value_name = "TEXT")]
    profile: Option<String>,
    /// The size of the table's map.
    #[arg(long, value_name = "TEXT")]
    map: Option<String>,
    /// The strength of the warp.
    #[arg(long, value_name = "off|on|STRENGTH")]
    warp: Option<String>,
    #[command(flatten)]
    settings: config::Args,
}

impl Args {
    fn values(&self) -> Values {
        let grid = self.grid.as_ref().map(|ends| ends.join(","));
        let given = [
            ("offsets", Some(&self.offsets)),
            ("alpha", Some(&self.alpha)),
            ("seed", self.seed.as_ref()),
            ("grid", grid.as_ref()),
            ("list", self.list.as_ref()),
            ("limit", self.limit.as_ref()),
            ("cursor", self.cursor.as_ref()),
            ("density", self.density.as_ref()),
            ("spacing", self.spacing.as_ref()),
            ("min_distance", self.min_distance.as_ref()),
            ("profile", self.profile.as_ref()),
            ("map", self.map.as_ref()),
            ("warp", self.warp.as_ref()),
        ];
        let mut values = Values::new(groups::ARRANGEMENT, "");
        for (name, text) in given {
            if let Some(text) = text {
                values.add_text(name, text);
            }
        }
        values
    }
}

/// Prints the facts, or the occurrences.
pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let refused = |error: Error| Source::Flags.refused(error);
    let config = args.settings.merged(config::Uses::LISTS)?;
    let query = ArrangementQuery::check(&args.values(), &config.tables()?).map_err(refused)?;
    let facts = query.facts();
    let Some(list) = query.list else {
        return output::print_json([facts]);
    };
    let places = query
        .set
        .clone()
        .map(Placed::at_once)
        .transpose()
        .map_err(refused)?;
    let listing = Listing::new(&query, places, config.limits.max_points).map_err(refused)?;
    let cursor = listing.cursor();
    let mut output = Output::open(None)?;
    for block in listing.text(list, &facts) {
        output.write(&block.map_err(refused)?)?;
    }
    output.finish()?;
    if let Some(cursor) = cursor {
        eprintln!("the rest: --cursor {cursor}");
    }
    Ok(())
}
