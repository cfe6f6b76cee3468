//! What a parameter is, and which requests take which parameters.

use std::borrow::Cow;

use super::{Checked, Set, Shape, Value, parameters::PARAMETERS, patterns::PATTERN_PARAMETERS};
use crate::service::Fault;

/// A parameter of queries, under the same name in addresses, JSON bodies, messages and (with hyphens)
/// flags.
#[derive(Clone, Copy, Debug)]
pub struct Parameter {
    /// Its name.
    pub name: &'static str,
    /// What it means, with its unit.
    pub about: &'static str,
    /// What it is about, which decides the requests that take it.
    pub group: Group,
    /// The values it takes.
    pub shape: Shape,
    /// What is allowed, where the shape does not say everything.
    pub allowed: Option<&'static str>,
    /// Whether requests that take it must give it.
    pub is_required: bool,
    /// What an absent one means.
    pub default: Option<&'static str>,
    /// A value that is valid on the built-in tables.
    pub example: &'static str,
    /// Its value in a checked set, which answers echo; `None` if it is the default and not worth
    /// mentioning.
    pub echo: Option<fn(&Set) -> Option<Value>>,
}

impl PartialEq for Parameter {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

/// What a parameter is about. A request takes all parameters of some groups.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Group {
    /// The region as text; JSON and messages have a member `region`. A request has one.
    Region,
    /// How densely points lie. A set has one of these, or of the next.
    Amount,
    /// The number of points in the region: an amount where there is a region.
    Count,
    /// The points of a period, instead of a region.
    Period,
    /// The name of a world.
    World,
    /// The digest of the world.
    WorldPin,
    /// The name of the profile.
    Profile,
    /// The table of the profile.
    Table,
    /// Which points.
    Points,
    /// Which points are left out one by one.
    Except,
    /// Values of points.
    Attributes,
    /// Which part of the points.
    Window,
    /// What the answer looks like.
    Output,
    /// A place whose neighbors are wanted.
    Nearest,
    /// Into how many parts a query is split.
    Split,
    /// How much of a list.
    Listed,
    /// The α of a pattern, of which no table is needed.
    Pattern,
    /// The offsets of an arrangement.
    Arrangement,
    /// Where an arrangement occurs.
    Occurrences,
    /// Which points are a cluster.
    Clusters,
    /// Which clusters have the same shape.
    Shapes,
    /// A neighborhood map.
    Map,
    /// A finer map.
    Refined,
    /// What a figure shows.
    Figure,
    /// The pixels of a figure.
    Picture,
    /// A threshold mask.
    Mask,
    /// The file of a threshold mask.
    MaskFile,
    /// A place in a path.
    Path,
}

/// The groups that requests take.
pub mod groups {
    use super::Group::{self, *};

