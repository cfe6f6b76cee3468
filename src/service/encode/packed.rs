//! Packed coordinates: x and y by turns, little-endian, nothing else.

use bytemuck::NoUninit;
use bytes::Bytes;
use strew_core::{
    Plan,
    sample::{self, Cursor, F32, F64, Format},
};

use super::{Blocks, EncodeError, buffer::Pool};

/// A point format whose items are pairs of plain numbers.
pub trait Scalars: Format<Item: NoUninit + std::fmt::Debug> {
    /// Turns an item around where memory order is not little-endian.
    fn to_little_endian(item: Self::Item) -> Self::Item;
}

impl Scalars for F32 {
    fn to_little_endian(item: [f32; 2]) -> [f32; 2] {
        item.map(|v| f32::from_bits(v.to_bits().to_le()))
    }
}

impl Scalars for F64 {
    fn to_little_endian(item: [f64; 2]) -> [f64; 2] {
        item.map(|v| f64::from_bits(v.to_bits().to_le()))
    }
}

/// The blocks of a packed answer.
#[derive(Debug)]
pub struct Packed<F: Scalars> {
    blocks: sample::Blocks<F>,
    pool: Pool<F::Item>,
    points: u64,
}

impl<F: Scalars> Packed<F> {
    /// The points of a plan, in blocks of at most `block_bytes` (and at least one point).
    #[must_use]
    pub fn new(plan: &Plan, block_bytes: usize) -> Self {
        let most = usize::try_from(plan.count()).unwrap_or(usize::MAX);
        let length = (block_bytes / size_of::<F::Item>()).min(most).max(1);
        Self {
            blocks: plan.blocks(),
            pool: Pool::new(length),
            points: 0,
        }
    }

    /// The place after the points given so far.
    #[must_use]
    pub fn cursor(&self) -> Option<Cursor> {
        self.blocks.cursor()
    }
}

impl<F: Scalars> Iterator for Packed<F> {
    type Item = Bytes;

    fn next(&mut self) -> Option<Bytes> {
        let mut buffer = self.pool.take();
        let filled = self.blocks.fill(&mut buffer);
        if filled == 0 {
            return None;
        }
        if cfg!(target_endian = "big") {
            for item in &mut buffer[..filled] {
                *item = F::to_little_endian(*item);
            }
        }
        self.points += filled as u64;
        Some(self.pool.lend(buffer, filled))
    }
}

impl<F: Scalars> Blocks for Packed<F> {
    fn next(&mut self) -> Option<Result<Bytes, EncodeError>> {
        Iterator::next(self).map(Ok)
    }

    fn points(&self) -> u64 {
        self.points
    }
}
