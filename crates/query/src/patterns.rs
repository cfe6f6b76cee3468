//! The parameters of requests about patterns: arrangements, clusters, maps and their figures; and of threshold masks.
//!
//! They stand beside the table of parameters because their names mean other things there: `alpha` is any
//! number between 1 and 2, `radius` that of a map, `size` counts pixels.

use strew_core::{LATTICE_LIMIT, map::Clusters, pattern::Arrangement};
use strew_forge::mask::Mask;

use super::{
    DEFAULT_ALPHA, Parameter, Shape,
    parameter::parameter,
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
    ALPHA = parameter!("alpha" of Pattern {
        about: "The number α of the pattern: a decimal, a fraction or a quadratic irrational.",
        shape: Shape::Quadratic,
        allowed: Some("a number between 1 and 2, not 1 or 2 themselves, such as 1.6, 13/8 or (1+sqrt(5))/2"),
        default: Some(DEFAULT_ALPHA),
        example: "sqrt(3)",
    });
    OFFSETS = parameter!("offsets" of Arrangement {
        about: "The offsets of the other points from the first, in grid units: x,y pairs. In an address they are \
                joined by spaces, each of which may be written as +.",
        shape: Shape::Offsets { limit: Arrangement::MAX_OFFSET },
        allowed: Some("1 to 65536 pairs of integers within ±4503599627370496, such as 2,1 3,3"),
        is_required: true,
        example: "2,1 3,3",
    });
    SEED = parameter!("seed" of Occurrences {
        about: "The seed that moves the pattern. Occurrences are at the ids that its points have.",
        ..SEED_OF_SET
    });
    GRID = parameter!("grid" of Occurrences {
        about: "A box of the grid: occurrences are counted whose first point has a column and a row from min \
                up to, but not including, max.",
        shape: Shape::Integers {
            names: &["min_x", "min_y", "max_x", "max_y"],
            limit: LATTICE_LIMIT,
        },
        allowed: Some("four integers min_x,min_y,max_x,max_y within ±4503599627370496 with min_x <= max_x and \
                       min_y <= max_y"),
        default: Some("none: nothing is counted"),
        example: "0,0,20,10",
    });
    LIST = parameter!("list" of Occurrences {
        about: "Lists the occurrences in the box, in this format, in the order of points: bands of 1024 columns, \
                in a band rows, in a row columns.",
        shape: Shape::Choice(&["json", "ndjson", "csv"]),
        default: Some("no list"),
        example: "csv",
    });
    LIMIT = parameter!("limit" of Occurrences {
        about: "The greatest number of occurrences in the list. The header strew-next is the cursor of the rest.",
        shape: Shape::Integer { min: 1, max: u64::MAX },
        default: Some("all"),
        example: "2",
    });
    CURSOR = parameter!("cursor" of Occurrences {
        about: "Where an earlier list of the same arrangement ended: the value of its header strew-next, the \
                column and row of the next occurrence.",
        shape: Shape::Pattern("^-?[0-9]{1,16}:-?[0-9]{1,16}$"),
        allowed: Some("a column and a row of the box joined by a colon, such as 3:-7"),
        default: Some("the beginning"),
        example: "3:-7",
    });
    MAP = parameter!("map" of Occurrences { ..MAP_OF_SET });
    WARP = parameter!("warp" of Occurrences { ..WARP_OF_SET });
    DISTANCE = parameter!("distance" of Clusters {
        about: "The largest distance of neighbors in a cluster, in grid units.",
        shape: Shape::Number { min: 1.0, max: Clusters::MAX_DISTANCE },
        default: Some("2.24"),
        example: "2.24",
    });
    MOST = parameter!("most" of Clusters {
        about: "The number of points up to which clusters are searched. Larger ones are counted together.",
        shape: Shape::Integer { min: 1, max: Clusters::MAX_POINTS as u64 },
        default: Some("64"),
        example: "16",
    });
    UP_TO = parameter!("up_to" of Shapes {
        about: "Which clusters have the same shape: those that are translations of each other, or also those \
                that are symmetric to each other under the symmetries of the square.",
        shape: Shape::Choice(&["translation", "symmetry"]),
        default: Some("translation"),
        example: "symmetry",
    });
    RADIUS = parameter!("radius" of Map {
        about: "The half-width R of the neighborhood map, in grid units.",
        shape: Shape::Integer { min: 0, max: MOST_RADIUS as u64 },
        default: Some("20"),
        example: "20",
    });
    BLOCK = parameter!("block" of Map {
        about: "The block whose neighbors are wanted: its intervals of dX and dY, from 0.",
        shape: Shape::Integers { names: &["column", "row"], limit: 1 << 20 },
        allowed: Some("two integers column,row from 0 to the number of intervals less 1"),
        default: Some("none; of the figure 0,0"),
        example: "0,0",
    });
    REFINED = parameter!("refined" of Refined {
        about: "The half-width R' of a finer map: for each of its intervals the one of R that holds it.",
        shape: Shape::Integer { min: 0, max: MOST_RADIUS as u64 },
        allowed: Some("an integer from radius to 1024"),
        default: Some("none"),
        example: "40",
    });
    WINDOW = parameter!("window" of Figure {
        about: "The side of the window of the plane, in grid units.",
        shape: Shape::Integer { min: 8, max: 200 },
        default: Some("64 for the index, 48 for an arrangement, 96 for clusters"),
        example: "64",
    });
    PIXELS = parameter!("size" of Picture {
        about: "The longer side of the picture in pixels.",
        shape: Shape::Integer { min: 64, max: 2048 },
        default: Some("1600"),
        example: "800",
    });
    MASK_SIZE = parameter!("size" of Mask {
        about: "The side of the mask in pixels.",
        shape: Shape::Integer { min: Mask::LEAST_SIZE as u64, max: MOST_MASK as u64 },
        default: Some("256"),
        example: "64",
    });
    MASK_SEED = parameter!("seed" of Mask {
        about: "Which mask: every seed has another one.",
        ..SEED_OF_SET
    });
    BITS = parameter!("bits" of MaskFile {
        about: "The bits of a threshold.",
        shape: Shape::Choice(&["8", "16"]),
        allowed: Some("8 or 16"),
        default: Some("8"),
        example: "16",
    });
}
