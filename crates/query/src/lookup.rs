//! Finding parameters in their tables.

use crate::{
    parameter::{Group, Parameter},
    parameters::PARAMETERS,
    patterns::PATTERN_PARAMETERS,
    space::SPACE_PARAMETERS,
};

impl Parameter {
    pub fn named(name: &str) -> Option<&'static Self> {
        let mut all = PARAMETERS.iter().copied();
        all.find(|parameter| parameter.name == name)
    }

    /// The parameter with a name as some groups have it, else as the plane has it.
    pub fn taken(groups: &[Group], name: &str) -> Option<&'static Self> {
        find(groups, name).or_else(|| Self::named(name))
    }
}

fn all() -> impl Iterator<Item = &'static Parameter> + Clone {
    let tables = PARAMETERS.iter().chain(PATTERN_PARAMETERS);
    tables.chain(SPACE_PARAMETERS).copied()
}

pub(crate) fn find(groups: &[Group], name: &str) -> Option<&'static Parameter> {
    let mut all = all();
    all.find(|parameter| parameter.name == name && groups.contains(&parameter.group))
}

pub fn of(groups: &'static [Group]) -> impl Iterator<Item = &'static Parameter> + Clone {
    all().filter(|parameter| groups.contains(&parameter.group))
}

pub(crate) fn names(groups: &'static [Group]) -> String {
    let names: Vec<&str> = of(groups).map(|parameter| parameter.name).collect();
    match names.as_slice() {
        [] => "no parameters".into(),
        names => names.join(", "),
    }
}

#[cfg(test)]
mod tests {
    use strew_error::unknown;

    use super::*;
    use crate::parameter::groups;

    #[test]
    fn slips_find_the_name() {
        let names = || of(groups::POINTS).map(|parameter| parameter.name);
        for (slip, name) in [
            ("minDistance", "min_distance"),
            ("min-distance", "min_distance"),
            ("sed", "seed"),
            ("box", "bbox"),
            ("Spacing", "spacing"),
        ] {
            let expected = format!("unknown parameter; did you mean `{name}`?");
            assert_eq!(unknown("parameter", slip, names()), expected);
        }
        assert_eq!(unknown("parameter", "color", names()), "unknown parameter");
    }

    #[test]
    fn names_are_unique() {
        for (i, parameter) in PARAMETERS.iter().enumerate() {
            assert!(!PARAMETERS[..i].contains(parameter), "{}", parameter.name);
        }
    }
}
