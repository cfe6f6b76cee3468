//! What the generated types share: their sections, which say which parameters stand together, and the words about each
//! parameter.

use strew_query::{Group, Parameter, Shape, groups, parameters::FORMAT};

/// Keywords of one kind that the bindings take.
pub(super) struct Section {
    /// The name of its type.
    pub(super) name: &'static str,
    /// Its meaning.
    pub(super) about: &'static str,
    pub(super) groups: &'static [Group],
}

/// The shapes of regions.
pub(super) const REGIONS: Section = Section {
    name: "Regions",
    about: "Regions that are parameters by themselves: a query has one of them, or a member `region`.",
    groups: &[Group::Region],
};

/// The members of a query but its region.
pub(super) const MEMBERS: Section = Section {
    name: "Parameters",
    about: "The parameters of a query: which points, and which part of them.",
    groups: &[
        Group::Period,
        Group::Amount,
        Group::Count,
        Group::World,
        Group::WorldPin,
        Group::Profile,
        Group::Table,
        Group::Points,
        Group::Thinned,
        Group::Except,
        Group::Attributes,
        Group::Choices,
        Group::Window,
    ],
};

/// The looks of a document.
pub(super) const OUTPUT: Section = Section {
    name: "Output",
    about: "The options of a document, beside its format.",
    groups: groups::OUTPUT,
};

/// The bounds of a search for neighbors.
pub(super) const NEIGHBORS: Section = Section {
    name: "Neighbors",
    about: "The bounds of a search for the nearest points.",
    groups: &[Group::Nearest, Group::Neighbors],
};

/// The shapes of volumes.
pub(super) const VOLUMES: Section = Section {
    name: "VolumeParameters",
    about: "Volumes that are parameters by themselves: a query in space has one of them, or a member `region`.",
    groups: &[Group::Volume],
};

/// The members of a query in space but its region.
pub(super) const SPACE: Section = Section {
    name: "SpaceParameters",
    about: "The parameters of a query in space: which points, and which part of them.",
    groups: &[
        Group::Amount,
        Group::Profile,
        Group::Table,
        Group::Points,
        Group::SpaceAttributes,
        Group::Choices,
        Group::Window,
    ],
};

impl Section {
    /// Its parameters in a table. Bindings have arguments of their own for what is required, and for the format.
    pub(super) fn of<'a>(&self, table: &[&'a Parameter]) -> Vec<&'a Parameter> {
        let mut taken = within(table, self.groups);
        taken.retain(|&parameter| !parameter.is_required && *parameter != FORMAT);
        taken
    }
}

/// The parameters of some groups in a table.
pub(super) fn within<'a>(table: &[&'a Parameter], groups: &[Group]) -> Vec<&'a Parameter> {
    let taken = table.iter().copied();
    taken
        .filter(|parameter| groups.contains(&parameter.group))
        .collect()
}

/// Their names, in quotes and joined by commas.
pub(super) fn quoted(parameters: &[&Parameter]) -> String {
    let names: Vec<String> = (parameters.iter())
        .map(|parameter| format!("\"{}\"", parameter.name))
        .collect();
    names.join(", ")
}

/// The columns of a line.
const WIDTH: usize = 120;

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

/// A paragraph in lines that begin with a prefix.
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

/// The kind of a parameter's values, by which bindings read and write texts.
pub(super) const fn kind(shape: Shape) -> &'static str {
    match shape {
        Shape::Number { .. } => "number",
        Shape::Integer { .. } | Shape::Signed { .. } => "integer",
        Shape::Switch => "switch",
        Shape::Strength { .. } => "strength",
        Shape::Numbers(_) | Shape::Integers { .. } => "numbers",
        Shape::Vertices | Shape::Offsets { .. } => "pairs",
        Shape::Names { .. } => "names",
        Shape::Weights => "weights",
        Shape::Ranges => "ranges",
        Shape::Field => "field",
        Shape::Fields => "fields",
        Shape::Choice(_) | Shape::Format | Shape::Quadratic | Shape::Pattern(_) | Shape::Text => {
            "text"
        }
    }
}
