//! The symmetries of the square, and the copies of a table that are turned by them.
//!
//! The thresholds of a map are symmetric: a neighbor shift s and its opposite mirror each other about the
//! middle of the set region. Reflecting the plane along an axis therefore reverses the order of the blocks of
//! that axis, reflecting it about the diagonal swaps the axes of the blocks, and a table turned with them
//! makes the reflected point set: the pattern is the same one with another origin. The order in which blocks
//! leave and the kinds of points turn alike. Only the strips of blocks that are partly kept, or that have two
//! kinds, run along dX in every turned table.

use alloc::{sync::Arc, vec::Vec};

use super::{Displacement, Labels, Mix, Order};
use crate::{map::Map, once::Once};

/// A symmetry of the square: an exchange of the axes, if any, and then reflections along x and y.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Symmetry {
    is_swapped: bool,
    is_reversed: [bool; 2],
}

/// The number of symmetries.
const ALL: usize = 8;

impl Symmetry {
    /// The symmetry of three bits: the lowest reverses x, the next y, the highest exchanges the axes.
    pub(crate) const fn from_bits(bits: u64) -> Self {
        Self {
            is_swapped: bits & 4 != 0,
            is_reversed: [bits & 1 != 0, bits & 2 != 0],
        }
    }

    const fn number(self) -> usize {
        let [x, y] = self.is_reversed;
        x as usize | (y as usize) << 1 | (self.is_swapped as usize) << 2
    }

    /// The column and row of a map of `n` intervals whose entry a turned table has at a column and row.
    pub(crate) fn source(self, n: usize, block: [usize; 2]) -> [usize; 2] {
        let [x, y] = [0, 1].map(|i| match self.is_reversed[i] {
            true => n - 1 - block[i],
            false => block[i],
        });
        if self.is_swapped { [y, x] } else { [x, y] }
    }

    /// A vector of the table, turned.
    #[inline(always)]
    pub(super) fn turn(self, [x, y]: Displacement) -> Displacement {
        let [x, y] = if self.is_swapped { [y, x] } else { [x, y] };
        let signed = |v: i32, is_reversed: bool| if is_reversed { -v } else { v };
        [
            signed(x, self.is_reversed[0]),
            signed(y, self.is_reversed[1]),
        ]
    }
}

/// The entries of a table for each block, turned.
#[derive(Debug)]
pub(super) struct Turned {
    pub(super) vectors: Vec<Displacement>,
    pub(super) order: Order,
    pub(super) labels: Option<Labels>,
}

/// The entries of a table before they are turned.
#[derive(Clone, Copy)]
pub(super) struct Upright<'a> {
    pub(super) map: &'a Map,
    pub(super) vectors: &'a [Displacement],
    pub(super) order: &'a Order,
    pub(super) mix: Option<&'a Mix>,
}

impl Turned {
    fn new(symmetry: Symmetry, upright: Upright<'_>) -> Self {
        let Upright {
            map,
            vectors,
            order,
            mix,
        } = upright;
        let n = map.intervals();
        let source = |block: usize| {
            let [x, y] = symmetry.source(n, [block % n, block / n]);
            y * n + x
        };
        let vector = |block| symmetry.turn(vectors[source(block)]);
        Self {
            vectors: (0..n * n).map(vector).collect(),
            order: order.turned(source),
            labels: mix.map(|mix| Labels::new(map, mix, source)),
        }
    }
}

/// The turned copies of a table, made when they are first needed.
#[derive(Debug)]
pub(super) struct TurnedCopies([Once<Arc<Turned>>; ALL]);

impl TurnedCopies {
    /// The number of copies that a table may come to hold.
    pub(super) const MOST: usize = ALL - 1;

    pub(super) const fn new() -> Self {
        Self([const { Once::new() }; ALL])
    }

    /// The copy for a symmetry; `None` for the table as it is.
    pub(super) fn get(&self, symmetry: Symmetry, upright: Upright<'_>) -> Option<Arc<Turned>> {
        let make = || Arc::new(Turned::new(symmetry, upright));
        (symmetry != Symmetry::default()).then(|| self.0[symmetry.number()].get_or(make))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::Map;

    #[test]
    fn maps_are_symmetric() {
        for (alpha, radius) in [
            ("(5-sqrt(3))/2", 49),
            ("sqrt(3)", 20),
            ("(1+sqrt(5))/2", 100),
        ] {
            let map = Map::new(alpha.parse().expect("valid"), radius).expect("small");
            let (side, n) = (map.alpha().set_side(), map.intervals());
            for i in 0..n {
                let (own, mirrored) = (map.interval(i), map.interval(n - 1 - i));
                assert_eq!(own.start, side - mirrored.end);
            }
        }
    }

    #[test]
    fn symmetries_are_a_group_of_eight() {
        let all: Vec<_> = (0..8).map(Symmetry::from_bits).collect();
        let images = |s: &Symmetry| [[3, 1], [1, 0]].map(|v| s.turn(v));
        for (i, a) in all.iter().enumerate() {
            assert_eq!(a.number(), i);
            assert!(all[..i].iter().all(|b| images(a) != images(b)));
            // Turning a place and turning its block agree.
            let [x, y] = a.source(5, [3, 1]).map(|v| v as i32 - 2);
            assert_eq!(a.turn([x, y]), [1, -1]);
        }
    }
}
