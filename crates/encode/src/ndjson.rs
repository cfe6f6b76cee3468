//! A JSON document a line: the points, then a summary unless it is switched off.

use serde::Serialize;
use strew_error::integer::Long;

use super::{
    head::{Head, Json as Written, Tables},
    members::{Members, write_json},
    rows::Row,
    text::TextFormat,
    writer::Writer,
};

#[derive(Debug)]
pub(super) struct Ndjson {
    /// The head that the summary repeats, if there is one.
    head: Option<Head>,
    members: Members,
}

impl Ndjson {
    pub(super) const fn new(head: Option<Head>, members: Members) -> Self {
        Self { head, members }
    }
}

#[derive(Serialize)]
struct Last<'a> {
    summary: Summary<'a>,
}

#[derive(Serialize)]
struct Summary<'a> {
    count: Long<u64>,
    query: &'a Written,
    #[serde(flatten)]
    tables: &'a Tables,
    #[serde(skip_serializing_if = "Option::is_none")]
    next: Option<&'a str>,
}

impl TextFormat for Ndjson {
    fn begin(&self, _out: &mut Vec<u8>) {}

    fn row(&self, row: Row<'_>, _first: bool, out: &mut Writer<'_>) {
        self.members.write_point(row, out);
        out.push(b'\n');
    }

    fn end(&self, points: u64, out: &mut Vec<u8>) {
        let Some(head) = &self.head else { return };
        let last = Last {
            summary: Summary {
                count: Long(points),
                query: &head.query,
                tables: &head.tables,
                next: head.next.as_deref(),
            },
        };
        write_json(&last, out);
        out.push(b'\n');
    }

    fn row_bytes(&self) -> usize {
        160 + self.members.bytes()
    }
}
