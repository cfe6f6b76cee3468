//! One JSON document: `{"query":…,"table":…,"count":N,"points":[…]}`, a point a line.

use strew_core::Point;

use super::{
    Head,
    text::{TextFormat, write_json, write_point},
};

#[derive(Debug)]
pub(super) struct Json {
    head: Head,
}

impl Json {
    pub(super) const fn new(head: Head) -> Self {
        Self { head }
    }
}

impl TextFormat for Json {
    fn begin(&mut self, out: &mut Vec<u8>) {
        write_json(&self.head, out);
        // The head's closing brace comes after the points.
        out.pop();
        out.extend_from_slice(b",\"points\":[");
    }

    fn point(&mut self, point: &Point, first: bool, out: &mut Vec<u8>) {
        out.extend_from_slice(if first { b"\n" } else { b",\n" });
        write_point(point, out);
    }

    fn end(&mut self, _points: u64, out: &mut Vec<u8>) {
        out.extend_from_slice(b"\n]}\n");
    }
}