    /// A set of points in a region: a layer.
    pub const SET: &[Group] = &[Amount, Count, Profile, Table, Points, Except, Attributes];
    /// A set without a region: single points.
    pub const SINGLE: &[Group] = &[Period, Amount, Profile, Table, Points, Attributes];
    /// `GET /v1/points`.
    pub const POINTS: &[Group] = &[
        Region, Period, Amount, Count, World, WorldPin, Profile, Table, Points, Except, Attributes,
        Window, Output,
    ];
    /// `GET /v1/chunks/…`, whose region is in the path.
    pub const CHUNK: &[Group] = &[
        Amount, Count, World, WorldPin, Profile, Table, Points, Except, Attributes, Window, Output,
    ];
    /// `GET /v1/worlds/…`, whose world and region are in the path.
    pub const WORLD_CHUNK: &[Group] = &[
        Amount, Count, WorldPin, Profile, Table, Points, Except, Attributes, Window, Output,
    ];
    /// Bodies, in which the region is a member.
    pub const QUERY: &[Group] = &[
        Period, Amount, Count, World, WorldPin, Profile, Table, Points, Except, Attributes, Window,
        Output,
    ];
    /// `GET /v1/count`.
    pub const COUNT: &[Group] = &[
        Region, Period, Amount, Count, World, WorldPin, Profile, Table, Points, Except, Attributes,
    ];
    /// `POST /v1/count`.
    pub const COUNTED: &[Group] = &[
        Period, Amount, Count, World, WorldPin, Profile, Table, Points, Except, Attributes,
    ];
    /// `GET /v1/periods`.
    pub const PERIODS: &[Group] = &[Period, Profile, Table, Listed];
    /// What `strew measure` takes.
    pub const MEASURED: &[Group] = &[
        Region, Amount, Count, World, WorldPin, Profile, Table, Points, Attributes,
    ];
    /// `GET /v1/nearest`.
    pub const NEAREST: &[Group] = &[Nearest, Amount, Profile, Table, Points, Attributes];
    /// `POST /v1/points:split`, beside the body.
    pub const SPLIT: &[Group] = &[Split];
    /// Which table.
    pub const TABLES: &[Group] = &[Profile, Table];
    /// What is about one table of a profile.
    pub const TABLE: &[Group] = &[Table];
    /// What is about an answer, and not about the points of a set.
    pub const ANSWER: &[Group] = &[Window, Output];
    /// What the answer looks like.
    pub const OUTPUT: &[Group] = &[Output];
    /// Arrangements, with the set that displaces their points.
    pub const ARRANGEMENT: &[Group] = &[Pattern, Arrangement, Occurrences, Amount, Profile];
    /// Clusters.
    pub const CLUSTERS: &[Group] = &[Pattern, Clusters, Shapes];
    /// Neighborhood maps.
    pub const MAP: &[Group] = &[Pattern, Map, Refined];
    /// The figure of the index.
    pub const INDEX_FIGURE: &[Group] = &[Pattern, Figure];
    /// The figure of an arrangement.
    pub const ARRANGEMENT_FIGURE: &[Group] = &[Pattern, Arrangement, Figure];
    /// The figure of clusters.
    pub const CLUSTERS_FIGURE: &[Group] = &[Pattern, Clusters, Figure];
    /// The figure of a map.
    pub const MAP_FIGURE: &[Group] = &[Pattern, Map];
    /// The figure of the index as pixels.
    pub const INDEX_PICTURE: &[Group] = &[Pattern, Figure, Picture];
    /// The figure of an arrangement as pixels.
    pub const ARRANGEMENT_PICTURE: &[Group] = &[Pattern, Arrangement, Figure, Picture];
    /// The figure of clusters as pixels.
    pub const CLUSTERS_PICTURE: &[Group] = &[Pattern, Clusters, Figure, Picture];
    /// The figure of a map as pixels.
    pub const MAP_PICTURE: &[Group] = &[Pattern, Map, Picture];
    /// `GET /v1/mask.png`.
    pub const MASK: &[Group] = &[Mask, MaskFile, Profile, Table];
    /// `GET /v1/mask/spectrum.svg`.
    pub const MASK_SPECTRUM: &[Group] = &[Mask, Profile, Table];
    /// What takes no parameters.
    pub const NONE: &[Group] = &[];
}

impl Parameter {
    /// The parameter that entries of the table differ from: any text, without a default.
    pub const PLAIN: Self = Self {
        name: "",
        about: "",
        group: Group::Path,
        shape: Shape::Text,
        allowed: None,
        is_required: false,
        default: None,
        example: "",
        echo: None,
    };

    /// The parameter with a name.
    #[must_use]
    pub fn named(name: &str) -> Option<&'static Self> {
        let mut all = PARAMETERS.iter().copied();
        all.find(|parameter| parameter.name == name)
    }

    /// Reads its value from text.
    ///
    /// # Errors
    /// A fault of the parameter.
    pub fn read<T>(&self, text: &str) -> Checked<T>
    where
        T: for<'a> TryFrom<&'a Value, Error = &'static str>,
    {
        let fault = |detail: Cow<'_, str>| Fault::new(self.name, text, detail, self.allowed());
        let value = self.shape.read(text).map_err(fault)?;
        T::try_from(&value).map_err(|detail| fault(detail.into()).into())
    }

    /// What is allowed, in words.
    #[must_use]
    pub fn allowed(&self) -> String {
        self.allowed
            .map_or_else(|| self.shape.allowed(), Into::into)
    }
}

/// The parameters of some groups.
pub fn of(groups: &'static [Group]) -> impl Iterator<Item = &'static Parameter> + Clone {
    let all = PARAMETERS.iter().chain(PATTERN_PARAMETERS).copied();
    all.filter(|parameter| groups.contains(&parameter.group))
}

/// The names of the parameters of some groups, for a fault.
pub(super) fn names(groups: &'static [Group]) -> String {
    let names: Vec<&str> = of(groups).map(|parameter| parameter.name).collect();
    match names.as_slice() {
        [] => "no parameters".into(),
        names => names.join(", "),
    }
}

/// Words for an unknown name, with the known one that is most like it.
pub(in crate::service) fn unknown<'a>(
    what: &str,
    name: &str,
    known: impl Iterator<Item = &'a str>,
) -> String {
    // `minDistance` and `min-distance` are `min_distance` in other notations.
    let plain = |name: &str| name.to_lowercase().replace(['_', '-', ' '], "");
    // Longer names are nobody's slip, and cost time.
    let wanted = plain(name.get(..name.len().min(40)).unwrap_or_default());
    let likeness = |known: &str| strsim::jaro_winkler(&plain(known), &wanted);
    let scored = known.map(|known| (likeness(known), known));
    let best = scored.max_by(|a, b| a.0.total_cmp(&b.0));
    match best.filter(|(likeness, _)| *likeness > 0.8) {
        Some((_, known)) => format!("unknown {what}; did you mean `{known}`?"),
        None => format!("unknown {what}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
