//! Regions of the plane and volumes of space as JSON.

use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::value::RawValue;
use strew_catalog::Dimension;
use strew_encode::Crs;
use strew_error::{Checked, Fault, Faults, all, integer::Whole, unknown};

use super::{
    super::{
        MOST_LEVELS, MOST_REGIONS, RegionDraft, Rings, ShapeDraft,
        region_check::{PRISM, REGION, VOLUME},
    },
    geojson::{GEOJSON, GeoJson, polygons},
    object::{Object, Only, elements, of_text, parse, read as typed, shown},
};

/// The forms of shapes, as faults describe them.
const BOX: &str = "[min_x, min_y, max_x, max_y], numbers with min_x < max_x and min_y < max_y";
const CUBOID: &str = "[min_x, min_y, min_z, max_x, max_y, max_z], numbers, each min below its max";
const CIRCLE: &str = r#"{"center": [x, y], "radius": r}, numbers with r above 0"#;
const BALL: &str = r#"{"center": [x, y, z], "radius": r}, numbers with r above 0"#;
const CHUNK: &str =
    r#"{"size": s, "x": column, "y": row}, a number above 0 and integers within ±4503599627370496"#;
const CUBE: &str = r#"{"size": s, "x": i, "y": j, "z": k}, a number above 0 and integers within ±4503599627370496"#;

/// A circle.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Circle")]
pub struct CircleJson {
    /// The center [x, y].
    center: [f64; 2],
    /// The radius in world units, above 0.
    #[schemars(extend("exclusiveMinimum" = 0))]
    radius: f64,
}

/// A square of the world grid: size·x ≤ p.x < size·(x + 1), and so for y.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Chunk")]
pub struct ChunkJson {
    /// The side in world units, above 0.
    #[schemars(extend("exclusiveMinimum" = 0))]
    size: f64,
    /// The column.
    #[schemars(range(min = -4_503_599_627_370_496_i64, max = 4_503_599_627_370_496_i64))]
    #[serde(deserialize_with = "Whole::read")]
    x: i64,
    /// The row.
    #[schemars(range(min = -4_503_599_627_370_496_i64, max = 4_503_599_627_370_496_i64))]
    #[serde(deserialize_with = "Whole::read")]
    y: i64,
}

/// A ball.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Ball")]
pub struct BallJson {
    /// The center [x, y, z].
    center: [f64; 3],
    /// The radius in world units, above 0.
    #[schemars(extend("exclusiveMinimum" = 0))]
    radius: f64,
}

/// A cube of the world grid: size·x ≤ p.x < size·(x + 1), and so for y and z.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Cube")]
pub struct CubeJson {
    /// The side in world units, above 0.
    #[schemars(extend("exclusiveMinimum" = 0))]
    size: f64,
    /// The place along x.
    #[schemars(range(min = -4_503_599_627_370_496_i64, max = 4_503_599_627_370_496_i64))]
    #[serde(deserialize_with = "Whole::read")]
    x: i64,
    /// The place along y.
    #[schemars(range(min = -4_503_599_627_370_496_i64, max = 4_503_599_627_370_496_i64))]
    #[serde(deserialize_with = "Whole::read")]
    y: i64,
    /// The place along z.
    #[schemars(range(min = -4_503_599_627_370_496_i64, max = 4_503_599_627_370_496_i64))]
    #[serde(deserialize_with = "Whole::read")]
    z: i64,
}

/// Where: a half-open box, a circle, polygons, a square of the world grid, or what lies in any of some
/// regions and in none of others.
#[derive(JsonSchema)]
#[schemars(untagged, rename = "Region")]
#[allow(dead_code, reason = "the type is only described, not built")]
pub enum RegionSchema {
    /// A box.
    Box(BoxRegion),
    /// A circle.
    Circle(CircleRegion),
    /// Polygons.
    Polygon(PolygonRegion),
    /// A chunk.
    Chunk(ChunkRegion),
    /// Regions combined.
    Combined(CombinedRegion),
}

/// Where in space: a half-open box, a ball, an upright prism, a cube of the world grid, or what lies in any of some
/// regions and in none of others.
#[derive(JsonSchema)]
#[schemars(untagged, rename = "Volume")]
#[allow(dead_code, reason = "the type is only described, not built")]
pub enum VolumeSchema {
    /// A box.
    Box(BoxVolume),
    /// A ball.
    Ball(BallVolume),
    /// A prism.
    Prism(PrismVolume),
    /// A chunk.
    Chunk(ChunkVolume),
    /// Volumes combined.
    Combined(CombinedVolume),
}

/// A region of the plane, or a volume of space.
#[derive(JsonSchema)]
#[schemars(untagged, rename = "AnyRegion")]
#[allow(dead_code, reason = "the type is only described, not built")]
pub enum AnyRegionSchema {
    /// Of the plane.
    Region(RegionSchema),
    /// Of space.
    Volume(VolumeSchema),
}

