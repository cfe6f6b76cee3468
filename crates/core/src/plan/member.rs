//! Members, points that know their attributes, and the iterator over those of a plan.

use alloc::{boxed::Box, vec, vec::Vec};
use core::{fmt::Debug, iter::FusedIterator, ops::RangeInclusive};

use crate::{
    attribute::{
        Attribute, Variants,
        hash::{Hashed, angle, between, hash, key, unit},
    },
    kernel::Points,
    lattice::{Point, PointId, seed::Seed},
    walk::Blocks,
};

/// A point of a set.
///
/// Its attributes are functions of the id and the seed alone, so a point has the same values whichever
/// request finds it, and the same as in the [columns](crate::Attributes) of many points.
///
/// ```
/// use strew_core::{PointSet, Table, Variants};
///
/// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let trees = PointSet::new(table).spacing(4.0)?.seed(7);
/// let kinds: Variants = "oak:3,birch:1".parse()?;
/// for tree in trees.chunk(64.0, [3, -2])? {
///     let [x, y] = tree.at();
///     println!("{} at {x} {y}: {}", tree.id(), tree.variant(&kinds));
///     assert!((0.8..=1.2).contains(&tree.scale(0.8..=1.2)));
///     assert_eq!(trees.point(tree.id()), Some(tree));
/// }
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Member<Id: Hashed = PointId> {
    point: Id::Point,
    seed: Seed,
}

impl<Id: Hashed> Member<Id> {
    pub(crate) const fn new(point: Id::Point, seed: Seed) -> Self {
        Self { point, seed }
    }

    /// The stable id, which finds the point again in the same set.
    #[must_use]
    pub fn id(&self) -> Id {
        Id::of(&self.point)
    }

    /// Id and coordinates.
    #[must_use]
    pub const fn point(&self) -> Id::Point {
        self.point
    }

    /// The attribute `scale`: a factor, uniform in a range, both ends included. An empty range returns its
    /// end.
    #[must_use]
    pub fn scale(&self, range: RangeInclusive<f64>) -> f64 {
        between(*range.start(), *range.end(), self.hash(Attribute::SCALE))
    }

    /// The attribute `variant`: the name of one of several things, chosen with a probability in proportion
    /// to its weight.
    #[must_use]
    pub fn variant<'v>(&self, variants: &'v Variants) -> &'v str {
        let index = variants.pick(self.hash(Attribute::VARIANT));
        variants.name(index).unwrap_or_default()
    }

    /// The attribute `u1`, `u2`, …: a number uniform in [0, 1), independent of those of other `n`. In
    /// output formats `n` is 1 to 16.
    #[must_use]
    pub fn uniform(&self, n: u8) -> f64 {
        unit(self.hash(Attribute::uniform_code(n)))
    }

    pub(crate) const fn seed(&self) -> Seed {
        self.seed
    }

    fn hash(&self, code: u64) -> u64 {
        hash(key(self.seed, code), self.id())
    }
}

impl Member {
    /// The place, in world coordinates.
    #[must_use]
    pub const fn at(&self) -> [f64; 2] {
        self.point.at()
    }

    /// The attribute `angle`: a rotation in radians, uniform in [0, 2π).
    #[must_use]
    pub fn angle(&self) -> f64 {
        angle(self.hash(Attribute::ANGLE))
    }
}

impl From<Member> for Point {
    fn from(member: Member) -> Self {
        member.point
    }
}

/// The ids of points that plans make block by block, in the plane or in space.
pub trait Made: Hashed {
    /// The points of a plan.
    type Blocks: Clone + Debug;
    /// Makes the next points, as many as there is room for but at the end, and returns their number.
    fn fill(blocks: &mut Self::Blocks, points: &mut [Self::Point]) -> usize;
}

impl Made for PointId {
    type Blocks = Blocks<Points>;

    fn fill(blocks: &mut Self::Blocks, points: &mut [Point]) -> usize {
        blocks.fill(points)
    }
}

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
pub struct Members<Id: Made = PointId> {
    /// On the heap, so that making a block does not take the address of the iterator: its other fields
    /// stay in registers.
    source: Box<Source<Id>>,
    /// The place of the next point in the block, and the end of the points there.
    next: usize,
    end: usize,
    seed: Seed,
}

/// Makes blocks of points.
#[derive(Clone, Debug)]
struct Source<Id: Made> {
    blocks: Id::Blocks,
    block: Vec<Id::Point>,
    /// The number of points after the block.
    left: u128,
}

/// The number of points made at once: 32 KiB, as fast memory holds.
const BLOCK: usize = 1024;

impl<Id: Made> Source<Id> {
    /// Makes the next block. Returns the number of its points.
    #[cold]
    #[inline(never)]
    fn refill(&mut self) -> usize {
        let filled = Id::fill(&mut self.blocks, &mut self.block);
        self.left -= filled as u128;
        filled
    }
}

impl<Id: Made> Members<Id> {
    pub(crate) fn new(blocks: Id::Blocks, count: u128, seed: Seed) -> Self {
        let length = usize::try_from(count).unwrap_or(BLOCK).min(BLOCK);
        Self {
            source: Box::new(Source {
                blocks,
                block: vec![Id::Point::default(); length],
                left: count,
            }),
            next: 0,
            end: 0,
            seed,
        }
    }
}

impl<Id: Made> Iterator for Members<Id> {
    type Item = Member<Id>;

    #[inline]
    fn next(&mut self) -> Option<Member<Id>> {
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

    fn fold<B, F: FnMut(B, Member<Id>) -> B>(mut self, init: B, mut f: F) -> B {
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

impl<Id: Made> ExactSizeIterator for Members<Id> {}

impl<Id: Made> FusedIterator for Members<Id> {}
