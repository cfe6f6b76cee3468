//! Polygons of GeoJSON: a geometry, a feature, or a collection of either.

use serde_json::Value;

use super::{RegionDraft, Rings, ShapeDraft};
use crate::service::Fault;

/// What is read.
pub(super) const GEOJSON: &str = "GeoJSON: a Polygon or MultiPolygon, or a Feature, \
                                  FeatureCollection or GeometryCollection of these; a ring is a \
                                  list of 3 different positions [x, y] or more";

/// The region of a file: all of its polygons.
///
/// # Errors
/// A [`Fault`] of `region`, which says where in the file something is wrong.
pub fn read_region(bytes: &[u8]) -> Result<RegionDraft, Fault> {
    let fault = |detail: String| {
        let text = String::from_utf8_lossy(bytes);
        let text: Vec<&str> = text.split_whitespace().collect();
        Fault::new("region", text.join(" "), detail, GEOJSON)
    };
    let value: Value =
        serde_json::from_slice(bytes).map_err(|error| fault(format!("it is not JSON: {error}")))?;
    Ok(RegionDraft {
        path: "region".into(),
        shape: ShapeDraft::Polygons(polygons(&value).map_err(fault)?),
    })
}

/// The polygons of a GeoJSON object, with their holes; what lies in any of them is meant.
///
/// # Errors
/// What is wrong, and where.
pub(super) fn polygons(value: &Value) -> Result<Vec<Rings>, String> {
    let mut found = vec![];
    collect(value, &mut Vec::new(), &mut found)?;
    if found.is_empty() {
        return Err("there is no polygon in it".into());
    }
    Ok(found)
}

fn collect(value: &Value, path: &mut Vec<String>, found: &mut Vec<Rings>) -> Result<(), String> {
    let Some(kind) = value.get("type").and_then(Value::as_str) else {
        return Err(format!("{} has no type", place(path)));
    };
    let mut list = |name: &str, each: &mut dyn FnMut(&Value, &mut Vec<String>) -> Outcome| {
        let Some(items) = value.get(name).and_then(Value::as_array) else {
            return Err(format!("{} has no list `{name}`", place(path)));
        };
        for (i, item) in items.iter().enumerate() {
            path.push(format!("{name}[{i}]"));
            each(item, path)?;
            path.pop();
        }
        Ok(())
    };
    match kind {
        "Polygon" => {
            let mut rings = vec![];
            list("coordinates", &mut |item, path| {
                rings.push(ring(item, path)?);
                Ok(())
            })?;
            found.push(rings);
            Ok(())
        }
        "MultiPolygon" => list("coordinates", &mut |item, path| {
            let Some(items) = item.as_array() else {
                return Err(format!("{} is not a list of rings", place(path)));
            };
            let mut rings = vec![];
            for (i, item) in items.iter().enumerate() {
                path.push(format!("[{i}]"));
                rings.push(ring(item, path)?);
                path.pop();
            }
            found.push(rings);
            Ok(())
        }),
        "FeatureCollection" => list("features", &mut |item, path| collect(item, path, found)),
        "GeometryCollection" => list("geometries", &mut |item, path| collect(item, path, found)),
        "Feature" => match value.get("geometry") {
            // RFC 7946 has features without a place.
            Some(Value::Null) => Ok(()),
            Some(geometry) => {
                path.push("geometry".into());
                collect(geometry, path, found)?;
                path.pop();
                Ok(())
            }
            None => Err(format!("{} has no geometry", place(path))),
        },
        other => Err(format!("{} is a {other}, not a polygon", place(path))),
    }
}

type Outcome = Result<(), String>;

fn ring(value: &Value, path: &[String]) -> Result<Vec<[f64; 2]>, String> {
    let Some(items) = value.as_array() else {
        return Err(format!(
            "{} is not a ring, a list of positions",
            place(path)
        ));
    };
    // A position may have an elevation; it does not matter.
    let position = |value: &Value| {
        let numbers = value.as_array()?;
        Some([numbers.first()?.as_f64()?, numbers.get(1)?.as_f64()?])
    };
    let read = |(i, item): (usize, &Value)| {
        let detail = || format!("{}[{i}] is {item}, not a position [x, y]", place(path));
        position(item).ok_or_else(detail)
    };
    items.iter().enumerate().map(read).collect()
}

/// Where something is, in words.
fn place(path: &[String]) -> String {
    if path.is_empty() {
        return "it".into();
    }
    path.join(".").replace(".[", "[")
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    fn polygon() -> Value {
        json!({ "type": "Polygon", "coordinates": [[[0, 0], [4, 0], [0, 4], [0, 0]]] })
    }

    #[test]
    fn collections_give_all_of_their_polygons() {
        let multi = json!({ "type": "MultiPolygon", "coordinates": [
            polygon()["coordinates"], polygon()["coordinates"],
        ]});
        let feature = |geometry: &Value| json!({ "type": "Feature", "geometry": geometry });
        let features = json!({ "type": "FeatureCollection", "features": [
            feature(&polygon()), feature(&Value::Null), feature(&multi),
        ]});
        let geometries = json!({ "type": "GeometryCollection", "geometries": [polygon(), multi] });
        for (value, expected) in [
            (polygon(), 1),
            (multi.clone(), 2),
            (feature(&polygon()), 1),
            (features, 3),
            (geometries, 3),
        ] {
            let rings = polygons(&value).expect("polygons");
            assert_eq!(rings.len(), expected, "{value}");
            let ring = vec![[0.0, 0.0], [4.0, 0.0], [0.0, 4.0], [0.0, 0.0]];
            assert!(rings.iter().all(|rings| *rings == [ring.clone()]));
        }
    }

    #[test]
    fn what_is_wrong_is_said_with_its_place() {
        let line = json!({ "type": "LineString", "coordinates": [[0, 0], [1, 1]] });
        let among = json!({ "type": "FeatureCollection", "features": [
            { "type": "Feature", "geometry": polygon() },
            { "type": "Feature", "geometry": line },
        ]});
        let flat = json!({ "type": "Polygon", "coordinates": [[0, 0], [4, 0]] });
        let text = json!({ "type": "MultiPolygon", "coordinates": [[[[0, 0], ["4", 0]]]] });
        for (value, expected) in [
            (json!([1]), "it has no type"),
            (json!({ "type": "Feature" }), "it has no geometry"),
            (json!({ "type": "Polygon" }), "it has no list `coordinates`"),
            (line, "it is a LineString, not a polygon"),
            (among, "features[1].geometry is a LineString, not a polygon"),
            (flat, "coordinates[0][0] is 0, not a position [x, y]"),
            (
                text,
                "coordinates[0][0][1] is [\"4\",0], not a position [x, y]",
            ),
            (
                json!({ "type": "FeatureCollection", "features": [] }),
                "there is no polygon in it",
            ),
        ] {
            assert_eq!(polygons(&value), Err(expected.into()));
        }
        let fault = read_region(b"{\n  not").expect_err("no JSON");
        assert_eq!(fault.value.as_deref(), Some("{ not"));
    }
}
