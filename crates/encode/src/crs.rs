//! The coordinate reference system of the plane, for formats that state it.

use std::{fmt, str::FromStr, sync::Arc};

use serde::{Serialize, Serializer};
use serde_json::{Value, json};

/// The rule for coordinate reference systems, in words.
pub const CRS: &str =
    "an authority and a code joined by a colon, such as EPSG:3857, EPSG:32633 or OGC:CRS84";

/// A coordinate reference system, by authority and code.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Crs {
    authority: Arc<str>,
    code: Arc<str>,
    /// PROJJSON, if it was given.
    definition: Option<Arc<Value>>,
}

impl FromStr for Crs {
    type Err = &'static str;

    /// Reads `AUTHORITY:CODE`, letters and up to 16 letters or digits. Upper and lower case are the same.
    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let text = text.to_ascii_uppercase();
        let (authority, code) = text.split_once(':').ok_or(CRS)?;
        let is_word = |word: &str, is: fn(&u8) -> bool| {
            (1..=16).contains(&word.len()) && word.bytes().all(|byte| is(&byte))
        };
        if !is_word(authority, u8::is_ascii_uppercase) || !is_word(code, u8::is_ascii_alphanumeric)
        {
            return Err(CRS);
        }
        Ok(Self {
            authority: authority.into(),
            code: code.into(),
            definition: None,
        })
    }
}

impl fmt::Display for Crs {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}", self.authority, self.code)
    }
}

impl Serialize for Crs {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl Crs {
    /// The member `crs` of GeoJSON of 2008.
    pub fn to_geojson(&self) -> Value {
        json!({ "type": "name", "properties": { "name": self.urn() } })
    }

    /// The name as a URN, which GDAL reads in that member.
    fn urn(&self) -> String {
        let version = match &*self.authority {
            "OGC" => "1.3",
            _ => "",
        };
        format!("urn:ogc:def:crs:{}:{version}:{}", self.authority, self.code)
    }

    /// Whether coordinates are degrees of longitude and latitude.
    pub(super) fn is_geographic(&self) -> bool {
        matches!(
            (&*self.authority, &*self.code),
            ("OGC", "CRS84") | ("EPSG", "4326")
        )
    }

    /// Whether another name means the same plane. GeoJSON in degrees is longitude first under both of its names.
    pub fn is_plane_of(&self, other: &Self) -> bool {
        let is_same = (&self.authority, &self.code) == (&other.authority, &other.code);
        is_same || self.is_geographic() && other.is_geographic()
    }

    /// The system of a code of EPSG.
    pub fn epsg(code: u16) -> Self {
        Self {
            authority: "EPSG".into(),
            code: code.to_string().into(),
            definition: None,
        }
    }

    /// Reads the member `crs` of GeoJSON of 2008, which GDAL, QGIS and geopandas write. `null` is no system.
    ///
    /// # Errors
    /// Describes the fault.
    pub fn of_geojson(member: &Value) -> Result<Option<Self>, String> {
        if member.is_null() {
            return Ok(None);
        }
        let name = member["properties"]["name"].as_str();
        let name = name.filter(|_| member["type"] == "name");
        let name = name.ok_or_else(|| format!("has a `crs` without a name; allowed: {MEMBER}"))?;
        let crs = Self::of_name(name).ok_or_else(|| {
            let name: String = name.chars().take(80).collect();
            format!("has the `crs` `{name}`; allowed: {MEMBER}")
        })?;
        Ok(Some(crs))
    }

    /// The system of a name as text, as a URN or as an address of the OGC.
    fn of_name(name: &str) -> Option<Self> {
        let lower = name.to_ascii_lowercase();
        let urn = lower
            .strip_prefix("urn:ogc:def:crs:")
            .or_else(|| lower.strip_prefix("urn:x-ogc:def:crs:"));
        let parts: Vec<&str> = match urn {
            Some(urn) => urn.split(':').collect(),
            None => {
                let (_, path) = lower.split_once("://www.opengis.net/def/crs/").unzip();
                match path {
                    Some(path) => path.split('/').collect(),
                    None => return name.parse().ok(),
                }
            }
        };
        match parts.as_slice() {
            [authority, code] | [authority, _, code] => format!("{authority}:{code}").parse().ok(),
            _ => None,
        }
    }

