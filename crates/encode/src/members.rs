//! Rows as members of JSON objects, for all formats that are JSON.

use super::{
    Output,
    number::Digits,
    rows::{Row, Rows},
    schema::{Kind, Values},
    writer::Writer,
};

/// Writes a value as JSON. What is written here has no maps with strange keys, so it cannot fail.
pub(super) fn write_json(value: &impl serde::Serialize, out: &mut Vec<u8>) {
    if let Err(error) = serde_json::to_writer(out, value) {
        debug_assert!(false, "{error}");
    }
}

/// Names and dictionaries of the columns as JSON, made once.
#[derive(Debug)]
pub(super) struct Members {
    columns: Vec<Member>,
    digits: Digits,
}

#[derive(Debug)]
struct Member {
    /// `"name":`.
    key: Vec<u8>,
    /// The names of a dictionary, in quotes.
    names: Vec<Vec<u8>>,
}

impl Members {
    pub(super) fn new(rows: &Rows, output: &Output) -> Self {
        let quoted = |text: &String| {
            let mut out = vec![];
            write_json(text, &mut out);
            out
        };
        let columns = rows.schema().columns().iter().map(|column| {
            let mut key = quoted(&column.name);
            key.push(b':');
            let names = match &column.kind {
                Kind::Number => vec![],
                Kind::Dictionary(names) => names.iter().map(quoted).collect(),
            };
            Member { key, names }
        });
        Self {
            columns: columns.collect(),
            digits: Digits::of(output.decimals),
        }
    }

    /// The bytes of a row's columns, roughly.
    pub(super) fn bytes(&self) -> usize {
        let longest = |names: &[Vec<u8>]| names.iter().map(Vec::len).max().unwrap_or(24);
        let bytes = self.columns.iter();
        bytes
            .map(|member| member.key.len() + longest(&member.names) + 1)
            .sum()
    }

    /// Writes `{"id":"…","x":…,"y":…}` with the columns as further members.
    #[inline(always)]
    pub(super) fn write_point(&self, row: Row<'_>, out: &mut Writer<'_>) {
        out.constant(b"{\"id\":\"");
        out.id(row);
        out.constant(b"\",\"x\":");
        out.number(self.digits, row.point.x);
        out.constant(b",\"y\":");
        out.number(self.digits, row.point.y);
        if !self.columns.is_empty() {
            self.write_columns(row, b',', out);
        }
        out.push(b'}');
    }

    /// How numbers are written.
    pub(super) const fn digits(&self) -> Digits {
        self.digits
    }

    /// Writes an object of the columns.
    pub(super) fn write_object(&self, row: Row<'_>, out: &mut Writer<'_>) {
        if !self.write_columns(row, b'{', out) {
            out.push(b'{');
        }
        out.push(b'}');
    }

    /// Writes the columns as members, without those that the row lacks: `before` the first, commas between them.
    /// Returns whether there were any.
    fn write_columns(&self, row: Row<'_>, before: u8, out: &mut Writer<'_>) -> bool {
        let (mut separator, mut has_some) = (before, false);
        for (member, values) in self.columns.iter().zip(row.columns) {
            if *values == Values::Missing {
                continue;
            }
            out.push(separator);
            (separator, has_some) = (b',', true);
            out.text(&member.key);
            if let Some(name) = values.index(row.index) {
                let name = member
                    .names
                    .get(name as usize)
                    .map_or(&b"null"[..], |name| name);
                out.text(name);
            } else if let Some(number) = values.number(row.index) {
                out.number(self.digits, number);
            } else {
                out.constant(b"null");
            }
        }
        has_some
    }
}
