//! One JSON document: `{"query":…,"table":…,"count":N,"points":[…]}`, a point a line.

use super::{
    head::Head,
    members::{Members, write_json},
    rows::Row,
    text::TextFormat,
    writer::Writer,
};

#[derive(Debug)]
pub(super) struct Json {
    head: Head,
    members: Members,
}

impl Json {
    pub(super) const fn new(head: Head, members: Members) -> Self {
        Self { head, members }
    }
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

    fn end(&self, _points: u64, out: &mut Vec<u8>) {
        out.extend_from_slice(b"\n]}\n");
    }

    fn row_bytes(&self) -> usize {
        160 + self.members.bytes()
    }
}
