//! Amounts of points on their tables, without a region.

use strew_core::{ErrorKind, Spacing};

use super::{
    Error,
    cache::Ready,
    query::{Amount, Parameter, Set, parameters},
};

/// What an amount is on its table; `None` for a count, which needs a region.
pub(super) fn resolve(set: &Set, ready: &Ready) -> Result<Option<(Spacing, f64)>, Error> {
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
            Ok(Some((spacing, density)))
        }
        Amount::Spacing(value) => {
            let spacing = Spacing::new(value).map_err(wrong(&parameters::SPACING, value))?;
            Ok(Some((spacing, spacing.density())))
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
            Ok(Some((spacing, spacing.density())))
        }
        Amount::Count(_) => Ok(None),
    }
}

/// The least distance between points of a set, its warp included.
pub(super) fn least_distance(set: &Set, ready: &Ready, spacing: Spacing) -> f64 {
    ready.table.least_distance().with_warp(set.warp) * spacing.get()
}
