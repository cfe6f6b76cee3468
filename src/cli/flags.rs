//! Flags made from the table of parameters, so that the command line has each parameter of the REST API,
//! under the same name and with the same words.

use std::{fmt, marker::PhantomData};

use clap::{Arg, ArgAction, ArgMatches, Command, FromArgMatches};
use strew_encode::Encoding;
use strew_query::{
    BALL, Group, Parameter, Shape, Values, groups,
    parameters::{BBOX, FIELD, PARAMETERS, SETTLE, TABLE},
    patterns::PATTERN_PARAMETERS,
};

use super::completions;

pub(super) trait Takes: fmt::Debug + Send + Sync + 'static {
    const GROUPS: &'static [Group];
    /// Those of a request about points in space, if there is one.
    const IN_SPACE: &'static [Group] = &[];
    /// Defaults that differ from those of the parameters.
    const DEFAULTS: &'static [(&'static Parameter, &'static str)] = &[];

    fn takes(parameter: &Parameter) -> bool {
        Self::GROUPS.contains(&parameter.group)
    }

    /// All that it takes, in the order of help texts.
    fn all() -> impl Iterator<Item = &'static Parameter> {
        let all = PARAMETERS.iter().chain(PATTERN_PARAMETERS).copied();
        let all = all.chain([&BALL]);
        all.filter(|parameter| Self::takes(parameter))
    }

    /// The text that a parameter has if its flag is absent, where that differs from the parameter's own default.
    fn default(parameter: &Parameter) -> Option<&'static str> {
        let found = Self::DEFAULTS.iter().find(|(known, _)| *known == parameter);
        found.map(|(_, text)| *text)
    }
}

