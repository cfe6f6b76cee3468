//! Features as JSON: a collection of GeoJSON, with the properties that hold their names and their numbers of points.

use serde_json::value::RawValue;
use strew_config::name::is_title;
use strew_encode::Crs;
use strew_error::{Checked, Fault, Faults, unknown};

use super::{
    super::{Feature, MOST_FEATURES, RegionDraft, Rings, ShapeDraft},
    geojson::polygons_or_none,
    object::{Object, elements, parse, shown},
};

const MEMBERS: [&str; 3] = ["of", "id", "count"];
const FEATURES: &str = r#"{"of": a FeatureCollection of polygons, "id": the property with the name of a feature, by default its place, "count": the property with its number of points}"#;
const COLLECTION: &str =
    "GeoJSON: a FeatureCollection of 1 to 1000 features, each a Polygon or MultiPolygon";
const NAMES: &str = "a property that is text of 1 to 64 characters in one line, or a number, and tells features apart; \
                     without it features have the names 0, 1, 2, …";
const COUNTS: &str =
    "a property that is an integer, 0 or more; a feature without it, or with null, has no points";

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
pub fn read_features(bytes: &[u8], [id, count]: [Option<&str>; 2]) -> Checked<Vec<Feature>> {
    let json = parse(bytes);
    let json = json.map_err(|detail| Fault::new("features", "", detail, COLLECTION))?;
    features(json, [id, count])
}

fn features(json: &RawValue, names: [Option<&str>; 2]) -> Checked<Vec<Feature>> {
    let wrong = |detail: String| Fault::new("features.of", shown(json), detail, COLLECTION);
    let object = Object::read(json).map_err(wrong)?;
    if object.get("type").map(RawValue::get) != Some(r#""FeatureCollection""#) {
        return Err(wrong("is no FeatureCollection".into()).into());
    }
    let crs = object
        .get("crs")
        .and_then(|json| serde_json::from_str(json.get()).ok());
    let crs = crs.map(|member| Crs::of_geojson(&member));
    let crs = crs.transpose().map_err(wrong)?.flatten();
    let list = object
        .get("features")
        .ok_or_else(|| wrong("has no array `features`".into()))?;
    let list = elements(list, MOST_FEATURES, "features").map_err(wrong)?;
    let mut all: Vec<Feature> = vec![];
    let mut counted = None;
    for (i, json) in list.into_iter().enumerate() {
        let Some(mut feature) = feature(i, json, names, crs.as_ref())? else {
            continue;
        };
        if names[1].is_some() {
            counted = counted
                .or(Some(false))
                .map(|found| found || feature.count.is_some());
            feature.count = feature.count.or(Some(0));
        }
        if feature.count == Some(0) {
            continue;
        }
        if all.iter().any(|known| known.name == feature.name) {
            let field = format!("features[{i}]");
            let detail = "an earlier feature has this name";
            return Err(Fault::new(&field, feature.name, detail, NAMES).into());
        }
        all.push(feature);
    }
    match (names[1], counted) {
        (Some(name), Some(false)) => {
            let field = format!("features[].properties.{name}");
            Err(Fault::missing(&field, COUNTS).into())
        }
        _ if all.is_empty() => {
            Err(wrong("has no feature with a polygon and with points".into()).into())
        }
        _ => Ok(all),
    }
}

