//! Objects and arrays of JSON, read one level at a time.

use std::{fmt, marker::PhantomData, sync::Arc};

use serde::{
    Deserialize,
    de::{Deserializer as _, Error as _, MapAccess, Visitor, value::MapAccessDeserializer},
};
use serde_json::{Deserializer, value::RawValue};
use strew_catalog::{
    bounded_list::list,
    except::MOST_GIVEN,
    field::{self, Document},
};
use strew_config::bounded_file::without_mark;
use strew_error::{Checked, Fault, all};

/// The most members of an object: more than the largest valid one has.
const MOST_MEMBERS: usize = 300;

/// The members of a JSON object, each name once, in their order.
#[derive(Debug)]
pub(super) struct Object<'a> {
    members: Vec<(String, &'a RawValue)>,
}

impl<'a> Object<'a> {
    pub(super) fn read(json: &'a RawValue) -> Result<Self, String> {
        if !json.get().starts_with('{') {
            return Err("must be an object".into());
        }
        let mut deserializer = Deserializer::from_str(json.get());
        deserializer
            .deserialize_map(Members)
            .map_err(|error| text_of(&error))
    }

    pub(super) fn get(&self, name: &str) -> Option<&'a RawValue> {
        let found = self.members().find(|(known, _)| *known == name);
        found.map(|(_, json)| json)
    }

    pub(super) fn members(&self) -> impl Iterator<Item = (&str, &'a RawValue)> {
        self.members
            .iter()
            .map(|(name, json)| (name.as_str(), *json))
    }
}

/// An error of reading without the place in the text, which is that of a part of the body.
pub(super) fn text_of(error: &serde_json::Error) -> String {
    let text = error.to_string();
    // So serde_json says of an array.
    let text = text.replace("trailing characters", "too many elements");
    match text.rfind(" at line ") {
        Some(end) => text[..end].to_owned(),
        None => text,
    }
}

struct Members;

impl<'a> Visitor<'a> for Members {
    type Value = Object<'a>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an object")
    }

    fn visit_map<A: MapAccess<'a>>(self, mut map: A) -> Result<Object<'a>, A::Error> {
        let mut members: Vec<(String, &RawValue)> = vec![];
        while let Some((name, json)) = map.next_entry::<String, &RawValue>()? {
            if members.iter().any(|(known, _)| *known == name) {
                let name: String = name.chars().take(60).collect();
                return Err(A::Error::custom(format!(
                    "the member `{name}` appears twice"
                )));
            }
            if members.len() == MOST_MEMBERS {
                return Err(A::Error::custom(format!(
                    "more than {MOST_MEMBERS} members"
                )));
            }
            members.push((name, json));
        }
        Ok(Object { members })
    }
}

/// Reads JSON. `path` is the prefix of all paths in errors.
pub(super) fn read<'a, T: Deserialize<'a>>(json: &'a RawValue, path: &str) -> Result<T, String> {
    let mut json = Deserializer::from_str(json.get());
    serde_path_to_error::deserialize(&mut json).map_err(|error| {
        let text = text_of(error.inner());
        let path = match error.path().iter().len() {
            0 => path.to_owned(),
            _ => format!("{path}{}", error.path()),
        };
        // A longer one would leave no room for the reason.
        let path: String = path.chars().take(200).collect();
        let joint = match text.split([' ', '[', ':', '.']).next() {
            _ if path.is_empty() => "",
            Some("has" | "is") => " ",
            Some("coordinates") => ".",
            _ => ": ",
        };
        format!("{path}{joint}{text}")
    })
}

/// A value that is read from an object alone: serde would also accept an array of the members.
#[derive(Debug)]
pub(super) struct Only<T>(pub(super) T);

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Only<T> {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Members<T>(PhantomData<T>);

        impl<'de, T: Deserialize<'de>> Visitor<'de> for Members<T> {
            type Value = T;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("an object")
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<T, A::Error> {
                T::deserialize(MapAccessDeserializer::new(map))
            }
        }

        deserializer.deserialize_map(Members(PhantomData)).map(Self)
    }
}

pub(super) fn elements<'a>(
    json: &'a RawValue,
    most: usize,
    what: &'static str,
) -> Result<Vec<&'a RawValue>, String> {
    if !json.get().starts_with('[') {
        return Err("must be an array".into());
    }
    let mut json = Deserializer::from_str(json.get());
    list(&mut json, 0..=most, what).map_err(|error| text_of(&error))
}

