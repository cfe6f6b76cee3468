//! Bytes that arrive piece by piece, in segments of one size.
//!
//! A growing vector would leave behind as much memory as it takes, and hundreds of bodies may arrive at once.

use bytes::Bytes;

/// The bytes received so far.
#[derive(Debug, Default)]
pub struct Segments {
    parts: Vec<Vec<u8>>,
    length: usize,
}

impl Segments {
    const SIZE: usize = 64 << 10;

    /// The number of bytes.
    pub const fn len(&self) -> usize {
        self.length
    }

    /// Whether there are none.
    pub const fn is_empty(&self) -> bool {
        self.length == 0
    }

    pub fn append(&mut self, mut piece: &[u8]) {
        self.length += piece.len();
        while !piece.is_empty() {
            let last = self.parts.last_mut();
            let Some(last) = last.filter(|last| last.len() < last.capacity()) else {
                // Most bodies come in one piece.
                let is_first = self.parts.is_empty();
                let size = if is_first { piece.len() } else { Self::SIZE };
                self.parts.push(Vec::with_capacity(size));
                continue;
            };
            let room = last.capacity() - last.len();
            let (now, later) = piece.split_at(piece.len().min(room));
            last.extend_from_slice(now);
            piece = later;
        }
    }

    pub fn joined(mut self) -> Bytes {
        let whole = match self.parts.len() {
            1 => self.parts.swap_remove(0),
            _ => self.parts.concat(),
        };
        whole.into()
    }
}
