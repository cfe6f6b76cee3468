//! Packed coordinates of points in space: x, y and z by turns, little-endian, straight from the kernel.

use bytemuck::Pod;
use bytes::Bytes;
use strew_core::{
    F32, F64,
    space::{self, Plan},
};

use super::{EncodeError, blocks::Blocks, buffer::Pool};

/// A format whose items are triples of plain numbers.
pub(super) trait Scalars: space::Format<Item: Pod + std::fmt::Debug> {
    /// Turns an item around where memory order is not little-endian.
    fn to_little_endian(item: Self::Item) -> Self::Item;
}

impl Scalars for F32 {
    fn to_little_endian(item: [f32; 3]) -> [f32; 3] {
        item.map(|v| f32::from_bits(v.to_bits().to_le()))
    }
}

impl Scalars for F64 {
    fn to_little_endian(item: [f64; 3]) -> [f64; 3] {
        item.map(|v| f64::from_bits(v.to_bits().to_le()))
    }
}

/// The blocks of a packed answer.
#[derive(Debug)]
pub(super) struct Triples<F: Scalars> {
    blocks: space::Blocks<F>,
    pool: Pool<F::Item>,
    points: u64,
    count: u128,
}

impl<F: Scalars> Triples<F> {
    /// The points of a plan, in blocks of at most `block_bytes` (and at least one point).
    pub(super) fn new(plan: &Plan, block_bytes: usize) -> Self {
        let most = usize::try_from(plan.count()).unwrap_or(usize::MAX);
        let length = (block_bytes / size_of::<F::Item>()).min(most).max(1);
        Self {
            blocks: plan.blocks(),
            pool: Pool::new(length),
            points: 0,
            count: plan.count(),
        }
    }
}

impl<F: Scalars> Blocks for Triples<F> {
    fn next(&mut self) -> Option<Result<Bytes, EncodeError>> {
        if u128::from(self.points) == self.count {
            return None;
        }
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
        Some(Ok(self.pool.lend(buffer, filled)))
    }

    fn points(&self) -> u64 {
        self.points
    }
}
