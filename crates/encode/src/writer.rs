//! A writer for rows of text, which gathers pieces in a small buffer that stays in the fastest memory.
//!
//! A row is a dozen short pieces. Appending each to a long vector would check its capacity and call the general copy
//! each time, which takes as long as making the digits. Here digits are written where they stay, because copies are
//! slow: bytes that are written one by one and read again as a whole wait for the processor's store buffer. Numbers
//! written elsewhere and then copied were half as fast.

use strew_core::PointId;

use super::{
    number::{Digits, Room, fixed, integer, write_exactly},
    rows::Row,
};

/// The bytes that are gathered.
const GATHERED: usize = 4096;

/// Writes text to the end of a vector, all of it once it is [finished](Self::finish).
#[derive(Debug)]
pub(super) struct Writer<'a> {
    out: &'a mut Vec<u8>,
    gathered: [u8; GATHERED],
    /// The number of bytes gathered; there always is room for a piece.
    length: usize,
    /// The lattice row of the last id, with its colon and digits and how many these are: neighbors
    /// share it.
    row: (i64, Room, usize),
}

impl<'a> Writer<'a> {
    pub(super) fn new(out: &'a mut Vec<u8>) -> Self {
        let mut writer = Self {
            out,
            gathered: [0; GATHERED],
            length: 0,
            row: (0, Room::default(), 0),
        };
        writer.turn_to(0);
        writer
    }

    /// Writes all that is gathered.
    pub(super) fn finish(mut self) {
        self.flush();
    }

    #[cold]
    fn flush(&mut self) {
        self.out.extend_from_slice(&self.gathered[..self.length]);
        self.length = 0;
    }

    /// Room for a piece.
    #[inline(always)]
    fn room(&mut self) -> Option<&mut Room> {
        self.gathered.get_mut(self.length..)?.first_chunk_mut()
    }

    #[inline(always)]
    fn took(&mut self, length: usize) {
        self.length += length;
        if self.length > GATHERED - size_of::<Room>() {
            self.flush();
        }
    }

    /// Writes a byte.
    #[inline(always)]
    pub(super) fn push(&mut self, byte: u8) {
        self.constant(&[byte]);
    }

    /// Writes a short text of a known length.
    #[inline(always)]
    pub(super) fn constant<const N: usize>(&mut self, text: &[u8; N]) {
        const { assert!(N <= size_of::<Room>()) };
        if let Some(room) = self.room() {
            room[..N].copy_from_slice(text);
        }
        self.took(N);
    }

    /// Writes any text.
    pub(super) fn text(&mut self, text: &[u8]) {
        self.flush();
        self.out.extend_from_slice(text);
    }

    /// Writes a finite number.
    #[inline(always)]
    pub(super) fn number(&mut self, digits: Digits, value: f64) {
        match digits {
            Digits::Shortest => self.digits(zmij::Buffer::new().format_finite(value).as_bytes()),
            Digits::Fixed(decimals) => {
                let length = self.room().and_then(|room| fixed(value, decimals, room));
                match length {
                    Some(length) => self.took(length),
                    None => {
                        self.flush();
                        write_exactly(value, decimals, self.out);
                    }
                }
            }
        }
    }

    /// Writes the id of a row: `column:row`, in space `x:y:z`.
    #[inline(always)]
    pub(super) fn id(&mut self, row: Row<'_>) {
        self.address(row.point.id);
        if let Some(height) = row.height {
            self.push(b':');
            let length = self.room().map(|room| integer(height.address, room));
            self.took(length.unwrap_or_default());
        }
    }

    #[inline(always)]
    fn address(&mut self, id: PointId) {
        let column = self.room().map(|room| integer(id.x, room));
        self.took(column.unwrap_or_default());
        if self.row.0 != id.y {
            self.turn_to(id.y);
        }
        let (_, row, length) = self.row;
        if let Some(room) = self.room() {
            *room = row;
        }
        self.took(length);
    }

    #[cold]
    fn turn_to(&mut self, y: i64) {
        let (mut digits, mut row) = (Room::default(), Room::default());
        let length = integer(y, &mut digits);
        row[0] = b':';
        row[1..=length].copy_from_slice(&digits[..length]);
        self.row = (y, row, 1 + length);
    }

    /// Writes up to 24 digits: by copies of fixed sizes that meet or overlap.
    #[inline(always)]
    fn digits(&mut self, text: &[u8]) {
        let length = text.len();
        let Some(room) = self.room() else { return };
        if let (Some(first), Some(last)) = (text.first_chunk::<8>(), text.last_chunk::<8>()) {
            room[..8].copy_from_slice(first);
            if length > 16 {
                room[8..16].copy_from_slice(&text[8..16]);
            }
            room[length - 8..length].copy_from_slice(last);
        } else {
            room[..length].copy_from_slice(text);
        }
        self.took(length);
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn what_is_written_in_pieces_is_what_one_by_one_would_be(
            values in prop::collection::vec((any::<f64>(), -1e4f64..1e4, any::<i64>(), -9i64..9), 1..400),
            decimals in 0u8..=17,
        ) {
            let (mut out, mut expected) = (b"before".to_vec(), b"before".to_vec());
            let mut writer = Writer::new(&mut out);
            for &(any, usual, x, y) in &values {
                let any = if any.is_finite() { any } else { 0.0 };
                writer.address(PointId { x, y });
                writer.constant(b", ");
                expected.extend_from_slice(format!("{x}:{y}, ").as_bytes());
                for value in [any, usual] {
                    for digits in [Digits::Shortest, Digits::of(Some(decimals))] {
                        writer.number(digits, value);
                        digits.write(value, &mut expected);
                        writer.push(b';');
                        expected.push(b';');
                    }
                }
                let text = "text".repeat(y.unsigned_abs() as usize * 2);
                writer.text(text.as_bytes());
                expected.extend_from_slice(text.as_bytes());
            }
            writer.finish();
            prop_assert_eq!(String::from_utf8(out), String::from_utf8(expected));
        }
    }
}
