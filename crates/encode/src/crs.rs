//! The coordinate reference system of the plane, for formats that state it.

use std::{borrow::Cow, fmt, str::FromStr, sync::Arc};

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
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
        })
    }
}

impl fmt::Display for Crs {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}", self.authority, self.code)
    }
}

impl JsonSchema for Crs {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "Crs".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": "string" })
    }
}

impl Serialize for Crs {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl Crs {
    /// The name as a URN, which GDAL reads in the `crs` member of GeoJSON of 2008.
    pub(super) fn urn(&self) -> String {
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

    /// The system as PROJJSON, which GeoParquet requires. There is no database of systems here, so only
    /// longitude and latitude, web Mercator and the UTM zones of WGS 84 are known.
    pub(super) fn projjson(&self) -> Option<Value> {
        let axis = |name: &str, abbreviation: &str, direction: &str, unit: &str| json!({ "name": name, "abbreviation": abbreviation, "direction": direction, "unit": unit });
        let longitude = axis("Geodetic longitude", "Lon", "east", "degree");
        let latitude = axis("Geodetic latitude", "Lat", "north", "degree");
        let geographic = |name: &str, axes: [&Value; 2], id: Value| {
            json!({
                "type": "GeographicCRS",
                "name": name,
                "datum": {
                    "type": "GeodeticReferenceFrame",
                    "name": "World Geodetic System 1984",
                    "ellipsoid": {
                        "name": "WGS 84",
                        "semi_major_axis": 6_378_137,
                        "inverse_flattening": 298.257_223_563,
                    },
                },
                "coordinate_system": { "subtype": "ellipsoidal", "axis": axes },
                "id": id,
            })
        };
        let epsg = |code: u32| json!({ "authority": "EPSG", "code": code });
        let wgs84 = geographic("WGS 84", [&latitude, &longitude], epsg(4326));
        let projected = |name: &str, conversion: Value, letters: [&str; 2], code: u32| {
            json!({
                "type": "ProjectedCRS",
                "name": name,
                "base_crs": wgs84,
                "conversion": conversion,
                "coordinate_system": {
                    "subtype": "Cartesian",
                    "axis": [
                        axis("Easting", letters[0], "east", "metre"),
                        axis("Northing", letters[1], "north", "metre"),
                    ],
                },
                "id": epsg(code),
            })
        };
        let parameter = |name: &str, value: f64, unit: &str, code: u32| json!({ "name": name, "value": value, "unit": unit, "id": epsg(code) });
        let origin = |longitude: f64| {
            [
                parameter("Latitude of natural origin", 0.0, "degree", 8801),
                parameter("Longitude of natural origin", longitude, "degree", 8802),
            ]
        };
        let false_origin = |east: f64, north: f64| {
            [
                parameter("False easting", east, "metre", 8806),
                parameter("False northing", north, "metre", 8807),
            ]
        };
        if (&*self.authority, &*self.code) == ("OGC", "CRS84") {
            let id = json!({ "authority": "OGC", "code": "CRS84" });
            return Some(geographic("WGS 84 (CRS84)", [&longitude, &latitude], id));
        }
        let code: u32 = self
            .code
            .parse()
            .ok()
            .filter(|_| &*self.authority == "EPSG")?;
        match code {
            4326 => Some(wgs84),
            3857 => {
                let parameters = [origin(0.0), false_origin(0.0, 0.0)].concat();
                let conversion = json!({
                    "name": "Popular Visualisation Pseudo-Mercator",
                    "method": { "name": "Popular Visualisation Pseudo Mercator", "id": epsg(1024) },
                    "parameters": parameters,
                });
                Some(projected(
                    "WGS 84 / Pseudo-Mercator",
                    conversion,
                    ["X", "Y"],
                    code,
                ))
            }
            32601..=32660 | 32701..=32760 => {
                let (zone, is_north) = (code % 100, code < 32700);
                let zone_name = format!("{zone}{}", if is_north { "N" } else { "S" });
                let scale = parameter("Scale factor at natural origin", 0.9996, "unity", 8805);
                let north = if is_north { 0.0 } else { 1e7 };
                let west = origin(f64::from(zone) * 6.0 - 183.0);
                let parameters = [&west[..], &[scale], &false_origin(5e5, north)].concat();
                let conversion = json!({
                    "name": format!("UTM zone {zone_name}"),
                    "method": { "name": "Transverse Mercator", "id": epsg(9807) },
                    "parameters": parameters,
                });
                let name = format!("WGS 84 / UTM zone {zone_name}");
                Some(projected(&name, conversion, ["E", "N"], code))
            }
            _ => None,
        }
    }
}

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
    fn common_planes_are_known_in_full() {
        for text in [
            "EPSG:4326",
            "OGC:CRS84",
            "EPSG:3857",
            "EPSG:32633",
            "EPSG:32760",
        ] {
            let crs: Crs = text.parse().expect("valid");
            let known = crs.projjson().expect("known");
            let code = text.split_once(':').expect("a code").1;
            let id = known["id"]["code"].to_string();
            assert_eq!(id.trim_matches('"'), code);
        }
        for text in ["EPSG:32661", "EPSG:2154", "OGC:CRS83"] {
            assert_eq!(text.parse::<Crs>().expect("valid").projjson(), None);
        }
    }
}
