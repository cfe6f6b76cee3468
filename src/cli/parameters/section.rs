//! The sections of the generated types: which parameters stand together.

use strew_query::{Group, Parameter, groups, parameters::FORMAT};

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
