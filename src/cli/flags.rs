//! Flags made of the list of parameters, so that the command line has every one that an address has,
//! under the same name and with the same words.

use std::{fmt, marker::PhantomData};

use clap::{Arg, ArgAction, ArgMatches, Command, FromArgMatches};

use super::candidates;
use crate::service::{
    Encoding,
    query::{
        Group, Parameter, Shape, Values, groups,
        parameters::{self, PARAMETERS},
    },
};

/// Which parameters a command takes.
pub(super) trait Takes: fmt::Debug + Send + Sync + 'static {
    /// By their groups.
    const GROUPS: &'static [Group];

    /// Whether it takes a parameter.
    fn takes(parameter: &Parameter) -> bool {
        Self::GROUPS.contains(&parameter.group)
    }
}

/// A query with its output, as `GET /v1/points` takes it.
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
/// A table whose periods are listed, as for `GET /v1/periods`.
#[derive(Debug)]
pub(super) struct Listed;
/// A table.
#[derive(Debug)]
pub(super) struct Tabled;
/// A set and a place, as for `GET /v1/nearest`.
#[derive(Debug)]
pub(super) struct Near;
/// A set of points, or a world, in the chunks of a box.
#[derive(Debug)]
pub(super) struct Exported;
/// A box and a set; its table is named by another flag.
#[derive(Debug)]
pub(super) struct Measured;

impl Takes for Answered {
    const GROUPS: &'static [Group] = groups::POINTS;
}

impl Takes for Counted {
    const GROUPS: &'static [Group] = groups::COUNT;
}

impl Takes for Parted {
    const GROUPS: &'static [Group] = &[
        Group::Split,
        Group::Region,
        Group::Period,
        Group::Amount,
        Group::Count,
        Group::World,
        Group::WorldPin,
        Group::Profile,
        Group::Table,
        Group::Points,
        Group::Except,
        Group::Attributes,
        Group::Window,
        Group::Output,
    ];
}

impl Takes for Single {
    const GROUPS: &'static [Group] = groups::SINGLE;
}

impl Takes for Listed {
    const GROUPS: &'static [Group] = groups::PERIODS;
}

impl Takes for Tabled {
    const GROUPS: &'static [Group] = groups::TABLES;
}

impl Takes for Near {
    const GROUPS: &'static [Group] = groups::NEAREST;
}

impl Takes for Exported {
    const GROUPS: &'static [Group] = &[
        Group::Region,
        Group::Amount,
        Group::World,
        Group::WorldPin,
        Group::Profile,
        Group::Table,
        Group::Points,
        Group::Except,
        Group::Attributes,
        Group::Output,
    ];

    fn takes(parameter: &Parameter) -> bool {
        let is_box = *parameter == parameters::BBOX;
        Self::GROUPS.contains(&parameter.group) && (is_box || parameter.group != Group::Region)
    }
}

impl Takes for Measured {
    const GROUPS: &'static [Group] = groups::MEASURED;

    fn takes(parameter: &Parameter) -> bool {
        let is_other = *parameter == parameters::TABLE
            || *parameter == parameters::FIELD
            || parameter.group == Group::Attributes
            || parameter.group == Group::Region && *parameter != parameters::BBOX;
        Self::GROUPS.contains(&parameter.group) && !is_other
    }
}

/// The flags of the parameters that `T` takes, as they were given.
pub(super) struct Flags<T> {
    given: Vec<(&'static Parameter, String)>,
    takes: PhantomData<T>,
}

impl<T> fmt::Debug for Flags<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let given = self
            .given
            .iter()
            .map(|(parameter, text)| (parameter.name, text));
        f.debug_list().entries(given).finish()
    }
}

impl<T: Takes> Flags<T> {
    /// All of them as values.
    pub(super) fn values(&self) -> Values {
        self.values_of(T::GROUPS)
    }
}

impl<T> Flags<T> {
    /// Those of some groups as values.
    pub(super) fn values_of(&self, groups: &'static [Group]) -> Values {
        let mut values = Values::new(groups, "");
        for (parameter, text) in &self.given {
            if groups.contains(&parameter.group) {
                values.add_text(parameter.name, text);
            }
        }
        values
    }

    /// Those that are given.
    pub(super) fn given(&self) -> impl Iterator<Item = &'static Parameter> {
        self.given.iter().map(|(parameter, _)| *parameter)
    }

    /// Those that are given, with their text.
    pub(super) fn texts(&self) -> impl Iterator<Item = (&'static Parameter, &str)> {
        self.given
            .iter()
            .map(|(parameter, text)| (*parameter, text.as_str()))
    }

    /// Whether one is given.
    pub(super) fn has(&self, wanted: &Parameter) -> bool {
        self.given().any(|parameter| parameter == wanted)
    }
}

/// The flag of a parameter.
pub(super) fn flag(name: &str) -> String {
    format!("--{}", name.replace('_', "-"))
}

