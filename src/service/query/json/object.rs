//! Objects and arrays of JSON, read one level at a time.

use std::{fmt, sync::Arc};

use serde::de::{Deserializer as _, Error as _, IgnoredAny, MapAccess, SeqAccess, Visitor};
use serde_json::{Deserializer, value::RawValue};

use crate::service::{
    Fault,
    bounded_list::list,
    except::MOST_GIVEN,
    field::{self, Document},
    query::{Checked, all, values::shown},
};

/// The most members of an object: more than the largest valid one has.
const MOST_MEMBERS: usize = 300;

/// The members of a JSON object, each name once, in their order.
#[derive(Debug)]
pub(super) struct Object<'a> {
    members: Vec<(String, &'a RawValue)>,
}

impl<'a> Object<'a> {
    /// Reads an object.
    ///
    /// # Errors
    /// What is wrong: it is no object, has a member twice, or too many members.
    pub(super) fn read(json: &'a RawValue) -> Result<Self, String> {
        if !json.get().starts_with('{') {
            return Err("must be an object".into());
        }
        let mut deserializer = Deserializer::from_str(json.get());
        deserializer
            .deserialize_map(Members)
            .map_err(|error| text_of(&error))
    }

    /// The members with their names.
    pub(super) fn members(&self) -> impl Iterator<Item = (&str, &'a RawValue)> {
        self.members
            .iter()
            .map(|(name, json)| (name.as_str(), *json))
    }

    /// The member with a name.
    pub(super) fn get(&self, name: &str) -> Option<&'a RawValue> {
        let mut members = self.members();
        members.find_map(|(known, json)| (known == name).then_some(json))
    }
}

/// An error of reading without the place in the text, which is that of a part of the body.
pub(super) fn text_of(error: &serde_json::Error) -> String {
    let text = error.to_string();
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

/// Visits the elements of an array with their numbers until one returns false. Whether it is an
/// array.
pub(super) fn each<'a>(json: &'a RawValue, visit: impl FnMut(usize, &'a RawValue) -> bool) -> bool {
    if !json.get().starts_with('[') {
        return false;
    }
    // It breaks off where the visit does, which is an error of reading only.
    let _ = Deserializer::from_str(json.get()).deserialize_seq(Elements(visit));
    true
}

struct Elements<F>(F);

impl<'a, F: FnMut(usize, &'a RawValue) -> bool> Visitor<'a> for Elements<F> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an array")
    }

    fn visit_seq<A: SeqAccess<'a>>(mut self, mut elements: A) -> Result<(), A::Error> {
        let mut i = 0;
        while let Some(json) = elements.next_element::<&RawValue>()? {
            if !(self.0)(i, json) {
                return Err(A::Error::custom("enough"));
            }
            i += 1;
        }
        Ok(())
    }
}

/// An object of numbers by name.
///
/// # Errors
/// What is wrong with it.
pub(super) fn numbers(json: &RawValue) -> Result<Vec<(String, f64)>, String> {
    let read = |(name, json): (&str, &RawValue)| {
        let number: f64 = serde_json::from_str(json.get())
            .map_err(|_| format!("the value of `{name}` must be a number"))?;
        Ok((name.to_owned(), number))
    };
    Object::read(json)?.members().map(read).collect()
}

/// An array of names.
///
/// # Errors
/// What is wrong with it.
pub(in crate::service::query) fn list_of_names(json: &RawValue) -> Result<Vec<String>, String> {
    let mut deserializer = Deserializer::from_str(json.get());
    list(&mut deserializer, 0..=MOST_GIVEN, "names").map_err(|error| match text_of(&error) {
        text if text.contains("more than") => text,
        _ => "must be an array of names".into(),
    })
}

/// Weights: an object of weights by name.
///
/// # Errors
/// What is wrong with it.
pub(in crate::service::query) fn weights(json: &RawValue) -> Result<Vec<(String, f64)>, String> {
    numbers(json)
}

/// Ranges: an object of pairs of numbers by name.
///
/// # Errors
/// What is wrong with it.
pub(in crate::service::query) fn ranges(
    json: &RawValue,
) -> Result<Vec<(String, [f64; 2])>, String> {
    let read = |(name, json): (&str, &RawValue)| {
        let range: [f64; 2] = serde_json::from_str(json.get())
            .map_err(|_| format!("the value of `{name}` must be an array of two numbers"))?;
        Ok((name.to_owned(), range))
    };
    Object::read(json)?.members().map(read).collect()
}

/// Fields: an object of fields by name. `path` is put before the names in faults.
///
/// # Errors
/// Every fault.
pub(in crate::service::query) fn fields(
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

/// Two coordinates; further numbers, an elevation, do not matter.
#[derive(Clone, Copy, Debug)]
pub(super) struct Position(pub(super) [f64; 2]);

impl<'de> serde::Deserialize<'de> for Position {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Numbers;

        impl<'de> Visitor<'de> for Numbers {
            type Value = Position;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a position [x, y]")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut numbers: A) -> Result<Position, A::Error> {
                let mut next = |i| {
                    let number = numbers.next_element::<f64>()?;
                    number.ok_or_else(|| A::Error::invalid_length(i, &"a position [x, y]"))
                };
                let position = Position([next(0)?, next(1)?]);
                while numbers.next_element::<IgnoredAny>()?.is_some() {}
                Ok(position)
            }
        }

        deserializer.deserialize_seq(Numbers)
    }
}
