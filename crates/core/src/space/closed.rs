//! Counts in closed form, whose cost does not grow with the box.
//!
//! The points of one block have one vector, so those inside of a box are the ones at places of a box of the lattice, and
//! their number is a sum of eight products of three counts along the axes. Coordinates far from the ends of the box are
//! inside whatever the vector is: their products need only the totals of each class. The few coordinates near an end,
//! each of which has one interval, are multiplied with everything else one by one, where the vector allows it.

use alloc::{vec, vec::Vec};
use core::{array::from_fn, ops::Range};

use super::{
    lattice::{Lattice, fixed},
    pattern::products,
    scope::{Scope, common},
};
use crate::{
    kernel::{Backend, compiled},
    map::Numbers,
    pattern::AxisSet,
    table::{Cut, FRACTION_BITS},
};

/// The number of points of a box without warp at places of a box of the lattice, which is not empty.
pub(super) fn count(scope: &Scope, ranges: &[Range<i64>; 3]) -> u128 {
    Count::new(&scope.lattice, ranges, Some(&scope.bounds)).all()
}

/// The number of points of a lattice at places of a box, wherever they are displaced to.
pub(super) fn count_all(lattice: &Lattice, ranges: &[Range<i64>; 3]) -> u128 {
    if lattice.cut.is_none() {
        return lattice.pattern.count(ranges.clone());
    }
    Count::new(lattice, ranges, None).all()
}

/// The coordinates of an axis.
struct Axis {
    /// All that may be inside.
    clip: Range<i64>,
    /// The fixed-point coordinates of points, if they matter.
    bounds: Option<Range<i64>>,
    /// The numbers of those that are inside whatever the vector is.
    inner: Numbers,
    /// The others.
    edges: Vec<Edge>,
}

/// A coordinate near an end of the box.
struct Edge {
    own: usize,
    others: usize,
    block: usize,
    /// The displacements with which its points are inside.
    allowed: Range<i32>,
    /// Whether they are inside, by the intervals of the two other axes: those of the later one one after another.
    inside: Vec<bool>,
}

/// A count of blocks.
struct Count<'a> {
    lattice: &'a Lattice,
    axes: [Axis; 3],
}

/// The two other axes, ascending.
const OTHERS: [[usize; 2]; 3] = [[1, 2], [0, 2], [0, 1]];

/// The numbers of coordinates of a range by class and interval.
fn numbers(lattice: &Lattice, axis: usize, range: &Range<i64>) -> Numbers {
    /// Listing this many coordinates for each interval takes as long as closed forms.
    const WORTH: usize = 8;
    let map = lattice.table.map();
    let n = map.intervals();
    if range.end - range.start > (WORTH * n) as i64 {
        return map.numbers(lattice.pattern.axis_index(axis, 0, 0), range);
    }
    let mut numbers = from_fn(|_| from_fn(|_| vec![0; n]));
    for at in range.clone() {
        if let Some(visit) = lattice.pattern.visit(axis, at) {
            let class: &mut [Vec<u64>; 2] = &mut numbers[usize::from(visit.own)];
            class[usize::from(visit.others)][map.locate(visit.index)] += 1;
        }
    }
    numbers
}

impl Axis {
    fn new(lattice: &Lattice, axis: usize, clip: &Range<i64>, bounds: Option<&Range<i64>>) -> Self {
        let mut inner = clip.clone();
        if let Some(bounds) = bounds {
            let [least, most] = lattice.turned.reach[axis].map(i64::from);
            let first = |bound: i64, by: i64| -((by - bound) >> FRACTION_BITS);
            inner.start = first(bounds.start, least).clamp(clip.start, clip.end);
            inner.end = first(bounds.end, most).clamp(inner.start, clip.end);
        }
        let edges = (clip.start..inner.start).chain(inner.end..clip.end);
        let edge = |at| {
            let visit = lattice.pattern.visit(axis, at)?;
            let near =
                |bound: i64| (bound - fixed(at)).clamp(i32::MIN.into(), i32::MAX.into()) as i32;
            Some(Edge {
                own: visit.own.into(),
                others: visit.others.into(),
                block: lattice.table.map().locate(visit.index),
                allowed: bounds.map_or(0..0, |bounds| near(bounds.start)..near(bounds.end)),
                inside: Vec::new(),
            })
        };
        Self {
            clip: clip.clone(),
            bounds: bounds.cloned(),
            edges: edges.filter_map(edge).collect(),
            inner: numbers(lattice, axis, &inner),
        }
    }