/// A feature; none without a place. It has no number of points if the property is absent or null.
fn feature(
    i: usize,
    json: &RawValue,
    [id, count]: [Option<&str>; 2],
    crs: Option<&Crs>,
) -> Checked<Option<Feature>> {
    let path = format!("features[{i}]");
    let wrong = |detail: String| Fault::new(&path, shown(json), detail, COLLECTION);
    let object = Object::read(json).map_err(wrong)?;
    let is_there = |json: &&RawValue| json.get() != "null";
    let properties = object.get("properties").filter(is_there).map(Object::read);
    let properties = properties.transpose().map_err(wrong)?;
    let field = |name: &str| format!("{path}.properties.{name}");
    let property = |name: &str| {
        let found = properties.as_ref()?.get(name).filter(is_there)?;
        Some(found.get())
    };
    let Some(geometry) = object.get("geometry").filter(is_there) else {
        return Ok(None);
    };
    let (polygons, own): (Vec<Rings>, _) = polygons_or_none(geometry).map_err(wrong)?;
    if polygons.is_empty() {
        return Ok(None);
    }
    let name = match id {
        None => i.to_string(),
        Some(id) => {
            let text = property(id).ok_or_else(|| Fault::missing(&field(id), NAMES))?;
            let name = serde_json::from_str::<String>(text)
                .ok()
                .or_else(|| match integer(text) {
                    Some(whole) => Some(whole.to_string()),
                    None => text.parse::<f64>().ok().map(|_| text.to_owned()),
                });
            let name = name.filter(|name| is_title(name));
            name.ok_or_else(|| Fault::new(&field(id), text, "no name of a feature", NAMES))?
        }
    };
    let count = count.and_then(|count| {
        let text = property(count)?;
        let wrong = || Fault::new(&field(count), text, "no number of points", COUNTS);
        Some(
            integer(text)
                .and_then(|count| u64::try_from(count).ok())
                .ok_or_else(wrong),
        )
    });
    let count = count.transpose()?;
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

/// An integer of JSON, also one that is written as 7.0, as by tools in which every number is a float.
fn integer(text: &str) -> Option<i64> {
    const EXACT: f64 = (1u64 << 53) as f64;
    let whole = || {
        text.parse()
            .ok()
            .filter(|v: &f64| v.fract() == 0.0 && v.abs() <= EXACT)
    };
    text.parse().ok().or_else(|| whole().map(|v| v as i64))
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
            ("count", json!("id"), "features[0].properties.id"),
            ("count", json!("missing"), "features[].properties.missing"),
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

    /// pandas makes floats of columns with gaps, and writes gaps as null.
    #[test]
    fn numbers_may_be_floats_and_may_have_gaps() {
        let with = |n: Value| {
            let mut of = collection();
            of["features"][1]["properties"]["n"] = n;
            names_and_counts(&json!({ "of": of, "id": "id", "count": "n" }))
        };
        let both = |n| Ok(vec![("a".into(), Some(30)), ("7".into(), Some(n))]);
        assert_eq!(with(json!(5.0)), both(5));
        assert_eq!(with(json!(2e3)), both(2000));
        for none in [json!(null), json!(0.0)] {
            assert_eq!(with(none), Ok(vec![("a".into(), Some(30))]));
        }
        for wrong in [json!(5.5), json!("5"), json!(-1), json!(true), json!(1e300)] {
            let fault = with(wrong).expect_err("refused");
            assert!(fault.contains("features[1].properties.n"), "{fault}");
        }
    }

    #[test]
    fn names_are_kept_as_they_are() {
        let named = |id: Value| {
            let mut of = collection();
            of["features"][0]["properties"]["id"] = id;
            names_and_counts(&json!({ "of": of, "id": "id" })).map(|all| all[0].0.clone())
        };
        for (id, name) in [
            (json!("Bad Tölz"), "Bad Tölz"),
            (json!("a \"b\", c"), "a \"b\", c"),
            (json!(9.0), "9"),
            (json!(-9), "-9"),
            (json!(7.5), "7.5"),
            (json!("a\nb"), "a\nb"),
        ] {
            assert_eq!(named(id), Ok(name.into()));
        }
        for wrong in [
            json!(null),
            json!(""),
            json!("a\u{7}b"),
            json!(["a"]),
            json!(true),
        ] {
            let fault = named(wrong).expect_err("refused");
            assert!(fault.contains("features[0].properties.id"), "{fault}");
        }
        assert!(named(json!(7.0)).is_err_and(|fault| fault.contains("has this name")));
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
