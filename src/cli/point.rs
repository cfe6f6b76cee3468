//! `strew point` and `strew nearest`: single points, by id and near a place.

use serde::Serialize;

use super::{
    Failure, config,
    flags::{Flags, Near, Single},
    output,
    query::placed,
    refusal::Source,
};
use crate::service::{Error, Found, query::ResolvedSet};

/// Flags of `strew point`.
#[derive(Debug, clap::Args)]
pub(super) struct PointArgs {
    /// The id of the point: its lattice address, such as -31:52.
    #[arg(value_name = "ID", allow_hyphen_values = true)]
    id: String,
    /// Print the document of GET /v1/points/{id} instead: the point and the query as understood.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    flags: Flags<Single>,
    #[command(flatten)]
    settings: config::Args,
}

/// Flags of `strew nearest`.
#[derive(Debug, clap::Args)]
pub(super) struct NearestArgs {
    /// Print the document of GET /v1/nearest instead: the points and the query as understood.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    flags: Flags<Near>,
    #[command(flatten)]
    settings: config::Args,
}

#[derive(Serialize)]
struct One {
    point: Found,
    query: ResolvedSet,
}

#[derive(Serialize)]
struct Several {
    neighbors: Vec<Found>,
    query: ResolvedSet,
}

/// Prints a point.
pub(super) fn point(args: &PointArgs) -> Result<(), Failure> {
    let config = args.settings.merged()?;
    let placed = placed(&args.flags.parameters(|_| true), &[], &config)?;
    let found = placed.point(&args.id);
    let point = found.map_err(|error| Source::Flags.refused(error))?;
    if args.json {
        let query = placed.resolved;
        return output::print_json([One { point, query }]);
    }
    output::print_json([point])
}

/// Prints the points near a place.
pub(super) fn nearest(args: &NearestArgs) -> Result<(), Failure> {
    let refused = |error| Source::Flags.refused(error);
    let config = args.settings.merged()?;
    let parameters = args.flags.parameters(|_| true);
    let around = parameters.around().map_err(Error::Invalid);
    let around = around.map_err(refused)?;
    let placed = placed(&parameters, &["at", "k", "radius"], &config)?;
    let neighbors = placed.nearest(around).map_err(refused)?;
    if args.json {
        let query = placed.resolved;
        return output::print_json([Several { neighbors, query }]);
    }
    output::print_json(neighbors)
}
