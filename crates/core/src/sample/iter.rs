//! The iterator over the points of a plan.

use alloc::{boxed::Box, vec, vec::Vec};
use core::iter::FusedIterator;

use super::{kernel::Points, lattice::Point, member::Member, seed::Seed, walk::Blocks};

/// The points of a plan, one by one, in order; see [`Plan::iter`](crate::Plan::iter).
///
/// They are made in blocks, so iterating costs little more than filling blocks. [`ExactSizeIterator::len`]
/// panics if more than `usize::MAX` points are left.
///
/// ```
/// use strew_core::{PointSet, Table};
///
/// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let mut members = PointSet::new(table).chunk(10.0, [0, 0])?.iter();
/// let all = members.len();
/// let first = members.next().expect("not empty");
/// assert!(members.all(|member| member.id() != first.id()));
/// assert!(all > 90 && members.len() == 0);
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Members {
    /// On the heap, so that making a block does not take the address of the iterator: its other fields
    /// stay in registers.
    source: Box<Source>,
    /// The place of the next point in the block, and the end of the points there.
    next: usize,
    end: usize,
    seed: Seed,
}

/// Makes blocks of points.
#[derive(Clone, Debug)]
struct Source {
    blocks: Blocks<Points>,
    block: Vec<Point>,
    /// The number of points after the block.
    left: u128,
}

/// The number of points made at once: 32 KiB, as fast memory holds.
const BLOCK: usize = 1024;

impl Source {
    /// Makes the next block. Returns the number of its points.
    #[cold]
    #[inline(never)]
    fn refill(&mut self) -> usize {
        let filled = self.blocks.fill(&mut self.block);
        self.left -= filled as u128;
        filled
    }
}

impl Members {
    pub(crate) fn new(blocks: Blocks<Points>, count: u128, seed: Seed) -> Self {
        let length = usize::try_from(count).unwrap_or(BLOCK).min(BLOCK);
        Self {
            source: Box::new(Source {
                blocks,
                block: vec![Point::default(); length],
                left: count,
            }),
            next: 0,
            end: 0,
            seed,
        }
    }
}

impl Iterator for Members {
    type Item = Member;

    #[inline]
    fn next(&mut self) -> Option<Member> {
        if self.next == self.end {
            self.end = self.source.refill();
            self.next = 0;
            if self.end == 0 {
                return None;
            }
        }
        let point = self.source.block[self.next];
        self.next += 1;
        Some(Member::new(point, self.seed))
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        let left = self.source.left + (self.end - self.next) as u128;
        match usize::try_from(left) {
            Ok(left) => (left, Some(left)),
            Err(_) => (usize::MAX, None),
        }
    }

    fn fold<B, F: FnMut(B, Member) -> B>(mut self, init: B, mut f: F) -> B {
        let mut value = init;
        loop {
            for &point in &self.source.block[self.next..self.end] {
                value = f(value, Member::new(point, self.seed));
            }
            (self.next, self.end) = (0, self.source.refill());
            if self.end == 0 {
                return value;
            }
        }
    }
}

impl ExactSizeIterator for Members {}

impl FusedIterator for Members {}