/// The members of an object, each value read as a `T`, with their names.
fn by_name<'a, T: Deserialize<'a>>(
    json: &'a RawValue,
    what: &str,
) -> Result<Vec<(String, T)>, String> {
    let read = |(name, json): (String, &'a RawValue)| match serde_json::from_str(json.get()) {
        Ok(value) => Ok((name, value)),
        Err(_) => Err(format!("the value of `{name}` must be {what}")),
    };
    Object::read(json)?.members.into_iter().map(read).collect()
}

pub(crate) fn list_of_names(json: &RawValue) -> Result<Vec<String>, String> {
    let mut deserializer = Deserializer::from_str(json.get());
    list(&mut deserializer, 0..=MOST_GIVEN, "names").map_err(|error| match text_of(&error) {
        text if text.contains("more than") => text,
        _ => "must be an array of names".into(),
    })
}

pub(crate) fn weights(json: &RawValue) -> Result<Vec<(String, f64)>, String> {
    by_name(json, "a number")
}

pub(crate) fn ranges(json: &RawValue) -> Result<Vec<(String, [f64; 2])>, String> {
    by_name(json, "an array of two numbers")
}

/// Fields: an object of fields by name. `path` is put before the names in faults.
pub(crate) fn fields(
    path: &str,
    json: &RawValue,
    allowed: String,
) -> Checked<Vec<(String, Arc<Document>)>> {
    let object = Object::read(json);
    let object = object.map_err(|detail| Fault::new(path, shown(json), detail, allowed))?;
    let read = |(name, json): (&str, &RawValue)| {
        let field = field::read_json(&format!("{path}.{name}"), json.get())?;
        Ok((name.to_owned(), Arc::new(field)))
    };
    all(object.members().map(read))
}

pub fn shown(json: &RawValue) -> &str {
    let text = json.get();
    match text.char_indices().nth(200) {
        Some((end, _)) => &text[..end],
        None => text,
    }
}

pub(super) fn parse(bytes: &[u8]) -> Result<&RawValue, String> {
    let wrong = |detail: &str| format!("not JSON: {detail}");
    let bytes = without_mark(bytes).map_err(wrong)?;
    serde_json::from_slice(bytes).map_err(|error| {
        let starts = |start: &[u8]| bytes.trim_ascii_start().starts_with(start);
        match KINDS.iter().find(|(start, _)| starts(start)) {
            _ if bytes.trim_ascii().is_empty() => wrong("it is empty"),
            Some((_, kind)) => wrong(kind),
            None => wrong(&error.to_string()),
        }
    })
}

/// Files of other kinds that are given in the place of JSON, by their first bytes.
const KINDS: [(&[u8], &str); 10] = [
    (
        &[0, 0, 0x27, 0x0a],
        "a shapefile; ogr2ogr map.geojson map.shp converts it",
    ),
    (
        b"SQLite format 3",
        "a GeoPackage or another database of SQLite; ogr2ogr map.geojson map.gpkg converts it",
    ),
    (
        b"fgb",
        "a file of FlatGeobuf; ogr2ogr map.geojson map.fgb converts it",
    ),
    (b"PAR1", "a file of Parquet"),
    (b"PK\x03\x04", "a zip file"),
    (&[0x1f, 0x8b], "compressed by gzip"),
    (
        b"\x1e",
        "a text sequence (RFC 8142), and one FeatureCollection is read",
    ),
    (
        b"<",
        "XML, as KML and GML are; ogr2ogr map.geojson map.kml converts it",
    ),
    (b"II*\0", "a TIFF, a raster"),
    (b"\x89PNG", "a PNG, a picture"),
];

/// Makes a fault of a whole text, of which the beginning is shown.
pub(super) fn of_text(field: &str, bytes: &[u8], allowed: &str) -> impl Fn(String) -> Fault {
    move |detail| {
        let start = bytes.get(..bytes.len().min(500)).unwrap_or_default();
        let text = String::from_utf8_lossy(start);
        let words: Vec<&str> = text.split_whitespace().collect();
        Fault::new(field, words.join(" "), detail, allowed)
    }
}
