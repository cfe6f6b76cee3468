//! The parameters of requests about patterns: arrangements, clusters, maps and their figures; and of threshold masks.
//!
//! They stand beside the table of parameters because their names mean other things there: `alpha` is any
//! number between 1 and 2, `radius` that of a map, `size` counts pixels.

use strew_core::{LATTICE_LIMIT, map::Clusters, pattern::Arrangement};
use strew_forge::mask::Mask;

use super::{
    DEFAULT_ALPHA, Parameter, Shape,
    parameter::Group,
    parameters::{MAP as MAP_OF_SET, SEED as SEED_OF_SET, WARP as WARP_OF_SET},
};

pub const MOST_RADIUS: u32 = strew_core::map::MAX_RADIUS;
pub const MOST_MASK: u32 = 512;
pub const MOST_PLACED: usize = 1000;

/// Makes a static of each parameter, and the list of all.
macro_rules! parameters {
    ($($(#[$doc:meta])* $name:ident = $parameter:expr;)+) => {
        $($(#[$doc])* pub static $name: Parameter = $parameter;)+

        /// All parameters about patterns.
        pub static PATTERN_PARAMETERS: &[&Parameter] = &[$(&$name,)+];
    };
}

parameters! {
    ALPHA = Parameter {
        name: "alpha",
        about: "The number α of the pattern: a decimal, a fraction or a quadratic irrational.",
        group: Group::Pattern,
        shape: Shape::Quadratic,
        allowed: Some("a number between 1 and 2, not 1 or 2 themselves, such as 1.6, 13/8 or (1+sqrt(5))/2"),
        default: Some(DEFAULT_ALPHA),
        example: "sqrt(3)",
        ..Parameter::PLAIN
    };
    OFFSETS = Parameter {
        name: "offsets",
        about: "The offsets of the other points from the first, in grid units: x,y pairs. In an address they are \
                joined by spaces, each of which may be written as +.",
        group: Group::Arrangement,
        shape: Shape::Offsets { limit: Arrangement::MAX_OFFSET },
        allowed: Some("1 to 65536 pairs of integers within ±4503599627370496, such as 2,1 3,3"),
        is_required: true,
        example: "2,1 3,3",
        ..Parameter::PLAIN
    };
    SEED = Parameter {
        name: "seed",
        about: "The seed that moves the pattern. Occurrences are at the ids that its points have.",
        group: Group::Occurrences,
        ..SEED_OF_SET
    };
    GRID = Parameter {
        name: "grid",
        about: "A box of the grid: occurrences are counted whose first point has a column and a row from min \
                up to, but not including, max.",
        group: Group::Occurrences,
        shape: Shape::Integers {
            names: &["min_x", "min_y", "max_x", "max_y"],
            limit: LATTICE_LIMIT,
        },
        allowed: Some("four integers min_x,min_y,max_x,max_y within ±4503599627370496 with min_x <= max_x and \
                       min_y <= max_y"),
        default: Some("none: nothing is counted"),
        example: "0,0,20,10",
        ..Parameter::PLAIN
    };
    LIST = Parameter {
        name: "list",
        about: "Lists the occurrences in the box, in this format, in the order of points: bands of 1024 columns, \
                in a band rows, in a row columns.",
        group: Group::Occurrences,
        shape: Shape::Choice(&["json", "ndjson", "csv"]),
        default: Some("no list"),
        example: "csv",
        ..Parameter::PLAIN
    };
    LIMIT = Parameter {
        name: "limit",
        about: "The greatest number of occurrences in the list. The header strew-next is the cursor of the rest.",
        group: Group::Occurrences,
        shape: Shape::Integer { min: 1, max: u64::MAX },
        default: Some("all"),
        example: "2",
        ..Parameter::PLAIN
    };
    CURSOR = Parameter {
        name: "cursor",
        about: "Where an earlier list of the same arrangement ended: the value of its header strew-next, the \
                column and row of the next occurrence.",
        group: Group::Occurrences,
        shape: Shape::Pattern("^-?[0-9]{1,16}:-?[0-9]{1,16}$"),
        allowed: Some("a column and a row of the box joined by a colon, such as 3:-7"),
        default: Some("the beginning"),
        example: "3:-7",
        ..Parameter::PLAIN
    };
    MAP = Parameter {
        name: "map",
        group: Group::Occurrences,
        ..MAP_OF_SET
    };
    WARP = Parameter {
        name: "warp",
        group: Group::Occurrences,
        ..WARP_OF_SET
    };
    DISTANCE = Parameter {
        name: "distance",
        about: "The largest distance of neighbors in a cluster, in grid units.",
        group: Group::Clusters,
        shape: Shape::Number { min: 1.0, max: Clusters::MAX_DISTANCE },
        default: Some("2.24"),
        example: "2.24",
        ..Parameter::PLAIN
    };
    MOST = Parameter {
        name: "most",
        about: "The number of points up to which clusters are searched. Larger ones are counted together.",
        group: Group::Clusters,
        shape: Shape::Integer { min: 1, max: Clusters::MAX_POINTS as u64 },
        default: Some("64"),
        example: "16",
        ..Parameter::PLAIN
    };
    UP_TO = Parameter {
        name: "up_to",
        about: "Which clusters have the same shape: those that are translations of each other, or also those \
                that are symmetric to each other under the symmetries of the square.",
        group: Group::Shapes,
        shape: Shape::Choice(&["translation", "symmetry"]),
        default: Some("translation"),
        example: "symmetry",
        ..Parameter::PLAIN
    };
    RADIUS = Parameter {
        name: "radius",
        about: "The half-width R of the neighborhood map, in grid units.",
        group: Group::Map,
        shape: Shape::Integer { min: 0, max: MOST_RADIUS as u64 },
        default: Some("20"),
        example: "20",
        ..Parameter::PLAIN
    };
    BLOCK = Parameter {
        name: "block",
        about: "The block whose neighbors are wanted: its intervals of dX and dY, from 0.",
        group: Group::Map,
        shape: Shape::Integers { names: &["column", "row"], limit: 1 << 20 },
        allowed: Some("two integers column,row from 0 to the number of intervals less 1"),
        default: Some("none; of the figure 0,0"),
        example: "0,0",
        ..Parameter::PLAIN
    };
    REFINED = Parameter {
        name: "refined",
        about: "The half-width R' of a finer map: for each of its intervals the one of R that holds it.",
        group: Group::Refined,
        shape: Shape::Integer { min: 0, max: MOST_RADIUS as u64 },
        allowed: Some("an integer from radius to 1024"),
        default: Some("none"),
        example: "40",
        ..Parameter::PLAIN
    };
    WINDOW = Parameter {
        name: "window",
        about: "The side of the window of the plane, in grid units.",
        group: Group::Figure,
        shape: Shape::Integer { min: 8, max: 200 },
        default: Some("64 for the index, 48 for an arrangement, 96 for clusters"),
        example: "64",
        ..Parameter::PLAIN
    };
    PIXELS = Parameter {
        name: "size",
        about: "The longer side of the picture in pixels.",
        group: Group::Picture,
        shape: Shape::Integer { min: 64, max: 2048 },
        default: Some("1600"),
        example: "800",
        ..Parameter::PLAIN
    };
    MASK_SIZE = Parameter {
        name: "size",
        about: "The side of the mask in pixels.",
        group: Group::Mask,
        shape: Shape::Integer { min: Mask::LEAST_SIZE as u64, max: MOST_MASK as u64 },
        default: Some("256"),
        example: "64",
        ..Parameter::PLAIN
    };
    MASK_SEED = Parameter {
        name: "seed",
        about: "Which mask: every seed has another one.",
        group: Group::Mask,
        ..SEED_OF_SET
    };
    BITS = Parameter {
        name: "bits",
        about: "The bits of a threshold.",
        group: Group::MaskFile,
        shape: Shape::Choice(&["8", "16"]),
        allowed: Some("8 or 16"),
        default: Some("8"),
        example: "16",
        ..Parameter::PLAIN
    };
}
