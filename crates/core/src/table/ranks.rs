//! Ranks: the order in which the blocks of a table leave when a set is thinned.
//!
//! Blocks leave one after another. Inside the one block that is partly kept, points leave by a strip: those
//! with the greatest dX first. The indices of points are uniform over the set region, so the rank of a
//! point, the share of the pattern that leaves after it, is uniform over the pattern:
//!
//! rank = floor of its block + width of its block · (dX − start)/(length of the interval of dX).
//!
//! The floor of a block is the sum of the shares of the blocks that leave after it. Points of rank below λ
//! are a share λ of the pattern. They nest as λ grows, and are whole blocks and a strip, so their counts
//! have closed forms.
//!
//! The forge makes the order by void and cluster, with exact pair frequencies. A table without ranks is
//! thinned in a hashed order of its blocks, which is no more even than a random choice.

use alloc::{sync::Arc, vec, vec::Vec};

use crate::{
    error::{Error, ErrorKind},
    map::Map,
    sort,
};

/// The order in which blocks leave: for each block its position, 0 for the one that leaves last.
///
/// ```
/// use strew_core::table::Ranks;
///
/// let ranks = Ranks::new(vec![2, 0, 1])?;
/// assert_eq!(ranks.positions(), [2, 0, 1]);
/// assert!(Ranks::new(vec![2, 0, 2]).is_err());
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Ranks {
    positions: Vec<u32>,
}

impl Ranks {
    /// The order in which block number `b` has the position `positions[b]`. Blocks are numbered as the
    /// vectors of a table: row by row.
    ///
    /// # Errors
    /// [`ErrorKind::Table`] unless each position from 0 on occurs once.
    pub fn new(positions: Vec<u32>) -> Result<Self, Error> {
        let mut seen = vec![false; positions.len()];
        for &position in &positions {
            match seen.get_mut(position as usize) {
                Some(seen) if !*seen => *seen = true,
                _ => {
                    let allowed = "one of each from 0 to the number of blocks, less 1";
                    return Err(Error::new(ErrorKind::Table, "ranks", position, allowed));
                }
            }
        }
        Ok(Self { positions })
    }

    /// The position of each block, row by row; 0 is the block that leaves last.
    #[must_use]
    pub fn positions(&self) -> &[u32] {
        &self.positions
    }

    /// The block at each position.
    fn blocks(&self) -> Vec<u32> {
        let mut blocks = vec![0; self.positions.len()];
        for (block, &position) in (0..).zip(&self.positions) {
            blocks[position as usize] = block;
        }
        blocks
    }

    /// A hashed order, for tables without ranks.
    pub(crate) fn hashed(blocks: usize) -> Self {
        let mut positions = vec![0; blocks];
        for (position, &block) in (0..).zip(&scattered(blocks)) {
            positions[block as usize] = position;
        }
        Self { positions }
    }
}

/// The numbers of blocks in a hashed order.
pub(super) fn scattered(blocks: usize) -> Vec<u32> {
    let mut order: Vec<u32> = (0..blocks as u32).collect();
    sort::by_key(&mut order, |&block| scrambled(block.into()));
    order
}

/// A one-to-one hash: the finalizer of `SplitMix64`.
const fn scrambled(block: u64) -> u64 {
    let z = block.wrapping_add(1).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// The ranks of a table's points.
#[derive(Clone, Debug)]
pub(crate) struct Order {
    positions: Vec<u32>,
    /// The block at each position.
    blocks: Vec<u32>,
    /// The floor at each position, ascending from 0, and 1 after the last.
    floors: Arc<[f64]>,
}

/// The points of a pattern that are kept: those of the first positions, and a strip of the next block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Cut {
    /// The number of positions whose blocks are kept whole.
    pub(crate) whole: u32,
    /// The interval of dX of the block at position `whole`, and its row.
    partial: [u32; 2],
    /// The index dX at which the strip of that block ends.
    pub(crate) strip_end: u64,
}

