//! Volumes as JSON.

use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::value::RawValue;
use strew_error::{Checked, Fault, integer::Whole};

use super::{
    super::volume::{PRISM, VolumeDraft},
    geojson::{GEOJSON, GeoJson, polygons},
    object::{Object, Only, read as typed, shown},
};

const BOX: &str = "[min_x, min_y, min_z, max_x, max_y, max_z], numbers, each min below its max";
const BALL: &str = r#"{"center": [x, y, z], "radius": r}, numbers with r above 0"#;
const CHUNK: &str = r#"{"size": s, "x": i, "y": j, "z": k}, a number above 0 and integers within ±4503599627370496"#;

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

/// An upright prism: a polygon between two heights.
#[derive(JsonSchema)]
#[schemars(rename = "Prism", deny_unknown_fields)]
#[allow(dead_code, reason = "the type is only described, not built")]
pub struct PrismJson {
    /// The polygons, in x and y.
    polygon: GeoJson,
    /// The lower end: z of points is at least this.
    bottom: f64,
    /// The upper end: z of points is below this.
    top: f64,
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

/// A half-open box: min ≤ p < max.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
#[allow(dead_code, reason = "the type is only described, not built")]
pub struct BoxVolume {
    /// min_x, min_y, min_z, max_x, max_y, max_z, each min below its max.
    bbox: [f64; 6],
}

/// The points nearer to the center than the radius.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
#[allow(dead_code, reason = "the type is only described, not built")]
pub struct BallVolume {
    ball: BallJson,
}

/// The points above a polygon, between two heights.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
#[allow(dead_code, reason = "the type is only described, not built")]
pub struct PrismVolume {
    prism: PrismJson,
}

/// A chunk; coordinates of the answer are relative to its corner.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
#[allow(dead_code, reason = "the type is only described, not built")]
pub struct ChunkVolume {
    chunk: CubeJson,
}

/// The points in any region of include and in none of exclude. Lists nest 8 levels deep, and those of a query have
/// 1000 regions in all.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
#[allow(dead_code, reason = "the type is only described, not built")]
pub struct CombinedVolume {
    #[schemars(length(min = 1, max = 1000))]
    include: Vec<VolumeSchema>,
    #[schemars(default, length(max = 1000))]
    exclude: Option<Vec<VolumeSchema>>,
}

/// The shape of a volume; `None` for lists.
pub(super) fn shape(field: &str, kind: &str, json: &RawValue) -> Checked<Option<VolumeDraft>> {
    let wrong = |allowed| move |detail: String| Fault::new(field, shown(json), detail, allowed);
    Ok(Some(match kind {
        "bbox" => VolumeDraft::Box(typed(json, "").map_err(wrong(BOX))?),
        "ball" => {
            let Only(BallJson { center, radius }) = typed(json, "").map_err(wrong(BALL))?;
            VolumeDraft::Ball(center, radius)
        }
        "prism" => prism(field, json)?,
        "chunk" => {
            let Only(CubeJson { size, x, y, z }) = typed(json, "").map_err(wrong(CHUNK))?;
            VolumeDraft::Chunk(size, [x, y, z])
        }
        _ => return Ok(None),
    }))
}

fn prism(field: &str, json: &RawValue) -> Checked<VolumeDraft> {
    let wrong = |detail: String| Fault::new(field, shown(json), detail, PRISM);
    let object = Object::read(json).map_err(wrong)?;
    let (mut base, mut heights) = (None, [None; 2]);
    for (name, json) in object.members() {
        let path = format!("{field}.{name}");
        let wrong = |detail: String| Fault::new(&path, shown(json), detail, PRISM);
        match name {
            "polygon" => {
                let wrong = |detail: String| Fault::new(&path, shown(json), detail, GEOJSON);
                base = Some(polygons(json).map_err(wrong)?.0);
            }
            "bottom" | "top" => {
                let height: f64 = typed(json, "").map_err(wrong)?;
                heights[usize::from(name == "top")] = Some(height);
            }
            _ => return Err(wrong("unknown member".into()).into()),
        }
    }
    match (base, heights) {
        (Some(base), [Some(bottom), Some(top)]) => Ok(VolumeDraft::Prism(base, [bottom, top])),
        (base, [bottom, _]) => {
            let missing = match (base, bottom) {
                (None, _) => "polygon",
                (_, None) => "bottom",
                _ => "top",
            };
            Err(Fault::missing(&format!("{field}.{missing}"), PRISM).into())
        }
    }
}
