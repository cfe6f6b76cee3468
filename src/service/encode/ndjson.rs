//! A JSON document a line: the points, then a summary. Without the summary it is not complete.

use serde::Serialize;
use strew_core::Point;

use super::{
    Head, QueryEcho, TableEcho,
    text::{TextFormat, write_json, write_point},
};

#[derive(Debug)]
pub(super) struct Ndjson {
    head: Head,
}

impl Ndjson {
    pub(super) const fn new(head: Head) -> Self {
        Self { head }
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

    fn point(&mut self, point: &Point, _first: bool, out: &mut Vec<u8>) {
        write_point(point, out);
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
}
