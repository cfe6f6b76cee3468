//! The rows of bands, piece by piece: the order of the walk of points that settle.

use core::ops::Range;

use crate::sample::lattice::{BAND_WIDTH, PointId};

/// The rows of a piece: enough that the margins around it cost less than the piece.
pub(super) const PIECE: i64 = 512;

/// A part of a scope in its order: rows of a band.
#[derive(Clone, Debug)]
pub(super) struct Rows {
    pub(super) ahead: Range<i64>,
    pub(super) band: i64,
    pub(super) all: Range<i64>,
    pub(super) next: i64,
}

impl Rows {
    pub(super) fn new(bands: Range<i64>, all: Range<i64>) -> Self {
        Self {
            band: bands.start,
            next: all.end,
            ahead: bands,
            all,
        }
    }

    /// Moves to the next rows: the end of the piece that holds the next row, or further.
    pub(super) fn take(
        &mut self,
        sure: impl FnOnce(i64) -> Range<i64>,
    ) -> Option<(i64, Range<i64>, bool)> {
        if self.is_new_band() {
            self.band = self.ahead.next()?;
            self.next = self.all.start;
            if self.all.is_empty() {
                return None;
            }
        }
        let start = self.next;
        let sure = sure(self.band);
        let is_sure = sure.contains(&start);
        let end = if is_sure {
            sure.end
        } else {
            (start.div_euclid(PIECE) + 1) * PIECE
        };
        self.next = end.min(self.all.end);
        Some((self.band, start..self.next, is_sure))
    }

    /// Whether the next rows are the first of a band.
    pub(super) const fn is_new_band(&self) -> bool {
        self.next >= self.all.end
    }

    /// The address of the next row.
    pub(super) const fn place(&self) -> PointId {
        if self.next < self.all.end {
            PointId {
                x: self.band * BAND_WIDTH,
                y: self.next,
            }
        } else {
            PointId {
                x: self.ahead.start * BAND_WIDTH,
                y: self.all.start,
            }
        }
    }
}
