//! Sets of messages as values of parameters, and back.

use std::sync::Arc;

use strew_error::Faults;
use strew_query::{Group, Parameter, Value, Values, groups};

use super::{
    field::{document, message_of},
    proto::{Heights, PointSet, ScaleRange, point_set::Amount},
};

// Made from the contract: `fields`, the values of a message by name, and `put`, which sets one.
include!("generated/sets.rs");

/// The values of a set, with `path` before names in faults; an absent one has none.
pub(super) fn values(set: Option<&PointSet>, groups: &'static [Group], path: &str) -> Values {
    let mut values = Values::new(groups, path);
    let fields = set.map(fields).unwrap_or_default();
    let known = fields
        .into_iter()
        .filter_map(|(name, value)| Some((Parameter::taken(groups, name)?, value)));
    for (parameter, value) in known {
        values.add_value(parameter, value);
    }
    values
}

/// The message of some values.
pub(super) fn message(values: impl IntoIterator<Item = (&'static Parameter, Value)>) -> PointSet {
    let mut set = PointSet::default();
    for (parameter, value) in values {
        put(&mut set, parameter.name, value);
    }
    set
}

/// Names fields of sets by their path in messages: `layers[2].seed` is `layers[2].set.seed`.
pub(super) fn in_messages(faults: Faults) -> Faults {
    faults.rename(|field| {
        let (layer, rest) = match field.split_once("].") {
            Some((layer, rest)) if layer.starts_with("layers[") => (format!("{layer}]."), rest),
            _ => (String::new(), field),
        };
        // A part of a value has the value's name before it.
        let name = rest.split(['.', '[']).next().unwrap_or_default();
        let parameter = Parameter::named(name);
        match parameter.filter(|parameter| {
            parameter.group == Group::Period || groups::SET.contains(&parameter.group)
        }) {
            Some(_) => format!("{layer}set.{rest}"),
            None => field.into(),
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use strew_query::of;

    #[test]
    fn every_parameter_of_a_set_has_its_field() {
        for parameter in of(groups::SET) {
            let value = parameter.shape.read(parameter.example).expect("valid");
            let set = message([(parameter, value.clone())]);
            assert_eq!(
                fields(&set),
                [(parameter.name, value)],
                "{}",
                parameter.name
            );
        }
    }

    #[test]
    fn faults_name_fields_by_their_paths() {
        for (field, expected) in [
            ("seed", "set.seed"),
            ("layers[3].spacing", "layers[3].set.spacing"),
            ("layers[3].name", "layers[3].name"),
            ("field.min[2].noise", "set.field.min[2].noise"),
            ("layers[3].field.name", "layers[3].set.field.name"),
            ("limit", "limit"),
            ("region.bbox", "region.bbox"),
        ] {
            let fault = strew_error::Fault::new(field, 1, "wrong", "right");
            let renamed = in_messages(fault.into());
            assert_eq!(renamed.as_slice()[0].field, expected);
        }
    }
}
