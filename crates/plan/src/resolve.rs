//! Amounts of points on their tables, without a region.

use strew_catalog::Ready;
use strew_core::{ErrorKind, LeastDistance, Spacing};
use strew_error::{Error, number};
use strew_query::{Amount, KindDistance, Parameter, Set, parameters};

#[derive(Clone, Copy, Debug)]
pub(super) enum Resolved {
    /// A mean spacing, and the density as requested.
    Known(Spacing, f64),
    Count(u64),
}

pub(super) fn resolve(set: &Set, ready: &Ready) -> Result<Resolved, Error> {
    let fault = |parameter: &Parameter, value: f64, detail: String| {
        set.fault(parameter.name, value, detail, parameter.allowed())
    };
    let wrong = |parameter, value: f64| {
        move |error: strew_core::Error| fault(parameter, value, error.to_string())
    };
    match set.amount {
        Amount::Density(density) => {
            let spacing =
                Spacing::from_density(density).map_err(wrong(&parameters::DENSITY, density))?;
            Ok(Resolved::Known(spacing, density))
        }
        Amount::Spacing(value) => {
            let spacing = Spacing::new(value).map_err(wrong(&parameters::SPACING, value))?;
            Ok(Resolved::Known(spacing, spacing.density()))
        }
        Amount::MinDistance(distance) if set.moves() && set.field.is_some() => {
            let detail = "not with a field: points settle";
            let allowed = "density, spacing or count; or settle=0";
            Err(set.fault(parameters::MIN_DISTANCE.name, distance, detail, allowed))
        }
        Amount::MinDistance(distance) => {
            let least = ready.table.least_distance();
            let spacing = least.spacing_for(distance, set.warp).map_err(|error| {
                let detail = match error.kind() {
                    ErrorKind::NoLeastDistance => {
                        format!("profile `{}`: {}", set.entry.key.profile, error.problem())
                    }
                    _ => error.to_string(),
                };
                fault(&parameters::MIN_DISTANCE, distance, detail)
            })?;
            Ok(Resolved::Known(spacing, spacing.density()))
        }
        Amount::Count(count) => Ok(Resolved::Count(count)),
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
    let least = least.reported(spacing, set.warp, reach);
    match set.amount {
        // The spacing is a little wider than this takes.
        Amount::MinDistance(distance) => least.min(distance),
        _ => least,
    }
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