macro_rules! takes {
    ($($(#[$doc:meta])* $name:ident = $groups:expr $(, in space $space:expr)? $(, $takes:expr)?;)+) => {$(
        $(#[$doc])*
        #[derive(Debug)]
        pub(super) struct $name;

        impl Takes for $name {
            const GROUPS: &'static [Group] = $groups;
            $(const IN_SPACE: &'static [Group] = $space;)?

            $(fn takes(parameter: &Parameter) -> bool {
                let takes: fn(&Parameter) -> bool = $takes;
                takes(parameter)
            })?
        }
    )+};
}

takes! {
    /// A query with its output, as `GET /v1/points` takes it.
    Answered = groups::POINTS, |parameter| {
        *parameter == BALL || groups::POINTS.contains(&parameter.group)
    };
    /// A query of which only the number of points matters, as for `GET /v1/count`.
    Counted = groups::COUNT, |parameter| {
        *parameter == BALL || groups::COUNT.contains(&parameter.group)
    };
    Parted = groups::POINTS, |parameter| {
        parameter.group == Group::Split || Answered::takes(parameter)
    };
    /// A set without a region, as for `GET /v1/points/{id}`.
    Single = groups::SINGLE, in space groups::SPACE_SINGLE;
    /// A table whose periods are listed, as for `GET /v1/periods`.
    Listed = groups::PERIODS;
    Tabled = groups::TABLES;
    /// A set and a place, as for `GET /v1/nearest`.
    Near = groups::NEAREST, in space groups::SPACE_NEAREST;
    /// A set of points, or a world, in the chunks of a box.
    Exported = groups::POINTS, |parameter| {
        let others = [Group::Region, Group::Period, Group::Count, Group::Window];
        let is_flat = *parameter != BALL && Answered::takes(parameter);
        *parameter == BBOX || is_flat && !others.contains(&parameter.group)
    };
    /// A box and a set; its table is named by another flag.
    Measured = groups::MEASURED, |parameter| {
        let others = [Group::Region, Group::Attributes, Group::Choices];
        let others = others.contains(&parameter.group)
            || [&TABLE, &FIELD].contains(&parameter);
        *parameter == BBOX || Measured::GROUPS.contains(&parameter.group) && !others
    };
    Arranged = groups::ARRANGEMENT;
}

/// The points of a picture. What else they have follows from the picture, or is a flag of its own.
#[derive(Debug)]
pub(super) struct Stippled;

impl Takes for Stippled {
    const GROUPS: &'static [Group] = groups::POINTS;
    // A picture is made once, and no chunk of it is waited for. Tones err less by up to 9 % than after two steps.
    const DEFAULTS: &'static [(&'static Parameter, &'static str)] = &[(&SETTLE, "3")];

    fn takes(parameter: &Parameter) -> bool {
        *parameter == SETTLE
    }
}

#[derive(Debug)]
pub(super) struct Flags<T> {
    given: Vec<(&'static Parameter, String)>,
    takes: PhantomData<T>,
}

impl<T: Takes> Flags<T> {
    /// All given flags as values, and the defaults of the command for the others.
    pub(super) fn values(&self) -> Values {
        let mut values = self.values_of(T::GROUPS);
        for (parameter, text) in T::DEFAULTS {
            if !self.has(parameter) {
                values.add_text(parameter.name, text);
            }
        }
        values
    }
}

impl<T> Flags<T> {
    pub(super) fn values_of(&self, groups: &'static [Group]) -> Values {
        self.chosen(groups, |group| groups.contains(&group))
    }

    fn chosen(&self, groups: &'static [Group], is_chosen: impl Fn(Group) -> bool) -> Values {
        let mut values = Values::new(groups, "");
        for (parameter, text) in self.texts().filter(|(known, _)| is_chosen(known.group)) {
            values.add_text(parameter.name, text);
        }
        values
    }

    /// All given flags as values of a request about points in space, which some groups make.
    pub(super) fn values_in_space(&self, groups: &'static [Group]) -> Values {
        // How a query is split is not a part of it.
        self.chosen(groups, |group| group != Group::Split)
    }

    pub(super) fn given(&self) -> impl Iterator<Item = &'static Parameter> {
        self.texts().map(|(parameter, _)| parameter)
    }

    pub(super) fn texts(&self) -> impl Iterator<Item = (&'static Parameter, &str)> {
        let given = self.given.iter();
        given.map(|(parameter, text)| (*parameter, text.as_str()))
    }

    pub(super) fn text(&self, wanted: &Parameter) -> Option<&str> {
        let mut texts = self.texts();
        texts.find_map(|(parameter, text)| (parameter == wanted).then_some(text))
    }

    pub(super) fn has(&self, wanted: &Parameter) -> bool {
        self.text(wanted).is_some()
    }
}

/// The title under which `--help` lists the parameters of a group.
const fn heading(group: Group) -> &'static str {
    match group {
        Group::Region | Group::Volume | Group::Period | Group::Nearest | Group::Path => WHERE,
        Group::Window | Group::Split | Group::Listed => "Which of the points",
        Group::Neighbors => WHERE,
        Group::Output | Group::Reference => "Output",
        Group::Pattern | Group::Occurrences => "Pattern",
        _ => "Set of points",
    }
}

pub(super) const WHERE: &str = "Where";

/// The meaning and the default of a flag that differ from those of its parameter.
fn own_words(parameter: &Parameter) -> Option<(String, &'static str)> {
    let (about, default) = match (parameter.name, parameter.group) {
        ("format", _) => {
            let about = format!("The format of the output: {}.", Encoding::names());
            return Some((about, "the ending of the output's name, else json"));
        }
        ("offsets", _) => (
            "The offsets of the other points from the first, in grid units: pairs of integers, such as \"2,1 3,3\".",
            "",
        ),
        ("ball", _) => (
            "The region, with --space: the points nearer to x,y,z than the radius.",
            "",
        ),
        ("list", _) => (
            "List the occurrences instead: column and row of the first point of each, and with an amount the places \
             of its points. --list alone is --list=csv.",
            "",
        ),
        ("limit", Group::Occurrences) => ("The greatest number of occurrences in the list.", "all"),
        ("limit", _) => (
            "The greatest number of points. The cursor of the rest is reported before the points.",
            "all",
        ),
        ("cursor", Group::Occurrences) => (
            "Where an earlier list ended: the column and the row of the next occurrence.",
            "the beginning",
        ),
        ("cursor", _) => (
            "Where an earlier answer to the same query ended.",
            "the beginning",
        ),
        ("field", _) => (
            "The field that thins the points out, from place to place: the name of one of the settings, or a \
             file: a document (.json, .toml) or a raster (.png, .tif, .npy).",
            "none",
        ),
        ("terrain", _) => (
            "The terrain that points stand on, which adds a height z: a field by its name or in a file, whose \
             share becomes a height between heights.",
            "none",
        ),
        _ => return None,
    };
    Some((about.into(), default))
}

/// The flag of a parameter, with the default of the command if it has one of its own.
fn argument(parameter: &'static Parameter, default: Option<&'static str>) -> Arg {
    let name = parameter.name;
    let (about, usual) = own_words(parameter).map_or_else(
        || (parameter.about.to_owned(), parameter.default),
        |(about, default)| (about, Some(default)),
    );
    let default = default.or(usual).filter(|text| !text.is_empty());
    let default = default.map_or(String::new(), |text| format!(" [default: {text}]"));
    let short = match about.split_once(". ") {
        Some((first, _)) if name != "format" => first,
        _ => about.trim_end_matches('.'),
    };
    let allowed = parameter.allowed();
    let long = format!("{about}{default}\n\nAllowed: {allowed}");
    let argument = match parameter.group {
        Group::Arrangement => Arg::new(name).required(true),
        group => Arg::new(name)
            .help_heading(heading(group))
            .long(name.replace('_', "-"))
            .aliases(name.contains('_').then_some(name)),
    };
    let argument = match name {
        "list" => argument
            .num_args(0..=1)
            .require_equals(true)
            .default_missing_value("csv"),
        _ => argument,
    };
    argument
        .value_name(value_name(parameter))
        .help(format!("{short}{default}"))
        .long_help(long)
        .hide_short_help(parameter.is_rare)
        .action(ArgAction::Set)
        .add(completions::completer(parameter))
        .allow_hyphen_values(parameter.group == Group::Arrangement)
}

fn value_name(parameter: &Parameter) -> String {
    match parameter.shape {
        Shape::Numbers(names) => names.join(",").to_uppercase().replace('_', ""),
        Shape::Vertices => "X1,Y1,X2,Y2,…".into(),
        Shape::Integers { names, .. } => names.join(",").to_uppercase().replace('_', ""),
        Shape::Offsets { .. } => "OFFSETS".into(),
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
        command.args(T::all().map(|parameter| argument(parameter, T::default(parameter))))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl<T: Takes> FromArgMatches for Flags<T> {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let given = T::all().filter_map(|parameter| {
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
    use strew_query::of;

    use super::*;
    use crate::recipe::ADDED;

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
    fn an_added_parameter_is_a_flag_with_help() {
        let command = clap::Command::new("sample").arg(argument(&ADDED, None));
        let help = command.clone().render_long_help().to_string();
        assert!(
            help.contains("--added <NUMBER>") && help.contains("an integer from 1 to 9"),
            "{help}"
        );
    }

    #[test]
    fn a_default_of_a_command_is_in_its_help_and_gives_way_to_the_flag() {
        let command = || Flags::<Stippled>::augment_args(clap::Command::new("stipple"));
        let help = command().render_long_help().to_string();
        assert!(help.contains("[default: 3]"), "{help}");
        for (given, expected) in [(&["stipple"][..], 3), (&["stipple", "--settle", "0"], 0)] {
            let matches = command().get_matches_from(given);
            let flags = Flags::<Stippled>::from_arg_matches(&matches).expect("valid");
            assert_eq!(
                flags.values().get::<u64>(&SETTLE).ok().flatten(),
                Some(expected)
            );
        }
    }

    #[test]
    fn flags_are_a_loop_over_the_table() {
        let command = Flags::<Answered>::augment_args(clap::Command::new("sample"));
        let flags = command.get_arguments().map(|flag| flag.get_id().as_str());
        let all = of(groups::POINTS).map(|parameter| parameter.name);
        assert!(flags.eq(all.chain(["ball"])));
    }
}
