//! Rules between parameters, which no schema of a single one can state: published as `x-rules` of an
//! operation, and in words: in its description, or in that of the parameter.

use serde::Serialize;
use strew_encode::Encoding;
use strew_query::{
    Group, Parameter, SPACE_PARAMETERS, of as parameters_of,
    parameters::{FORMAT, ONLY, PARAMETERS, PROFILE, WORLD, WORLD_DIGEST},
    patterns::{
        CURSOR as PATTERN_CURSOR, GRID, LIMIT as PATTERN_LIMIT, LIST, MAP as PATTERN_MAP,
        WARP as PATTERN_WARP,
    },
    rules::{self, Condition, RULES},
};

#[derive(Clone, Debug, Serialize)]
#[serde(tag = "rule", rename_all = "kebab-case")]
pub(super) enum Rule {
    /// Exactly one of some parameters must be given.
    ExactlyOneOf {
        parameters: Vec<&'static str>,
        /// A parameter with which none of them needs to be given.
        #[serde(skip_serializing_if = "Option::is_none")]
        unless: Option<&'static str>,
    },
    /// At most one of some parameters may be given.
    AtMostOneOf { parameters: Vec<&'static str> },
    /// A parameter may only be given if another has one of some values (of a list: among its items).
    OnlyWith {
        parameter: &'static str,
        other: &'static str,
        values: Vec<&'static str>,
    },
    /// A parameter may only be given if one of some others is, with one of some values (of a list: among its
    /// items; of an empty list: any).
    OnlyWithOneOf {
        parameter: &'static str,
        others: Vec<Other>,
    },
    /// A parameter may not be given beside some others.
    NotWith {
        parameter: &'static str,
        others: Vec<&'static str>,
    },
    /// A value of a list needs another parameter.
    Needs {
        parameter: &'static str,
        value: &'static str,
        needs: &'static str,
    },
}

#[derive(Clone, Debug, Serialize)]
pub(super) struct Other {
    parameter: &'static str,
    values: Vec<&'static str>,
}

impl Other {
    const fn any(parameter: &'static str) -> Self {
        let values = vec![];
        Self { parameter, values }
    }
}

/// Whether a parameter is the first of those that exclude each other, or excludes none.
pub(super) fn is_first_of_its_kind(parameter: &Parameter) -> bool {
    const ALTERNATIVES: [Group; 5] = [
        Group::Region,
        Group::Volume,
        Group::Period,
        Group::Amount,
        Group::Count,
    ];
    let is_alternative = |group: Group| ALTERNATIVES.contains(&group);
    let mut same = PARAMETERS.iter().chain(SPACE_PARAMETERS).filter(|other| {
        let both_amounts = other.group == Group::Amount && parameter.group == Group::Count;
        let both_places = other.group == Group::Region && parameter.group == Group::Period;
        other.group == parameter.group || both_amounts || both_places
    });
    !is_alternative(parameter.group) || same.next().is_some_and(|first| *first == parameter)
}

pub(super) fn of(groups: &'static [Group]) -> Vec<Rule> {
    let names = |wanted: &[Group]| -> Vec<&'static str> {
        let taken = parameters_of(groups).filter(|parameter| wanted.contains(&parameter.group));
        taken.map(|parameter| parameter.name).collect()
    };
    let world = names(&[Group::World]).first().copied();
    // The world is in the path, and may have an amount.
    let is_of_world = world.is_none() && groups.contains(&Group::WorldPin);
    let mut places = names(&[Group::Region, Group::Period, Group::Volume]);
    let is_body = world.is_some() && names(&[Group::Region]).is_empty();
    match groups.contains(&Group::Period) {
        // The region is a member of its own.
        true if is_body => places.insert(0, "region"),
        // Without a region a period is a choice.
        true if names(&[Group::Region]).is_empty() => places.clear(),
        _ => {}
    }
    let is_optional = groups.contains(&Group::Occurrences);
    let amounts = match is_optional || is_of_world {
        true => vec![],
        false => names(&[Group::Amount, Group::Count]),
    };
    let alternatives = [(places, None), (amounts, world)];
    let mut rules: Vec<Rule> = alternatives
        .into_iter()
        .filter(|(parameters, _)| !parameters.is_empty())
        .map(|(parameters, unless)| Rule::ExactlyOneOf { parameters, unless })
        .collect();
    let mut shared = RULES
        .iter()
        .filter_map(|rule| published(rule, groups))
        .peekable();
    // Those about places and amounts come first.
    while let Some(rule) = shared.next_if(|rule| matches!(rule, Rule::NotWith { .. })) {
        join(&mut rules, rule);
    }
    if is_of_world {
        rules.push(Rule::AtMostOneOf {
            parameters: names(&[Group::Amount, Group::Count]),
        });
    } else if groups.contains(&Group::WorldPin) {
        rules.push(Rule::OnlyWithOneOf {
            parameter: WORLD_DIGEST.name,
            others: vec![Other::any(WORLD.name)],
        });
    }
    if is_optional {
        let amounts = names(&[Group::Amount]);
        let beside = |parameter: &Parameter, others: &[&'static str]| Rule::OnlyWithOneOf {
            parameter: parameter.name,
            others: others.iter().copied().map(Other::any).collect(),
        };
        rules.push(beside(&LIST, &[GRID.name]));
        rules.extend([&PATTERN_LIMIT, &PATTERN_CURSOR].map(|given| beside(given, &[LIST.name])));
        rules.extend([&PROFILE, &PATTERN_MAP, &PATTERN_WARP].map(|given| beside(given, &amounts)));
        rules.push(Rule::AtMostOneOf {
            parameters: amounts,
        });
    }
    for mut rule in shared {
        // Beside layers, which a world may have, it is one of them.
        if let Rule::OnlyWithOneOf { parameter, others } = &mut rule
            && *parameter == ONLY.name
        {
            let layers = world.into_iter().chain(is_body.then_some("layers"));
            others.extend(layers.map(Other::any));
        }
        if !(is_of_world && rule.words().0 == Some(ONLY.name)) {
            join(&mut rules, rule);
        }
    }
    rules
}

