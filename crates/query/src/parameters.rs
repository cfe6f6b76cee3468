//! The table of parameters: each is described once, here.
//!
//! Addresses, command lines, JSON bodies, messages, worlds, echoes, help texts and the API's
//! description are loops over this table. ARCHITECTURE.md says how to add a parameter.

use strew_catalog::except::MOST_GIVEN;
use strew_core::{Keep, PeriodicSet, ScaleRange, Settle, Spacing, UniformNumber, Variants, Warp};
use strew_encode::{
    CRS as CRS_ALLOWED, MOST_DECIMALS,
    preview::{LEAST_SIZE, MOST_SIZE},
};

use crate::{
    defaults::{DEFAULT_ALPHA, DEFAULT_PROFILE, MOST_PARTS},
    parameter::{Parameter, parameter},
    schema::TITLE,
    shape::Shape,
    spread::Spread,
};

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
    BBOX = parameter!("bbox" of Region {
        about: "The region as a box: min ≤ p < max on the reported coordinates.",
        shape: Shape::Numbers(&["min_x", "min_y", "max_x", "max_y"]),
        allowed: Some("four finite numbers min_x,min_y,max_x,max_y with min_x < max_x and min_y < max_y"),
        example: "0,0,3,2",
    });
    CIRCLE = parameter!("circle" of Region {
        about: "The region as a circle: the points nearer to x,y than the radius.",
        shape: Shape::Numbers(&["x", "y", "radius"]),
        allowed: Some("three finite numbers x,y,radius with a radius above 0"),
        example: "5,5,3",
    });
    POLYGON = parameter!("polygon" of Region {
        about: "The region as a polygon with these vertices. Polygons that share an edge share no \
                point and leave none out.",
        shape: Shape::Vertices,
        allowed: Some("at least 3 different vertices as x1,y1,x2,y2,x3,y3,…; for holes and several \
                       polygons send the query as JSON"),
        example: "0,0,4,0,0,4",
        ..Parameter::RARE
    });
    PERIODIC = parameter!("periodic" of Period {
        about: "One exact period of points on [0, L)² instead of a region: the smallest that has at least this \
                many points. Its copies, moved by L, continue one another. L is the mean spacing times the root of \
                the number of points. Small maps have more periods: with map=m, the default, 5000 becomes 57121, with \
                map=s 5041. The list of periods has all.",
        shape: Shape::Integer { min: 1, max: PeriodicSet::MAX_POINTS },
        default: Some("the points of a region, on the unbounded plane"),
        example: "5000",
        is_echoed: true,
    });
    /// Points per unit of area.
    DENSITY = parameter!("density" of Amount {
        about: "Points per unit of area, in space of volume.",
        shape: Shape::Number { min: Spacing::MIN_DENSITY, max: Spacing::MAX_DENSITY },
        example: "1",
    });
    SPACING = parameter!("spacing" of Amount {
        about: "The mean spacing in world units: density^-1/2, in space density^-1/3.",
        shape: SPACING_SHAPE,
        example: "1",
    });
    MIN_DISTANCE = parameter!("min_distance" of Amount {
        about: "The least distance of any two points in world units: the density is the greatest that \
                guarantees it, with the warp. Not for profiles that guarantee none.",
        shape: SPACING_SHAPE,
        example: "1",
    });
    COUNT = parameter!("count" of Count {
        about: "The exact number of points in the region: the density follows from it.",
        shape: Shape::Integer { min: 1, max: u64::MAX },
        example: "100",
    });
    WORLD = parameter!("world" of World {
        about: "The world that everything is taken from that the query leaves open: layers or a set of \
                points, seed, limit, format. The list of worlds shows what is loaded.",
        allowed: Some("the name of a loaded world"),
        default: Some("none"),
        example: "forest",
    });
    WORLD_DIGEST = parameter!("world_digest" of WorldPin {
        about: "The digest that the world must have: caches may keep the answer forever. If the server's world \
                has another one, the query is refused.",
        shape: Shape::Pattern("^[0-9a-fA-F]{64}$"),
        allowed: Some("64 hexadecimal digits, as in the header strew-world, beside world"),
        default: Some("any"),
        example: "964d5f8f3b54b47d272533f84423daa3e9b1dd6624fa906325132538c062fa4a",
        ..Parameter::RARE
    });
    PROFILE = parameter!("profile" of Profile {
        about: "The noise profile. The list of profiles shows what is loaded.",
        allowed: Some("the name of a loaded profile"),
        default: Some(DEFAULT_PROFILE),
        example: "blue",
        is_echoed: true,
    });
    ALPHA = parameter!("alpha" of Table {
        about: "The number α of the pattern, as a decimal, a fraction or a quadratic irrational.",
        shape: Shape::Quadratic,
        allowed: Some("a number for which the profile is loaded"),
        default: Some(DEFAULT_ALPHA),
        example: "(5-sqrt(3))/2",
        is_echoed: true,
        ..Parameter::RARE
    });
    MAP = parameter!("map" of Table {
        about: "The size of the neighborhood map: larger maps have better quality and take more memory.",
        allowed: Some("s, m or l, if the profile is loaded with it"),
        default: Some("m; of pink l; if it is not loaded, s or the smallest, unless profile and alpha are the default"),
        example: "s",
        is_echoed: true,
        ..Parameter::RARE
    });
    TABLE = parameter!("table" of Table {
        about: "The digest of the table that must answer: caches may keep the answer forever. If \
                another table would answer, the query is refused.",
        shape: Shape::Pattern("^[0-9a-fA-F]{64}$"),
        allowed: Some("64 hexadecimal digits, as in the header strew-table"),
        default: Some("any table that fits the query"),
        example: "964d5f8f3b54b47d272533f84423daa3e9b1dd6624fa906325132538c062fa4a",
        ..Parameter::RARE
    });
    SEED = parameter!("seed" of Points {
        about: "Which set of points. Seed 0 is the plain pattern, every other seed a set of its own. Beside layers: \
                the common seed, from which each layer without a seed has one by its name.",
        shape: Shape::Integer { min: 0, max: u64::MAX },
        default: Some("0"),
        example: "7",
        is_echoed: true,
    });
    WARP = parameter!("warp" of Points {
        about: "The strength of the warp that makes a set isotropic and unlike those of other seeds: 0 \
                (off), 1 (on), or between 0 and 2.",
        shape: Shape::Strength { max: Warp::MAX_STRENGTH },
        default: Some("off for seed 0, else on"),
        example: "on",
        is_echoed: true,
        ..Parameter::RARE
    });
    /// The share of points to keep.
    KEEP = parameter!("keep" of Points {
        about: "The share of points to keep, those of the lowest rank. A smaller share keeps a subset \
                of a larger one.",
        shape: Shape::Number { min: Keep::MIN, max: 1.0 },
        default: Some("1"),
        example: "0.5",
        is_echoed: true,
    });
    SETTLE = parameter!("settle" of Points {
        about: "The steps by which the points of a set that is thinned or in a field move apart, so that they are \
                spread evenly: 0 leaves them where their ranks have them, 4 is the smoothest. Each step takes its \
                time. Sets with all points stay by default; for them 1 is one small step that moves the nearest \
                points apart, and more count as 1. In space they stay: it counts as 0.",
        shape: Shape::Integer {
            min: 0,
            max: Settle::MAX_STEPS as u64,
        },
        default: Some("2; 0 for sets with all points"),
        example: "3",
        is_echoed: true,
        ..Parameter::RARE
    });
    LOD = parameter!("lod" of Points {
        about: "The level of detail: the part of the points that the answer has, at each place those of the lowest \
                rank. None of them moves, so a level has a part of the points of a finer one, in fields, of kinds \
                and of layers, too. Beside layers: of all of them; they keep clear of all points of each other.",
        shape: Shape::Number {
            min: Keep::MIN,
            max: 1.0,
        },
        default: Some("1"),
        example: "0.25",
        is_echoed: true,
        ..Parameter::RARE
    });
    FIELD = parameter!("field" of Points {
        about: "The field that thins the points out, from place to place: a share of the density, which is \
                that where the field is 1. The list of fields shows what is loaded.",
        shape: Shape::Field,
        default: Some("none"),
        example: "forest",
        is_echoed: true,
    });
    EXCEPT = parameter!("except" of Except {
        about: "The points that are left out, by their ids, lists of the server by their names, and lists that were sent \
                by their digests. Other layers keep clear of them all the same. Beside layers ids are layer/column:row. \
                The list of lists shows what is loaded.",
        shape: Shape::Names {
            pattern: "^(.{1,64}/)?-?[0-9]+:-?[0-9]+(:-?[0-9]+)?$|^[A-Za-z0-9_.-]{1,64}$",
        },
        allowed: Some(
            "at most 10000 ids of points (column:row, in space x:y:z, beside layers layer/column:row) and names of \
                       loaded lists or digests of sent ones, joined by commas; not with count or periodic",
        ),
        default: Some("none"),
        example: "18:-17",
        is_echoed: true,
        ..Parameter::RARE
    });
    ATTRIBUTES = parameter!("attributes" of Attributes {
        about: "Further values of each point, hashed from its id and the seed: angle (radians, 0 to \
                2π), scale (within scale_range), variant (one of variants, by weight), rank (0 to \
                1, see keep), u1 to u16 (uniform, 0 to 1).",
        shape: Shape::Names {
            pattern: "^(angle|scale|variant|rank|u([1-9]|1[0-6]))$",
        },
        allowed: Some("different names of angle, scale, variant, rank and u1 to u16, joined by commas"),
        default: Some("none"),
        example: "angle,u1",
        is_echoed: true,
    });
    /// The range of the attribute `scale`.
    SCALE_RANGE = parameter!("scale_range" of Choices {
        about: "The least and the greatest value of the attribute scale.",
        shape: Shape::Numbers(&["min", "max"]),
        allowed: Some("two numbers min,max with 0 <= min <= max <= 1e9, beside the attribute scale"),
        default: Some("0,1"),
        example: "0.8,1.2",
        is_echoed: true,
        ..Parameter::RARE
    });
    /// The ranges of the attribute `scale` by variant.
    SCALE_RANGES = parameter!("scale_ranges" of Choices {
        about: "The least and the greatest value of the attribute scale for each variant.",
        shape: Shape::Ranges,
        allowed: Some("name:min:max for each of the variants, joined by commas, such as oak:0.8:1.2,birch:0.5:0.7, \
                       beside the attribute scale and variants; with 0 <= min <= max <= 1e9"),
        default: Some("scale_range for all"),
        example: "oak:0.8:1.2,birch:0.5:0.7",
        is_echoed: true,
        ..Parameter::RARE
    });
    /// The choices of the attribute `variant`.
    VARIANTS = parameter!("variants" of Choices {
        about: "The names that the attribute variant chooses from, with their weights. Their order does \
                not matter.",
        shape: Shape::Weights,
        allowed: Some("name:weight pairs joined by commas, such as oak:3,birch:1, beside the attribute \
                       variant or a spread other than chance: 1 to 256 different names of 1 to 64 letters, digits, _, - and ., \
                       weights from 1e-9 to 1e9"),
        example: "oak:3,birch:1",
        is_echoed: true,
    });
    SPREAD = parameter!("spread" of Attributes {
        about: "How variants are spread. chance: each point has one by chance. even: each variant is evenly \
                spread, like the points of all of them together, which do not move. joint: more evenly still, on \
                a table made for these shares.",
        shape: Shape::Choice(Spread::NAMES),
        default: Some("chance"),
        example: "even",
        is_echoed: true,
        ..Parameter::RARE
    });
    VARIANT_FIELDS = parameter!("variant_fields" of Attributes {
        about: "The fields that multiply the weights of variants, from place to place. A variant without one has \
                its weight; where all weights are zero, the fields do not count.",
        shape: Shape::Fields,
        allowed: Some("name:field pairs joined by commas, such as birch:river, each name one of variants, each field \
                       the name of a loaded one or in JSON also an object that describes one, with spread even"),
        default: Some("none"),
        example: "birch:forest",
        is_echoed: true,
    });
    ONLY = parameter!("only" of Attributes {
        about: "The one variant whose points are wanted, of those that are evenly spread. Beside layers: the one \
                layer.",
        shape: Shape::Pattern(TITLE),
        allowed: Some("one of the names in variants, with spread even or joint; or the name of a layer"),
        default: Some("all of them"),
        example: "oak",
        is_echoed: true,
        ..Parameter::RARE
    });
    OFFSET = parameter!("offset" of Window {
        about: "The number of points to leave out, in the fixed order, from the start or after the \
                cursor.",
        shape: Shape::Integer { min: 0, max: u64::MAX },
        default: Some("0"),
        example: "3",
        ..Parameter::RARE
    });
    LIMIT = parameter!("limit" of Window {
        about: "The greatest number of points in the answer. The header strew-next is the cursor of the \
                rest.",
        shape: Shape::Integer { min: 1, max: u64::MAX },
        default: Some("all"),
        example: "2",
    });
    CURSOR = parameter!("cursor" of Window {
        about: "Where an earlier answer to the same query ended: the value of its header strew-next.",
        shape: Shape::Pattern("^[0-9a-f]+$"),
        allowed: Some("the cursor of an earlier answer to the same query"),
        default: Some("the beginning"),
        example: "01000000000000000000000000000000000000290000000000000000000000000000005100000000000000000000000000000008000000000000000f000000000000007228ff94af7ec61562886f26",
        ..Parameter::RARE
    });
    FORMAT = parameter!("format" of Output {
        about: "The format of the answer; overrides the header Accept.",
        shape: Shape::Format,
        default: Some("the preferred one of Accept, else json"),
        example: "csv",
    });
    DECIMALS = parameter!("decimals" of Output {
        about: "The number of decimals in text formats, rounded to the nearest, ties to even; zero has \
                no sign. Coordinates are rounded within the box around the region: min ≤ p < max stays true.",
        shape: Shape::Integer { min: 0, max: MOST_DECIMALS as u64 },
        default: Some("the fewest digits that read back as the same number"),
        example: "3",
        ..Parameter::RARE
    });
    SIZE = parameter!("size" of Output {
        about: "The longer side of a picture (png, svg) in pixels.",
        shape: Shape::Integer { min: LEAST_SIZE as u64, max: MOST_SIZE as u64 },
        default: Some("512"),
        example: "256",
        ..Parameter::RARE
    });
    /// Whether a stream of lines ends with a summary.
    SUMMARY = parameter!("summary" of Output {
        about: "Whether ndjson ends with a line that is not a point: the query, the table and the count. \
                Without it, programs that expect rows of one kind read the answer.",
        shape: Shape::Switch,
        default: Some("on"),
        example: "off",
        ..Parameter::RARE
    });
    CRS = parameter!("crs" of Reference {
        about: "The coordinate reference system of the plane, for geojson and Parquet: by default that of the \
                region and of GeoTIFFs; another one is refused, since coordinates do not change. Without one \
                readers of GeoJSON take coordinates for degrees.",
        shape: Shape::Pattern("^[A-Za-z]{1,16}:[A-Za-z0-9]{1,16}$"),
        allowed: Some(CRS_ALLOWED),
        default: Some("none"),
        example: "EPSG:3857",
        ..Parameter::RARE
    });
    AT = parameter!("at" of Nearest {
        about: "The place whose neighbors are wanted.",
        shape: Shape::Numbers(&["x", "y"]),
        is_required: true,
        example: "100.5,-3",
    });
    K = parameter!("k" of Neighbors {
        about: "The number of nearest points.",
        shape: Shape::Integer { min: 1, max: MOST_NEAREST },
        default: Some("1, or all within the radius"),
        example: "8",
    });
    RADIUS = parameter!("radius" of Neighbors {
        about: "The greatest distance from the place, in world units: points at exactly this distance, as reported, are found.",
        shape: Shape::Number { min: 0.0, max: f64::MAX },
        default: Some("unlimited"),
        example: "2",
    });
    MOST = parameter!("most" of Listed {
        about: "The greatest number of entries of the list.",
        shape: Shape::Integer { min: 1, max: MOST_PERIODS },
        default: Some("100"),
        example: "4",
    });
    PARTS = parameter!("parts" of Split {
        about: "The number of queries to split the query into.",
        shape: Shape::Integer { min: 1, max: MOST_PARTS },
        is_required: true,
        example: "4",
    });
    TERRAIN = parameter!("terrain" of Attributes {
        about: "The terrain that points stand on: each has a height z. It is a field: its share becomes a height \
                between heights.",
        shape: Shape::Field,
        default: Some("none"),
        example: "hills",
        is_echoed: true,
        ..Parameter::RARE
    });
    HEIGHTS = parameter!("heights" of Attributes {
        about: "The heights of the terrain where its field is 0 and where it is 1, in world units.",
        shape: Shape::Numbers(&["low", "high"]),
        allowed: Some("two numbers low,high with -1e9 <= low < high <= 1e9, beside a terrain"),
        default: Some("0,1"),
        example: "0,120",
        is_echoed: true,
        ..Parameter::RARE
    });
    NORMALS = parameter!("normals" of Attributes {
        about: "Whether points have the normal nx, ny, nz of the terrain, of unit length.",
        shape: Shape::Switch,
        allowed: Some("on or off, beside a terrain"),
        default: Some("off"),
        example: "on",
        is_echoed: true,
        ..Parameter::RARE
    });
    ALIGN = parameter!("align" of Attributes {
        about: "How far things lean from the vertical (0) to the normal of the terrain (1). Points then have a \
                rotation qx, qy, qz, qw, which the attribute angle is part of.",
        shape: Shape::Number { min: 0.0, max: 1.0 },
        allowed: Some("a number from 0 to 1, beside a terrain"),
        default: Some("no rotations"),
        example: "0.5",
        is_echoed: true,
        ..Parameter::RARE
    });
}

/// The figures that texts of the table repeat.
const _: () = assert!(
    UniformNumber::MAX == 16
        && Variants::MAX == 256
        && Variants::MAX_NAME == 64
        && ScaleRange::LIMIT == 1e9
        && MOST_GIVEN == 10_000
);