    /// Reads PROJJSON, with its name in the member `id`.
    ///
    /// # Errors
    /// Describes the fault.
    pub fn of_projjson(bytes: &[u8]) -> Result<Self, String> {
        let definition: Value =
            serde_json::from_slice(bytes).map_err(|error| format!("not JSON: {error}"))?;
        let kind = definition["type"].as_str().unwrap_or_default();
        if !kind.ends_with("CRS") {
            return Err("has no `type` of a reference system, such as ProjectedCRS".into());
        }
        if !definition["name"].is_string() || !definition["coordinate_system"].is_object() {
            return Err("has no `name` or no `coordinate_system`".into());
        }
        let id = &definition["id"];
        let text = |member: &Value| match member {
            Value::String(text) => text.clone(),
            Value::Number(code) => code.to_string(),
            _ => String::new(),
        };
        let name = format!("{}:{}", text(&id["authority"]), text(&id["code"]));
        let named: Self = name
            .parse()
            .map_err(|_| "has no `id` with an authority and a code".to_owned())?;
        Ok(Self {
            definition: Some(definition.into()),
            ..named
        })
    }

    /// The system as PROJJSON, which GeoParquet requires: as it was given, else as EPSG defines it.
    #[cfg(feature = "columnar")]
    pub(super) fn projjson(&self) -> Option<Value> {
        match &self.definition {
            Some(definition) => Some((**definition).clone()),
            None => super::definitions::find(&self.to_string()),
        }
    }
}

/// The members `crs` of GeoJSON that are read.
const MEMBER: &str =
    r#"{"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::32633"}} or no such member"#;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_checked_and_normal() {
        for (text, urn) in [
            ("epsg:3857", "urn:ogc:def:crs:EPSG::3857"),
            ("OGC:CRS84", "urn:ogc:def:crs:OGC:1.3:CRS84"),
            ("IAU:49900", "urn:ogc:def:crs:IAU::49900"),
        ] {
            let crs: Crs = text.parse().expect("valid");
            assert_eq!(
                (crs.to_string(), crs.urn()),
                (text.to_uppercase(), urn.into())
            );
        }
        for bad in [
            "",
            "3857",
            "EPSG:",
            ":1",
            "EPSG:1:2",
            "EPSG 3857",
            "ÉPSG:1",
            "EPSG:\"1",
        ] {
            assert_eq!(bad.parse::<Crs>(), Err(CRS), "{bad}");
        }
    }

    #[test]
    fn names_of_geojson_are_read_in_all_their_forms() {
        let read = |name: &str| {
            Crs::of_geojson(&json!({ "type": "name", "properties": { "name": name } }))
        };
        for (name, code) in [
            ("urn:ogc:def:crs:EPSG::25832", "EPSG:25832"),
            ("urn:ogc:def:crs:EPSG:6.18.3:3857", "EPSG:3857"),
            ("urn:ogc:def:crs:OGC:1.3:CRS84", "OGC:CRS84"),
            ("urn:x-ogc:def:crs:EPSG:4326", "EPSG:4326"),
            ("http://www.opengis.net/def/crs/EPSG/0/2154", "EPSG:2154"),
            ("EPSG:32633", "EPSG:32633"),
        ] {
            let crs = read(name).expect("read").expect("a system");
            assert_eq!(crs.to_string(), code);
        }
        assert_eq!(Crs::of_geojson(&Value::Null), Ok(None));
        for wrong in [
            json!({}),
            json!(7),
            json!({ "type": "link", "properties": { "name": "EPSG:1" } }),
        ] {
            assert!(Crs::of_geojson(&wrong).is_err_and(|text| text.contains("without a name")));
        }
        for wrong in [
            "WGS 84",
            "",
            "urn:ogc:def:crs:EPSG:1:2:3",
            "http://example.com/EPSG/0/4326",
        ] {
            assert!(
                read(wrong).is_err_and(|text| text.contains("has the `crs`")),
                "{wrong}"
            );
        }
        let degrees = ["EPSG:4326", "OGC:CRS84"].map(|text| text.parse::<Crs>().expect("valid"));
        assert!(degrees[0].is_plane_of(&degrees[1]) && !degrees[0].is_plane_of(&Crs::epsg(4258)));
    }

    #[test]
    fn projjson_brings_its_name_and_its_definition() {
        let mut json = json!({
            "type": "ProjectedCRS", "name": "Mine", "coordinate_system": {}, "id": { "authority": "ME", "code": 7 },
        });
        let crs = Crs::of_projjson(json.to_string().as_bytes()).expect("read");
        assert_eq!(crs.to_string(), "ME:7");
        assert_eq!(crs.definition.as_deref(), Some(&json));
        for member in ["id", "name", "coordinate_system", "type"] {
            let without = json
                .as_object_mut()
                .expect("an object")
                .remove(member)
                .expect("there");
            let fault = Crs::of_projjson(json.to_string().as_bytes()).expect_err(member);
            assert!(fault.contains(member), "{fault}");
            json[member] = without;
        }
    }
}
