//! Parameters, and the requests that take them.

use std::borrow::Cow;

use strew_error::{Checked, Fault};

use crate::{shape::Shape, value::Value};

/// A parameter of queries, under the same name in addresses, JSON bodies, messages and (with hyphens)
/// flags.
#[derive(Clone, Copy, Debug)]
pub struct Parameter {
    pub name: &'static str,
    /// Its meaning, with its unit.
    pub about: &'static str,
    pub group: Group,
    pub shape: Shape,
    /// The rule for its values, where the shape does not state it in full.
    pub allowed: Option<&'static str>,
    /// Whether requests that take it must include it.
    pub is_required: bool,
    pub is_rare: bool,
    pub default: Option<&'static str>,
    pub example: &'static str,
    pub is_echoed: bool,
}

impl PartialEq for Parameter {
    /// By name; most are the same static.
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self, other) || self.name == other.name
    }
}

/// The subject of a parameter. A request takes all parameters of some groups.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Group {
    /// The region as text; JSON and messages have a member `region`. A request has one.
    Region,
    /// How densely points lie. A set has one of these, or of the next.
    Amount,
    /// The number of points in the region: an amount where there is a region.
    Count,
    Period,
    World,
    WorldPin,
    Profile,
    Table,
    Points,
    Except,
    Attributes,
    /// The ranges of values and the names that they are chosen from.
    Choices,
    Window,
    Output,
    Reference,
    /// The volume as text; JSON and messages have a member `region`.
    Volume,
    /// Values of points in space. All requests about points in space take it, and no others.
    SpaceAttributes,
    SpaceNearest,
    Nearest,
    Neighbors,
    Split,
    Listed,
    /// The α of a pattern, of which no table is needed.
    Pattern,
    Arrangement,
    Occurrences,
    Clusters,
    Shapes,
    Map,
    Refined,
    Figure,
    Picture,
    Mask,
    MaskFile,
    Path,
}

pub mod groups {
    use super::Group::{self, *};

