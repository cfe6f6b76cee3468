//! Comma-separated values with the header `id,x,y`.

use strew_core::Point;

use super::text::{TextFormat, write_id, write_number};

#[derive(Debug)]
pub(super) struct Csv;

impl TextFormat for Csv {
    fn begin(&mut self, out: &mut Vec<u8>) {
        out.extend_from_slice(b"id,x,y\n");
    }

    fn point(&mut self, point: &Point, _first: bool, out: &mut Vec<u8>) {
        write_id(point.id, out);
        out.push(b',');
        write_number(point.x, out);
        out.push(b',');
        write_number(point.y, out);
        out.push(b'\n');
    }

    fn end(&mut self, _points: u64, _out: &mut Vec<u8>) {}
}
