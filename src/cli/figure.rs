//! `strew figure`: pictures of AA patterns, for any α.

use std::path::{Path, PathBuf};

use anyhow::anyhow;
use clap::Subcommand;
use strew_core::Alpha;
use strew_forge::figure::{self, Drawing, FigureError};

use super::{
    Failure,
    offsets::{Offsets, Pair},
    output::Output,
};

/// The figures.
#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// The pattern, the index of every grid point, and the set region.
    Index {
        #[command(flatten)]
        common: Common,
        /// The side of the window of the plane, 8 to 200 grid units.
        #[arg(long, value_name = "NUMBER", default_value_t = 64)]
        window: u32,
    },
    /// Where an arrangement of points occurs, its image in index space, and the margin that is left.
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
            allow_hyphen_values = true
        )]
        offsets: Offsets,
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
        /// The number of points up to which clusters are told apart, 1 to 64.
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
        /// The block whose neighbors are drawn: its intervals of dX and dY, from 0.
        #[arg(long, value_name = "X,Y", default_value = "0,0")]
        block: Pair<usize>,
    },
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

/// Draws a figure.
pub(super) fn run(command: &Command) -> Result<(), Failure> {
    let (common, drawing) = match command {
        Command::Index { common, window } => (common, figure::index(common.alpha, *window)),
        Command::Arrangement {
            common,
            window,
            offsets,
        } => {
            let drawing = figure::arrangement(common.alpha, offsets.as_slice(), *window);
            (common, drawing)
        }
        Command::Clusters {
            common,
            window,
            distance,
            most,
        } => {
            let drawing = figure::clusters(common.alpha, *distance, *most, *window);
            (common, drawing)
        }
        Command::Map {
            common,
            radius,
            block,
        } => (common, figure::map(common.alpha, *radius, block.0)),
    };
    let drawing = drawing.map_err(refused)?;
    write(&drawing, common)
}

fn refused(error: FigureError) -> Failure {
    let FigureError {
        field,
        value,
        allowed,
    } = error;
    Failure::Usage(anyhow!("--{field} {value}: allowed: {allowed}"))
}

fn write(drawing: &Drawing, common: &Common) -> Result<(), Failure> {
    let path = common.output.as_deref();
    let ending = path.and_then(Path::extension).unwrap_or("svg".as_ref());
    let bytes = if ending.eq_ignore_ascii_case("svg") {
        drawing.to_svg().into_bytes()
    } else if ending.eq_ignore_ascii_case("png") {
        drawing.to_png(common.size).map_err(refused)?
    } else {
        return Err(Failure::Usage(anyhow!(
            "--output: figures are not drawn as {}; allowed: a file whose name ends in .svg or .png, or -",
            ending.display()
        )));
    };
    let mut output = Output::open(path)?;
    output.write(&bytes)?;
    Ok(output.finish()?)
}
