//! Amounts of points in space on their tables, and the distance that the points keep.

use strew_core::{
    ErrorKind, Spacing,
    space::{self, SpaceSet},
};
use strew_error::Error;
use strew_query::{Amount, Parameter, Set, parameters};

/// The set of some points in space at the spacing that its amount means, and its density.
pub(super) fn placed(set: &Set, table: &space::Table) -> Result<(SpaceSet, f64), Error> {
    let (spacing, density) = spacing(set, table)?;
    Ok((set.points_in_space(table, spacing)?, density))
}

fn spacing(set: &Set, table: &space::Table) -> Result<(Spacing, f64), Error> {
    let fault = |parameter: &Parameter, value: f64, error: &strew_core::Error| {
        let detail = match error.kind() {
            ErrorKind::NoLeastDistance => {
                format!("profile `{}`: {}", set.entry.key.profile, error.problem())
            }
            _ => error.to_string(),
        };
        set.fault(parameter.name, value, detail, parameter.allowed())
    };
    match set.amount {
        Amount::Density(density) => {
            let placed = SpaceSet::new(table.clone()).density(density);
            let placed = placed.map_err(|error| fault(&parameters::DENSITY, density, &error))?;
            Ok((placed.placement().spacing, density))
        }
        Amount::Spacing(value) => {
            let spacing = Spacing::new(value);
            let spacing = spacing.map_err(|error| fault(&parameters::SPACING, value, &error))?;
            Ok((spacing, density(spacing)))
        }
        Amount::MinDistance(distance) => {
            let spacing = table.least_distance().spacing_for(distance, set.warp);
            let spacing =
                spacing.map_err(|error| fault(&parameters::MIN_DISTANCE, distance, &error))?;
            Ok((spacing, density(spacing)))
        }
        Amount::Count(count) => Err(set.fault(
            parameters::COUNT.name,
            count,
            "not for points in space",
            "density, spacing or min_distance",
        )),
    }
}

/// The points per unit of volume.
fn density(spacing: Spacing) -> f64 {
    spacing.get().powi(-3)
}

/// The distance that the coordinates of a set within ±`reach` keep.
pub(super) fn least_distance(set: &Set, points: &SpaceSet, reach: f64) -> f64 {
    // Each coordinate is rounded by at most half a unit in its last place.
    let rounding = 2.0 * 3f64.sqrt() * reach * f64::EPSILON;
    let least = (points.least_distance() - rounding).max(0.0);
    match set.amount {
        // The spacing is a little wider than this takes.
        Amount::MinDistance(distance) => least.min(distance),
        _ => least,
    }
}