    /// The coordinates of an interval, by class, whose points a displacement leaves inside.
    fn of_block(&self, block: usize, by: i32) -> [[u64; 2]; 2] {
        let mut numbers = self
            .inner
            .each_ref()
            .map(|own| own.each_ref().map(|numbers| numbers[block]));
        for edge in self.edges.iter().filter(|edge| edge.block == block) {
            numbers[edge.own][edge.others] += u64::from(edge.allowed.contains(&by));
        }
        numbers
    }

    /// The coordinates whose points a displacement leaves inside.
    fn range(&self, by: i32) -> Range<i64> {
        let Some(bounds) = &self.bounds else {
            return self.clip.clone();
        };
        let first = |bound: i64| -((i64::from(by) - bound) >> FRACTION_BITS);
        common(&(first(bounds.start)..first(bounds.end)), &self.clip)
    }
}

impl Edge {
    /// Finds out which blocks of the edge are inside.
    fn test(&mut self, lattice: &Lattice, axis: usize, columns: &[i32]) {
        let n = lattice.table.map().intervals();
        let vectors = &lattice.turned.vectors;
        self.inside.reserve_exact(n * n);
        for outer in 0..n {
            let (from, first) = match axis {
                0 => (columns, (outer * n + self.block) * n),
                1 => (&vectors[1][..], (outer * n + self.block) * n),
                _ => (&vectors[2][..], (self.block * n + outer) * n),
            };
            let Range { start, end } = self.allowed;
            let is_inside = |&by: &i32| (start <= by) & (by < end);
            self.inside.extend(from[first..][..n].iter().map(is_inside));
        }
        if lattice.cut.is_none() {
            return;
        }
        for (i, inside) in self.inside.iter_mut().enumerate() {
            let (inner, outer) = (i % n, i / n);
            let block = match axis {
                0 => [self.block, inner, outer],
                1 => [inner, self.block, outer],
                _ => [inner, outer, self.block],
            };
            *inside &= lattice.is_whole(lattice.number(block));
        }
    }

    /// Whether blocks along one of the other axes are inside, at an interval of the second other one.
    fn along(&self, block: usize, is_outer: bool) -> impl Iterator<Item = bool> {
        let n = self.inside.len().isqrt();
        let (start, step) = if is_outer { (block, n) } else { (block * n, 1) };
        self.inside[start..].iter().step_by(step).copied()
    }

    /// The number of points of the edge at inner coordinates of the other axes.
    fn count(&self, [inner, outer]: [&Numbers; 2]) -> u128 {
        let n = inner[0][0].len();
        let mut sum = 0;
        for own_inner in 0..2 {
            let own_outer = own_inner ^ self.others;
            let columns = &inner[own_inner][self.own ^ own_outer];
            let rows = &outer[own_outer][self.own ^ own_inner];
            for (inside, &rows) in self.inside.chunks_exact(n).zip(rows) {
                let columns = inside.iter().zip(columns);
                let there: u64 = columns
                    .map(|(&inside, &columns)| u64::from(inside).wrapping_neg() & columns)
                    .sum();
                sum += u128::from(there) * u128::from(rows);
            }
        }
        sum
    }
}

impl<'a> Count<'a> {
    fn new(
        lattice: &'a Lattice,
        ranges: &[Range<i64>; 3],
        bounds: Option<&[Range<i64>; 3]>,
    ) -> Self {
        let mut axes = [0, 1, 2].map(|axis| {
            let bounds = bounds.map(|bounds| &bounds[axis]);
            Axis::new(lattice, axis, &ranges[axis], bounds)
        });
        let columns = lattice.turned.columns(lattice.table.map().intervals());
        compiled(Backend::best(), || {
            for (number, axis) in axes.iter_mut().enumerate() {
                for edge in &mut axis.edges {
                    edge.test(lattice, number, &columns);
                }
            }
        });
        Self { lattice, axes }
    }

