//! The values of parameters, whichever way they came, and how they are written.

use std::sync::Arc;

use serde::{Serialize, Serializer, ser::SerializeMap as _};
use strew_catalog::field::Document;
use strew_error::{integer::Long, number};

#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A number, not NaN and not infinite.
    Number(f64),
    Integer(u64),
    Signed(i64),
    Switch(bool),
    /// Several numbers, none of them NaN or infinite.
    Numbers(Vec<f64>),
    Names(Vec<String>),
    /// Names with weights, sorted by name.
    Weights(Vec<(String, f64)>),
    /// Names with two numbers each, sorted by name.
    Ranges(Vec<(String, [f64; 2])>),
    Text(String),
    Field(Arc<Document>),
    /// Fields by name, sorted by name.
    Fields(Vec<(String, Arc<Document>)>),
}

/// The fault of a value that is not of the shape's type: only programs can make one.
pub(super) const OTHER_TYPE: &str = "has another type";

impl Value {
    /// The value reduced to names: loaded fields, and no described ones.
    pub(crate) fn named(&self) -> Option<Self> {
        let is_name = |field: &Document| matches!(field, Document::Name(_));
        match self {
            Self::Field(field) => is_name(field).then(|| self.clone()),
            Self::Fields(fields) => {
                let named = fields.iter().filter(|(_, field)| is_name(field));
                let named: Vec<_> = named.cloned().collect();
                (!named.is_empty()).then_some(Self::Fields(named))
            }
            _ => Some(self.clone()),
        }
    }

    pub fn to_text(&self) -> String {
        let listed = |parts: Vec<String>| parts.join(",");
        match self {
            Self::Number(value) => number(*value),
            Self::Integer(value) => value.to_string(),
            Self::Signed(value) => value.to_string(),
            Self::Switch(value) => if *value { "on" } else { "off" }.into(),
            Self::Numbers(values) => listed(values.iter().map(|value| number(*value)).collect()),
            Self::Names(names) => names.join(","),
            Self::Weights(pairs) => {
                let pair = |(name, weight): &(String, f64)| format!("{name}:{}", number(*weight));
                listed(pairs.iter().map(pair).collect())
            }
            Self::Ranges(ranges) => {
                let range = |(name, [min, max]): &(String, [f64; 2])| {
                    format!("{name}:{}:{}", number(*min), number(*max))
                };
                listed(ranges.iter().map(range).collect())
            }
            Self::Text(text) => text.clone(),
            Self::Field(field) => field_text(field),
            Self::Fields(fields) => {
                let pair = |(name, field): &(String, Arc<Document>)| {
                    format!("{name}:{}", field_text(field))
                };
                listed(fields.iter().map(pair).collect())
            }
        }
    }
}

/// A field as text: its name, or its description as JSON.
fn field_text(field: &Document) -> String {
    match field {
        Document::Name(name) => name.clone(),
        field => serde_json::to_string(field).unwrap_or_default(),
    }
}

/// A field in an answer: by its name, or described.
struct Written<'a>(&'a Document);

impl Serialize for Written<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self.0 {
            Document::Name(name) => name.serialize(serializer),
            field => field.serialize(serializer),
        }
    }
}

/// Types that values are read as.
macro_rules! read_as {
    ($($variant:ident as $kind:ty;)+) => {$(
        impl TryFrom<&Value> for $kind {
            type Error = &'static str;

            fn try_from(value: &Value) -> Result<Self, Self::Error> {
                match value {
                    Value::$variant(value) => Ok(value.clone()),
                    _ => Err(OTHER_TYPE),
                }
            }
        }
    )+};
}

read_as! {
    Number as f64;
    Integer as u64;
    Signed as i64;
    Switch as bool;
    Numbers as Vec<f64>;
    Names as Vec<String>;
    Weights as Vec<(String, f64)>;
    Ranges as Vec<(String, [f64; 2])>;
    Text as String;
    Field as Arc<Document>;
    Fields as Vec<(String, Arc<Document>)>;
}

impl<const N: usize> TryFrom<&Value> for [f64; N] {
    type Error = &'static str;

    fn try_from(value: &Value) -> Result<Self, Self::Error> {
        let values = Vec::try_from(value)?;
        values.try_into().map_err(|_| OTHER_TYPE)
    }
}

impl Serialize for Value {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Number(value) => value.serialize(serializer),
            Self::Integer(value) => Long(*value).serialize(serializer),
            Self::Signed(value) => Long(*value).serialize(serializer),
            Self::Switch(value) => value.serialize(serializer),
            Self::Numbers(values) => values.serialize(serializer),
            Self::Names(names) => names.serialize(serializer),
            Self::Weights(pairs) => {
                let mut map = serializer.serialize_map(Some(pairs.len()))?;
                for (name, weight) in pairs {
                    map.serialize_entry(name, weight)?;
                }
                map.end()
            }
            Self::Ranges(ranges) => {
                let mut map = serializer.serialize_map(Some(ranges.len()))?;
                for (name, range) in ranges {
                    map.serialize_entry(name, range)?;
                }
                map.end()
            }
            Self::Text(text) => text.serialize(serializer),
            Self::Field(field) => Written(field).serialize(serializer),
            Self::Fields(fields) => {
                serializer.collect_map(fields.iter().map(|(name, field)| (name, Written(field))))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use strew_error::integer::Whole;

    use super::*;

    #[test]
    fn serde_reads_what_is_exact() {
        let read = |json: &str| {
            serde_json::from_str::<Whole<u32>>(json)
                .map(|whole| whole.0)
                .ok()
        };
        assert_eq!([read("7"), read("7.0"), read("7e0")], [Some(7); 3]);
        for wrong in ["7.5", "-1.0", "1e10", "\"7\"", "true", "null", "[7]"] {
            assert_eq!(read(wrong), None, "{wrong}");
        }
        let long = |json: &str| {
            serde_json::from_str::<Whole<u64>>(json)
                .map(|whole| whole.0)
                .ok()
        };
        assert_eq!(long("18446744073709551615"), Some(u64::MAX));
        assert_eq!(long("9007199254740993.0"), None);
    }

    #[test]
    fn long_integers_are_text() {
        let json = |value: &dyn Fn() -> serde_json::Result<String>| value().expect("JSON");
        for (value, expected) in [
            (0, "0"),
            ((1 << 53) - 1, "9007199254740991"),
            (1 << 53, "\"9007199254740992\""),
            (u64::MAX, "\"18446744073709551615\""),
        ] {
            assert_eq!(json(&|| serde_json::to_string(&Long(value))), expected);
            assert_eq!(
                json(&|| serde_json::to_string(&Long(u128::from(value)))),
                expected
            );
        }
        let negative = json(&|| serde_json::to_string(&Long(i64::MIN)));
        assert_eq!(negative, "\"-9223372036854775808\"");
    }
}
