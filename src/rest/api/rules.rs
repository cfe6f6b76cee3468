//! Rules between parameters, which no schema of a single one can state: published as `x-rules` of an
//! operation, and in words: in its description, or in that of the parameter.

use serde::Serialize;

use crate::service::{
    Encoding,
    query::{
        Group, Parameter, Spread, of as parameters_of,
        parameters::{
            ALIGN, ATTRIBUTES, COUNT, CRS, DECIMALS, EXCEPT, FORMAT, HEIGHTS, MIN_DISTANCE,
            NORMALS, ONLY, PARAMETERS, PERIODIC, PROFILE, SCALE_RANGE, SCALE_RANGES, SIZE, SPREAD,
            SUMMARY, TERRAIN, VARIANT_FIELDS, VARIANTS, WORLD, WORLD_DIGEST,
        },
        patterns::{
            CURSOR as PATTERN_CURSOR, GRID, LIMIT as PATTERN_LIMIT, LIST, MAP as PATTERN_MAP,
            WARP as PATTERN_WARP,
        },
    },
};

/// The spreads of kinds.
const EVEN: &[&str] = &[Spread::Even.name(), Spread::Joint.name()];

/// A rule between parameters.
#[derive(Clone, Debug, Serialize)]
#[serde(tag = "rule", rename_all = "kebab-case")]
pub(super) enum Rule {
    /// Exactly one of some parameters must be given.
    ExactlyOneOf {
        /// Their names.
        parameters: Vec<&'static str>,
        /// A parameter with which none of them needs to be given.
        #[serde(skip_serializing_if = "Option::is_none")]
        unless: Option<&'static str>,
    },
    /// At most one of some parameters may be given.
    AtMostOneOf {
        /// Their names.
        parameters: Vec<&'static str>,
    },
    /// A parameter may only be given if another has one of some values (of a list: among its items).
    OnlyWith {
        /// The parameter.
        parameter: &'static str,
        /// The other one.
        other: &'static str,
        /// Its values.
        values: Vec<&'static str>,
    },
    /// A parameter may only be given if one of some others is, with one of some values (of a list: among its
    /// items; of an empty list: any).
    OnlyWithOneOf {
        /// The parameter.
        parameter: &'static str,
        /// The others.
        others: Vec<Other>,
    },
    /// A parameter may not be given beside some others.
    NotWith {
        /// The parameter.
        parameter: &'static str,
        /// The others.
        others: Vec<&'static str>,
    },
    /// A value of a list needs another parameter.
    Needs {
        /// The list.
        parameter: &'static str,
        /// The value.
        value: &'static str,
        /// The other parameter.
        needs: &'static str,
    },
}

/// A parameter with some values.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Other {
    parameter: &'static str,
    values: Vec<&'static str>,
}

/// Whether a parameter is the first of those that exclude each other, or excludes none.
pub(super) fn is_first_of_its_kind(parameter: &Parameter) -> bool {
    let is_alternative =
        |group: Group| [Group::Region, Group::Period, Group::Amount, Group::Count].contains(&group);
    let mut same = PARAMETERS.iter().filter(|other| {
        let both_amounts = other.group == Group::Amount && parameter.group == Group::Count;
        let both_places = other.group == Group::Region && parameter.group == Group::Period;
        other.group == parameter.group || both_amounts || both_places
    });
    !is_alternative(parameter.group) || same.next().is_some_and(|first| *first == parameter)
}

