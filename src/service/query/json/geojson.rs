//! Polygons of GeoJSON: a geometry, a feature, or a collection of either.

use serde::{Deserialize, Deserializer};
use serde_json::value::RawValue;

use super::{
    super::{MOST_LEVELS, Rings, values::shown},
    object::{Position, each, text_of},
};
use crate::service::bounded_list::list;

/// What is read.
pub(super) const GEOJSON: &str = "GeoJSON: a Polygon or MultiPolygon, or a Feature, \
                                  FeatureCollection or GeometryCollection of these; a ring is an \
                                  array of 3 different positions [x, y] or more";

/// The members of GeoJSON objects that matter here; others may be there.
#[derive(Deserialize)]
struct Object<'a> {
    r#type: Option<String>,
    #[serde(borrow, default)]
    coordinates: Option<&'a RawValue>,
    #[serde(borrow, default)]
    geometry: Option<&'a RawValue>,
    #[serde(borrow, default)]
    features: Option<&'a RawValue>,
    #[serde(borrow, default)]
    geometries: Option<&'a RawValue>,
}

/// The polygons of a GeoJSON object, with their holes; what lies in any of them is meant.
///
/// # Errors
/// What is wrong, and where.
pub(super) fn polygons(json: &RawValue) -> Result<Vec<Rings>, String> {
    let mut found = vec![];
    collect(json, "", 0, &mut found)?;
    if found.is_empty() {
        return Err("contains no polygon".into());
    }
    Ok(found)
}

fn collect(
    json: &RawValue,
    path: &str,
    depth: usize,
    found: &mut Vec<Rings>,
) -> Result<(), String> {
    let name = || match path {
        "" => "the object",
        path => path,
    };
    if depth > MOST_LEVELS {
        return Err(format!(
            "{} is nested too deeply: {MOST_LEVELS} levels at most",
            name()
        ));
    }
    if !json.get().starts_with('{') {
        return Err(format!("{} must be an object", name()));
    }
    let object: Object<'_> = serde_json::from_str(json.get())
        .map_err(|error| format!("{}: {}", name(), text_of(&error)))?;
    let under = |member: &str| match path {
        "" => member.to_owned(),
        path => format!("{path}.{member}"),
    };
    let list = |member: &str, items: Option<&RawValue>, found: &mut Vec<Rings>| {
        let path = under(member);
        let mut read = Ok(());
        let is_array = items.is_some_and(|items| {
            each(items, |i, item| {
                read = collect(item, &format!("{path}[{i}]"), depth + 1, found);
                read.is_ok()
            })
        });
        if !is_array {
            return Err(format!("{} has no array `{member}`", name()));
        }
        read
    };
    match object.r#type.as_deref() {
        Some("Polygon") => {
            let rings: RingsJson = coordinates(&object, name(), &under("coordinates"), 2)?;
            found.push(plain(rings));
            Ok(())
        }
        Some("MultiPolygon") => {
            let PolygonsJson(all) = coordinates(&object, name(), &under("coordinates"), 3)?;
            found.extend(all.into_iter().map(plain));
            Ok(())
        }
        Some("FeatureCollection") => list("features", object.features, found),
        Some("GeometryCollection") => list("geometries", object.geometries, found),
        Some("Feature") => match object.geometry {
            Some(geometry) if geometry.get() != "null" => {
                collect(geometry, &under("geometry"), depth + 1, found)
            }
            // RFC 7946 has features without a place.
            _ => Ok(()),
        },
        Some(other) => {
            let other: String = other.chars().take(40).collect();
            Err(format!(
                "{} has the type `{other}`, not a polygon's",
                name()
            ))
        }
        None => Err(format!("{} has no type", name())),
    }
}

/// The least positions of a ring.
const LEAST: usize = 3;

// Empty lists would take many times the memory of their text.

/// A ring.
#[derive(Deserialize)]
struct RingJson(#[serde(deserialize_with = "positions")] Vec<Position>);

/// The rings of a polygon.
#[derive(Deserialize)]
struct RingsJson(#[serde(deserialize_with = "some")] Vec<RingJson>);

/// Polygons.
#[derive(Deserialize)]
struct PolygonsJson(#[serde(deserialize_with = "some")] Vec<RingsJson>);

fn positions<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<Position>, D::Error> {
    list(deserializer, LEAST..=usize::MAX, "positions")
}

fn some<'de, D, T>(deserializer: D) -> Result<Vec<T>, D::Error>
where
    D: Deserializer<'de>,
    T: Deserialize<'de>,
{
    list(deserializer, 1..=usize::MAX, "rings")
}

fn plain(RingsJson(rings): RingsJson) -> Rings {
    let ring = |RingJson(ring): RingJson| ring.into_iter().map(|position| position.0).collect();
    rings.into_iter().map(ring).collect()
}

/// The coordinates of a geometry: positions in `levels` levels of arrays.
fn coordinates<'a, T: Deserialize<'a>>(
    object: &Object<'a>,
    name: &str,
    path: &str,
    levels: usize,
) -> Result<T, String> {
    let json = object.coordinates;
    let json = json.ok_or_else(|| format!("{name} has no array `coordinates`"))?;
    let wrong = |_| wrong(json, path, levels).unwrap_or_else(|| format!("{path} cannot be read"));
    serde_json::from_str(json.get()).map_err(wrong)
}

/// Where coordinates are not what they must be.
fn wrong(json: &RawValue, path: &str, levels: usize) -> Option<String> {
    if levels == 0 {
        let is_position = serde_json::from_str::<Position>(json.get()).is_ok();
        let text: String = shown(json).chars().take(60).collect();
        return (!is_position).then(|| format!("{path} is `{text}`, not a position [x, y]"));
    }
    let (mut first, mut count) = (None, 0);
    let is_array = each(json, |i, item| {
        count = i + 1;
        first = wrong(item, &format!("{path}[{i}]"), levels - 1);
        first.is_none()
    });
    let few = match (levels, count) {
        (1, ..LEAST) => Some(format!(
            "{path} has {count} positions, and a ring has {LEAST} or more"
        )),
        (_, 0) => Some(format!("{path} is empty")),
        _ => None,
    };
    if is_array {
        return first.or(few);
    }
    let what = match levels {
        1 => "a ring, an array of positions",
        2 => "an array of rings",
        _ => "an array of polygons",
    };
    Some(format!("{path} is not {what}"))
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::*;

    fn read(value: &Value) -> Result<Vec<Rings>, String> {
        polygons(&RawValue::from_string(value.to_string()).expect("JSON"))
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
            (json!([]), "the object must be an object"),
            (json!({}), "the object has no type"),
            (
                json!({ "type": "Point" }),
                "the object has the type `Point`, not a polygon's",
            ),
            (
                json!({ "type": "Polygon" }),
                "the object has no array `coordinates`",
            ),
            (
                json!({ "type": "Polygon", "coordinates": [7] }),
                "coordinates[0] is not a ring, an array of positions",
            ),
            (
                bad.clone(),
                "coordinates[0][1] is `[4]`, not a position [x, y]",
            ),
            (
                within,
                "features[1].geometry.coordinates[0][1] is `[4]`, not a position [x, y]",
            ),
            (
                json!({ "type": "Feature", "geometry": null }),
                "contains no polygon",
            ),
            (
                json!({ "type": "FeatureCollection" }),
                "the object has no array `features`",
            ),
        ] {
            assert_eq!(read(&value), Err(expected.into()), "{value}");
        }
        assert!(read(&deep).is_err_and(|detail| detail.contains("nested too deeply")));
    }
}
