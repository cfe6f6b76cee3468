//! Rules between parameters, which no shape of a single one can state: each stands here once, is evaluated when a set
//! is checked, and is published with the operations that take its parameters.

use strew_encode::Encoding;
use strew_error::{Checked, Fault};

use crate::{
    parameter::Parameter,
    parameters::{
        ALIGN, ATTRIBUTES, COUNT, CRS, DECIMALS, EXCEPT, HEIGHTS, MIN_DISTANCE, NORMALS, ONLY,
        PERIODIC, SCALE_RANGE, SCALE_RANGES, SIZE, SPREAD, SUMMARY, TERRAIN, VARIANT_FIELDS,
        VARIANTS,
    },
    spread::Spread,
    value::Value,
    values::Values,
};

/// A rule about a parameter.
#[derive(Clone, Copy, Debug)]
pub struct Rule {
    pub parameter: &'static Parameter,
    pub condition: Condition,
}

#[derive(Clone, Copy, Debug)]
pub enum Condition {
    /// One of some others is present. The words of the fault if none is.
    With(&'static [Other], &'static str),
    /// Another one is absent. The words of its fault, and what is allowed instead, unless its own words include it.
    Without(&'static Parameter, &'static str, Option<&'static str>),
    /// With a value, or a list that has it, another one must be present.
    Needs(&'static str, &'static Parameter),
    Format(fn(Encoding) -> bool),
}

/// A parameter with one of some values, or a list with one of them among its items; with any value if there are none.
#[derive(Clone, Copy, Debug)]
pub struct Other {
    pub parameter: &'static Parameter,
    pub values: &'static [&'static str],
}

const fn other(parameter: &'static Parameter, values: &'static [&'static str]) -> Other {
    Other { parameter, values }
}

const fn rule(parameter: &'static Parameter, condition: Condition) -> Rule {
    Rule {
        parameter,
        condition,
    }
}

const fn without(
    parameter: &'static Parameter,
    other: &'static Parameter,
    words: &'static str,
    allowed: Option<&'static str>,
) -> Rule {
    rule(parameter, Condition::Without(other, words, allowed))
}

const EVEN: &[&str] = &[Spread::Even.name(), Spread::Joint.name()];

const GROUND: Condition =
    Condition::With(&[other(&TERRAIN, &[])], "has no effect without a terrain");
const SCALED: Condition = Condition::With(
    &[other(&ATTRIBUTES, &["scale"])],
    "has no effect without the attribute scale",
);
const VARIED: Condition = Condition::With(
    &[
        other(&ATTRIBUTES, &["variant"]),
        other(&SPREAD, EVEN),
        other(&SCALE_RANGES, &[]),
    ],
    "has no effect without the attribute variant",
);
const SPREAD_EVENLY: Condition =
    Condition::With(&[other(&SPREAD, EVEN)], "has no effect with spread chance");
const EVEN_ALONE: Condition = Condition::With(
    &[other(&SPREAD, &[Spread::Even.name()])],
    "needs spread even",
);
const AMOUNT: Option<&str> = Some("density or spacing, from which the side follows");
const NO_COUNT: Option<&str> = Some("density, spacing or min_distance");
const REPEATS: &str = "not with periodic: shares that vary do not repeat";
const REMAIN: &str = "not with except: the excepted points decide how many remain";
const COPIES: &str = "not with except: a point of a period is in all of its copies";

/// All rules, in the order in which they are published.
pub static RULES: &[Rule] = &[
    without(&PERIODIC, &MIN_DISTANCE, "not with periodic", AMOUNT),
    without(&PERIODIC, &COUNT, "not with periodic", AMOUNT),
    without(&PERIODIC, &VARIANT_FIELDS, REPEATS, None),
    without(&EXCEPT, &COUNT, REMAIN, NO_COUNT),
    without(&EXCEPT, &PERIODIC, COPIES, Some("a region")),
    rule(&SCALE_RANGE, SCALED),
    rule(&SCALE_RANGES, SCALED),
    without(&SCALE_RANGE, &SCALE_RANGES, "not beside scale_range", None),
    rule(&HEIGHTS, GROUND),
    rule(&NORMALS, GROUND),
    rule(&ALIGN, GROUND),
    rule(&VARIANTS, VARIED),
    rule(&ONLY, SPREAD_EVENLY),
    rule(&VARIANT_FIELDS, EVEN_ALONE),
    rule(&SPREAD, Condition::Needs(Spread::Even.name(), &VARIANTS)),
    rule(&SPREAD, Condition::Needs(Spread::Joint.name(), &VARIANTS)),
    rule(&ATTRIBUTES, Condition::Needs("variant", &VARIANTS)),
    rule(&DECIMALS, Condition::Format(|of| of.traits().is_text)),
    rule(&SIZE, Condition::Format(|of| of.traits().is_picture)),
    rule(&SUMMARY, Condition::Format(|of| of.traits().has_summary)),
    rule(&CRS, Condition::Format(|of| of.traits().has_crs)),
];

/// The rules about a parameter.
fn about(parameter: &Parameter) -> impl Iterator<Item = &'static Condition> {
    let rules = RULES
        .iter()
        .filter(move |rule| rule.parameter.name == parameter.name);
    rules.map(|rule| &rule.condition)
}

