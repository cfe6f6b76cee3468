//! Flags made of the list of parameters, so that the command line has every one that an address has,
//! under the same name and with the same words.

use std::{fmt, marker::PhantomData};

use clap::{Arg, ArgAction, ArgMatches, Command, FromArgMatches};

use crate::service::{
    Encoding,
    query::{
        LOOKS_NAMES, PARAMETERS, Parameter, Parameters, REGION_NAMES, SET_NAMES, WINDOW_NAMES,
    },
};

/// Which parameters a command takes.
pub(super) trait Takes: fmt::Debug + Send + Sync + 'static {
    /// Whether it takes the one of this name.
    fn takes(name: &str) -> bool;
}

const NEAR: [&str; 3] = ["at", "k", "radius"];
const PARTS: &str = "parts";

/// What points there are.
fn is_of_set(name: &str) -> bool {
    SET_NAMES.contains(&name)
}

/// A query with its looks, as `GET /v1/points` has them.
#[derive(Debug)]
pub(super) struct Answered;
/// A query of which only the number of points matters, as for `GET /v1/count`.
#[derive(Debug)]
pub(super) struct Counted;
/// A query and a number of parts.
#[derive(Debug)]
pub(super) struct Parted;
/// A set without a region, as for `GET /v1/points/{id}`.
#[derive(Debug)]
pub(super) struct Single;
/// A set and a place, as for `GET /v1/nearest`.
#[derive(Debug)]
pub(super) struct Near;
/// A box and a set; its table is named by another flag.
#[derive(Debug)]
pub(super) struct Measured;

impl Takes for Answered {
    fn takes(name: &str) -> bool {
        is_of_set(name)
            || [REGION_NAMES, WINDOW_NAMES, LOOKS_NAMES]
                .concat()
                .contains(&name)
    }
}

impl Takes for Counted {
    fn takes(name: &str) -> bool {
        is_of_set(name) || [REGION_NAMES, WINDOW_NAMES].concat().contains(&name)
    }
}

impl Takes for Parted {
    fn takes(name: &str) -> bool {
        name == PARTS || Answered::takes(name)
    }
}

impl Takes for Single {
    fn takes(name: &str) -> bool {
        is_of_set(name) && name != "count"
    }
}

impl Takes for Near {
    fn takes(name: &str) -> bool {
        Single::takes(name) || NEAR.contains(&name)
    }
}

impl Takes for Measured {
    fn takes(name: &str) -> bool {
        let is_other = ["table", "attributes", "scale_range", "variants"].contains(&name);
        name == "bbox" || is_of_set(name) && !is_other
    }
}

/// The flags of the parameters that `T` takes, as they were given.
pub(super) struct Flags<T> {
    given: Vec<(&'static str, String)>,
    takes: PhantomData<T>,
}

impl<T> fmt::Debug for Flags<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Flags").field(&self.given).finish()
    }
}

impl<T> Flags<T> {
    /// The given ones as parameters, as far as they are wanted.
    pub(super) fn parameters(&self, wanted: impl Fn(&str) -> bool) -> Parameters {
        let given = self.given.iter().filter(|(name, _)| wanted(name));
        Parameters::of(given.map(|(name, text)| (*name, Some(text.clone()))))
    }

    /// Those that are given, with their values.
    pub(super) fn given(&self) -> impl Iterator<Item = (&'static str, &str)> {
        self.given.iter().map(|(name, text)| (*name, text.as_str()))
    }

    /// The value of one, if it is given.
    pub(super) fn get(&self, wanted: &str) -> Option<&str> {
        let mut given = self.given();
        given.find_map(|(name, text)| (name == wanted).then_some(text))
    }
}

/// The flag of a parameter.
pub(super) fn flag(name: &str) -> String {
    format!("--{}", name.replace('_', "-"))
}