/// Adds a rule; what a parameter may not be given beside is listed in one.
fn join(rules: &mut Vec<Rule>, rule: Rule) {
    if let (
        Some(Rule::NotWith { parameter, others }),
        Rule::NotWith {
            parameter: same,
            others: more,
        },
    ) = (rules.last_mut(), &rule)
        && parameter == same
    {
        others.extend(more);
        return;
    }
    rules.push(rule);
}

fn published(rule: &rules::Rule, groups: &'static [Group]) -> Option<Rule> {
    let is_taken = |parameter: &Parameter| groups.contains(&parameter.group);
    let parameter = Some(rule.parameter)
        .filter(|parameter| is_taken(parameter))?
        .name;
    Some(match rule.condition {
        Condition::With([only], _) if !only.values.is_empty() && parameter != ONLY.name => {
            Rule::OnlyWith {
                parameter,
                other: only.parameter.name,
                values: only.values.into(),
            }
        }
        Condition::With(others, _) => Rule::OnlyWithOneOf {
            parameter,
            others: others
                .iter()
                .map(|other| Other {
                    parameter: other.parameter.name,
                    values: other.values.into(),
                })
                .collect(),
        },
        Condition::Without(other, ..) => Rule::NotWith {
            parameter,
            others: vec![Some(other).filter(|other| is_taken(other))?.name],
        },
        Condition::Needs(value, needed) => Rule::Needs {
            parameter,
            value,
            needs: needed.name,
        },
        Condition::Format(fits) => Rule::OnlyWith {
            parameter,
            other: FORMAT.name,
            values: (Encoding::ALL.iter().copied())
                .filter(|encoding| fits(*encoding))
                .map(Encoding::name)
                .collect(),
        },
    })
}

/// The rules that are about no single parameter, as a list in Markdown below a description.
pub(super) fn below(about: &str, rules: &[Rule]) -> String {
    let all = rules.iter().map(Rule::words);
    let shared = all.filter(|(parameter, _)| parameter.is_none());
    let items: String = shared.map(|(_, words)| format!("\n- {words}")).collect();
    match items.is_empty() {
        true => about.into(),
        false => format!("{about}\n{items}"),
    }
}

/// The rules about a parameter, as sentences behind its description.
pub(super) fn at(parameter: &str, rules: &[Rule]) -> String {
    let all = rules.iter().map(Rule::words);
    let its = all.filter(|(of, _)| *of == Some(parameter));
    its.map(|(_, words)| format!(" {words}")).collect()
}

impl Rule {
    /// The parameter that it is about, if it is about one, and what it says.
    fn words(&self) -> (Option<&'static str>, String) {
        match self {
            Self::ExactlyOneOf { parameters, unless } => {
                let unless =
                    unless.map_or_else(String::new, |other| format!(", unless {other} is"));
                let parameters = parameters.join(", ");
                let words = format!("Exactly one of {parameters} must be given{unless}.");
                (None, words)
            }
            Self::AtMostOneOf { parameters } => {
                let parameters = parameters.join(", ");
                (None, format!("At most one of {parameters} may be given."))
            }
            Self::OnlyWith {
                parameter,
                other,
                values,
            } => {
                let words = format!("Only with {other} {}.", values.join(", "));
                (Some(parameter), words)
            }
            Self::OnlyWithOneOf { parameter, others } => {
                let others = others.iter().map(|other| {
                    let words = [&[other.parameter], &other.values[..]].concat();
                    words.join(" ").replace("even joint", "even or joint")
                });
                let others: Vec<String> = others.collect();
                (Some(parameter), format!("Only with {}.", others.join(", ")))
            }
            Self::NotWith { parameter, others } => {
                let words = format!("Not together with {}.", others.join(", "));
                (Some(parameter), words)
            }
            Self::Needs {
                parameter,
                value,
                needs,
            } => (Some(parameter), format!("`{value}` needs {needs}.")),
        }
    }
}
