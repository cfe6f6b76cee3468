//! Comma-separated values with a header: `id,x,y` and the columns, the layer before all.

use std::sync::Arc;

use super::{
    Output,
    number::Digits,
    rows::{Row, Rows},
    schema::{Kind, Schema, Values},
    text::TextFormat,
    writer::Writer,
};

#[derive(Debug)]
pub(super) struct Csv {
    schema: Arc<Schema>,
    /// The names of each column's dictionary, quoted where they need it.
    names: Vec<Vec<String>>,
    digits: Digits,
    /// The column of the layer, which comes before the id.
    layer: Option<usize>,
}

impl Csv {
    pub(super) fn new(rows: &Rows, output: &Output) -> Self {
        let schema = rows.schema().clone();
        let names = schema.columns().iter().map(|column| match &column.kind {
            Kind::Number => vec![],
            Kind::Dictionary(names) => names.iter().map(|name| field(name)).collect(),
        });
        Self {
            names: names.collect(),
            digits: Digits::of(output.decimals),
            layer: schema.layer(),
            schema,
        }
    }

    fn value(&self, column: usize, row: Row<'_>, out: &mut Writer<'_>) {
        let values = row.columns.get(column).unwrap_or(&Values::Missing);
        if let Some(name) = values.index(row.index) {
            let name = self.names[column].get(name as usize);
            out.text(name.map_or(b"", |name| name.as_bytes()));
        } else if let Some(number) = values.number(row.index) {
            out.number(self.digits, number);
        }
    }
}

impl TextFormat for Csv {
    fn begin(&self, out: &mut Vec<u8>) {
        let columns = self.schema.columns();
        if let Some(layer) = self.layer {
            out.extend_from_slice(field(&columns[layer].name).as_bytes());
            out.push(b',');
        }
        out.extend_from_slice(b"id,x,y");
        for (i, column) in columns.iter().enumerate() {
            if self.layer == Some(i) {
                continue;
            }
            out.push(b',');
            out.extend_from_slice(field(&column.name).as_bytes());
        }
        out.push(b'\n');
    }

    fn row(&self, row: Row<'_>, _first: bool, out: &mut Writer<'_>) {
        if let Some(layer) = self.layer {
            self.value(layer, row, out);
            out.push(b',');
        }
        out.id(row);
        out.push(b',');
        out.number(self.digits, row.point.x);
        out.push(b',');
        out.number(self.digits, row.point.y);
        for column in 0..self.names.len() {
            if self.layer == Some(column) {
                continue;
            }
            out.push(b',');
            self.value(column, row, out);
        }
        out.push(b'\n');
    }

    fn row_bytes(&self) -> usize {
        let longest = |names: &[String]| names.iter().map(String::len).max().unwrap_or(24);
        160 + self
            .names
            .iter()
            .map(|names| longest(names) + 1)
            .sum::<usize>()
    }
}

/// A text as a field (RFC 4180): in quotes if it has a comma, a quote or a line break.
fn field(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.into()
    }
}