impl Order {
    /// The order of the blocks of a map along some axes; `ranks` has a position for each. The size of a block is the
    /// product of the lengths of its intervals, each rounded down to 2²⁴ units along three axes: it has less than 126 bits.
    pub(super) fn new(map: &Map, axes: u32, ranks: &Ranks) -> Self {
        let n = map.intervals();
        let coarse = if axes == 2 { 0 } else { 24 };
        let length = |i: usize| {
            let interval = map.interval(i);
            u128::from((interval.end - interval.start) >> coarse)
        };
        let size = |block: u32| {
            let places = (0..axes).scan(block as usize, |rest, _| {
                let place = *rest % n;
                *rest /= n;
                Some(place)
            });
            places.map(length).product::<u128>()
        };
        let blocks = ranks.blocks();
        let all = (0..n).map(length).sum::<u128>().pow(axes) as f64;
        let mut below = 0u128;
        let mut floors = Vec::with_capacity(blocks.len() + 1);
        for &block in &blocks {
            floors.push(below as f64 / all);
            below += size(block);
        }
        floors.push(1.0);
        Self {
            positions: ranks.positions.clone(),
            blocks,
            floors: floors.into(),
        }
    }

    /// The order of a table whose block at each place is block `source(place)` of this order's table. The two
    /// have the same size.
    pub(crate) fn turned(&self, source: impl Fn(usize) -> usize) -> Self {
        let positions = (0..self.positions.len()).map(|block| self.positions[source(block)]);
        let ranks = Ranks {
            positions: positions.collect(),
        };
        Self {
            blocks: ranks.blocks(),
            positions: ranks.positions,
            floors: self.floors.clone(),
        }
    }

    /// The position of a block.
    #[inline]
    pub(crate) fn position(&self, block: usize) -> usize {
        self.positions[block] as usize
    }

    /// The positions of some blocks that follow each other in a row.
    #[inline]
    pub(crate) fn positions(&self, blocks: core::ops::Range<usize>) -> &[u32] {
        &self.positions[blocks]
    }

    /// The block at a position, if there are so many.
    pub(crate) fn block_at(&self, position: usize) -> Option<usize> {
        self.blocks.get(position).map(|&block| block as usize)
    }

    /// The ranks of the block at a position.
    #[inline]
    pub(crate) fn floors(&self, position: usize) -> core::ops::Range<f64> {
        self.floors[position]..self.floors[position + 1]
    }

    /// The number of blocks of which a point may have a rank below `share`.
    pub(crate) fn alive(&self, share: f64) -> usize {
        let floors = &self.floors[..self.blocks.len()];
        floors.partition_point(|&floor| floor < share)
    }

    /// The number of positions of which all points have ranks below `share`.
    pub(crate) fn whole(&self, share: f64) -> usize {
        self.floors[1..].partition_point(|&end| end <= share)
    }

    /// The rank of a point: its block's position, and where its dX lies in the interval. In [0, 1).
    #[inline]
    pub(crate) fn rank(&self, position: usize, offset: u64, length: u64) -> f64 {
        let (floor, next) = (self.floors[position], self.floors[position + 1]);
        // Conversion, quotient, product and sum round monotonically, so ranks never fall along a block.
        let within = floor + (next - floor) * (offset as f64 / length as f64);
        within.min(next.next_down()).max(0.0)
    }

    /// The cut that keeps exactly the points of rank below `share`.
    pub(crate) fn cut(&self, map: &Map, share: f64) -> Cut {
        // A rank lies below the next floor.
        let whole = self.whole(share);
        let Some(&block) = self.blocks.get(whole) else {
            return Cut {
                whole: whole as u32,
                partial: [u32::MAX; 2],
                strip_end: 0,
            };
        };
        let n = map.intervals();
        let [x, y] = [block as usize % n, block as usize / n];
        let interval = map.interval(x);
        let length = interval.end - interval.start;
        // A bisection on the rank itself: below `low` all are kept, at `high` and above none.
        let (mut low, mut high) = (0, length);
        while low < high {
            let middle = low + (high - low) / 2;
            if self.rank(whole, middle, length) < share {
                low = middle + 1
            } else {
                high = middle
            }
        }
        Cut {
            whole: whole as u32,
            partial: [x as u32, y as u32],
            strip_end: interval.start + low,
        }
    }