    /// A set of points in a region: a layer.
    pub const SET: &[Group] = &[
        Amount, Count, Profile, Table, Points, Except, Attributes, Choices,
    ];
    /// A set without a region: single points.
    pub const SINGLE: &[Group] = &[
        Period, Amount, Profile, Table, Points, Except, Attributes, Choices,
    ];
    /// `GET /v1/points`.
    pub const POINTS: &[Group] = &[
        Region, Period, Amount, Count, World, WorldPin, Profile, Table, Points, Except, Attributes,
        Choices, Window, Output, Reference,
    ];
    /// `GET /v1/chunks/…`, whose region is in the path.
    pub const CHUNK: &[Group] = &[
        Amount, Count, World, WorldPin, Profile, Table, Points, Except, Attributes, Choices,
        Window, Output, Reference,
    ];
    /// `GET /v1/worlds/…`, whose world and region are in the path.
    pub const WORLD_CHUNK: &[Group] = &[
        Amount, Count, WorldPin, Profile, Table, Points, Except, Attributes, Choices, Window,
        Output, Reference,
    ];
    pub const QUERY: &[Group] = &[
        Period, Amount, Count, World, WorldPin, Profile, Table, Points, Except, Attributes,
        Choices, Window, Output, Reference,
    ];
    /// `GET /v1/count`.
    pub const COUNT: &[Group] = &[
        Region, Period, Amount, Count, World, WorldPin, Profile, Table, Points, Except, Attributes,
        Choices,
    ];
    /// `POST /v1/count`.
    pub const COUNTED: &[Group] = &[
        Period, Amount, Count, World, WorldPin, Profile, Table, Points, Except, Attributes, Choices,
    ];
    /// `GET /v1/periods`.
    pub const PERIODS: &[Group] = &[Period, Profile, Table, Listed];
    /// `strew measure`.
    pub const MEASURED: &[Group] = &[
        Region, Amount, Count, World, WorldPin, Profile, Table, Points, Attributes, Choices,
    ];
    /// `GET /v1/nearest`.
    pub const NEAREST: &[Group] = &[
        Nearest, Neighbors, Amount, Profile, Table, Points, Except, Attributes, Choices,
    ];
    /// `POST /v1/points:split`, beside the body.
    pub const SPLIT: &[Group] = &[Split];
    pub const TABLES: &[Group] = &[Profile, Table];
    pub const TABLE: &[Group] = &[Table];
    /// The parameters of an answer, without those of the points of a set.
    pub const ANSWER: &[Group] = &[Window, Output, Reference];
    pub const OUTPUT: &[Group] = &[Output, Reference];
    pub const ARRANGEMENT: &[Group] = &[Pattern, Arrangement, Occurrences, Amount, Profile];
    pub const CLUSTERS: &[Group] = &[Pattern, Clusters, Shapes];
    pub const MAP: &[Group] = &[Pattern, Map, Refined];
    pub const INDEX_FIGURE: &[Group] = &[Pattern, Figure];
    pub const ARRANGEMENT_FIGURE: &[Group] = &[Pattern, Arrangement, Figure];
    pub const CLUSTERS_FIGURE: &[Group] = &[Pattern, Clusters, Figure];
    pub const MAP_FIGURE: &[Group] = &[Pattern, Map];
    pub const INDEX_PICTURE: &[Group] = &[Pattern, Figure, Picture];
    pub const ARRANGEMENT_PICTURE: &[Group] = &[Pattern, Arrangement, Figure, Picture];
    pub const CLUSTERS_PICTURE: &[Group] = &[Pattern, Clusters, Figure, Picture];
    pub const MAP_PICTURE: &[Group] = &[Pattern, Map, Picture];
    /// `GET /v1/mask.png`.
    pub const MASK: &[Group] = &[Mask, MaskFile, Profile, Table];
    /// `GET /v1/mask/spectrum.svg`.
    pub const MASK_SPECTRUM: &[Group] = &[Mask, Profile, Table];
    pub const SPACE_SET: &[Group] = &[
        Amount,
        Count,
        Profile,
        Table,
        Points,
        Except,
        SpaceAttributes,
        Choices,
    ];
    pub const SPACE_SINGLE: &[Group] = &[
        Amount,
        Profile,
        Table,
        Points,
        Except,
        SpaceAttributes,
        Choices,
    ];
    /// `GET /v1/space/points`.
    pub const SPACE_POINTS: &[Group] = &[
        Volume,
        Amount,
        Count,
        Profile,
        Table,
        Points,
        Except,
        SpaceAttributes,
        Choices,
        Window,
        Output,
        Reference,
    ];
    /// `GET /v1/space/chunks/…`, whose region is in the path, and bodies, in which it is a member.
    pub const SPACE_QUERY: &[Group] = &[
        Amount,
        Count,
        Profile,
        Table,
        Points,
        Except,
        SpaceAttributes,
        Choices,
        Window,
        Output,
        Reference,
    ];
    /// `GET /v1/space/count`.
    pub const SPACE_COUNT: &[Group] = &[
        Volume,
        Amount,
        Count,
        Profile,
        Table,
        Points,
        Except,
        SpaceAttributes,
        Choices,
    ];
    /// `GET /v1/space/nearest`.
    pub const SPACE_NEAREST: &[Group] = &[
        SpaceNearest,
        Neighbors,
        Amount,
        Profile,
        Table,
        Points,
        Except,
        SpaceAttributes,
        Choices,
    ];
    /// For requests without parameters.
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
        is_rare: false,
        default: None,
        example: "",
        is_echoed: false,
    };

    pub const RARE: Self = Self {
        is_rare: true,
        ..Self::PLAIN
    };

    pub fn read<T>(&self, text: &str) -> Checked<T>
    where
        T: for<'a> TryFrom<&'a Value, Error = &'static str>,
    {
        let fault = |detail: Cow<'_, str>| Fault::new(self.name, text, detail, self.allowed());
        let value = self.shape.read(text).map_err(fault)?;
        T::try_from(&value).map_err(|detail| fault(detail.into()).into())
    }

    pub fn allowed(&self) -> String {
        self.allowed
            .map_or_else(|| self.shape.allowed(), Into::into)
    }
}

/// An entry of a table: its name, its group, and what differs from [`Parameter::PLAIN`] or another entry.
macro_rules! parameter {
    (@base) => { $crate::parameter::Parameter::PLAIN };
    (@base $base:expr) => { $base };
    ($name:literal of $group:ident { $($field:ident: $value:expr,)* $(..$base:expr)? }) => {
        $crate::parameter::Parameter {
            name: $name,
            group: $crate::parameter::Group::$group,
            $($field: $value,)*
            ..$crate::parameter::parameter!(@base $($base)?)
        }
    };
}
pub(crate) use parameter;
