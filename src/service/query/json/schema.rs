//! The JSON Schema of regions, derived from the types that say what is read.

// Schemas are all that is made of these types.
#![allow(dead_code, reason = "the types are only described, not built")]

use schemars::JsonSchema;

use super::region::{ChunkJson, CircleJson};

/// Where: a half-open box, a circle, polygons, a square of the world grid, or what lies in any of some
/// regions and in none of others.
#[derive(JsonSchema)]
#[serde(untagged)]
#[schemars(rename = "Region")]
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

/// A half-open box: min ≤ p < max.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct BoxRegion {
    /// min_x, min_y, max_x, max_y with min_x < max_x and min_y < max_y.
    bbox: [f64; 4],
}

/// The points nearer to the center than the radius.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct CircleRegion {
    circle: CircleJson,
}

/// Polygons.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct PolygonRegion {
    polygon: GeoJson,
}

/// A chunk; coordinates of the answer are relative to its corner.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct ChunkRegion {
    chunk: ChunkJson,
}

/// What lies in any region of include and in none of exclude. Lists nest 8 levels deep, and those of a query have
/// 1000 regions in all.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct CombinedRegion {
    #[schemars(length(min = 1, max = 1000))]
    include: Vec<RegionSchema>,
    #[schemars(default, length(max = 1000))]
    exclude: Option<Vec<RegionSchema>>,
}

/// A polygon or several as GeoJSON, holes included, bare, in features or in collections.
#[derive(JsonSchema)]
#[serde(untagged)]
pub enum GeoJson {
    Polygon(Polygon),
    MultiPolygon(MultiPolygon),
    Feature(Box<Feature>),
    FeatureCollection(FeatureCollection),
    GeometryCollection(GeometryCollection),
}

/// A position: x, y. Further numbers, an elevation, do not matter.
#[derive(JsonSchema)]
#[schemars(transparent)]
pub struct Position(#[schemars(length(min = 2))] Vec<f64>);

/// A ring: at least 3 different positions. The last may repeat the first.
#[derive(JsonSchema)]
#[schemars(transparent)]
pub struct Ring(#[schemars(length(min = 3))] Vec<Position>);

/// A polygon: its outline, then holes.
#[derive(JsonSchema)]
pub struct Polygon {
    r#type: PolygonType,
    #[schemars(length(min = 1))]
    coordinates: Vec<Ring>,
}

/// Several polygons.
#[derive(JsonSchema)]
pub struct MultiPolygon {
    r#type: MultiPolygonType,
    #[schemars(length(min = 1))]
    coordinates: Vec<Vec<Ring>>,
}

/// A feature with a polygon.
#[derive(JsonSchema)]
pub struct Feature {
    r#type: FeatureType,
    geometry: Option<GeoJson>,
}

/// Features with polygons.
#[derive(JsonSchema)]
pub struct FeatureCollection {
    r#type: FeatureCollectionType,
    #[schemars(length(min = 1))]
    features: Vec<Feature>,
}

/// Several geometries.
#[derive(JsonSchema)]
pub struct GeometryCollection {
    r#type: GeometryCollectionType,
    #[schemars(length(min = 1))]
    geometries: Vec<GeoJson>,
}

/// The names of types, each a type with one value.
macro_rules! types {
    ($($kind:ident = $name:ident;)+) => {$(
        /// The type of the object.
        #[derive(JsonSchema)]
        #[schemars(inline)]
        pub enum $kind {
            $name,
        }
    )+};
}

types! {
    PolygonType = Polygon;
    MultiPolygonType = MultiPolygon;
    FeatureType = Feature;
    FeatureCollectionType = FeatureCollection;
    GeometryCollectionType = GeometryCollection;
}
