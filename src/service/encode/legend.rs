//! What the numbers of an answer mean, for formats that have no names in them.

use serde::Serialize;

use super::{
    Encoding,
    members::write_json,
    schema::{Kind, Schema},
};

/// Longer texts break proxies that hold the head of an answer in a page of memory.
const MOST_BYTES: usize = 4000;

/// A column of records.
#[derive(Clone, Debug, Serialize)]
struct Entry<'a> {
    name: &'a str,
    /// How its values are stored.
    #[serde(rename = "type")]
    kind: &'static str,
    /// The names that values are indices into, from 0 on.
    #[serde(skip_serializing_if = "Option::is_none")]
    names: Option<&'a [String]>,
    /// The number of names, where there is no room for them.
    #[serde(skip_serializing_if = "Option::is_none")]
    names_left_out: Option<usize>,
}

/// The columns of a format of records in their order, as a JSON list in ASCII; `None` for other formats.
/// Names that would make it too long are left out.
pub(super) fn legend(schema: &Schema, encoding: Encoding) -> Option<String> {
    let whole = listed(schema, encoding, true)?;
    if whole.len() <= MOST_BYTES {
        Some(whole)
    } else {
        listed(schema, encoding, false)
    }
}

fn listed(schema: &Schema, encoding: Encoding, has_names: bool) -> Option<String> {
    let (coordinates, number, index): (&[&str], _, _) = match encoding {
        Encoding::F32 => (&["x", "y"], "f32", "f32"),
        Encoding::F64 | Encoding::Npy => (&["x", "y"], "f64", "f64"),
        Encoding::Ply => (&["x", "y", "z"], "f64", "i32"),
        _ => return None,
    };
    let entry = |name, kind, names: Option<&'_ [String]>| Entry {
        name,
        kind,
        names: None,
        names_left_out: names.map(<[_]>::len),
    };
    let coordinates = coordinates.iter().map(|name| entry(name, number, None));
    let columns = schema.columns().iter().map(|column| match &column.kind {
        Kind::Number => entry(&column.name, number, None),
        Kind::Dictionary(names) if has_names => Entry {
            names: Some(names),
            ..entry(&column.name, index, None)
        },
        Kind::Dictionary(names) => entry(&column.name, index, Some(names)),
    });
    let mut json = vec![];
    write_json(&coordinates.chain(columns).collect::<Vec<_>>(), &mut json);
    Some(ascii(&String::from_utf8_lossy(&json)))
}

/// JSON with everything beyond ASCII as escapes.
pub(super) fn ascii(json: &str) -> String {
    let mut out = String::with_capacity(json.len());
    for char in json.chars() {
        if char.is_ascii() {
            out.push(char);
        } else {
            for unit in char.encode_utf16(&mut [0; 2]) {
                out += &format!("\\u{unit:04x}");
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::service::encode::Column;

    #[test]
    fn names_are_listed_in_the_order_of_their_indices() {
        let names = |names: &[&str]| -> Vec<String> { names.iter().map(|n| (*n).into()).collect() };
        let schema = Schema::joined(&[(
            None,
            vec![
                Column::dictionary("variant", names(&["Bäume", "oak"])),
                Column::number("angle"),
            ],
        )]);
        let expected = concat!(
            r#"[{"name":"x","type":"f64"},{"name":"y","type":"f64"},"#,
            r#"{"name":"variant","type":"f64","names":["B\u00e4ume","oak"]},"#,
            r#"{"name":"angle","type":"f64"}]"#
        );
        for encoding in [Encoding::F64, Encoding::Npy] {
            assert_eq!(legend(&schema, encoding).as_deref(), Some(expected));
        }
        assert_eq!(
            legend(&schema, Encoding::F32),
            Some(expected.replace("f64", "f32"))
        );
        assert_eq!(legend(&schema, Encoding::Csv), None);
        let many: Vec<String> = (0..256).map(|i| format!("{i:064}")).collect();
        let schema = Schema::joined(&[(None, vec![Column::dictionary("variant", many)])]);
        let long = legend(&schema, Encoding::F64).expect("records");
        assert!(
            long.len() < MOST_BYTES && long.ends_with(r#""names_left_out":256}]"#),
            "{long}"
        );
    }
}
