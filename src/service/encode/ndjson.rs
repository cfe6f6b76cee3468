//! A JSON document a line: the points, then a summary. Without the summary it is not complete.

use serde::Serialize;

use super::{
    head::{Head, QueryEcho, TableEcho},
    members::{Members, write_json},
    rows::Row,
    text::TextFormat,
};

#[derive(Debug)]
pub(super) struct Ndjson {
    head: Head,
    members: Members,
}

impl Ndjson {
    pub(super) const fn new(head: Head, members: Members) -> Self {
        Self { head, members }
    }
}

#[derive(Serialize)]
struct Last<'a> {
    summary: Summary<'a>,
}

#[derive(Serialize)]
struct Summary<'a> {
    count: u64,
    query: &'a QueryEcho,
    table: &'a TableEcho,
}

impl TextFormat for Ndjson {
    fn begin(&mut self, _out: &mut Vec<u8>) {}

    fn row(&mut self, row: Row<'_>, _first: bool, out: &mut Vec<u8>) {
        self.members.write_point(row, out);
        out.push(b'\n');
    }

    fn end(&mut self, points: u64, out: &mut Vec<u8>) {
        let last = Last {
            summary: Summary {
                count: points,
                query: &self.head.query,
                table: &self.head.table,
            },
        };
        write_json(&last, out);
        out.push(b'\n');
    }

    fn row_bytes(&self) -> usize {
        160 + self.members.bytes()
    }
}
