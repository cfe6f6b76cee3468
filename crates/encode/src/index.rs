//! Where the bytes of an answer lie, so that any part of it can be made alone.

use std::ops::Range;

use bytes::Bytes;

/// Where the bytes of an answer lie: a front, pieces of so many rows each, a back.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Index {
    front: Bytes,
    pieces: Pieces,
    back: Bytes,
}

#[derive(Clone, Debug, PartialEq, Eq)]
enum Pieces {
    /// Each is one row of so many bytes, and there are so many.
    Even(u64, u64),
    /// Each but the last is of so many rows, and ends so many bytes after the front.
    Ending(u64, Vec<u64>),
}

/// A part of an answer: some of its front, bytes among those of some rows, some of its back.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Cut {
    /// Bytes of the front.
    pub front: Bytes,
    /// The rows whose pieces have bytes of the part; the last piece may have fewer.
    pub rows: Range<u64>,
    /// Which bytes of these pieces.
    pub bytes: Range<u64>,
    /// Bytes of the back.
    pub back: Bytes,
}

impl Index {
    /// An answer that is at hand.
    pub fn whole(front: Bytes) -> Self {
        Self::even(front, 0, 0)
    }

    /// Rows of the same number of bytes after a front.
    pub fn even(front: Bytes, bytes: u64, rows: u64) -> Self {
        Self {
            front,
            pieces: Pieces::Even(bytes, rows),
            back: Bytes::new(),
        }
    }

    /// A front, pieces of `each` rows that end at some places after it, and a back.
    pub const fn ending(front: Bytes, each: u64, ends: Vec<u64>, back: Bytes) -> Self {
        Self {
            front,
            pieces: Pieces::Ending(each, ends),
            back,
        }
    }

    /// The bytes of all pieces.
    fn length(&self) -> u64 {
        match &self.pieces {
            Pieces::Even(bytes, rows) => bytes.saturating_mul(*rows),
            Pieces::Ending(_, ends) => ends.last().copied().unwrap_or_default(),
        }
    }

    /// The size of the answer in bytes.
    pub fn size(&self) -> u64 {
        self.length() + (self.front.len() + self.back.len()) as u64
    }

    /// The part that has some bytes of the answer.
    pub fn cut(&self, range: Range<u64>) -> Cut {
        let slice = |bytes: &Bytes, before: u64| {
            let length = bytes.len() as u64;
            let at = |place: u64| place.saturating_sub(before).min(length) as usize;
            bytes.slice(at(range.start)..at(range.end))
        };
        let (front, length) = (self.front.len() as u64, self.length());
        let within = |place: u64| place.saturating_sub(front).min(length);
        let bytes = within(range.start)..within(range.end);
        let (rows, start) = match &self.pieces {
            _ if bytes.is_empty() => (0..0, bytes.start),
            Pieces::Even(each, _) => {
                let first = bytes.start / each;
                (first..bytes.end.div_ceil(*each), first * each)
            }
            Pieces::Ending(each, ends) => {
                let first = ends.partition_point(|&end| end <= bytes.start);
                let last = ends.partition_point(|&end| end < bytes.end) as u64 + 1;
                let start = first.checked_sub(1).map_or(0, |before| ends[before]);
                (first as u64 * each..last * each, start)
            }
        };
        Cut {
            front: slice(&self.front, 0),
            rows,
            bytes: bytes.start - start..bytes.end - start,
            back: slice(&self.back, front + length),
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn a_part_has_the_bytes_of_the_whole(
            lengths in proptest::collection::vec(1usize..20, 0..6),
            front in 0usize..5, back in 0usize..9, a in 0usize..140, b in 0usize..140,
        ) {
            let ends: Vec<usize> = (1..=lengths.len()).map(|n| lengths[..n].iter().sum()).collect();
            let end = front + ends.last().copied().unwrap_or(0);
            let whole: Vec<u8> = (0..end + back).map(|i| i as u8).collect();
            let of = |range: Range<usize>| Bytes::copy_from_slice(&whole[range]);
            let listed = ends.iter().map(|end| *end as u64).collect();
            let index = Index::ending(of(0..front), 3, listed, of(end..whole.len()));
            prop_assert_eq!(index.size(), whole.len() as u64);
            let range = a.min(b).min(whole.len())..a.max(b).min(whole.len());
            let Cut { front: first, rows, bytes, back: last } = index.cut(range.start as u64..range.end as u64);
            prop_assert!(rows.start % 3 == 0 && rows.end % 3 == 0);
            let place = |rows: u64| front + (rows as usize / 3).checked_sub(1).map_or(0, |piece| ends[piece]);
            let made = match rows.is_empty() {
                true => &[][..],
                false => &whole[place(rows.start)..place(rows.end)][bytes.start as usize..bytes.end as usize],
            };
            prop_assert_eq!([&*first, made, &*last].concat(), &whole[range]);
        }
    }
}