/// Under which title `--help` lists the parameters of a group.
const fn heading(group: Group) -> &'static str {
    match group {
        Group::Region | Group::Period | Group::Nearest | Group::Path => WHERE,
        Group::Window | Group::Split | Group::Listed => "Which of the points",
        Group::Output => "Output",
        _ => "Set of points",
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
            "The greatest number of points. The cursor of the rest is reported before the points."
                .into(),
            "all",
        )),
        "cursor" => Some((
            "Where an earlier answer to the same query ended.".into(),
            "the beginning",
        )),
        "field" => Some((
            "The field that thins the points out, from place to place: the name of one of the settings, or a \
             file: a document (.json, .toml) or a raster (.png, .tif, .npy)."
                .into(),
            "none",
        )),
        "terrain" => Some((
            "The terrain that points stand on, which adds a height z: a field by its name or in a file, whose \
             share becomes a height between heights."
                .into(),
            "none",
        )),
        _ => None,
    }
}

/// Those that `-h` leaves to `--help`, so that it fits a screen.
const RARE: &[&str] = &[
    "align",
    "alpha",
    "crs",
    "cursor",
    "decimals",
    "except",
    "heights",
    "map",
    "normals",
    "offset",
    "only",
    "polygon",
    "raster_bbox",
    "rings",
    "scale_range",
    "scale_ranges",
    "size",
    "spread",
    "summary",
    "table",
    "terrain",
    "warp",
    "world_digest",
];

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
    let allowed = parameter.allowed();
    let long = format!("{about}{default}\n\nAllowed: {allowed}");
    let is_name = parameter.shape.is_of_names() || name == "profile" || name == "map";
    Arg::new(name)
        .long(name.replace('_', "-"))
        .aliases(name.contains('_').then_some(name))
        .value_name(value_name(parameter))
        .help(format!("{short}{default}"))
        .long_help(long)
        .help_heading(heading(parameter.group))
        .hide_short_help(RARE.contains(&name))
        .action(ArgAction::Set)
        .add(candidates::completer(parameter))
        // Negative numbers, also those that are wrong: the query says what is.
        .allow_hyphen_values(!is_name)
}

/// The value in the usage of a flag.
fn value_name(parameter: &Parameter) -> String {
    match parameter.shape {
        Shape::Numbers(names) => names.join(",").to_uppercase().replace('_', ""),
        Shape::Vertices => "X1,Y1,X2,Y2,…".into(),
        Shape::Integers { names, .. } => names.join(",").to_uppercase().replace('_', ""),
        Shape::Offsets { .. } => "X,Y …".into(),
        Shape::Names { .. } => "NAME,…".into(),
        Shape::Weights => "NAME:WEIGHT,…".into(),
        Shape::Switch => "on|off".into(),
        Shape::Strength { .. } => "off|on|STRENGTH".into(),
        Shape::Number { .. } | Shape::Integer { .. } | Shape::Signed { .. } | Shape::Quadratic => {
            "NUMBER".into()
        }
        Shape::Ranges => "NAME:MIN:MAX,…".into(),
        Shape::Choice(words) => words.join("|"),
        Shape::Format => "NAME".into(),
        Shape::Field => "NAME|FILE".into(),
        Shape::Fields => "NAME:FIELD,…".into(),
        Shape::Pattern(_) | Shape::Text => "TEXT".into(),
    }
}

impl<T: Takes> clap::Args for Flags<T> {
    fn augment_args(command: Command) -> Command {
        let taken = PARAMETERS
            .iter()
            .copied()
            .filter(|parameter| T::takes(parameter));
        command.args(taken.map(argument))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl<T: Takes> FromArgMatches for Flags<T> {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let taken = PARAMETERS
            .iter()
            .copied()
            .filter(|parameter| T::takes(parameter));
        let given = taken.filter_map(|parameter| {
            let text: &String = matches.get_one(parameter.name)?;
            Some((parameter, text.clone()))
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
    use clap::Args as _;

    use super::*;

    #[test]
    fn every_parameter_is_a_flag_of_some_command() {
        for parameter in PARAMETERS {
            let taken = [
                Answered::takes(parameter),
                Parted::takes(parameter),
                Near::takes(parameter),
                Listed::takes(parameter),
            ];
            assert!(taken.contains(&true), "{}", parameter.name);
        }
    }

    #[test]
    fn a_split_query_takes_what_a_query_takes() {
        let both = || {
            PARAMETERS
                .iter()
                .filter(|parameter| Parted::takes(parameter))
        };
        assert!(both().all(|parameter| Answered::takes(parameter) != (parameter.name == "parts")));
    }

    #[test]
    fn an_added_parameter_is_a_flag_with_help() {
        let command = Flags::<Answered>::augment_args(clap::Command::new("sample"));
        let help = command.clone().render_long_help().to_string();
        assert!(
            help.contains("--added <NUMBER>") && help.contains("an integer from 1 to 9"),
            "{help}"
        );
        let other = Flags::<Counted>::augment_args(clap::Command::new("count"));
        assert!(other.get_arguments().all(|flag| flag.get_id() != "added"));
    }
}
