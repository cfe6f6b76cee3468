//! PLY, binary and little-endian: vertices with x, y and z (0 without a terrain) as `double`, columns as properties.
//!
//! A column of numbers is a `double`; a dictionary is an `int`, the index into names that comments
//! list, −1 where a row has none.

use bytes::Bytes;

use super::{
    head::{Head, Json},
    rows::Rows,
    schema::{Column, Kind, Z},
};

/// The header. Comments are JSON, whose escapes keep them on one line and in ASCII.
pub(super) fn head(rows: &Rows, head: &Head) -> Bytes {
    let mut out = b"ply\nformat binary_little_endian 1.0\n".to_vec();
    comment("query", head.query.text(), &mut out);
    comment("table", &head.tables.text(), &mut out);
    for column in rows.schema().columns() {
        if let Kind::Dictionary(names) = &column.kind {
            comment(&property(column), Json::of(&&**names).text(), &mut out);
        }
    }
    let count = rows.count();
    out.extend_from_slice(format!("element vertex {count}\n").as_bytes());
    out.extend_from_slice(b"property double x\nproperty double y\nproperty double z\n");
    // The height stands in the vertex itself.
    let columns = rows.schema().columns();
    for column in columns.iter().filter(|column| column.name != Z) {
        let kind = match column.kind {
            Kind::Number => "double",
            Kind::Dictionary(_) => "int",
        };
        out.extend_from_slice(format!("property {kind} {}\n", property(column)).as_bytes());
    }
    out.extend_from_slice(b"end_header\n");
    out.into()
}

fn comment(name: &str, json: &str, out: &mut Vec<u8>) {
    out.extend_from_slice(format!("comment {name} ").as_bytes());
    for char in json.chars() {
        if char.is_ascii() {
            out.push(char as u8);
        } else {
            let mut units = [0; 2];
            for unit in char.encode_utf16(&mut units) {
                out.extend_from_slice(format!("\\u{unit:04x}").as_bytes());
            }
        }
    }
    out.push(b'\n');
}

/// A column's name as one word.
fn property(column: &Column) -> String {
    let word = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
    column.name.chars().map(word).collect()
}

#[cfg(test)]
mod tests {
    use crate::{Encoding, Output, sample_rows::answer};

    #[test]
    fn the_header_says_what_follows() {
        let (ply, size) = answer(&Output::new(Encoding::Ply), 4096);
        assert_eq!(size, Some(ply.len() as u64));
        let end = b"end_header\n";
        let at = ply.windows(end.len()).position(|part| part == end);
        let (head, data) = ply.split_at(at.expect("an end") + end.len());
        let head = std::str::from_utf8(head).expect("ASCII");
        assert!(head.starts_with("ply\nformat binary_little_endian 1.0\ncomment query {"));
        assert!(
            head.contains(
                "\ncomment variant [\"oak\",\"birch\",\"grey, \\\"old\\\"\",\"flint\"]\n"
            )
        );
        let record = 8 * 3 + 4 + 8 + 4;
        assert_eq!(data.len() % record, 0);
        let vertices = data.len() / record;
        let expected = format!(
            "element vertex {vertices}\nproperty double x\nproperty double y\nproperty double z\n\
             property int layer\nproperty double angle\nproperty int variant\nend_header\n"
        );
        assert!(head.ends_with(&expected), "{head}");
        let (f64s, _) = answer(&Output::new(Encoding::F64), 4096);
        for (vertex, point) in data.chunks_exact(record).zip(f64s.chunks_exact(40)) {
            assert_eq!(vertex[..16], point[..16]);
            assert_eq!(vertex[16..24], 0f64.to_le_bytes());
            let int = |at: usize| i32::from_le_bytes(vertex[at..at + 4].try_into().expect("4"));
            let number = |at: usize| f64::from_le_bytes(point[at..at + 8].try_into().expect("8"));
            assert_eq!(f64::from(int(24)), number(16));
            assert_eq!(vertex[28..36], point[24..32]);
            assert_eq!(f64::from(int(36)), number(32));
        }
    }
}
