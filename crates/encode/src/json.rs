//! JSON: one document, `{"query":…,"table":…,"count":N,"points":[…]}`, a point a line; or a document a line.

use serde::Serialize;

use super::{
    head::Head,
    members::{Members, write_json},
    rows::Row,
    text::TextFormat,
    writer::Writer,
};

/// One document.
#[derive(Debug)]
pub(super) struct Json {
    pub(super) head: Head,
    pub(super) members: Members,
}

impl TextFormat for Json {
    fn begin(&self, out: &mut Vec<u8>) {
        write_json(&self.head, out);
        // The head's closing brace comes after the points.
        out.pop();
        out.extend_from_slice(b",\"points\":[");
    }

    fn row(&self, row: Row<'_>, first: bool, out: &mut Writer<'_>) {
        out.text(if first { b"\n" } else { b",\n" });
        self.members.write_point(row, out);
    }

    fn end(&self, out: &mut Vec<u8>) {
        out.extend_from_slice(b"\n]}\n");
    }

    fn row_bytes(&self) -> usize {
        160 + self.members.bytes()
    }
}

/// A document a line: the points, then the summary, if there is one.
#[derive(Debug)]
pub(super) struct Ndjson {
    pub(super) last: Option<Last>,
    pub(super) members: Members,
}

#[derive(Debug, Serialize)]
pub(super) struct Last {
    pub(super) summary: Head,
}

impl TextFormat for Ndjson {
    fn row(&self, row: Row<'_>, _first: bool, out: &mut Writer<'_>) {
        self.members.write_point(row, out);
        out.push(b'\n');
    }

    fn end(&self, out: &mut Vec<u8>) {
        if let Some(last) = &self.last {
            write_json(last, out);
            out.push(b'\n');
        }
    }

    fn row_bytes(&self) -> usize {
        160 + self.members.bytes()
    }
}
