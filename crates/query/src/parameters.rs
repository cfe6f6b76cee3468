//! The table of parameters: each is described once, here.
//!
//! Addresses, command lines, JSON bodies, messages, worlds, echoes, help texts and the API's
//! description are loops over this table. ARCHITECTURE.md says how to add a parameter.

use strew_core::{Keep, PeriodicSet, ScaleRange, Spacing, UniformNumber, Variants, Warp};
use strew_encode::{
    CRS as CRS_ALLOWED, MOST_DECIMALS,
    preview::{LEAST_SIZE, MOST_SIZE},
};

use crate::{
    defaults::{DEFAULT_ALPHA, DEFAULT_PROFILE, MOST_PARTS},
    parameter::{Group, Parameter},
    schema::TITLE,
    shape::Shape,
    spread::Spread,
};

mod named;
mod terrain;
mod thinned;

/// Makes a static of each parameter, and the list of all.
macro_rules! parameters {
    ($($(#[$doc:meta])* $name:ident = $parameter:expr;)+) => {
        $($(#[$doc])* pub static $name: Parameter = $parameter;)+

        /// All parameters, in the order of help texts.
        pub static PARAMETERS: &[&Parameter] = &[
            $(&$name,)+
            #[cfg(test)] &crate::recipe::ADDED,
        ];
    };
}

pub const MOST_PERIODS: u64 = 1000;

/// The most points of an answer about neighbors.
pub const MOST_NEAREST: u64 = 10_000;

const SPACING_SHAPE: Shape = Shape::Number {
    min: Spacing::MIN,
    max: Spacing::MAX,
};

parameters! {
    BBOX = Parameter {
        name: "bbox",
        about: "The region as a box: min ≤ p < max on the reported coordinates.",
        group: Group::Region,
        shape: Shape::Numbers(&["min_x", "min_y", "max_x", "max_y"]),
        allowed: Some("four finite numbers min_x,min_y,max_x,max_y with min_x < max_x and min_y < max_y"),
        example: "0,0,3,2",
        ..Parameter::PLAIN
    };
    CIRCLE = Parameter {
        name: "circle",
        about: "The region as a circle: the points nearer to x,y than the radius.",
        group: Group::Region,
        shape: Shape::Numbers(&["x", "y", "radius"]),
        allowed: Some("three finite numbers x,y,radius with a radius above 0"),
        example: "5,5,3",
        ..Parameter::PLAIN
    };
    POLYGON = Parameter {
        name: "polygon",
        about: "The region as a polygon with these vertices. Polygons that share an edge share no \
                point and leave none out.",
        group: Group::Region,
        shape: Shape::Vertices,
        allowed: Some("at least 3 different vertices as x1,y1,x2,y2,x3,y3,…; for holes and several \
                       polygons send the query as JSON"),
        example: "0,0,4,0,0,4",
        ..Parameter::RARE
    };
    PERIODIC = Parameter {
        name: "periodic",
        about: "One exact period of points on [0, L)² instead of a region: the smallest that has at least this \
                many points. Its copies, moved by L, continue one another. L is the mean spacing times the root of \
                the number of points. Small maps have more periods: with map=m, the default, 5000 becomes 57121, with \
                map=s 5041. The list of periods has all.",
        group: Group::Period,
        shape: Shape::Integer { min: 1, max: PeriodicSet::MAX_POINTS },
        default: Some("the points of a region, on the unbounded plane"),
        example: "5000",
        is_echoed: true,
        ..Parameter::PLAIN
    };
    /// Points per unit of area.
    DENSITY = Parameter {
        name: "density",
        about: "Points per unit of area, in space of volume.",
        group: Group::Amount,
        shape: Shape::Number { min: Spacing::MIN_DENSITY, max: Spacing::MAX_DENSITY },
        example: "1",
        ..Parameter::PLAIN
    };
    SPACING = Parameter {
        name: "spacing",
        about: "The mean spacing in world units: density^-1/2, in space density^-1/3.",
        group: Group::Amount,
        shape: SPACING_SHAPE,
        example: "1",
        ..Parameter::PLAIN
    };
    MIN_DISTANCE = Parameter {
        name: "min_distance",
        about: "The least distance of any two points in world units: the density is the greatest that \
                guarantees it, with the warp. Not for profiles that guarantee none.",
        group: Group::Amount,
        shape: SPACING_SHAPE,
        example: "1",
        ..Parameter::PLAIN
    };
    COUNT = Parameter {
        name: "count",
        about: "The exact number of points in the region: the density follows from it.",
        group: Group::Count,
        shape: Shape::Integer { min: 1, max: u64::MAX },
        example: "100",
        ..Parameter::PLAIN
    };
    WORLD = named::WORLD;
    WORLD_DIGEST = named::WORLD_DIGEST;
    PROFILE = Parameter {
        name: "profile",
        about: "The noise profile. The list of profiles shows what is loaded.",
        group: Group::Profile,
        allowed: Some("the name of a loaded profile"),
        default: Some(DEFAULT_PROFILE),
        example: "blue",
        is_echoed: true,
        ..Parameter::PLAIN
    };
    ALPHA = Parameter {
        name: "alpha",
        about: "The number α of the pattern, as a decimal, a fraction or a quadratic irrational.",
        group: Group::Table,
        shape: Shape::Quadratic,
        allowed: Some("a number for which the profile is loaded"),
        default: Some(DEFAULT_ALPHA),
        example: "(5-sqrt(3))/2",
        is_echoed: true,
        ..Parameter::RARE
    };
    MAP = Parameter {
        name: "map",
        about: "The size of the neighborhood map: larger maps have better quality and take more memory.",
        group: Group::Table,
        allowed: Some("s, m or l, if the profile is loaded with it"),
        default: Some("m, of pink l, if it is loaded, else s or the smallest"),
        example: "s",
        is_echoed: true,
        ..Parameter::RARE
    };
    TABLE = Parameter {
        name: "table",
        about: "The digest of the table that must answer: caches may keep the answer forever. If \
                another table would answer, the query is refused.",
        group: Group::Table,
        shape: Shape::Pattern("^[0-9a-fA-F]{64}$"),
        allowed: Some("64 hexadecimal digits, as in the header strew-table"),
        default: Some("any table that fits the query"),
        example: "964d5f8f3b54b47d272533f84423daa3e9b1dd6624fa906325132538c062fa4a",
        ..Parameter::RARE
    };
    SEED = Parameter {
        name: "seed",
        about: "Which set of points. Seed 0 is the plain pattern, every other seed a set of its own. Beside layers: \
                the common seed, from which each layer without a seed has one by its name.",
        group: Group::Points,
        shape: Shape::Integer { min: 0, max: u64::MAX },
        default: Some("0"),
        example: "7",
        is_echoed: true,
        ..Parameter::PLAIN
    };
    WARP = Parameter {
        name: "warp",
        about: "The strength of the warp that makes a set isotropic and unlike those of other seeds: 0 \
                (off), 1 (on), or between 0 and 2.",
        group: Group::Points,
        shape: Shape::Strength { max: Warp::MAX_STRENGTH },
        default: Some("off for seed 0, else on"),
        example: "on",
        is_echoed: true,
        ..Parameter::RARE
    };
    /// The share of points to keep.
    KEEP = Parameter {
        name: "keep",
        about: "The share of points to keep, those of the lowest rank. A smaller share keeps a subset \
                of a larger one.",
        group: Group::Points,
        shape: Shape::Number { min: Keep::MIN, max: 1.0 },
        default: Some("1"),
        example: "0.5",
        is_echoed: true,
        ..Parameter::PLAIN
    };
    SETTLE = thinned::SETTLE;
    LOD = thinned::LOD;
    FIELD = Parameter {
        name: "field",
        about: "The field that thins the points out, from place to place: a share of the density, which is \
                that where the field is 1. The list of fields shows what is loaded.",
        group: Group::Thinned,
        shape: Shape::Field,
        default: Some("none"),
        example: "forest",
        is_echoed: true,
        ..Parameter::PLAIN
    };
    EXCEPT = named::EXCEPT;
    ATTRIBUTES = Parameter {
        name: "attributes",
        about: "Further values of each point, hashed from its id and the seed: angle (radians, 0 to \
                2π), scale (within scale_range), variant (one of variants, by weight), rank (0 to \
                1, see keep), u1 to u16 (uniform, 0 to 1).",
        group: Group::Attributes,
        shape: Shape::Names {
            pattern: "^(angle|scale|variant|rank|u([1-9]|1[0-6]))$",
        },
        allowed: Some("different names of angle, scale, variant, rank and u1 to u16, joined by commas"),
        default: Some("none"),
        example: "angle,u1",
        is_echoed: true,
        ..Parameter::PLAIN
    };
    /// The range of the attribute `scale`.
    SCALE_RANGE = Parameter {
        name: "scale_range",
        about: "The least and the greatest value of the attribute scale.",
        group: Group::Choices,
        shape: Shape::Numbers(&["min", "max"]),
        allowed: Some("two numbers min,max with 0 <= min <= max <= 1e9, beside the attribute scale"),
        default: Some("0,1"),
        example: "0.8,1.2",
        is_echoed: true,
        ..Parameter::RARE
    };
    /// The ranges of the attribute `scale` by variant.
    SCALE_RANGES = Parameter {
        name: "scale_ranges",
        about: "The least and the greatest value of the attribute scale for each variant.",
        group: Group::Choices,
        shape: Shape::Ranges,
        allowed: Some("name:min:max for each of the variants, joined by commas, such as oak:0.8:1.2,birch:0.5:0.7, \
                       beside the attribute scale and variants; with 0 <= min <= max <= 1e9"),
        default: Some("scale_range for all"),
        example: "oak:0.8:1.2,birch:0.5:0.7",
        is_echoed: true,
        ..Parameter::RARE
    };
    /// The choices of the attribute `variant`.
    VARIANTS = Parameter {
        name: "variants",
        about: "The names that the attribute variant chooses from, with their weights. Their order does \
                not matter.",
        group: Group::Choices,
        shape: Shape::Weights,
        allowed: Some("name:weight pairs joined by commas, such as oak:3,birch:1, beside the attribute \
                       variant or a spread other than chance: 1 to 256 different names of 1 to 64 letters, digits, _, - and ., \
                       weights from 1e-9 to 1e9"),
        example: "oak:3,birch:1",
        is_echoed: true,
        ..Parameter::PLAIN
    };
    SPREAD = Parameter {
        name: "spread",
        about: "How variants are spread. chance: each point has one by chance. even: each variant is evenly \
                spread, like the points of all of them together, which do not move. joint: more evenly still, on \
                a table made for these shares.",
        group: Group::Attributes,
        shape: Shape::Choice(Spread::NAMES),
        default: Some("chance"),
        example: "even",
        is_echoed: true,
        ..Parameter::RARE
    };
    VARIANT_FIELDS = Parameter {
        name: "variant_fields",
        about: "The fields that multiply the weights of variants, from place to place. A variant without one has \
                its weight; where all weights are zero, the fields do not count.",
        group: Group::Attributes,
        shape: Shape::Fields,
        allowed: Some("name:field pairs joined by commas, such as birch:river, each name one of variants, each field \
                       the name of a loaded one or in JSON also an object that describes one, with spread even"),
        default: Some("none"),
        example: "birch:forest",
        is_echoed: true,
        ..Parameter::PLAIN
    };
    ONLY = Parameter {
        name: "only",
        about: "The one variant whose points are wanted, of those that are evenly spread. Beside layers: the one \
                layer.",
        group: Group::Attributes,
        shape: Shape::Pattern(TITLE),
        allowed: Some("one of the names in variants, with spread even or joint; or the name of a layer"),
        default: Some("all of them"),
        example: "oak",
        is_echoed: true,
        ..Parameter::RARE
    };
    OFFSET = Parameter {
        name: "offset",
        about: "The number of points to leave out, in the fixed order, from the start or after the \
                cursor.",
        group: Group::Window,
        shape: Shape::Integer { min: 0, max: u64::MAX },
        default: Some("0"),
        example: "3",
        ..Parameter::RARE
    };
    LIMIT = Parameter {
        name: "limit",
        about: "The greatest number of points in the answer. The header strew-next is the cursor of the \
                rest.",
        group: Group::Window,
        shape: Shape::Integer { min: 1, max: u64::MAX },
        default: Some("all"),
        example: "2",
        ..Parameter::PLAIN
    };
    CURSOR = Parameter {
        name: "cursor",
        about: "Where an earlier answer to the same query ended: the value of its header strew-next.",
        group: Group::Window,
        shape: Shape::Pattern("^[0-9a-f]+$"),
        allowed: Some("the cursor of an earlier answer to the same query"),
        default: Some("the beginning"),
        example: "01000000000000000000000000000000000000290000000000000000000000000000005100000000000000000000000000000008000000000000000f000000000000007228ff94af7ec61562886f26",
        ..Parameter::RARE
    };
    FORMAT = Parameter {
        name: "format",
        about: "The format of the answer; overrides the header Accept.",
        group: Group::Output,
        shape: Shape::Format,
        default: Some("the preferred one of Accept, else json"),
        example: "csv",
        ..Parameter::PLAIN
    };
    DECIMALS = Parameter {
        name: "decimals",
        about: "The number of decimals in text formats, rounded to the nearest, ties to even; zero has \
                no sign. Coordinates are rounded within the box around the region: min ≤ p < max stays true.",
        group: Group::Output,
        shape: Shape::Integer { min: 0, max: MOST_DECIMALS as u64 },
        default: Some("the fewest digits that read back as the same number"),
        example: "3",
        ..Parameter::RARE
    };
    SIZE = Parameter {
        name: "size",
        about: "The longer side of a picture (png, svg) in pixels.",
        group: Group::Output,
        shape: Shape::Integer { min: LEAST_SIZE as u64, max: MOST_SIZE as u64 },
        default: Some("512"),
        example: "256",
        ..Parameter::RARE
    };
    /// Whether a stream of lines ends with a summary.
    SUMMARY = Parameter {
        name: "summary",
        about: "Whether ndjson ends with a line that is not a point: the query, the table and the count. \
                Without it, programs that expect rows of one kind read the answer.",
        group: Group::Output,
        shape: Shape::Switch,
        default: Some("on"),
        example: "off",
        ..Parameter::RARE
    };
    CRS = Parameter {
        name: "crs",
        about: "The coordinate reference system of the plane, for geojson and Parquet: by default that of the \
                region and of GeoTIFFs; another one is refused, since coordinates do not change. Without one \
                readers of GeoJSON take coordinates for degrees.",
        group: Group::Reference,
        shape: Shape::Pattern("^[A-Za-z]{1,16}:[A-Za-z0-9]{1,16}$"),
        allowed: Some(CRS_ALLOWED),
        default: Some("none"),
        example: "EPSG:3857",
        ..Parameter::RARE
    };
    AT = Parameter {
        name: "at",
        about: "The place whose neighbors are wanted.",
        group: Group::Nearest,
        shape: Shape::Numbers(&["x", "y"]),
        is_required: true,
        example: "100.5,-3",
        ..Parameter::PLAIN
    };
    K = Parameter {
        name: "k",
        about: "The number of nearest points.",
        group: Group::Neighbors,
        shape: Shape::Integer { min: 1, max: MOST_NEAREST },
        default: Some("1, or all within the radius"),
        example: "8",
        ..Parameter::PLAIN
    };
    RADIUS = Parameter {
        name: "radius",
        about: "The greatest distance from the place, in world units: points at exactly this distance, as reported, are found.",
        group: Group::Neighbors,
        shape: Shape::Number { min: 0.0, max: f64::MAX },
        default: Some("unlimited"),
        example: "2",
        ..Parameter::PLAIN
    };
    MOST = Parameter {
        name: "most",
        about: "The greatest number of entries of the list.",
        group: Group::Listed,
        shape: Shape::Integer { min: 1, max: MOST_PERIODS },
        default: Some("100"),
        example: "4",
        ..Parameter::PLAIN
    };
    PARTS = Parameter {
        name: "parts",
        about: "The number of queries to split the query into.",
        group: Group::Split,
        shape: Shape::Integer { min: 1, max: MOST_PARTS },
        is_required: true,
        example: "4",
        ..Parameter::PLAIN
    };
    TERRAIN = terrain::TERRAIN;
    HEIGHTS = terrain::HEIGHTS;
    NORMALS = terrain::NORMALS;
    ALIGN = terrain::ALIGN;
}

/// The figures that texts of the table repeat.
const _: () = assert!(
    UniformNumber::MAX == 16
        && Variants::MAX == 256
        && Variants::MAX_NAME == 64
        && ScaleRange::LIMIT == 1e9
);