/// Under which title `--help` lists it.
fn heading(name: &str) -> &'static str {
    if REGION_NAMES.contains(&name) || NEAR.contains(&name) {
        WHERE
    } else if WINDOW_NAMES.contains(&name) || name == PARTS {
        "Which of the points"
    } else if LOOKS_NAMES.contains(&name) {
        "How the answer looks"
    } else {
        "Which points there are"
    }
}

/// The title of the flags that say where.
pub(super) const WHERE: &str = "Where";

/// What a flag means where it is not quite what the parameter means: about, default.
fn own_words(name: &str) -> Option<(String, &'static str)> {
    match name {
        "format" => Some((
            format!(
                "The format of the output: {} or {}.",
                Encoding::ALL.map(Encoding::name).join(", "),
                Encoding::Parquet.name()
            ),
            "what the output's name ends with, else json",
        )),
        "limit" => Some((
            "How many points to give at most. The cursor of the rest is said beforehand.".into(),
            "all",
        )),
        "cursor" => Some((
            "Where an earlier answer to the same query ended.".into(),
            "the beginning",
        )),
        _ => None,
    }
}

fn argument(parameter: &'static Parameter) -> Arg {
    let name = parameter.name;
    let (about, default) = own_words(name).map_or_else(
        || (parameter.about.to_owned(), parameter.default),
        |(about, default)| (about, Some(default)),
    );
    let default = default.map_or(String::new(), |text| format!(" [default: {text}]"));
    let short = match about.split_once(". ") {
        Some((first, _)) if name != "format" => first,
        _ => about.trim_end_matches('.'),
    };
    let allowed = parameter.allowed;
    let long = format!("{about}{default}\n\nAllowed: {allowed}");
    let is_name = ["profile", "map", "format", "attributes", "variants"].contains(&name);
    Arg::new(name)
        .long(name.replace('_', "-"))
        .aliases(name.contains('_').then_some(name))
        .value_name(value_name(name))
        .help(format!("{short}{default}"))
        .long_help(long)
        .help_heading(heading(name))
        .action(ArgAction::Set)
        // Negative numbers, also those that are wrong: the query says what is.
        .allow_hyphen_values(!is_name)
}

fn value_name(name: &str) -> &'static str {
    match name {
        "bbox" => "MINX,MINY,MAXX,MAXY",
        "circle" => "X,Y,RADIUS",
        "polygon" => "X1,Y1,X2,Y2,…",
        "at" => "X,Y",
        "scale_range" => "MIN,MAX",
        "variants" => "NAME:WEIGHT,…",
        "attributes" => "NAME,…",
        "table" => "DIGEST",
        "profile" | "map" | "format" => "NAME",
        "cursor" => "CURSOR",
        "size" => "PIXELS",
        "warp" => "off|on|STRENGTH",
        _ => "NUMBER",
    }
}

impl<T: Takes> clap::Args for Flags<T> {
    fn augment_args(command: Command) -> Command {
        let taken = PARAMETERS.iter().filter(|p| T::takes(p.name));
        command.args(taken.map(argument))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl<T: Takes> FromArgMatches for Flags<T> {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let taken = PARAMETERS.iter().filter(|p| T::takes(p.name));
        let given = taken.filter_map(|parameter| {
            let text: &String = matches.get_one(parameter.name)?;
            Some((parameter.name, text.clone()))
        });
        Ok(Self {
            given: given.collect(),
            takes: PhantomData,
        })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_parameter_is_a_flag_of_some_command() {
        for Parameter { name, .. } in PARAMETERS {
            let near = ["at", "k", "radius"].contains(name);
            let parts = *name == "parts";
            assert_eq!(Answered::takes(name), !near && !parts, "{name}");
            assert_eq!(Parted::takes(name), !near, "{name}");
            assert!(!near || Near::takes(name), "{name}");
            let looks = LOOKS_NAMES.contains(name);
            assert_eq!(
                Counted::takes(name),
                Answered::takes(name) && !looks,
                "{name}"
            );
        }
    }
}
