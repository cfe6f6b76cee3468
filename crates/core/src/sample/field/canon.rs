//! The canonical encoding of fields, of which digests are made.

use crate::table::Digest;

/// Collects the parts of a field: numbers of eight bytes each, the lowest first.
pub(super) struct Canon(blake3::Hasher);

impl Canon {
    /// A field of a kind.
    pub(super) fn new(kind: &str) -> Self {
        let mut canon = Self(blake3::Hasher::new());
        canon.0.update(b"strew field 1\0");
        canon.0.update(kind.as_bytes());
        canon.0.update(&[0]);
        canon
    }

    pub(super) fn number(&mut self, number: u64) {
        self.0.update(&number.to_le_bytes());
    }

    /// Numbers, after their number.
    pub(super) fn numbers(&mut self, numbers: &[f64]) {
        self.number(numbers.len() as u64);
        for number in numbers {
            // −0 is 0.
            self.number((number + 0.0).to_bits());
        }
    }

    /// Places, after their number.
    pub(super) fn places<const D: usize>(&mut self, places: &[[f64; D]]) {
        self.number(places.len() as u64);
        for place in places {
            self.numbers(place);
        }
    }

    pub(super) fn digest(&mut self, digest: Digest) {
        self.0.update(digest.as_bytes());
    }

    pub(super) fn finish(self) -> Digest {
        Digest::from_bytes(*self.0.finalize().as_bytes())
    }
}
