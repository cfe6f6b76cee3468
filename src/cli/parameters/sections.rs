//! The parts of the table that bindings have apart, and the words for parameters that all forms share.

use strew_query::{Group, Parameter, Shape, groups, parameters::FORMAT};

pub(super) struct Section {
    pub(super) name: &'static str,
    pub(super) about: &'static str,
    pub(super) groups: &'static [Group],
}

/// The types of a query, and those that only programs in TypeScript have.
pub(super) const SECTIONS: [Section; 6] = [
    Section {
        name: "Regions",
        about: "Regions that are parameters by themselves: a query has one of them, or a member `region`.",
        groups: &[Group::Region],
    },
    Section {
        name: "Parameters",
        about: "The parameters of a query: which points, and which part of them.",
        groups: groups::QUERY,
    },
    Section {
        name: "Output",
        about: "The options of a document, beside its format.",
        groups: groups::OUTPUT,
    },
    Section {
        name: "Neighbors",
        about: "The bounds of a search for the nearest points.",
        groups: &[Group::Nearest, Group::Neighbors],
    },
    Section {
        name: "VolumeParameters",
        about: "Volumes that are parameters by themselves: a query in space has one of them, or a member `region`.",
        groups: &[Group::Volume],
    },
    Section {
        name: "SpaceParameters",
        about: "The parameters of a query in space: which points, and which part of them.",
        groups: groups::SPACE_QUERY,
    },
];

pub(super) fn of_query() -> &'static [Section] {
    &SECTIONS[..3]
}

impl Section {
    /// Its parameters in a table. Bindings have arguments of their own for what is required, and for the format. The
    /// options of documents are a section of their own.
    pub(super) fn of<'a>(&self, table: &[&'a Parameter]) -> Vec<&'a Parameter> {
        let mut taken = within(table, self.groups);
        let is_output = self.groups == groups::OUTPUT;
        taken.retain(|&parameter| {
            let is_own = groups::OUTPUT.contains(&parameter.group) == is_output;
            is_own && !parameter.is_required && *parameter != FORMAT
        });
        taken
    }
}

pub(super) fn within<'a>(table: &[&'a Parameter], groups: &[Group]) -> Vec<&'a Parameter> {
    let taken = table.iter().copied();
    taken
        .filter(|parameter| groups.contains(&parameter.group))
        .collect()
}

pub(super) const WIDTH: usize = 120;

/// A parameter's meaning, allowed values and default, as one paragraph. Lists, objects and switches have types of their
/// own in programs: only texts write them with commas and colons. `raster` is how a language names the function that
/// makes fields.
pub(super) fn paragraph(parameter: &Parameter, raster: &str) -> String {
    let allowed = match parameter.shape {
        Shape::Switch | Shape::Names { .. } | Shape::Weights | Shape::Ranges | Shape::Fields => {
            String::new()
        }
        Shape::Vertices => " Vertices, or GeoJSON.".into(),
        Shape::Field => format!(" By its name, or as in JSON; see {raster}."),
        _ => format!(" Allowed: {}.", parameter.allowed()),
    };
    let default = parameter.default;
    let default = default.map_or_else(String::new, |default| format!(" Default: {default}."));
    format!("{}{allowed}{default}", parameter.about)
}

pub(super) fn wrapped(text: &str, prefix: &str) -> String {
    let mut lines = String::new();
    let mut line = String::new();
    for word in text.split_whitespace() {
        let is_full = prefix.len() + line.chars().count() + 1 + word.chars().count() > WIDTH;
        if is_full && !line.is_empty() {
            lines += &format!("{prefix}{line}\n");
            line.clear();
        }
        if !line.is_empty() {
            line.push(' ');
        }
        line += word;
    }
    lines + &format!("{prefix}{line}\n")
}

/// The largest integer up to which each is a number of JavaScript.
pub(super) const SAFE: u64 = (1 << 53) - 1;

/// The kind of a shape's values, by which bindings read and write texts, and their types in TypeScript and Python.
pub(super) const fn words(shape: Shape) -> [&'static str; 3] {
    match shape {
        Shape::Number { .. } => ["number", "number", "Number"],
        // As text, too: so JSON has integers that a number does not hold.
        Shape::Integer { max, .. } if max > SAFE => {
            ["integer", "number | bigint | `${number}`", "Integer"]
        }
        Shape::Integer { .. } | Shape::Signed { .. } => ["integer", "number", "Integer"],
        Shape::Switch => ["switch", "boolean", "bool"],
        Shape::Strength { .. } => ["strength", "\"on\" | \"off\" | number", "str | Number"],
        Shape::Numbers(_) | Shape::Integers { .. } => ["numbers", "Numbers", "Numbers"],
        // In Python vertices, GeoJSON, or an object with `__geo_interface__`.
        Shape::Vertices => ["pairs", "ArrayLike<Numbers> | object | null", "Any"],
        Shape::Offsets { .. } => ["pairs", "ArrayLike<Numbers>", "Sequence[Numbers]"],
        Shape::Names { .. } => ["names", "string | readonly string[]", "str | Sequence[str]"],
        Shape::Weights => ["weights", "Record<string, number>", "Mapping[str, Number]"],
        Shape::Ranges => {
            let of = "Record<string, Tuple<[min: number, max: number]>>";
            ["ranges", of, "Mapping[str, Numbers]"]
        }
        Shape::Field => ["field", "string | object", "str | Mapping[str, Any]"],
        Shape::Fields => {
            let of = "Record<string, string | object>";
            ["fields", of, "Mapping[str, str | Mapping[str, Any]]"]
        }
        Shape::Quadratic => ["text", "string | number", "str | Number"],
        Shape::Choice(_) | Shape::Format | Shape::Pattern(_) | Shape::Text => {
            ["text", "string", "str"]
        }
    }
}

/// The names of regions, of parts of the points and of options of documents; and lines with the kinds of all values.
pub(super) fn lists(table: &[&Parameter], mark: &str) -> [String; 4] {
    let of = |groups| {
        let names = within(table, groups).into_iter();
        let quoted = names.map(|parameter| format!("\"{}\"", parameter.name));
        quoted.collect::<Vec<_>>().join(", ")
    };
    let kinds = within(table, groups::POINTS).into_iter();
    let kinds =
        kinds.map(|of| format!("    {mark}{}{mark}: \"{}\",\n", of.name, words(of.shape)[0]));
    [
        of(&[Group::Region]),
        of(&[Group::Window]),
        of(groups::OUTPUT),
        kinds.collect(),
    ]
}
