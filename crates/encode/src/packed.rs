//! Packed coordinates: x and y by turns, little-endian, nothing else.

use std::sync::LazyLock;

use bytemuck::Pod;
use bytes::Bytes;
use strew_core::{F32, F64, Format, Plan};

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
    /// The items of room that a buffer has before and after its points.
    room: [usize; 2],
    points: u64,
    count: u128,
}

impl<F: Scalars> Packed<F> {
    /// The points of a plan, in blocks of at most `block_bytes` (and at least one point).
    #[must_use]
    pub fn new(plan: &Plan, block_bytes: usize) -> Self {
        Self::with_room(plan, block_bytes, [0; 2])
    }

    /// The points of a plan, in blocks of at most `block_bytes` (and at least one point), with room for `room` bytes
    /// before and after the points of each.
    #[must_use]
    pub fn with_room(plan: &Plan, block_bytes: usize, room: [usize; 2]) -> Self {
        let most = usize::try_from(plan.count()).unwrap_or(usize::MAX);
        let length = (block_bytes / size_of::<F::Item>()).min(most).max(1);
        let room = room.map(|bytes| bytes.div_ceil(size_of::<F::Item>()));
        let items = room[0] + length + room[1];
        // Longer buffers would make longer blocks, unless one block is all there is.
        let pool = match length == most && (FEW..=SMALL).contains(&items) {
            true => F::small().clone(),
            false => Pool::new(items),
        };
        Self {
            blocks: plan.blocks(),
            pool,
            room,
            points: 0,
            count: plan.count(),
        }
    }

    /// The next block, between the two byte strings of `around`, which gets the block's size in bytes and the blocks
    /// after it. Points are not copied if the strings fit into the room.
    pub fn next_between(
        &mut self,
        around: impl FnOnce(usize, &strew_core::Blocks<F>) -> [Vec<u8>; 2],
    ) -> Option<Bytes> {
        if u128::from(self.points) == self.count {
            // Another buffer would be cleared for nothing.
            return None;
        }
        let mut buffer = self.pool.take();
        let end = buffer.len() - self.room[1];
        let filled = self.blocks.fill(&mut buffer[self.room[0]..end]);
        if filled == 0 {
            return None;
        }
        let items = self.room[0]..self.room[0] + filled;
        if cfg!(target_endian = "big") {
            for item in &mut buffer[items.clone()] {
                *item = F::to_little_endian(*item);
            }
        }
        self.points += filled as u64;
        let [start, end] = [items.start, items.end].map(|item| item * size_of::<F::Item>());
        let [before, after] = around(end - start, &self.blocks);
        let bytes: &mut [u8] = bytemuck::cast_slice_mut(&mut buffer);
        if before.len() > start || after.len() > bytes.len() - end {
            return Some([&before, &bytes[start..end], &after].concat().into());
        }
        let part = start - before.len()..end + after.len();
        bytes[part.start..start].copy_from_slice(&before);
        bytes[end..part.end].copy_from_slice(&after);
        Some(self.pool.lend_part(buffer, part))
    }
}

impl<F: Scalars> Blocks for Packed<F> {
    fn next(&mut self) -> Option<Result<Bytes, EncodeError>> {
        self.next_between(|_, _| [vec![], vec![]]).map(Ok)
    }

    fn points(&self) -> u64 {
        self.points
    }
}
