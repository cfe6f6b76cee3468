//! Features as JSON: a collection of GeoJSON, with the properties that hold their names and their numbers of points.

use serde_json::value::RawValue;
use strew_config::name::is_name;
use strew_encode::Crs;
use strew_error::{Checked, Fault, Faults, unknown};

use super::{
    super::{Feature, MOST_FEATURES, RegionDraft, Rings, ShapeDraft},
    geojson::polygons,
    object::{Object, elements, parse, shown},
};

/// The members of features in a body.
const MEMBERS: [&str; 3] = ["of", "id", "count"];
/// Their form, as faults describe it.
const FEATURES: &str = r#"{"of": a FeatureCollection of polygons, "id": the property with the name of a feature, by default its place, "count": the property with its number of points}"#;
/// The form of a collection.
const COLLECTION: &str =
    "GeoJSON: a FeatureCollection of 1 to 1000 features, each a Polygon or MultiPolygon";
/// The rule for names.
const NAMES: &str = "a property of 1 to 64 ASCII letters, digits, _, - and ., or an integer, that tells features \
                     apart; without it features have the names 0, 1, 2, …";
/// The rule for numbers of points.
const COUNTS: &str = "a property that is an integer, 0 or more, of every feature";

/// Features of a body.
pub(super) fn read(json: &RawValue) -> Checked<Vec<Feature>> {
    let wrong =
        |field: &str, json, detail| Faults::from(Fault::new(field, shown(json), detail, FEATURES));
    let object = Object::read(json).map_err(|detail| wrong("features", json, detail))?;
    let (mut collection, mut names) = (None, [None, None]);
    for (name, json) in object.members() {
        let field = format!("features.{name}");
        match MEMBERS.iter().position(|known| *known == name) {
            Some(0) => collection = Some(json),
            Some(place) => {
                let text = serde_json::from_str::<String>(json.get());
                let text = text.map_err(|_| wrong(&field, json, "must be text".into()))?;
                names[place - 1] = Some(text);
            }
            None => {
                let detail = unknown("member", name, MEMBERS.into_iter());
                return Err(wrong(&field, json, detail));
            }
        }
    }
    let collection =
        collection.ok_or_else(|| Faults::from(Fault::missing("features.of", COLLECTION)))?;
    features(collection, [names[0].as_deref(), names[1].as_deref()])
}

/// The features of a GeoJSON file, with the properties that hold their names and their numbers of points.
///
/// # Errors
/// A fault of `features`.
pub fn read_features(bytes: &[u8], [id, count]: [Option<&str>; 2]) -> Checked<Vec<Feature>> {
    let json = parse(bytes);
    let json = json.map_err(|detail| Fault::new("features", "", detail, COLLECTION))?;
    features(json, [id, count])
}

fn features(json: &RawValue, names: [Option<&str>; 2]) -> Checked<Vec<Feature>> {
    let wrong = |detail: String| Fault::new("features.of", shown(json), detail, COLLECTION);
    let object = Object::read(json).map_err(wrong)?;
    let member = |name: &str| {
        object
            .members()
            .find(|(known, _)| *known == name)
            .map(|(_, json)| json)
    };
    if member("type").map(RawValue::get) != Some(r#""FeatureCollection""#) {
        return Err(wrong("is no FeatureCollection".into()).into());
    }
    let crs = member("crs").and_then(|json| serde_json::from_str(json.get()).ok());
    let crs = crs.map(|member| Crs::of_geojson(&member));
    let crs = crs.transpose().map_err(wrong)?.flatten();
    let list = member("features").ok_or_else(|| wrong("has no array `features`".into()))?;
    let list = elements(list, MOST_FEATURES, "features").map_err(wrong)?;
    let mut all: Vec<Feature> = vec![];
    for (i, json) in list.into_iter().enumerate() {
        let feature = feature(i, json, names, crs.as_ref())?;
        let Some(feature) = feature.filter(|feature| feature.count != Some(0)) else {
            continue;
        };
        if all.iter().any(|known| known.name == feature.name) {
            let field = format!("features[{i}]");
            let detail = "an earlier feature has this name";
            return Err(Fault::new(&field, feature.name, detail, NAMES).into());
        }
        all.push(feature);
    }
    match all.is_empty() {
        true => Err(wrong("has no feature with a polygon and with points".into()).into()),
        false => Ok(all),
    }
}

