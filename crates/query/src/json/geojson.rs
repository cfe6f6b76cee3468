//! Polygons of GeoJSON: a geometry, a feature, or a collection of either.

use std::fmt;

use schemars::JsonSchema;
use serde::{
    Deserialize, Deserializer,
    de::{Error as _, IgnoredAny, SeqAccess, Visitor},
};
use serde_json::{Value, value::RawValue};
use strew_catalog::bounded_list::list;
use strew_encode::Crs;

use super::{
    super::{MOST_LEVELS, Rings},
    object::{Only, read},
};

/// The GeoJSON that is accepted, as faults describe it.
pub(super) const GEOJSON: &str = "GeoJSON: a Polygon or MultiPolygon, or a Feature, \
                                  FeatureCollection or GeometryCollection of these; a ring is an \
                                  array of 3 different positions [x, y] or more";

/// A position: x, y. Further numbers, an elevation, do not matter.
#[derive(JsonSchema)]
#[schemars(transparent)]
pub struct Position(#[schemars(with = "Vec<f64>", length(min = 2))] [f64; 2]);

impl<'de> Deserialize<'de> for Position {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Numbers;

        impl<'de> Visitor<'de> for Numbers {
            type Value = Position;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a position [x, y]")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut numbers: A) -> Result<Position, A::Error> {
                let mut next = |i| {
                    let number = numbers.next_element::<f64>()?;
                    number.ok_or_else(|| A::Error::invalid_length(i, &self))
                };
                let position = Position([next(0)?, next(1)?]);
                while numbers.next_element::<IgnoredAny>()?.is_some() {}
                Ok(position)
            }
        }

        deserializer.deserialize_seq(Numbers)
    }
}

/// A ring: at least 3 different positions. The last may repeat the first.
#[derive(Deserialize, JsonSchema)]
#[schemars(transparent)]
pub struct Ring(
    #[serde(deserialize_with = "ring")]
    #[schemars(with = "Vec<Position>", length(min = 3))]
    Vec<[f64; 2]>,
);

fn ring<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<[f64; 2]>, D::Error> {
    let positions: Vec<Position> = list(deserializer, 0..=usize::MAX, "positions")?;
    if let count @ 1..3 = positions.len() {
        let detail = format!("has {count} positions, and a ring has 3 or more");
        return Err(D::Error::custom(detail));
    }
    Ok(positions.into_iter().map(|position| position.0).collect())
}

/// The rings of a polygon; none if its exterior is empty.
#[derive(Default)]
struct Outline(Rings);

/// A list of which empty elements are left out (RFC 7946, 3.1), while it is read: they take many times the memory of
/// their text.
trait Parts: Default {
    type Part: for<'de> Deserialize<'de>;
    const NAME: &str;

    fn add(&mut self, i: usize, part: Self::Part);
}

impl Parts for Outline {
    type Part = Ring;
    const NAME: &str = "an array of rings";

    fn add(&mut self, i: usize, Ring(ring): Ring) {
        if !ring.is_empty() && (i == 0 || !self.0.is_empty()) {
            self.0.push(ring);
        }
    }
}

impl Parts for Vec<Rings> {
    type Part = Several<Outline>;
    const NAME: &str = "an array of polygons";

    fn add(&mut self, _: usize, Several(Outline(rings)): Several<Outline>) {
        if !rings.is_empty() {
            self.push(rings);
        }
    }
}

struct Several<T>(T);

impl<'de, T: Parts> Deserialize<'de> for Several<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct List<T>(T);

        impl<'de, T: Parts> Visitor<'de> for List<T> {
            type Value = T;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(T::NAME)
            }

            fn visit_seq<A: SeqAccess<'de>>(mut self, mut parts: A) -> Result<T, A::Error> {
                let mut i = 0;
                while let Some(part) = parts.next_element()? {
                    self.0.add(i, part);
                    i += 1;
                }
                Ok(self.0)
            }
        }

        deserializer.deserialize_seq(List(T::default())).map(Self)
    }
}