    /// About the memory that the order holds, in bytes, with those of `turned` copies.
    pub(super) fn memory_bytes(&self, turned: usize) -> usize {
        (16 + 8 * turned) * self.blocks.len()
    }
}

impl Cut {
    /// Whether a point is kept, given its block's position and whether its dX lies in the strip.
    #[inline(always)]
    pub(crate) const fn keeps(&self, position: u32, is_in_strip: bool) -> bool {
        position < self.whole || (position == self.whole && is_in_strip)
    }

    /// Whether an index dX in an interval lies in the strip of the block that is partly kept.
    #[inline(always)]
    pub(crate) const fn is_in_strip(&self, interval: usize, index: u64) -> bool {
        interval == self.partial[0] as usize && index < self.strip_end
    }

    /// The strip: the interval of dX and that of dY which it belongs to, and the end of its dX.
    pub(crate) const fn strip(&self) -> ([usize; 2], u64) {
        let [x, y] = self.partial;
        ([x as usize, y as usize], self.strip_end)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn order(radius: u32) -> (Map, Order) {
        let map = Map::new("(5-sqrt(3))/2".parse().expect("valid"), radius).expect("small");
        let blocks = map.intervals() * map.intervals();
        let order = Order::new(&map, 2, &Ranks::hashed(blocks));
        (map, order)
    }

    #[test]
    fn positions_are_a_permutation() {
        assert!(Ranks::new(vec![0, 1, 3]).is_err());
        assert!(Ranks::new(vec![1, 1, 0]).is_err());
        let hashed = Ranks::hashed(729);
        assert_eq!(Ranks::new(hashed.positions.clone()), Ok(hashed));
    }

    proptest! {
        #[test]
        fn a_cut_keeps_the_points_whose_rank_is_below_the_share(
            share in prop_oneof![0.0..1.0f64, 0.0..1e-3f64, Just(0.0), Just(1.0)], block in 0usize..441, at: u64, near in 0u64..6,
        ) {
            let (map, order) = order(15);
            let n = map.intervals();
            let cut = order.cut(&map, share);
            let ([px, py], end) = cut.strip();
            // Any point, and points next to the end of the strip, which all points are without.
            let places = [(block % n, block / n, at), (px, py, end.wrapping_add(near).wrapping_sub(3))];
            for (x, y, at) in places.into_iter().filter(|(x, y, _)| *x.max(y) < n) {
                let interval = map.interval(x);
                let length = interval.end - interval.start;
                let index = if interval.contains(&at) { at } else { interval.start + at % length };
                let position = order.position(y * n + x);
                let rank = order.rank(position, index - interval.start, length);
                prop_assert!((0.0..1.0).contains(&rank));
                let kept = cut.keeps(position as u32, cut.is_in_strip(x, index));
                prop_assert_eq!(kept, rank < share, "{} {}", rank, share);
                prop_assert!(share < 1.0 || cut.keeps(position as u32, false));
            }
        }

        #[test]
        fn ranks_ascend_along_blocks_and_from_block_to_block(position in 0usize..440, a: u64, b: u64) {
            let (_, order) = order(15);
            let length = 1 << 60;
            let (a, b) = (a % length, b % length);
            let rank = |position, offset| order.rank(position, offset, length);
            prop_assert!(rank(position, a.min(b)) <= rank(position, a.max(b)));
            prop_assert!(rank(position, a) <= rank(position + 1, b));
        }
    }
}