/// A feature; none without a place.
fn feature(
    i: usize,
    json: &RawValue,
    [id, count]: [Option<&str>; 2],
    crs: Option<&Crs>,
) -> Checked<Option<Feature>> {
    let path = format!("features[{i}]");
    let wrong = |detail: String| Fault::new(&path, shown(json), detail, COLLECTION);
    let object = Object::read(json).map_err(wrong)?;
    let member = |name: &str| {
        object
            .members()
            .find(|(known, _)| *known == name)
            .map(|(_, json)| json)
    };
    let is_there = |json: &&RawValue| json.get() != "null";
    let properties = member("properties").filter(is_there).map(Object::read);
    let properties = properties.transpose().map_err(wrong)?;
    let property = |name: &str, allowed: &str| {
        let mut all = properties.iter().flat_map(Object::members);
        let found = all
            .find(|(known, _)| *known == name)
            .map(|(_, json)| json.get());
        found.ok_or_else(|| Fault::missing(&format!("{path}.properties.{name}"), allowed))
    };
    let Some(geometry) = member("geometry").filter(is_there) else {
        return Ok(None);
    };
    let name = match id {
        None => i.to_string(),
        Some(id) => {
            let text = property(id, NAMES)?;
            let name = serde_json::from_str::<String>(text).unwrap_or_else(|_| text.to_owned());
            if !is_name(&name) {
                let detail = format!("property `{id}` is no name of features");
                return Err(Fault::new(&path, name, detail, NAMES).into());
            }
            name
        }
    };
    let count = count.map(|count| {
        let text = property(count, COUNTS)?;
        let wrong = || {
            Fault::new(
                &path,
                text,
                format!("property `{count}` is no number of points"),
                COUNTS,
            )
        };
        text.parse().map_err(|_| wrong())
    });
    let count = count.transpose()?;
    let (polygons, own): (Vec<Rings>, _) = polygons(geometry).map_err(wrong)?;
    let shape = ShapeDraft::Polygons(polygons, own.or_else(|| crs.cloned()));
    Ok(Some(Feature {
        name,
        region: Some(RegionDraft {
            path: path.into(),
            shape,
        }),
        field: None,
        count,
    }))
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::{super::read_body, *};
    use crate::groups;

    fn collection() -> Value {
        let square = |x: i32| json!([[[x, 0], [x + 1, 0], [x + 1, 1], [x, 1], [x, 0]]]);
        let feature = |id: Value, n: i32, geometry: Value| {
            json!({
                "type": "Feature", "properties": { "id": id, "n": n }, "geometry": geometry,
            })
        };
        let polygon = |x| json!({ "type": "Polygon", "coordinates": square(x) });
        json!({ "type": "FeatureCollection", "features": [
            feature(json!("a"), 30, polygon(0)),
            feature(json!(7), 20, polygon(2)),
            feature(json!("nowhere"), 5, Value::Null),
            feature(json!("none"), 0, polygon(9)),
        ]})
    }

    fn names_and_counts(features: &Value) -> Result<Vec<(String, Option<u64>)>, String> {
        let json = RawValue::from_string(features.to_string()).expect("JSON");
        let read = read(&json).map_err(|faults| faults.as_slice()[0].to_string())?;
        Ok(read
            .into_iter()
            .map(|feature| (feature.name, feature.count))
            .collect())
    }

    #[test]
    fn features_have_the_names_and_the_numbers_of_their_properties() {
        let both = json!({ "of": collection(), "id": "id", "count": "n" });
        let expected = vec![("a".into(), Some(30)), ("7".into(), Some(20))];
        assert_eq!(names_and_counts(&both), Ok(expected));
        let plain = json!({ "of": collection() });
        let names = ["0", "1", "3"].map(|name| (name.to_owned(), None));
        assert_eq!(names_and_counts(&plain), Ok(names.into()));
    }

    #[test]
    fn faults_name_the_feature() {
        for (member, value, expected) in [
            ("id", json!("missing"), "features[0].properties.missing"),
            ("count", json!("id"), "property `id` is no number of points"),
            ("count", json!(3), "must be text"),
            ("per", json!(1), "unknown member"),
            (
                "of",
                json!({ "type": "Polygon" }),
                "is no FeatureCollection",
            ),
            (
                "of",
                json!({ "type": "FeatureCollection", "features": [] }),
                "has no feature with a polygon",
            ),
        ] {
            let mut features = json!({ "of": collection() });
            features[member] = value;
            let fault = names_and_counts(&features).expect_err(member);
            assert!(fault.contains(expected), "{fault}");
        }
        let mut twice = collection();
        twice["features"][1]["properties"]["id"] = json!("a");
        let fault = names_and_counts(&json!({ "of": twice, "id": "id" })).expect_err("twice");
        assert!(
            fault.contains("an earlier feature has this name"),
            "{fault}"
        );
    }

    #[test]
    fn a_body_with_features_is_one_of_layers() {
        let body = json!({ "features": { "of": collection(), "id": "id" }, "count": 4, "seed": 5, "format": "csv" });
        let draft = read_body(body.to_string().as_bytes(), groups::QUERY).expect("read");
        let body = draft.to_body();
        assert_eq!(body["layers"][1]["name"], "7");
        assert_eq!(body["layers"][1]["count"], 4);
        assert_eq!(body["layers"][1]["seed"], 5);
        assert_eq!((body.get("count"), &body["format"]), (None, &json!("csv")));
    }
}
