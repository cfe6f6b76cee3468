//! `strew arrangement` and `strew figure`: what an AA pattern has, for any α, as documents and as pictures.
//!
//! The flags of the former are the parameters of GET /v1/pattern/arrangements, and so are the answers.

use std::path::{Path, PathBuf};

use clap::Subcommand;
use strew_core::Alpha;
use strew_forge::figure::{self, Drawing};
use strew_plan::Placed;
use strew_query::{Value, patterns::OFFSETS};
use strew_service::pattern::{ArrangementQuery, Listing};

use super::{
    Failure, config,
    failure::refused,
    flags::{Arranged, Flags},
    output::{self, Output},
    refuse,
};

/// Flags of `strew arrangement`.
#[derive(Debug, clap::Args)]
pub(super) struct ArrangementArgs {
    #[command(flatten)]
    flags: Flags<Arranged>,
    #[command(flatten)]
    settings: config::Args,
}

pub(super) fn arrangement(args: &ArrangementArgs) -> Result<(), Failure> {
    let config = args.settings.merged(config::Uses::LISTS)?;
    let query = ArrangementQuery::check(&args.flags.values(), &config::tables(&config)?)
        .map_err(refused)?;
    let facts = query.facts();
    let Some(list) = query.list else {
        return output::print_json([facts]);
    };
    let places = query.set.clone().map(Placed::at_once).transpose();
    let listing = Listing::new(&query, places.map_err(refused)?, config.limits.max_points);
    let listing = listing.map_err(refused)?;
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

/// The figures.
#[derive(Debug, Subcommand)]
pub(super) enum Figure {
    /// The pattern, the index of every grid point, and the set region.
    Index {
        #[command(flatten)]
        common: Common,
        /// The side of the window of the plane, 8 to 200 grid units.
        #[arg(long, value_name = "NUMBER", default_value_t = 64)]
        window: u32,
    },
    /// Where an arrangement of points occurs, its image in index space, and the remaining margin.
    Arrangement {
        #[command(flatten)]
        common: Common,
        /// The side of the window of the plane, 8 to 200 grid units.
        #[arg(long, value_name = "NUMBER", default_value_t = 48)]
        window: u32,
        /// The offsets of the other points from the first: pairs of integers.
        #[arg(
            long,
            value_name = "X,Y …",
            default_value = "2,1 3,3",
            value_parser = pairs
        )]
        offsets: Pairs,
    },
    /// The shapes of connected clusters, in the plane and in the set region.
    Clusters {
        #[command(flatten)]
        common: Common,
        /// The side of the window of the plane, 8 to 200 grid units.
        #[arg(long, value_name = "NUMBER", default_value_t = 96)]
        window: u32,
        /// The largest distance of neighbors, 1 to 16 grid units.
        #[arg(long, value_name = "NUMBER", default_value_t = 2.24)]
        distance: f64,
        /// The number of points up to which clusters are distinguished, 1 to 64.
        #[arg(long, value_name = "NUMBER", default_value_t = 64)]
        most: usize,
    },
    /// The blocks of a neighborhood map, the neighbors of one block, and the number of intervals against R.
    Map {
        #[command(flatten)]
        common: Common,
        /// The half-width R of the map, 1 to 200 grid units.
        #[arg(long, value_name = "NUMBER", default_value_t = 20)]
        radius: u32,
        /// The block whose neighbors are drawn: its intervals of dX and dY, counted from 0.
        #[arg(long, value_name = "X,Y", default_value = "0,0", value_parser = block)]
        block: [usize; 2],
    },
}

/// A list that is one value of a flag.
type Pairs = Box<[(i64, i64)]>;

fn pairs(text: &str) -> Result<Pairs, String> {
    let numbers = OFFSETS.shape.read(text)?;
    let Value::Numbers(numbers) = numbers else {
        return Err("not a list of pairs".into());
    };
    // Integers within ±2⁵², so exact.
    let pairs = numbers.chunks_exact(2);
    Ok(pairs.map(|pair| (pair[0] as i64, pair[1] as i64)).collect())
}

fn block(text: &str) -> Result<[usize; 2], String> {
    let read = || {
        let (column, row) = text.split_once(',')?;
        Some([column.trim().parse().ok()?, row.trim().parse().ok()?])
    };
    read().ok_or_else(|| "must be two integers joined by a comma, such as 2,1".into())
}

/// Flags of all figures.
#[derive(Debug, clap::Args)]
pub(super) struct Common {
    /// α: a decimal, a fraction or a quadratic irrational, between 1 and 2.
    #[arg(long, value_name = "ALPHA", default_value = "(5-sqrt(3))/2")]
    alpha: Alpha,
    /// The file to write, SVG or PNG by its ending; - is standard output, with SVG.
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
    /// The longer side of a PNG in pixels, 64 to 4096.
    #[arg(long, value_name = "PIXELS", default_value_t = 1600)]
    size: u32,
}

pub(super) fn draw(command: &Figure) -> Result<(), Failure> {
    let (common, drawing) = match command {
        Figure::Index { common, window } => (common, figure::index(common.alpha, *window)),
        Figure::Arrangement {
            common,
            window,
            offsets,
        } => {
            let drawing = figure::arrangement(common.alpha, offsets, *window);
            (common, drawing)
        }
        Figure::Clusters {
            common,
            window,
            distance,
            most,
        } => {
            let drawing = figure::clusters(common.alpha, *distance, *most, *window);
            (common, drawing)
        }
        Figure::Map {
            common,
            radius,
            block,
        } => (common, figure::map(common.alpha, *radius, *block)),
    };
    let path = common.output.as_deref();
    let drawing = drawing.map_err(Failure::of_setting)?;
    let bytes = encoded(&drawing, ("--output", path), common.size)?;
    output::write(path, &bytes)
}

/// A drawing as SVG or PNG, by the ending of a path that a flag has; without a path as SVG.
pub(super) fn encoded(
    drawing: &Drawing,
    (flag, path): (&str, Option<&Path>),
    size: u32,
) -> Result<Vec<u8>, Failure> {
    let ending = path.and_then(Path::extension).unwrap_or("svg".as_ref());
    if ending.eq_ignore_ascii_case("svg") {
        Ok(drawing.to_svg().into_bytes())
    } else if ending.eq_ignore_ascii_case("png") {
        drawing.to_png(size).map_err(Failure::of_setting)
    } else {
        refuse!(
            "{flag}: figures are not drawn as {}; allowed: a file whose name ends in .svg or .png",
            ending.display()
        )
    }
}