/// The rules of a request that takes some groups.
pub(super) fn of(groups: &'static [Group]) -> Vec<Rule> {
    let names = |wanted: &[Group]| -> Vec<&'static str> {
        let taken = parameters_of(groups).filter(|parameter| wanted.contains(&parameter.group));
        taken.map(|parameter| parameter.name).collect()
    };
    let world = names(&[Group::World]).first().copied();
    // The world is in the path, and may have an amount.
    let is_of_world = world.is_none() && groups.contains(&Group::WorldPin);
    let mut places = names(&[Group::Region, Group::Period]);
    let is_body = world.is_some() && names(&[Group::Region]).is_empty();
    match groups.contains(&Group::Period) {
        // The region is a member of its own.
        true if is_body => places.insert(0, "region"),
        // Without a region a period is a choice.
        true if names(&[Group::Region]).is_empty() => places.clear(),
        _ => {}
    }
    let is_optional = groups.contains(&Group::Occurrences);
    let alternatives = [
        (places, None),
        (
            if is_optional || is_of_world {
                vec![]
            } else {
                names(&[Group::Amount, Group::Count])
            },
            world,
        ),
    ];
    let mut rules: Vec<Rule> = alternatives
        .into_iter()
        .filter(|(parameters, _)| !parameters.is_empty())
        .map(|(parameters, unless)| Rule::ExactlyOneOf { parameters, unless })
        .collect();
    let only_with =
        |parameter: &Parameter, other: &Parameter, values: Vec<&'static str>| Rule::OnlyWith {
            parameter: parameter.name,
            other: other.name,
            values,
        };
    if groups.contains(&Group::Period) && groups.contains(&Group::Amount) {
        let amounts = [&MIN_DISTANCE, &COUNT].map(|parameter| parameter.name);
        let taken = names(&[Group::Amount, Group::Count]);
        rules.push(Rule::NotWith {
            parameter: PERIODIC.name,
            others: amounts
                .into_iter()
                .filter(|name| taken.contains(name))
                .chain(
                    names(&[Group::Attributes])
                        .into_iter()
                        .filter(|name| *name == VARIANT_FIELDS.name),
                )
                .collect(),
        });
    }
    if groups.contains(&Group::Except) {
        let others = names(&[Group::Count, Group::Period]);
        rules.push(Rule::NotWith {
            parameter: EXCEPT.name,
            others,
        });
    }
    if is_of_world {
        rules.push(Rule::AtMostOneOf {
            parameters: names(&[Group::Amount, Group::Count]),
        });
    } else if groups.contains(&Group::WorldPin) {
        rules.push(Rule::OnlyWithOneOf {
            parameter: WORLD_DIGEST.name,
            others: vec![Other {
                parameter: WORLD.name,
                values: vec![],
            }],
        });
    }
    if is_optional {
        let amounts = names(&[Group::Amount]);
        let beside = |parameter: &Parameter, others: &[&'static str]| Rule::OnlyWithOneOf {
            parameter: parameter.name,
            others: others
                .iter()
                .map(|&parameter| Other {
                    parameter,
                    values: vec![],
                })
                .collect(),
        };
        rules.push(beside(&LIST, &[GRID.name]));
        rules.extend([&PATTERN_LIMIT, &PATTERN_CURSOR].map(|given| beside(given, &[LIST.name])));
        rules.extend([&PROFILE, &PATTERN_MAP, &PATTERN_WARP].map(|given| beside(given, &amounts)));
        rules.push(Rule::AtMostOneOf {
            parameters: amounts,
        });
    }
    if groups.contains(&Group::Attributes) {
        rules.push(only_with(&SCALE_RANGE, &ATTRIBUTES, vec!["scale"]));
        rules.push(only_with(&SCALE_RANGES, &ATTRIBUTES, vec!["scale"]));
        rules.extend(
            [&HEIGHTS, &NORMALS, &ALIGN].map(|given| Rule::OnlyWithOneOf {
                parameter: given.name,
                others: vec![Other {
                    parameter: TERRAIN.name,
                    values: vec![],
                }],
            }),
        );
        let other = |parameter: &Parameter, values: &[&'static str]| Other {
            parameter: parameter.name,
            values: values.into(),
        };
        rules.push(Rule::OnlyWithOneOf {
            parameter: VARIANTS.name,
            others: vec![
                other(&ATTRIBUTES, &["variant"]),
                other(&SPREAD, EVEN),
                other(&SCALE_RANGES, &[]),
            ],
        });
        // Beside layers, which a world may have, it is one of them.
        let layers = world.into_iter().chain(is_body.then_some("layers"));
        let layers = layers.map(|parameter| Other {
            parameter,
            values: vec![],
        });
        if !is_of_world {
            rules.push(Rule::OnlyWithOneOf {
                parameter: ONLY.name,
                others: [other(&SPREAD, EVEN)].into_iter().chain(layers).collect(),
            });
        }
        rules.push(only_with(
            &VARIANT_FIELDS,
            &SPREAD,
            vec![Spread::Even.name()],
        ));
        rules.extend(EVEN.iter().map(|value| Rule::Needs {
            parameter: SPREAD.name,
            value,
            needs: VARIANTS.name,
        }));
        rules.push(Rule::Needs {
            parameter: ATTRIBUTES.name,
            value: "variant",
            needs: VARIANTS.name,
        });
    }
    if groups.contains(&Group::Output) {
        let formats = |fits: fn(Encoding) -> bool| {
            let fitting = Encoding::ALL.into_iter().filter(|encoding| fits(*encoding));
            fitting.map(Encoding::name).collect()
        };
        rules.push(only_with(&DECIMALS, &FORMAT, formats(Encoding::is_text)));
        rules.push(only_with(&SIZE, &FORMAT, formats(Encoding::is_picture)));
        rules.push(only_with(&SUMMARY, &FORMAT, formats(Encoding::has_summary)));
        rules.push(only_with(&CRS, &FORMAT, formats(Encoding::has_crs)));
    }
    rules
}

/// The rules that are about no single parameter, as a list in Markdown below a description.
pub(super) fn below(about: &str, rules: &[Rule]) -> String {
    let shared = rules.iter().filter_map(Rule::of_several);
    let items: String = shared.map(|words| format!("\n- {words}")).collect();
    match items.is_empty() {
        true => about.into(),
        false => format!("{about}\n{items}"),
    }
}

/// The rules about a parameter, as sentences behind its description.
pub(super) fn at(parameter: &str, rules: &[Rule]) -> String {
    let sentences = rules.iter().filter_map(|rule| rule.of_one(parameter));
    sentences.map(|words| format!(" {words}")).collect()
}

impl Rule {
    fn of_several(&self) -> Option<String> {
        match self {
            Self::ExactlyOneOf { parameters, unless } => {
                let unless =
                    unless.map_or_else(String::new, |other| format!(", unless {other} is"));
                let parameters = parameters.join(", ");
                Some(format!(
                    "Exactly one of {parameters} must be given{unless}."
                ))
            }
            Self::AtMostOneOf { parameters } => Some(format!(
                "At most one of {} may be given.",
                parameters.join(", ")
            )),
            _ => None,
        }
    }

    fn of_one(&self, wanted: &str) -> Option<String> {
        match self {
            Self::OnlyWith {
                parameter,
                other,
                values,
            } if *parameter == wanted => Some(format!("Only with {other} {}.", values.join(", "))),
            Self::OnlyWithOneOf { parameter, others } if *parameter == wanted => {
                let others = others.iter().map(|other| {
                    let words = [&[other.parameter], &other.values[..]].concat();
                    words.join(" ").replace("even joint", "even or joint")
                });
                let others: Vec<String> = others.collect();
                Some(format!("Only with {}.", others.join(", ")))
            }
            Self::NotWith { parameter, others } if *parameter == wanted && !others.is_empty() => {
                Some(format!("Not together with {}.", others.join(", ")))
            }
            Self::Needs {
                parameter,
                value,
                needs,
            } if *parameter == wanted => Some(format!("`{value}` needs {needs}.")),
            _ => None,
        }
    }
}
