//! Packed coordinates: x and y by turns, little-endian, nothing else.

use std::sync::LazyLock;

use bytemuck::Pod;
use bytes::Bytes;
use strew_core::{Cursor, F32, F64, Format, Plan};

use super::{EncodeError, blocks::Blocks, buffer::Pool};

/// A point format whose items are pairs of plain numbers.
pub trait Scalars: Format<Item: Pod + std::fmt::Debug> {
    /// Turns an item around where memory order is not little-endian.
    fn to_little_endian(item: Self::Item) -> Self::Item;

    /// The buffers of small answers, which would otherwise each clear one of their own.
    fn small() -> &'static Pool<Self::Item>;
}

/// The items of a buffer for small answers.
const SMALL: usize = 2048;
/// Fewer items leave most of such a buffer unused.
const FEW: usize = SMALL / 4;

impl Scalars for F32 {
    fn to_little_endian(item: [f32; 2]) -> [f32; 2] {
        item.map(|v| f32::from_bits(v.to_bits().to_le()))
    }

    fn small() -> &'static Pool<[f32; 2]> {
        static POOL: LazyLock<Pool<[f32; 2]>> = LazyLock::new(|| Pool::new(SMALL));
        &POOL
    }
}

impl Scalars for F64 {
    fn to_little_endian(item: [f64; 2]) -> [f64; 2] {
        item.map(|v| f64::from_bits(v.to_bits().to_le()))
    }

    fn small() -> &'static Pool<[f64; 2]> {
        static POOL: LazyLock<Pool<[f64; 2]>> = LazyLock::new(|| Pool::new(SMALL));
        &POOL
    }
}

/// The blocks of a packed answer.
#[derive(Debug)]
pub struct Packed<F: Scalars> {
    blocks: strew_core::Blocks<F>,
    pool: Pool<F::Item>,
    points: u64,
    count: u128,
}

impl<F: Scalars> Packed<F> {
    /// The points of a plan, in blocks of at most `block_bytes` (and at least one point).
    pub fn new(plan: &Plan, block_bytes: usize) -> Self {
        let most = usize::try_from(plan.count()).unwrap_or(usize::MAX);
        let length = (block_bytes / size_of::<F::Item>()).min(most).max(1);
        // Longer buffers would make longer blocks, unless one block is all there is.
        let pool = match length == most && (FEW..=SMALL).contains(&length) {
            true => F::small().clone(),
            false => Pool::new(length),
        };
        Self {
            blocks: plan.blocks(),
            pool,
            points: 0,
            count: plan.count(),
        }
    }

    /// Where the points after those of the blocks so far begin; nothing after the last one.
    pub fn cursor(&self) -> Option<Cursor> {
        self.blocks.cursor()
    }

    /// The next block, and how many points it has.
    pub fn block(&mut self) -> Option<(usize, Bytes)> {
        if u128::from(self.points) == self.count {
            // Another buffer would be cleared for nothing.
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
        Some((filled, self.pool.lend(buffer, filled)))
    }
}

impl<F: Scalars> Blocks for Packed<F> {
    fn next(&mut self) -> Option<Result<Bytes, EncodeError>> {
        self.block().map(|(_, bytes)| Ok(bytes))
    }

    fn points(&self) -> u64 {
        self.points
    }
}
