//! Packed coordinates: x, y and, in space, z by turns, little-endian, straight from the kernel.

use std::{fmt::Debug, sync::LazyLock};

use bytemuck::Pod;
use bytes::Bytes;
use strew_core::{Cursor, F32, F64, Format, Plan, space};

use super::{EncodeError, blocks::Blocks, buffer::Pool};

/// A source of the coordinates of points, which fills buffers.
pub trait Fill: Debug + Send {
    /// The coordinates of a point.
    type Point: Pod + Default + Debug + Send;
    /// How many there are.
    const COORDINATES: usize;

    /// Fills a buffer with the next points, and says with how many.
    fn fill(&mut self, points: &mut [Self::Point]) -> usize;
}

impl<F: Format<Item: Pod + Debug>> Fill for strew_core::Blocks<F> {
    type Point = F::Item;
    const COORDINATES: usize = 2;

    fn fill(&mut self, points: &mut [F::Item]) -> usize {
        self.fill(points)
    }
}

impl<F: space::Format<Item: Pod + Debug>> Fill for space::Blocks<F> {
    type Point = F::Item;
    const COORDINATES: usize = 3;

    fn fill(&mut self, points: &mut [F::Item]) -> usize {
        self.fill(points)
    }
}

/// A point format of the plane that has buffers for small answers, which would otherwise each clear one of their own.
pub trait Scalars: Format<Item: Pod + Debug> {
    /// These buffers.
    fn buffers() -> &'static Pool<Self::Item>;
}

/// The items of a buffer for small answers.
const SMALL: usize = 2048;
/// Fewer items leave most of such a buffer unused.
const FEW: usize = SMALL / 4;

impl Scalars for F32 {
    fn buffers() -> &'static Pool<[f32; 2]> {
        static POOL: LazyLock<Pool<[f32; 2]>> = LazyLock::new(|| Pool::new(SMALL));
        &POOL
    }
}

impl Scalars for F64 {
    fn buffers() -> &'static Pool<[f64; 2]> {
        static POOL: LazyLock<Pool<[f64; 2]>> = LazyLock::new(|| Pool::new(SMALL));
        &POOL
    }
}

/// Turns coordinates around where memory order is not little-endian.
pub fn to_little_endian<T: Pod>(points: &mut [T], coordinates: usize) {
    if cfg!(target_endian = "big") {
        let bytes: &mut [u8] = bytemuck::cast_slice_mut(points);
        let of_one = bytes.chunks_exact_mut(size_of::<T>() / coordinates);
        of_one.for_each(<[u8]>::reverse);
    }
}

/// The blocks of a packed answer.
#[derive(Debug)]
pub struct Packed<B: Fill> {
    blocks: B,
    pool: Pool<B::Point>,
    points: u64,
    count: u128,
}

/// The number of points of a block of at most `block_bytes` (and at least one point).
fn length<T>(count: u128, block_bytes: usize) -> usize {
    let most = usize::try_from(count).unwrap_or(usize::MAX);
    (block_bytes / size_of::<T>()).min(most).max(1)
}

/// Those of points of the plane.
pub type Pairs<F> = Packed<strew_core::Blocks<F>>;
/// Those of points in space.
pub type Triples<F> = Packed<space::Blocks<F>>;

impl<F: Scalars> Pairs<F> {
    /// The points of a plan, in blocks of at most `block_bytes` (and at least one point).
    pub fn new(plan: &Plan, block_bytes: usize) -> Self {
        let (count, length) = (plan.count(), length::<F::Item>(plan.count(), block_bytes));
        // Longer buffers would make longer blocks, unless one block is all there is.
        let pool = match length as u128 == count && (FEW..=SMALL).contains(&length) {
            true => F::buffers().clone(),
            false => Pool::new(length),
        };
        Self::of(plan.blocks(), pool, count)
    }

    /// Where the points after those of the blocks so far begin; nothing after the last one.
    pub fn cursor(&self) -> Option<Cursor> {
        self.blocks.cursor()
    }
}

impl<F: space::Format<Item: Pod + Debug>> Triples<F> {
    /// The points of a plan in space, in blocks of at most `block_bytes` (and at least one point).
    pub fn new(plan: &space::Plan, block_bytes: usize) -> Self {
        let pool = Pool::new(length::<F::Item>(plan.count(), block_bytes));
        Self::of(plan.blocks(), pool, plan.count())
    }
}

impl<B: Fill> Packed<B> {
    const fn of(blocks: B, pool: Pool<B::Point>, count: u128) -> Self {
        Self {
            blocks,
            pool,
            points: 0,
            count,
        }
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
        to_little_endian(&mut buffer[..filled], B::COORDINATES);
        self.points += filled as u64;
        Some((filled, self.pool.lend(buffer, filled)))
    }
}

impl<B: Fill> Blocks for Packed<B> {
    fn next(&mut self) -> Option<Result<Bytes, EncodeError>> {
        self.block().map(|(_, bytes)| Ok(bytes))
    }

    fn points(&self) -> u64 {
        self.points
    }
}