/// Describes objects with no other members.
macro_rules! objects {
    ($($(#[$doc:meta])+ $name:ident { $($members:tt)+ })+) => {$(
        #[derive(JsonSchema)]
        $(#[$doc])+
        #[schemars(deny_unknown_fields)]
        #[allow(dead_code, reason = "the type is only described, not built")]
        pub struct $name { $($members)+ }
    )+};
}

objects! {
    /// A half-open box: min ≤ p < max.
    BoxRegion {
        /// min_x, min_y, max_x, max_y with min_x < max_x and min_y < max_y.
        bbox: [f64; 4],
    }
    /// The points nearer to the center than the radius.
    CircleRegion { circle: CircleJson }
    /// Polygons.
    PolygonRegion { polygon: GeoJson }
    /// A chunk; coordinates of the answer are relative to its corner.
    ChunkRegion { chunk: ChunkJson }
    /// The points in any region of include and in none of exclude. Lists nest 8 levels deep, and those of a query have
    /// 1000 regions in all.
    CombinedRegion {
        #[schemars(length(min = 1, max = 1000))]
        include: Vec<RegionSchema>,
        #[schemars(default, length(max = 1000))]
        exclude: Option<Vec<RegionSchema>>,
    }
    /// An upright prism: a polygon between two heights.
    #[schemars(rename = "Prism")]
    PrismJson {
        /// The polygons, in x and y.
        polygon: GeoJson,
        /// The lower end: z of points is at least this.
        bottom: f64,
        /// The upper end: z of points is below this.
        top: f64,
    }
    /// A half-open box: min ≤ p < max.
    BoxVolume {
        /// min_x, min_y, min_z, max_x, max_y, max_z, each min below its max.
        bbox: [f64; 6],
    }
    /// The points nearer to the center than the radius.
    BallVolume { ball: BallJson }
    /// The points above a polygon, between two heights.
    PrismVolume { prism: PrismJson }
    /// A chunk; coordinates of the answer are relative to its corner.
    ChunkVolume { chunk: CubeJson }
    /// The points in any region of include and in none of exclude. Lists nest 8 levels deep, and those of a query have
    /// 1000 regions in all.
    CombinedVolume {
        #[schemars(length(min = 1, max = 1000))]
        include: Vec<VolumeSchema>,
        #[schemars(default, length(max = 1000))]
        exclude: Option<Vec<VolumeSchema>>,
    }
}

/// The region of a GeoJSON file: all of its polygons.
pub fn read_region(bytes: &[u8]) -> Result<RegionDraft, Fault> {
    let polygons = parse(bytes).and_then(polygons);
    Ok(RegionDraft {
        path: "region".into(),
        shape: polygons
            .map(of_polygons)
            .map_err(of_text("region", bytes, GEOJSON))?,
    })
}

fn of_polygons((polygons, crs): (Vec<Rings>, Option<Crs>)) -> ShapeDraft {
    ShapeDraft::Polygons(polygons, crs)
}

/// A region within as many lists as `depth` says. `listed` counts the regions in lists of the query.
pub(super) fn read(
    json: &RawValue,
    path: &str,
    depth: usize,
    listed: &mut usize,
    dimension: Dimension,
) -> Checked<RegionDraft> {
    let (shapes, allowed) = match dimension {
        Dimension::Plane => (["bbox", "circle", "polygon", "chunk", "include"], REGION),
        Dimension::Space => (["bbox", "ball", "prism", "chunk", "include"], VOLUME),
    };
    let wrong = |detail: String| Faults::from(Fault::new(path, shown(json), detail, allowed));
    let object = Object::read(json).map_err(wrong)?;
    let mut members: Vec<_> = object.members().collect();
    members.sort_by_key(|(name, _)| *name);
    let strange = members
        .iter()
        .filter(|(name, _)| !shapes.contains(name) && *name != "exclude");
    all(strange.map(|(name, json)| -> Checked<()> {
        let detail = match (*name, dimension) {
            ("ball" | "prism", Dimension::Plane) => "a shape of space: see /v1/space".into(),
            ("circle" | "polygon", Dimension::Space) => "a shape of the plane".into(),
            _ => unknown("member", name, shapes.into_iter()),
        };
        let field = format!("{path}.{name}");
        Err(Fault::new(&field, shown(json), detail, allowed).into())
    }))?;
    let (kind, json, exclude) = match members.as_slice() {
        [] | [("exclude", _)] => return Err(wrong("has no shape".into())),
        [(kind, json)] => (*kind, *json, None),
        [("exclude", exclude), ("include", json)] => ("include", *json, Some(*exclude)),
        several => {
            let names: Vec<&str> = several.iter().map(|(name, _)| *name).collect();
            return Err(wrong(format!("has several shapes: {}", names.join(", "))));
        }
    };
    let field = format!("{path}.{kind}");
    let wrong = |allowed| {
        let field = &field;
        move |detail: String| Fault::new(field, shown(json), detail, allowed)
    };
    let shape = match (kind, dimension) {
        ("bbox", Dimension::Plane) => ShapeDraft::Box(typed(json, "").map_err(wrong(BOX))?),
        ("bbox", Dimension::Space) => ShapeDraft::Cuboid(typed(json, "").map_err(wrong(CUBOID))?),
        ("circle", _) => {
            let Only(CircleJson { center, radius }) = typed(json, "").map_err(wrong(CIRCLE))?;
            ShapeDraft::Circle(center, radius)
        }
        ("ball", _) => {
            let Only(BallJson { center, radius }) = typed(json, "").map_err(wrong(BALL))?;
            ShapeDraft::Ball(center, radius)
        }
        ("polygon", _) => polygons(json).map(of_polygons).map_err(wrong(GEOJSON))?,
        ("prism", _) => prism(&field, json)?,
        ("chunk", Dimension::Plane) => {
            let Only(ChunkJson { size, x, y }) = typed(json, "").map_err(wrong(CHUNK))?;
            ShapeDraft::Chunk(size, [x, y])
        }
        ("chunk", Dimension::Space) => {
            let Only(CubeJson { size, x, y, z }) = typed(json, "").map_err(wrong(CUBE))?;
            ShapeDraft::Cube(size, [x, y, z])
        }
        _ => combined(path, (json, exclude), depth, listed, dimension)?,
    };
    let path = match kind {
        "include" => path.to_owned(),
        _ => field,
    };
    Ok(RegionDraft {
        path: path.into(),
        shape,
    })
}

/// The union of some regions without others.
fn combined(
    path: &str,
    (include, exclude): (&RawValue, Option<&RawValue>),
    depth: usize,
    listed: &mut usize,
    dimension: Dimension,
) -> Checked<ShapeDraft> {
    let field = format!("{path}.include");
    if depth == MOST_LEVELS {
        let detail = "regions are nested too deeply";
        return Err(Fault::new(&field, shown(include), detail, "8 levels at most").into());
    }
    let mut items = |field: &str, json| list(field, json, depth, listed, dimension);
    let include = items(&field, include)?;
    let exclude = exclude.map(|json| items(&format!("{path}.exclude"), json));
    Ok(ShapeDraft::Combined(
        include,
        exclude.transpose()?.unwrap_or_default(),
    ))
}

fn list(
    path: &str,
    json: &RawValue,
    depth: usize,
    listed: &mut usize,
    dimension: Dimension,
) -> Checked<Vec<Checked<RegionDraft>>> {
    let wrong = |detail: String| {
        let allowed =
            format!("an array of regions, at most {MOST_REGIONS} in the lists of a query");
        Faults::from(Fault::new(path, shown(json), detail, allowed))
    };
    let items = elements(json, MOST_REGIONS, "regions").map_err(wrong)?;
    *listed += items.len();
    if *listed > MOST_REGIONS {
        return Err(wrong(format!("{listed} regions, more than {MOST_REGIONS}")));
    }
    let items = items.into_iter().enumerate();
    Ok(items
        .map(|(i, item)| read(item, &format!("{path}[{i}]"), depth + 1, listed, dimension))
        .collect())
}

/// A prism, whose polygon is read as everywhere.
fn prism(field: &str, json: &RawValue) -> Checked<ShapeDraft> {
    let wrong = |detail: String| Fault::new(field, shown(json), detail, PRISM);
    let object = Object::read(json).map_err(wrong)?;
    let (mut base, mut heights) = (None, [None; 2]);
    for (name, json) in object.members() {
        let path = format!("{field}.{name}");
        let wrong = |allowed| {
            let path = &path;
            move |detail: String| Fault::new(path, shown(json), detail, allowed)
        };
        match name {
            "polygon" => base = Some(polygons(json).map_err(wrong(GEOJSON))?.0),
            "bottom" => heights[0] = Some(typed::<f64>(json, "").map_err(wrong(PRISM))?),
            "top" => heights[1] = Some(typed::<f64>(json, "").map_err(wrong(PRISM))?),
            _ => return Err(wrong(PRISM)("unknown member".into()).into()),
        }
    }
    let missing = match (base, heights) {
        (Some(base), [Some(bottom), Some(top)]) => {
            return Ok(ShapeDraft::Prism(base, [bottom, top]));
        }
        (None, _) => "polygon",
        (_, [None, _]) => "bottom",
        _ => "top",
    };
    Err(Fault::missing(&format!("{field}.{missing}"), PRISM).into())
}