/// The members of GeoJSON objects that matter here; others may be there.
#[derive(Deserialize)]
struct Object<'a> {
    r#type: String,
    #[serde(borrow)]
    coordinates: Option<&'a RawValue>,
    geometry: Option<Box<Part>>,
    features: Option<Vec<Part>>,
    geometries: Option<Vec<Option<Part>>>,
    crs: Option<Value>,
}

impl Object<'_> {
    /// Its polygons, and those of its parts.
    fn part(mut self) -> Result<Part, String> {
        let crs = self.crs.take().map(|member| Crs::of_geojson(&member));
        let own = crs.transpose()?.flatten();
        self.polygons()?.within(own)
    }

    fn polygons(self) -> Result<Part, String> {
        let missing = |member| format!("has no array `{member}`");
        let coordinates = || self.coordinates.ok_or_else(|| missing("coordinates"));
        let parts = match &*self.r#type {
            "Polygon" => {
                let Several(outline) = read(coordinates()?, "coordinates")?;
                let mut polygons: Vec<Rings> = vec![];
                polygons.add(0, Several(outline));
                return Ok(Part {
                    polygons,
                    ..Part::default()
                });
            }
            "MultiPolygon" => {
                let Several(polygons) = read(coordinates()?, "coordinates")?;
                return Ok(Part {
                    polygons,
                    ..Part::default()
                });
            }
            // Empty ones may be anything: RFC 7946 takes them for null.
            "Point" | "MultiPoint" | "LineString" | "MultiLineString"
                if self.coordinates.is_some_and(is_empty) =>
            {
                return Ok(Part::default());
            }
            "Topology" => return Err("is TopoJSON, not GeoJSON".into()),
            // RFC 7946 has features without a place.
            "Feature" => self.geometry.into_iter().map(|part| *part).collect(),
            "FeatureCollection" => self.features.ok_or_else(|| missing("features"))?,
            "GeometryCollection" => {
                let all = self.geometries.ok_or_else(|| missing("geometries"))?;
                all.into_iter().flatten().collect()
            }
            other => {
                let other: String = other.chars().take(40).collect();
                return Err(format!("has the type `{other}`, not a polygon's"));
            }
        };
        let levels = parts.iter().map(|part| part.levels + 1).max().unwrap_or(0);
        if levels > MOST_LEVELS {
            return Err(format!(
                "is nested too deeply: {MOST_LEVELS} levels at most"
            ));
        }
        let mut whole = Part {
            levels,
            ..Part::default()
        };
        for part in parts {
            whole = whole.within(part.crs)?;
            whole.polygons.extend(part.polygons);
        }
        Ok(whole)
    }
}

/// The polygons of a GeoJSON object, which has levels of others in it.
#[derive(Default)]
struct Part {
    polygons: Vec<Rings>,
    levels: usize,
    /// The plane that it or one of its parts states.
    crs: Option<Crs>,
}

impl Part {
    /// This part in a plane, if one is stated.
    fn within(mut self, crs: Option<Crs>) -> Result<Self, String> {
        match (&self.crs, crs) {
            (Some(first), Some(other)) if !first.is_plane_of(&other) => Err(format!(
                "has two planes, {first} and {other}: coordinates are not converted"
            )),
            (None, Some(other)) => {
                self.crs = Some(other);
                Ok(self)
            }
            _ => Ok(self),
        }
    }
}

impl<'de> Deserialize<'de> for Part {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let Only(object) = Only::<Object<'_>>::deserialize(deserializer)?;
        object.part().map_err(D::Error::custom)
    }
}

/// Whether coordinates hold no number.
fn is_empty(coordinates: &RawValue) -> bool {
    let mut all = coordinates.get().bytes();
    all.all(|c| b"[], \t\r\n".contains(&c))
}

