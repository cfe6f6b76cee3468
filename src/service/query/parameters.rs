//! What every parameter means and allows: one list, for reading, for faults and for the API's
//! description.

use strew_core::Spacing;

use super::{
    AMOUNT, BOX, DEFAULT_ALPHA, DEFAULT_PROFILE, WARP,
    pin::{self, DIGEST},
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
        about: "The region: a half-open box, min ≤ p < max on the reported coordinates.",
        allowed: BOX,
        shape: Shape::Numbers(4),
        default: None,
        example: "0,0,3,2",
    },
    Parameter {
        name: "density",
        about: "Points per unit of area. Either this or spacing.",
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
        about: "The mean spacing, density^-1/2. Either this or density.",
        allowed: AMOUNT,
        shape: Shape::Number {
            min: Spacing::MIN,
            max: Spacing::MAX,
        },
        default: None,
        example: "1",
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
];

/// What a seed may be.
pub(super) const SEED: &str = "an integer from 0 to 18446744073709551615";

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
