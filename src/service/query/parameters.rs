//! What every parameter means and allows: one list, for reading, for faults and for the API's
//! description.

use strew_core::Spacing;

use super::{
    AMOUNT, BOX, DEFAULT_ALPHA, DEFAULT_PROFILE, KEEP, MOST_PARTS, WARP,
    amount::COUNT,
    attributes::{ATTRIBUTES, SCALE_RANGE, VARIANTS},
    pin::{self, DIGEST},
    region::{CIRCLE, POLYGON},
};
use crate::service::{
    Encoding,
    encode::{
        DECIMALS, MOST_DECIMALS,
        preview::{LEAST_SIZE, MOST_SIZE, SIZE},
    },
};

/// A parameter of an address.
#[derive(Clone, Copy, Debug)]
pub struct Parameter {
    /// Its name.
    pub name: &'static str,
    /// What it means, with its unit.
    pub about: &'static str,
    /// What is allowed, in words.
    pub allowed: &'static str,
    /// What is allowed, for a program.
    pub shape: Shape,
    /// What an absent one means, in words.
    pub default: Option<&'static str>,
    /// A value that is in order on the built-in tables.
    pub example: &'static str,
}

/// The values that a parameter takes.
#[derive(Clone, Copy, Debug)]
pub enum Shape {
    /// A number within bounds, both included.
    Number {
        /// The least.
        min: f64,
        /// The greatest.
        max: f64,
    },
    /// An integer within bounds, both included.
    Integer {
        /// The least.
        min: i64,
        /// The greatest.
        max: u64,
    },
    /// So many numbers joined by commas.
    Numbers(usize),
    /// One of some names.
    OneOf(fn() -> Vec<&'static str>),
    /// One of some names, or a number within bounds.
    NameOrNumber {
        /// The names.
        names: &'static [&'static str],
        /// The least.
        min: f64,
        /// The greatest.
        max: f64,
    },
    /// Text that a regular expression matches.
    Pattern(&'static str),
    /// Any text: what is right shows when it is looked up.
    Text,
}

/// The parameters of a query in an address. A name here is a name that is read; see
/// [`Parameters`](super::Parameters) for the reading.
pub const PARAMETERS: &[Parameter] = &[
    Parameter {
        name: "bbox",
        about: "The region: a half-open box, min ≤ p < max on the reported coordinates. Either this, \
                circle or polygon.",
        allowed: BOX,
        shape: Shape::Numbers(4),
        default: None,
        example: "0,0,3,2",
    },
    Parameter {
        name: "circle",
        about: "The region: the points nearer to x,y than the radius.",
        allowed: CIRCLE,
        shape: Shape::Numbers(3),
        default: None,
        example: "5,5,3",
    },
    Parameter {
        name: "polygon",
        about: "The region: a polygon of these vertices. Polygons that share an edge share no point \
                and lose none.",
        allowed: POLYGON,
        shape: Shape::Pattern(super::region::VERTICES),
        default: None,
        example: "0,0,4,0,0,4",
    },
    Parameter {
        name: "density",
        about: "Points per unit of area. Either this, spacing, min_distance or count.",
        allowed: AMOUNT,
        shape: Shape::Number {
            min: Spacing::MIN_DENSITY,
            max: Spacing::MAX_DENSITY,
        },
        default: None,
        example: "1",
    },
    Parameter {
        name: "spacing",
        about: "The mean spacing, density^-1/2. Either this, density, min_distance or count.",
        allowed: AMOUNT,
        shape: Shape::Number {
            min: Spacing::MIN,
            max: Spacing::MAX,
        },
        default: None,
        example: "1",
    },
    Parameter {
        name: "min_distance",
        about: "The least distance of any two points: the density is the greatest at which it is \
                guaranteed, with the warp. Not for profiles that promise none.",
        allowed: AMOUNT,
        shape: Shape::Number {
            min: Spacing::MIN,
            max: Spacing::MAX,
        },
        default: None,
        example: "1",
    },
    Parameter {
        name: "count",
        about: "How many points the region is to hold: the density is what gives exactly that many.",
        allowed: COUNT,
        shape: Shape::Integer {
            min: 1,
            max: u64::MAX,
        },
        default: None,
        example: "100",
    },
    Parameter {
        name: "profile",
        about: "The noise profile. The list of profiles says what is loaded.",
        allowed: "the name of a profile that is loaded",
        shape: Shape::Text,
        default: Some(DEFAULT_PROFILE),
        example: "blue",
    },
    Parameter {
        name: "alpha",
        about: "The number α of the pattern, as a decimal, a fraction or a quadratic irrational.",
        allowed: "a number that the profile is loaded for",
        shape: Shape::Text,
        default: Some(DEFAULT_ALPHA),
        example: "(5-sqrt(3))/2",
    },
    Parameter {
        name: "map",
        about: "The size of the neighborhood map: larger ones are of better quality and take more \
                memory.",
        allowed: "s, m or l, as far as the profile is loaded with it",
        shape: Shape::Text,
        default: Some("s if it is loaded, else the smallest"),
        example: "s",
    },
    Parameter {
        name: "seed",
        about: "Which set of points. Seed 0 is the plain pattern, every other one a set of its own.",
        allowed: SEED,
        shape: Shape::Integer {
            min: 0,
            max: u64::MAX,
        },
        default: Some("0"),
        example: "7",
    },
    Parameter {
        name: "warp",
        about: "The strength of the warp that makes a set isotropic and unlike those of other \
                seeds.",
        allowed: WARP,
        shape: Shape::NameOrNumber {
            names: &["off", "on"],
            min: 0.0,
            max: 2.0,
        },
        default: Some("off for seed 0, else on"),
        example: "on",
    },
    Parameter {
        name: "keep",
        about: "The share of points to keep, those of the lowest rank: a smaller share keeps some \
                of the points of a larger one.",
        allowed: KEEP,
        shape: Shape::Number {
            min: 1e-6,
            max: 1.0,
        },
        default: Some("1"),
        example: "0.5",
    },
    Parameter {
        name: "attributes",
        about: "Further values of each point, hashed from its id and the seed: angle (radians, 0 to \
                2π), scale (within scale_range), variant (one of variants, by weight), rank (0 to \
                1, see keep), u1 to u16 (uniform, 0 to 1).",
        allowed: ATTRIBUTES,
        shape: Shape::Pattern(
            "^(angle|scale|variant|rank|u([1-9]|1[0-6]))(,(angle|scale|variant|rank|u([1-9]|1[0-6])))*$",
        ),
        default: Some("none"),
        example: "angle,u1",
    },
    Parameter {
        name: "scale_range",
        about: "The least and the greatest value of the attribute scale.",
        allowed: SCALE_RANGE,
        shape: Shape::Numbers(2),
        default: Some("0,1"),
        example: "0.8,1.2",
    },
    Parameter {
        name: "variants",
        about: "The names that the attribute variant chooses from, with their weights.",
        allowed: VARIANTS,
        shape: Shape::Pattern("^[A-Za-z0-9_.-]+(:[^,:]+)?(,[A-Za-z0-9_.-]+(:[^,:]+)?)*$"),
        default: None,
        example: "oak:3,birch:1",
    },
    Parameter {
        name: "offset",
        about: "How many points to leave out, in the fixed order, from the beginning or from the \
                cursor on.",
        allowed: OFFSET,
        shape: Shape::Integer {
            min: 0,
            max: u64::MAX,
        },
        default: Some("0"),
        example: "3",
    },
    Parameter {
        name: "limit",
        about: "How many points to give at most. The header strew-next is the cursor of the rest.",
        allowed: LIMIT,
        shape: Shape::Integer {
            min: 1,
            max: u64::MAX,
        },
        default: Some("all"),
        example: "2",
    },
    Parameter {
        name: "cursor",
        about: "Where an earlier answer to the same query ended: the value of its header \
                strew-next.",
        allowed: "the cursor of an earlier answer to the same query",
        shape: Shape::Pattern("^[0-9a-f]+$"),
        default: Some("the beginning"),
        example: "01000000000000000000000000000000000000290000000000000000000000000000005100000000000000000000000000000008000000000000000f000000000000007228ff94af7ec61562886f26",
    },
    Parameter {
        name: "table",
        about: "The digest of the table that has to answer: caches may keep the answer forever. \
                If another table would answer, there is a problem that names both.",
        allowed: DIGEST,
        shape: Shape::Pattern(pin::PATTERN),
        default: Some("whichever table the query leads to"),
        example: "985209040b65570b20f8b11cb6d95cad1d2260ad50bd5a1efb61251c18c8a075",
    },
    Parameter {
        name: "format",
        about: "The format of the answer; stronger than the header Accept.",
        allowed: "the name of a format",
        shape: Shape::OneOf(formats),
        default: Some("what Accept likes best, else json"),
        example: "csv",
    },
    Parameter {
        name: "decimals",
        about: "Decimals of all numbers in text formats, rounded to the nearest, ties to even; a \
                zero has no sign.",
        allowed: DECIMALS,
        shape: Shape::Integer {
            min: 0,
            max: MOST_DECIMALS as u64,
        },
        default: Some("the shortest digits that read back"),
        example: "3",
    },
    Parameter {
        name: "size",
        about: "The longer side of a picture in pixels, for png and svg.",
        allowed: SIZE,
        shape: Shape::Integer {
            min: LEAST_SIZE as i64,
            max: MOST_SIZE as u64,
        },
        default: Some("512"),
        example: "256",
    },
    Parameter {
        name: "at",
        about: "The place whose neighbors are asked for.",
        allowed: PLACE,
        shape: Shape::Numbers(2),
        default: None,
        example: "100.5,-3",
    },
    Parameter {
        name: "k",
        about: "How many of the nearest points are wanted.",
        allowed: NEAREST,
        shape: Shape::Integer {
            min: 1,
            max: MOST_NEAREST,
        },
        default: Some("1, or all within the radius"),
        example: "8",
    },
    Parameter {
        name: "radius",
        about: "How far away they may be.",
        allowed: RADIUS,
        shape: Shape::Number {
            min: 0.0,
            max: f64::MAX,
        },
        default: Some("however far"),
        example: "2",
    },
    Parameter {
        name: "parts",
        about: "How many queries to split the query into.",
        allowed: PARTS,
        shape: Shape::Integer {
            min: 1,
            max: MOST_PARTS as u64,
        },
        default: None,
        example: "4",
    },
];

/// The parameters that say what the points of a set are: also the members of one in JSON.
pub const SET_NAMES: [&str; 14] = [
    "density",
    "spacing",
    "min_distance",
    "count",
    "profile",
    "alpha",
    "map",
    "table",
    "seed",
    "warp",
    "keep",
    "attributes",
    "scale_range",
    "variants",
];
/// The parameters that say where; one of them.
pub const REGION_NAMES: [&str; 3] = ["bbox", "circle", "polygon"];
/// The parameters that say which of the points.
pub const WINDOW_NAMES: [&str; 3] = ["offset", "limit", "cursor"];
/// The parameters that say how the answer looks.
pub const LOOKS_NAMES: [&str; 3] = ["format", "decimals", "size"];

/// What a seed may be.
pub(super) const SEED: &str = "an integer from 0 to 18446744073709551615";

/// What an offset may be.
pub(super) const OFFSET: &str = "an integer from 0 to 18446744073709551615";
/// What a limit may be.
pub(super) const LIMIT: &str = "an integer from 1 to 18446744073709551615";
/// What a place may be.
pub(super) const PLACE: &str = "two finite numbers x,y";
/// The most neighbors of one answer.
pub(super) const MOST_NEAREST: u64 = 10_000;
/// What a number of neighbors may be.
pub(super) const NEAREST: &str = "an integer from 1 to 10000";
/// What a radius may be.
pub(super) const RADIUS: &str = "a finite number from 0 on";
/// What a number of parts may be.
pub(super) const PARTS: &str = "an integer from 1 to 10000";

fn formats() -> Vec<&'static str> {
    Encoding::ALL.map(Encoding::name).into()
}

impl Parameter {
    /// The parameter of a name.
    #[must_use]
    pub fn named(name: &str) -> Option<&'static Self> {
        PARAMETERS.iter().find(|parameter| parameter.name == name)
    }
}

/// The names, for a fault.
pub(super) fn names() -> String {
    let names: Vec<&str> = PARAMETERS.iter().map(|parameter| parameter.name).collect();
    names.join(", ")
}