/// The polygons of a GeoJSON object, with their holes, and the plane that it states; what lies in any of them is meant.
pub(super) fn polygons(json: &RawValue) -> Result<(Vec<Rings>, Option<Crs>), String> {
    match polygons_or_none(json)? {
        (none, _) if none.is_empty() => Err("contains no polygon, or empty ones alone".into()),
        found => Ok(found),
    }
}

/// [`polygons`], or none if all are empty.
pub(super) fn polygons_or_none(json: &RawValue) -> Result<(Vec<Rings>, Option<Crs>), String> {
    let Part { polygons, crs, .. } = read(json, "")?;
    Ok((polygons, crs))
}

/// A polygon or several as GeoJSON, holes included, bare, in features or in collections.
#[derive(JsonSchema)]
#[schemars(untagged)]
#[allow(dead_code, reason = "the type is only described, not built")]
pub enum GeoJson {
    Polygon(Polygon),
    MultiPolygon(MultiPolygon),
    Feature(Box<Feature>),
    FeatureCollection(FeatureCollection),
    GeometryCollection(GeometryCollection),
}

/// Describes objects with a type and one other member.
macro_rules! objects {
    ($($(#[$doc:meta])+ $name:ident, $kind:ident: $member:ident = $(#[$rule:meta])* $of:ty;)+) => {$(
        /// The type of the object.
        #[derive(JsonSchema)]
        #[schemars(inline)]
        #[allow(dead_code, reason = "the type is only described, not built")]
        enum $kind {
            $name,
        }

        $(#[$doc])+
        #[derive(JsonSchema)]
        #[allow(dead_code, reason = "the type is only described, not built")]
        pub struct $name {
            r#type: $kind,
            $(#[$rule])*
            $member: $of,
        }
    )+};
}

objects! {
    /// A polygon: its outline, then holes.
    Polygon, PolygonType: coordinates = Vec<Ring>;
    /// Several polygons.
    MultiPolygon, MultiPolygonType: coordinates = Vec<Vec<Ring>>;
    /// A feature with a polygon.
    Feature, FeatureType: geometry = Option<GeoJson>;
    /// Features with polygons.
    FeatureCollection, FeatureCollectionType: features = Vec<Feature>;
    /// Several geometries.
    GeometryCollection, GeometryCollectionType: geometries = Vec<GeoJson>;
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    fn both(value: &Value) -> Result<(Vec<Rings>, Option<Crs>), String> {
        polygons(&RawValue::from_string(value.to_string()).expect("JSON"))
    }

    fn read(value: &Value) -> Result<Vec<Rings>, String> {
        both(value).map(|(polygons, _)| polygons)
    }

    fn polygon() -> Value {
        json!({ "type": "Polygon", "coordinates": [[[0, 0], [4, 0], [0, 4, 7.5], [0, 0]]] })
    }

    #[test]
    fn collections_have_all_of_their_polygons() {
        let multi = json!({ "type": "MultiPolygon", "coordinates": [
            polygon()["coordinates"], polygon()["coordinates"],
        ]});
        let feature = |geometry: &Value| json!({ "type": "Feature", "geometry": geometry, "properties": { "type": 1 } });
        let features = json!({ "type": "FeatureCollection", "features": [
            feature(&polygon()), feature(&Value::Null), feature(&multi),
        ]});
        let nested = json!({ "type": "GeometryCollection", "geometries": [multi, polygon()] });
        for (value, count) in [(polygon(), 1), (multi, 2), (features, 3), (nested, 3)] {
            assert_eq!(read(&value).map(|found| found.len()), Ok(count), "{value}");
        }
    }

    /// RFC 7946, 3.1: geometries without coordinates are as good as null.
    #[test]
    fn empty_geometries_are_left_out() {
        let of =
            |kind: &str, coordinates: Value| json!({ "type": kind, "coordinates": coordinates });
        let ring = polygon()["coordinates"][0].clone();
        let empty = [
            of("Polygon", json!([])),
            of("Polygon", json!([[]])),
            of("Polygon", json!([[], ring])),
            of("MultiPolygon", json!([])),
            of("MultiPolygon", json!([[], [[]]])),
            of("Point", json!([])),
            of("MultiLineString", json!([[]])),
            json!({ "type": "GeometryCollection", "geometries": [] }),
            json!({ "type": "GeometryCollection", "geometries": [null] }),
        ];
        for empty in empty {
            let fault = read(&empty).expect_err("empty");
            assert_eq!(fault, "contains no polygon, or empty ones alone", "{empty}");
            let both = json!({ "type": "GeometryCollection", "geometries": [polygon(), empty] });
            assert_eq!(read(&both).map(|found| found.len()), Ok(1), "{empty}");
        }
        let empty_hole = of("Polygon", json!([ring, []]));
        assert_eq!(read(&empty_hole).map(|found| found[0].len()), Ok(1));
        let empty_part = of("MultiPolygon", json!([[], [ring, []], [[]]]));
        assert_eq!(read(&empty_part).map(|found| found.len()), Ok(1));
    }

    #[test]
    fn the_plane_of_a_collection_or_of_its_parts_is_read() {
        let within = |value: &Value, name: &str| {
            let mut value = value.clone();
            value["crs"] = json!({ "type": "name", "properties": { "name": name } });
            value
        };
        let crs = |value: &Value| both(value).map(|(_, crs)| crs.map(|crs| crs.to_string()));
        let part = within(&polygon(), "EPSG:25832");
        let collection = json!({ "type": "GeometryCollection", "geometries": [polygon(), part] });
        assert_eq!(crs(&polygon()), Ok(None));
        assert_eq!(crs(&collection), Ok(Some("EPSG:25832".into())));
        let same = within(&collection, "urn:ogc:def:crs:EPSG::25832");
        assert_eq!(crs(&same), Ok(Some("EPSG:25832".into())));
        let other = within(&collection, "urn:ogc:def:crs:EPSG::4326");
        let detail = "has two planes, EPSG:25832 and EPSG:4326: coordinates are not converted";
        assert_eq!(crs(&other), Err(detail.into()));
        let local = within(&polygon(), "my field");
        assert!(crs(&local).is_err_and(|detail| detail.starts_with("has the `crs` `my field`")));
    }

    #[test]
    fn faults_say_where() {
        let mut deep = polygon();
        for _ in 0..20 {
            deep = json!({ "type": "GeometryCollection", "geometries": [deep] });
        }
        let bad = json!({ "type": "Polygon", "coordinates": [[[0, 0], [4], [0, 4], [0, 0]]] });
        let within = json!({ "type": "FeatureCollection", "features": [
            { "type": "Feature", "geometry": polygon() }, { "type": "Feature", "geometry": bad },
        ]});
        for (value, expected) in [
            (json!([]), "invalid type: sequence, expected an object"),
            (json!({}), "missing field `type`"),
            (
                json!({ "type": "Point" }),
                "has the type `Point`, not a polygon's",
            ),
            (json!({ "type": "Polygon" }), "has no array `coordinates`"),
            (
                json!({ "type": "Polygon", "coordinates": [7] }),
                "coordinates[0]: invalid type: integer `7`, expected an array of positions",
            ),
            (
                bad.clone(),
                "coordinates[0][1]: invalid length 1, expected a position [x, y]",
            ),
            (
                within,
                "features[1].geometry.coordinates[0][1]: invalid length 1, expected a position [x, y]",
            ),
            (
                json!({ "type": "Feature", "geometry": null }),
                "contains no polygon, or empty ones alone",
            ),
            (
                json!({ "type": "Topology", "arcs": [] }),
                "is TopoJSON, not GeoJSON",
            ),
            (
                json!({ "type": "FeatureCollection" }),
                "has no array `features`",
            ),
        ] {
            assert_eq!(read(&value), Err(expected.into()), "{value}");
        }
        assert!(read(&deep).is_err_and(|detail| detail.contains("nested too deeply")));
    }
}
