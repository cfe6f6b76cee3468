//! The values of a set with everything filled in.

use crate::{parameter::Parameter, parameters::PARAMETERS, value::Value, values::Values};

pub(crate) type Resolved = Vec<(&'static Parameter, Value)>;

/// The given values that answers echo. Fields are there by their names; others are known by their digests.
pub(crate) fn of(values: &Values) -> Resolved {
    let echoed = values.given().filter(|(parameter, _)| parameter.is_echoed);
    let named = echoed.filter_map(|(parameter, value)| Some((parameter, value.named()?)));
    named.collect()
}

/// Replaces values, or removes them, and puts all in the order of the table.
pub(crate) fn replace(
    all: &mut Resolved,
    others: impl IntoIterator<Item = (&'static Parameter, Option<Value>)>,
) {
    for (parameter, value) in others {
        let known = all.iter().position(|(known, _)| *known == parameter);
        match (known, value) {
            (Some(place), Some(value)) => all[place].1 = value,
            (Some(place), None) => drop(all.remove(place)),
            (None, value) => all.extend(value.map(|value| (parameter, value))),
        }
    }
    all.sort_by_cached_key(|(parameter, _)| {
        let mut table = PARAMETERS.iter();
        table.position(|known| known == parameter)
    });
}
