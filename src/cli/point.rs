//! `strew point` and `strew nearest`: finds points by id and near a place.

use strew_catalog::Catalog;
use strew_plan::Placed;
use strew_query::{Nearest, Set, Values};

use super::{
    Failure, config,
    failure::refused,
    fields::FieldArgs,
    flags::{Flags, Near, Single, Takes},
    output,
};
use crate::rest::{One, Several};

/// A set without a region.
#[derive(Debug, clap::Args)]
pub(super) struct SetArgs<T: Takes> {
    /// Print the document of the REST API instead: what is found, and the set with everything filled in.
    #[arg(long)]
    json: bool,
    /// Points in space: ids are x:y:z, and places have three numbers.
    #[arg(long)]
    space: bool,
    #[command(flatten)]
    flags: Flags<T>,
    #[command(flatten)]
    field: FieldArgs,
    #[command(flatten)]
    settings: config::Args,
}

/// Flags of `strew point`.
#[derive(Debug, clap::Args)]
pub(super) struct PointArgs {
    /// The id of the point: its lattice address, such as -31:52, in space -31:52:7.
    #[arg(value_name = "ID", allow_hyphen_values = true)]
    id: String,
    #[command(flatten)]
    set: SetArgs<Single>,
}

pub(super) type NearestArgs = SetArgs<Near>;

impl<T: Takes> SetArgs<T> {
    fn load(&self) -> Result<(Values, Catalog), Failure> {
        let config = self.settings.merged(config::Uses::LOADED)?;
        let mut values = match self.space {
            true => self.flags.values_in_space(T::IN_SPACE),
            false => self.flags.values(),
        };
        let catalog = self.field.load(&mut values, config::tables(&config)?)?;
        Ok((values, catalog))
    }
}

pub(super) fn point(args: &PointArgs) -> Result<(), Failure> {
    let (values, catalog) = args.set.load()?;
    let set = Set::single(&values, &catalog);
    let found = set.and_then(Placed::at_once).and_then(|placed| {
        let point = placed.point(&args.id)?;
        Ok((placed.resolved, point))
    });
    let (query, point) = found.map_err(refused)?;
    if args.set.json {
        return output::print_json([One { point, query }]);
    }
    output::print_json([point])
}

pub(super) fn nearest(args: &NearestArgs) -> Result<(), Failure> {
    let (values, catalog) = args.load()?;
    let near = Nearest::of_set(&values, &catalog);
    let found = near.and_then(|(set, nearest)| {
        let placed = Placed::at_once(set)?;
        let neighbors = placed.nearest(nearest)?;
        Ok((placed.resolved, neighbors))
    });
    let (query, neighbors) = found.map_err(refused)?;
    if args.json {
        return output::print_json([Several { neighbors, query }]);
    }
    output::print_json(neighbors)
}
