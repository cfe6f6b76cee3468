//! The iterator over the points of a plan.

use alloc::{boxed::Box, vec};
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
    blocks: Blocks<Points>,
    block: Box<[Point]>,
    /// The place of the next point in the block, and the end of the points there.
    next: usize,
    end: usize,
    /// The number of points after the block.
    left: u128,
    seed: Seed,
}

/// The number of points made at once: 32 KiB, as fast memory holds.
const BLOCK: usize = 1024;

impl Members {
    pub(crate) fn new(blocks: Blocks<Points>, count: u128, seed: Seed) -> Self {
        let length = usize::try_from(count).unwrap_or(BLOCK).min(BLOCK);
        Self {
            blocks,
            block: vec![Point::default(); length].into(),
            next: 0,
            end: 0,
            left: count,
            seed,
        }
    }

    /// Makes the next block. Returns whether there is one.
    fn refill(&mut self) -> bool {
        self.next = 0;
        self.end = self.blocks.fill(&mut self.block);
        self.left -= self.end as u128;
        self.end > 0
    }
}

impl Iterator for Members {
    type Item = Member;

    #[inline]
    fn next(&mut self) -> Option<Member> {
        if self.next == self.end && !self.refill() {
            return None;
        }
        let point = self.block[self.next];
        self.next += 1;
        Some(Member::new(point, self.seed))
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        let left = self.left + (self.end - self.next) as u128;
        match usize::try_from(left) {
            Ok(left) => (left, Some(left)),
            Err(_) => (usize::MAX, None),
        }
    }

    fn fold<B, F: FnMut(B, Member) -> B>(mut self, init: B, mut f: F) -> B {
        let mut value = init;
        loop {
            for &point in &self.block[self.next..self.end] {
                value = f(value, Member::new(point, self.seed));
            }
            if !self.refill() {
                return value;
            }
        }
    }
}

impl ExactSizeIterator for Members {}

impl FusedIterator for Members {}
