//! Amounts of points on their tables, without a region, and the distances that points keep.

use strew_catalog::Ready;
use strew_core::{
    ErrorKind, LeastDistance, Spacing,
    space::{self, SpaceSet},
};
use strew_error::{Error, number};
use strew_query::{Amount, KindDistance, Set, parameters};

#[derive(Clone, Copy, Debug)]
pub(super) enum Resolved {
    /// A mean spacing, and the density as requested.
    Known(Spacing, f64),
    Count(u64),
}

/// The meaning of a set's amount: with the spacings of a density and of a least distance, and the density of a spacing.
fn resolved(
    set: &Set,
    of_density: impl Fn(f64) -> Result<Spacing, strew_core::Error>,
    for_distance: impl Fn(f64) -> Result<Spacing, strew_core::Error>,
    density: impl Fn(Spacing) -> f64,
) -> Result<Resolved, Error> {
    if let Amount::MinDistance(distance) = set.amount
        && set.moves()
        && set.field.is_some()
    {
        let detail = "not with a field: points settle";
        let allowed = "density, spacing or count; or settle=0";
        return Err(set.fault(parameters::MIN_DISTANCE.name, distance, detail, allowed));
    }
    let (parameter, value, spacing) = match set.amount {
        Amount::Density(value) => (&parameters::DENSITY, value, of_density(value)),
        Amount::Spacing(value) => (&parameters::SPACING, value, Spacing::new(value)),
        Amount::MinDistance(value) => (&parameters::MIN_DISTANCE, value, for_distance(value)),
        Amount::Count(count) => return Ok(Resolved::Count(count)),
    };
    let spacing = spacing.map_err(|error| {
        let detail = match error.kind() {
            ErrorKind::NoLeastDistance => {
                format!("profile `{}`: {}", set.entry.key.profile, error.problem())
            }
            _ => error.to_string(),
        };
        set.fault(parameter.name, value, detail, parameter.allowed())
    })?;
    let density = match set.amount {
        Amount::Density(density) => density,
        _ => density(spacing),
    };
    Ok(Resolved::Known(spacing, density))
}

pub(super) fn resolve(set: &Set, ready: &Ready) -> Result<Resolved, Error> {
    let for_distance = |distance| ready.table.least_distance().spacing_for(distance, set.warp);
    resolved(set, Spacing::from_density, for_distance, |spacing| {
        spacing.density()
    })
}

/// The spacing and density of a set in space, or its number of points.
pub(super) fn in_space(set: &Set, table: &space::Table) -> Result<Resolved, Error> {
    let of_density = |density| {
        let placed = SpaceSet::new(table.clone()).density(density)?;
        Ok(placed.placement().spacing)
    };
    let for_distance = |distance| table.least_distance().spacing_for(distance, set.warp);
    resolved(set, of_density, for_distance, density_in_space)
}

/// Points per unit of volume.
pub(super) fn density_in_space(spacing: Spacing) -> f64 {
    spacing.get().powi(-3)
}

/// The distance that the coordinates of a set in space within ±`reach` keep.
pub(super) fn least_distance_in_space(set: &Set, points: &SpaceSet, reach: f64) -> f64 {
    // Each coordinate is rounded by at most half a unit in its last place.
    let rounding = 2.0 * 3f64.sqrt() * reach * f64::EPSILON;
    kept(set, (points.least_distance() - rounding).max(0.0))
}

/// A least distance; where one is requested, no more: the spacing is a little wider than this takes.
fn kept(set: &Set, least: f64) -> f64 {
    match set.amount {
        Amount::MinDistance(distance) => least.min(distance),
        _ => least,
    }
}

/// The spacing in the plane of whose grid units a set's points are apart: of a period, whose twin has slightly other
/// ones, not quite its spacing.
pub(super) fn unit(set: &Set, ready: &Ready, spacing: Spacing) -> Spacing {
    let Some(period) = set.period else {
        return spacing;
    };
    let unit = period.side / period.twin.period() as f64;
    Spacing::new(unit / ready.table.alpha().set_side_f64()).unwrap_or(spacing)
}

/// The error of a period that was found when the query was checked.
pub(super) fn no_period(error: strew_core::Error) -> Error {
    tracing::error!(%error, "a table has no such period");
    Error::Internal("a table has no such period")
}

/// The distance that coordinates within ±`reach` keep.
pub(super) fn least_distance(set: &Set, ready: &Ready, spacing: Spacing, reach: f64) -> f64 {
    if set.moves() && set.field.is_some() {
        return 0.0;
    }
    let only = set.kinds.as_ref().and_then(|kinds| kinds.only.as_ref());
    // Where points settle, those of a kind keep the distance of all.
    let only = only.filter(|_| !set.moves());
    let of_kind = only.and_then(|(_, kind)| ready.table.least_distance_of(*kind, *kind));
    let least = of_kind.unwrap_or_else(|| ready.table.least_distance());
    kept(set, least.reported(spacing, set.warp, reach))
}

/// The distances that the points of each two kinds keep from each other, of a kind and itself, too: the names in their
/// order, and the distance of coordinates within ±`reach`.
pub(super) fn kind_distances(
    set: &Set,
    ready: &Ready,
    spacing: Spacing,
    reach: f64,
) -> Vec<KindDistance> {
    let Some(kinds) = set.kinds.as_ref().filter(|_| !set.moves()) else {
        return vec![];
    };
    let wanted = |name: &&str| kinds.only_name().is_none_or(|only| only == *name);
    let names: Vec<&str> = kinds.variants.variants().names().filter(wanted).collect();
    let mut all = vec![];
    for (i, one) in names.iter().enumerate() {
        for other in &names[i..] {
            let (a, b) = (kinds.variants.number(one), kinds.variants.number(other));
            let least = a
                .zip(b)
                .and_then(|(a, b)| ready.table.least_distance_of(a, b));
            all.extend(least.map(|least| KindDistance {
                kinds: [(*one).into(), (*other).into()],
                least_distance: least.reported(spacing, set.warp, reach),
            }));
        }
    }
    all
}

/// Refuses a least distance that coordinates within ±`reach` do not keep.
pub(super) fn check_reach(set: &Set, reach: f64) -> Result<(), Error> {
    let Amount::MinDistance(distance) = set.amount else {
        return Ok(());
    };
    let limit = LeastDistance::RANGE * distance;
    if reach <= limit {
        return Ok(());
    }
    let [far, near] = [reach, limit].map(number);
    let detail = format!(
        "coordinates up to {far} are rounded too coarsely to keep it: it holds within ±{near}"
    );
    let allowed = format!(
        "coordinates within ±{near}, a distance of at least {}, chunks, whose coordinates are relative to \
         their corner, or spacing",
        number(reach / LeastDistance::RANGE)
    );
    Err(set.fault("min_distance", distance, detail, allowed))
}