    /// The number of all points.
    fn all(&self) -> u128 {
        self.inner() + self.singles() + self.pairs() + self.triples() + self.strip()
    }

    /// The number of points of the whole blocks at inner coordinates.
    fn inner(&self) -> u128 {
        let inner = self.axes.each_ref().map(|axis| &axis.inner);
        let of = |count: &dyn Fn(usize, &[u64]) -> u64| {
            let numbers = from_fn(|axis| {
                from_fn(|own| from_fn(|others| count(axis, &inner[axis][own][others])))
            });
            products(&numbers)
        };
        let Some(cut) = self.lattice.cut else {
            return of(&|_, numbers| numbers.iter().sum());
        };
        let positions = 0..cut.whole as usize;
        let order = &self.lattice.turned.order;
        let blocks = positions.filter_map(|position| order.block_at(position));
        let count = |block| {
            let block = self.lattice.intervals(block);
            of(&|axis, numbers| numbers[block[axis]])
        };
        blocks.map(count).sum()
    }

    /// The number of points with one coordinate near an end.
    fn singles(&self) -> u128 {
        let of_axis = |axis: usize| {
            let others = OTHERS[axis].map(|other| &self.axes[other].inner);
            let edges = &self.axes[axis].edges;
            compiled(Backend::best(), || {
                edges.iter().map(|edge| edge.count(others)).sum::<u128>()
            })
        };
        (0..3).map(of_axis).sum()
    }

    /// The number of points with two coordinates near ends.
    fn pairs(&self) -> u128 {
        let mut sum = 0;
        for (third, [first, second]) in OTHERS.into_iter().enumerate() {
            let inner = &self.axes[third].inner;
            let is_outer = [first, second].map(|axis| OTHERS[axis][1] == third);
            for a in &self.axes[first].edges {
                for b in &self.axes[second].edges {
                    let own = a.others ^ b.own;
                    if own != b.others ^ a.own {
                        continue;
                    }
                    let numbers = &inner[own][a.own ^ b.own];
                    let along = [a.along(b.block, is_outer[0]), b.along(a.block, is_outer[1])];
                    let [a, b] = along;
                    let there = a.zip(b).zip(numbers);
                    let number = |((a, b), number)| u64::from(a & b).wrapping_neg() & number;
                    sum += u128::from(there.map(number).sum::<u64>());
                }
            }
        }
        sum
    }

    /// The number of points with all three coordinates near ends.
    fn triples(&self) -> u128 {
        let n = self.lattice.table.map().intervals();
        let [x, y, z] = self.axes.each_ref().map(|axis| &axis.edges);
        let mut sum = 0;
        for a in x {
            for b in y.iter().filter(|b| a.others ^ b.own == b.others ^ a.own) {
                let (own, others) = (a.others ^ b.own, a.own ^ b.own);
                for c in z.iter().filter(|c| c.own == own && c.others == others) {
                    let is_inside = a.inside[c.block * n + b.block]
                        & b.inside[c.block * n + a.block]
                        & c.inside[b.block * n + a.block];
                    sum += u128::from(is_inside);
                }
            }
        }
        sum
    }

    /// The number of points of the block of which a strip is kept.
    fn strip(&self) -> u128 {
        let Lattice {
            cut, turned, table, ..
        } = self.lattice;
        let partial = |cut: Cut| Some((cut, turned.order.block_at(cut.whole as usize)?));
        let Some((cut, block)) = cut.and_then(partial) else {
            return 0;
        };
        let ([i, j, k], [x, y, z]) = (self.lattice.intervals(block), turned.vector(block));
        let map = table.map();
        let (start, range) = (map.interval(i).start, self.axes[0].range(x));
        let columns = [0u8, 1].map(|own| {
            [0u8, 1].map(|others| {
                let zero = self.lattice.pattern.axis_index(0, 0, others);
                AxisSet::new(map.alpha(), zero, own, start..cut.strip_end).count(range.clone())
            })
        });
        products(&[
            columns,
            self.axes[1].of_block(j, y),
            self.axes[2].of_block(k, z),
        ])
    }
}
