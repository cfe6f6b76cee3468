//! The meaning of an answer's numbers, for formats without names in them.

use serde::Serialize;

use super::{
    Encoding,
    members::write_json,
    pose::Pose,
    posed::MULTIMESH_OTHERS,
    schema::{Column, Kind, LAYER, Schema, Z},
};

/// The most bytes of a legend with names: proxies hold the whole head of an answer in 4 kB.
const MOST_BYTES: usize = 1000;

/// The legend of `f32` for points that have nothing but a place.
pub const F32: &str = r#"[{"name":"x","type":"f32"},{"name":"y","type":"f32"}]"#;

/// A column of records.
#[derive(Clone, Debug, Default, Serialize)]
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
    /// The value of the least integer that is stored, where they are stored as parts of a range.
    #[serde(skip_serializing_if = "Option::is_none")]
    low: Option<f64>,
    /// The value of the greatest.
    #[serde(skip_serializing_if = "Option::is_none")]
    high: Option<f64>,
}

impl<'a> Entry<'a> {
    fn new(name: &'a str, kind: &'static str) -> Self {
        Self {
            name,
            kind,
            ..Self::default()
        }
    }

    /// With the names of a column, or with their number if there is no room for them.
    fn named(self, column: &'a Column, has_names: bool) -> Self {
        let Kind::Dictionary(names) = &column.kind else {
            return self;
        };
        Self {
            names: has_names.then_some(names),
            names_left_out: (!has_names).then_some(names.len()),
            ..self
        }
    }
}

/// The columns of a format of records in their order, as a JSON list in ASCII; `None` for other formats.
/// Names that would make it too long are left out.
pub(super) fn legend(schema: &Schema, encoding: Encoding) -> Option<String> {
    // Most requests want this one.
    if let (Encoding::F32, []) = (encoding, schema.columns()) {
        return Some(F32.into());
    }
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
        Encoding::Multimesh => return Some(written(&multimesh(schema, has_names))),
        Encoding::Instances => return Some(written(&instance(schema, has_names))),
        _ => return None,
    };
    let coordinates = coordinates.iter().map(|name| Entry::new(name, number));
    // In ply the height is a coordinate.
    let columns = schema.columns().iter();
    let columns = columns.filter(|column| encoding != Encoding::Ply || column.name != Z);
    let columns = columns.map(|column| {
        let kind = match &column.kind {
            Kind::Number => number,
            Kind::Dictionary(_) => index,
        };
        Entry::new(&column.name, kind).named(column, has_names)
    });
    Some(written(&coordinates.chain(columns).collect::<Vec<_>>()))
}

fn written(entries: &[Entry<'_>]) -> String {
    let mut json = vec![];
    write_json(&entries, &mut json);
    ascii(&String::from_utf8_lossy(&json))
}

/// The sixteen numbers of a record of `multimesh`.
fn multimesh(schema: &Schema, has_names: bool) -> Vec<Entry<'_>> {
    const MATRIX: [&str; 12] = [
        "xx", "yx", "zx", "x", "xy", "yy", "zy", "y", "xz", "yz", "zz", "z",
    ];
    let pose = Pose::new(schema);
    let column = |i: usize| &schema.columns()[i];
    let mut entries: Vec<_> = MATRIX.iter().map(|name| Entry::new(name, "f32")).collect();
    for (place, name) in [(pose.variant, "variant"), (pose.layer, LAYER)] {
        let entry = Entry::new(name, "f32");
        entries.push(match place {
            Some(i) => entry.named(column(i), has_names),
            None => entry,
        });
    }
    let others = pose.others.iter().map(|i| &*column(*i).name);
    let others = others.chain(["unused"; MULTIMESH_OTHERS]);
    let others = others.map(|name| Entry::new(name, "f32"));
    entries.extend(others.take(MULTIMESH_OTHERS));
    entries
}

/// The fields of a record of `instances`.
fn instance(schema: &Schema, has_names: bool) -> Vec<Entry<'_>> {
    let pose = Pose::new(schema);
    let mut entries = vec![Entry::new("x", "f32"), Entry::new("y", "f32")];
    let ranges = ["z", "angle", "scale"].into_iter().zip(pose.ranges(schema));
    entries.extend(ranges.map(|(name, [low, high])| Entry {
        low: Some(low),
        high: Some(high),
        ..Entry::new(name, "u16")
    }));
    entries.push(match pose.variant.or(pose.layer) {
        Some(i) => {
            let column = &schema.columns()[i];
            Entry::new(&column.name, "u16").named(column, has_names)
        }
        None => Entry::new("variant", "u16"),
    });
    entries
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
    use crate::Column;

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