/// Refuses a parameter that is given against a rule about it. Rules about formats are evaluated once the format is
/// settled.
pub(crate) fn check(values: &Values, parameter: &'static Parameter) -> Checked<()> {
    match values.has(parameter) {
        true => check_as_given(values, parameter),
        false => Ok(()),
    }
}

/// As [`check`] of a parameter that is given, here or for all layers.
pub(crate) fn check_as_given(values: &Values, parameter: &'static Parameter) -> Checked<()> {
    for condition in about(parameter) {
        match *condition {
            Condition::With(others, detail) => {
                if !others
                    .iter()
                    .any(|other| is_given(values, other.parameter, other.values))
                {
                    return Err(values.fault(parameter, detail).into());
                }
            }
            Condition::Without(other, detail, allowed) => {
                if values.has(other) {
                    let allowed = allowed.map_or_else(|| other.allowed(), Into::into);
                    let fault = values.fault(other, detail);
                    return Err(Fault { allowed, ..fault }.into());
                }
            }
            Condition::Needs(value, needed) => {
                if !values.has(needed) && is_given(values, parameter, &[value]) {
                    return Err(values.missing(needed).into());
                }
            }
            Condition::Format(_) => {}
        }
    }
    Ok(())
}

/// Refuses the value of a parameter that has no effect in a format.
pub(crate) fn check_format(
    parameter: &Parameter,
    value: Option<String>,
    encoding: Encoding,
) -> Checked<()> {
    let Some(value) = value else { return Ok(()) };
    for condition in about(parameter) {
        if let Condition::Format(fits) = *condition
            && !fits(encoding)
        {
            let detail = format!("has no effect in the format {}", encoding.name());
            let allowed = format!("the formats {}", Encoding::names_where(fits));
            return Err(Fault::new(parameter.name, value, detail, allowed).into());
        }
    }
    Ok(())
}

/// Whether a parameter is given with one of some values, or with any if none are named. A value that could not be read
/// has a fault of its own.
fn is_given(values: &Values, parameter: &Parameter, wanted: &[&str]) -> bool {
    if !values.has(parameter) {
        return false;
    }
    let mut given = values.given();
    match given.find(|(known, _)| *known == parameter) {
        None => true,
        _ if wanted.is_empty() => true,
        Some((_, Value::Text(text))) => wanted.contains(&text.as_str()),
        Some((_, Value::Names(names))) => names.iter().any(|name| wanted.contains(&name.as_str())),
        Some(_) => false,
    }
}
