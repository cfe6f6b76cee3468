//! `strew point` and `strew nearest`: single points, by id and near a place.

use serde::Serialize;

use super::{
    Failure, config,
    fields::FieldArgs,
    flags::{Flags, Near, Single},
    output,
    refusal::Source,
};
use crate::service::{Found, Nearest, Placed, Set, query::ResolvedSet};

/// Flags of `strew point`.
#[derive(Debug, clap::Args)]
pub(super) struct PointArgs {
    /// The id of the point: its lattice address, such as -31:52.
    #[arg(value_name = "ID", allow_hyphen_values = true)]
    id: String,
    /// Print the document of GET /v1/points/{id} instead: the point and the set with everything filled in.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    flags: Flags<Single>,
    #[command(flatten)]
    field: FieldArgs,
    #[command(flatten)]
    settings: config::Args,
}

/// Flags of `strew nearest`.
#[derive(Debug, clap::Args)]
pub(super) struct NearestArgs {
    /// Print the document of GET /v1/nearest instead: the points and the set with everything filled in.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    flags: Flags<Near>,
    #[command(flatten)]
    field: FieldArgs,
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
    let config = args.settings.merged(config::Uses::LOADED)?;
    let mut values = args.flags.values();
    let catalog = args.field.load(&mut values, config.tables()?)?;
    let set = Set::single(&values, &catalog);
    let found = set.and_then(Placed::at_once).and_then(|placed| {
        let point = placed.point(&args.id)?;
        Ok((placed, point))
    });
    let (placed, point) = found.map_err(|error| Source::Flags.refused(error))?;
    if args.json {
        let query = placed.resolved;
        return output::print_json([One { point, query }]);
    }
    output::print_json([point])
}

/// Prints the points near a place.
pub(super) fn nearest(args: &NearestArgs) -> Result<(), Failure> {
    let config = args.settings.merged(config::Uses::LOADED)?;
    let mut values = args.flags.values();
    let catalog = args.field.load(&mut values, config.tables()?)?;
    let near = Nearest::of_set(&values, &catalog);
    let found = near.and_then(|(set, nearest)| {
        let placed = Placed::at_once(set)?;
        let neighbors = placed.nearest(nearest)?;
        Ok((placed, neighbors))
    });
    let (placed, neighbors) = found.map_err(|error| Source::Flags.refused(error))?;
    if args.json {
        let query = placed.resolved;
        return output::print_json([Several { neighbors, query }]);
    }
    output::print_json(neighbors)
}
