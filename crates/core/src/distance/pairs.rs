//! The pairs of blocks that meet, in the plane or in space, and the least distances of their points.

use alloc::{vec, vec::Vec};
use core::array::from_fn;

use crate::{
    map::Map,
    sort,
    table::{FRACTION_BITS, Labels, Shares, Table},
};

/// The distance of neighbors in the densest packing of the plane or of space, in mean spacings: √(2/√3) in a hexagonal
/// lattice, 2^(1/6) in space. No point set keeps a larger least distance.
pub(super) const fn densest(dimensions: usize) -> f64 {
    match dimensions {
        2 => 1.074_569_931_823_542,
        _ => 1.122_462_048_309_373,
    }
}

/// The largest lattice offset of a pair. It suffices for t ≥ 0.017 with the longest displacements;
/// sparser patterns, α below 1.035, guarantee nothing.
const MAX_REACH: i64 = 320;

/// The least and the greatest component of some vectors along each axis.
type Spans<const D: usize> = [[i64; 2]; D];

/// The pairs of blocks of a table, by lattice offset.
struct Pairs<'a, const D: usize> {
    map: &'a Map,
    /// The vector of each block, in fixed-point units.
    vectors: &'a [[i32; D]],
    meetings: Meetings,
    /// The spans of the blocks that differ in the interval of dX only.
    rows: Vec<Spans<D>>,
    /// A bound of the squared distance of any pair across an offset, and the offset, ascending.
    offsets: Vec<(u64, [i64; D])>,
}

impl<'a, const D: usize> Pairs<'a, D> {
    /// The pairs that can be up to `most` fixed-point units apart; `None` if they are too far apart in the
    /// lattice.
    fn new(map: &'a Map, vectors: &'a [[i32; D]], most: f64) -> Option<Self> {
        let all = spans(vectors);
        // Displacements differ by the span at most, so only offsets within it and the distance matter.
        let reach = all.map(|[low, high]| {
            let span = high - low;
            (span.saturating_add(most as i64) >> FRACTION_BITS) + 1
        });
        let farthest = reach.into_iter().max().unwrap_or(0);
        if farthest > MAX_REACH {
            return None;
        }
        let sides = reach.map(|reach| 2 * reach + 1);
        let count = sides.iter().product::<i64>();
        // The other half of the offsets has the same pairs.
        let offsets = (count / 2 + 1..count).map(|mut number| {
            let offset = from_fn(|axis| {
                let place = number % sides[axis];
                number /= sides[axis];
                place - reach[axis]
            });
            (apart(&offset, [&all, &all]), offset)
        });
        let mut offsets: Vec<_> = offsets
            .filter(|(nearest, _)| *nearest as f64 <= most * most)
            .collect();
        // Offsets that can be nearest come first; most of the others are never visited.
        sort::by_key(&mut offsets, |&(nearest, offset)| {
            (nearest, offset.map(|v| v * v).iter().sum::<i64>(), offset)
        });
        Some(Self {
            map,
            vectors,
            meetings: Meetings::new(map, farthest),
            rows: vectors.chunks(map.intervals()).map(spans).collect(),
            offsets,
        })
    }

    /// Folds a bound with the pairs across an offset, by the numbers of both blocks and their squared distance. Rows of
    /// blocks none of which is nearer than the bound are left out.
    #[inline]
    fn fold(
        &self,
        offset: &[i64; D],
        mut bound: u64,
        fold: &mut impl FnMut(u64, [usize; 2], u64) -> u64,
    ) -> u64 {
        let n = self.map.intervals();
        let columns = self.meetings.across(offset, 0);
        self.rows(offset, D - 1, [0, 0], &mut |rows| {
            if apart(offset, rows.map(|row| &self.rows[row])) >= bound {
                return;
            }
            bound = columns.iter().fold(bound, |bound, column| {
                let [a, b] = [0, 1].map(|i| rows[i] * n + column[i] as usize);
                let by = |block: usize, axis: usize| i64::from(self.vectors[block][axis]);
                let squared = (0..D).map(|axis| {
                    let d = (offset[axis] << FRACTION_BITS) + by(b, axis) - by(a, axis);
                    d * d
                });
                fold(bound, [a, b], squared.sum::<i64>() as u64)
            });
        });
        bound
    }

    /// Calls `found` with the pairs of rows of blocks that meet across an offset: those of pairs of planes, and so on, that
    /// meet along the axes from `axis` down to 1.
    fn rows(
        &self,
        offset: &[i64; D],
        axis: usize,
        pair: [usize; 2],
        found: &mut impl FnMut([usize; 2]),
    ) {
        if axis == 0 {
            return found(pair);
        }
        for meeting in self.meetings.across(offset, axis) {
            let inner = [0, 1].map(|i| pair[i] * self.map.intervals() + meeting[i] as usize);
            self.rows(offset, axis - 1, inner, found);
        }
    }
}

/// The least and the greatest component of some vectors along each axis.
fn spans<const D: usize>(vectors: &[[i32; D]]) -> Spans<D> {
    let mut ends = [[i64::MAX, i64::MIN]; D];
    for vector in vectors {
        for ([least, most], &v) in ends.iter_mut().zip(vector) {
            *least = (*least).min(v.into());
            *most = (*most).max(v.into());
        }
    }
    ends
}

/// The squared distance of blocks of some spans across an offset, at least.
fn apart<const D: usize>(offset: &[i64; D], [a, b]: [&Spans<D>; 2]) -> u64 {
    let along = |axis: usize| {
        let at = offset[axis] << FRACTION_BITS;
        let [low, high] = [at + b[axis][0] - a[axis][1], at + b[axis][1] - a[axis][0]];
        low.max(-high).max(0)
    };
    (0..D).map(|axis| along(axis) * along(axis)).sum::<i64>() as u64
}

/// The greatest distance that a share of a table's points may keep, in fixed-point units.
fn greatest(map: &Map, dimensions: usize, share: f64) -> f64 {
    densest(dimensions) / libm::sqrt(share) / map.alpha().set_side_f64()
        * f64::from(1u32 << FRACTION_BITS)
}

/// The least squared distance over all pairs of blocks that meet, in fixed-point units; their vectors are, too.
pub(super) fn least_squared<const D: usize>(map: &Map, vectors: &[[i32; D]]) -> u64 {
    let most = greatest(map, D, 1.0);
    let Some(pairs) = Pairs::new(map, vectors, most) else {
        return 0;
    };
    let mut least = (most * most) as u64 + 1;
    for (nearest, offset) in &pairs.offsets {
        if *nearest >= least {
            break;
        }
        least = pairs.fold(offset, least, &mut |least, _, squared| least.min(squared));
    }
    least
}

/// The least squared distances of pairs by the kinds of their points, row by row, in fixed-point units; at most
/// those of a hexagonal lattice of the rarer kind.
pub(super) fn least_of_kinds(table: &Table, shares: &Shares, labels: &Labels) -> Vec<u64> {
    let (map, kinds) = (table.map(), shares.kinds());
    let most = |a: usize, b: usize| {
        // Kinds ascend by share.
        let most = greatest(map, 2, shares.of(a.min(b) as u8));
        (most * most) as u64 + 1
    };
    let mut least: Vec<u64> = (0..kinds * kinds)
        .map(|i| most(i / kinds, i % kinds))
        .collect();
    let rarest = greatest(map, 2, shares.of(0));
    let Some(pairs) = Pairs::new(map, table.displacements(), rarest) else {
        return vec![0; kinds * kinds];
    };
    let n = map.intervals();
    // A split block is of two kinds.
    let mut second = labels.all().to_vec();
    for split in labels.splits() {
        let [x, y] = split.block.map(|v| v as usize);
        second[y * n + x] = split.kinds[1];
    }
    let of = [labels.all(), &second];
    for (nearest, offset) in &pairs.offsets {
        let greatest = least.iter().copied().max().unwrap_or(0);
        if *nearest >= greatest {
            break;
        }
        pairs.fold(offset, greatest, &mut |greatest, [a, b], squared| {
            if squared >= greatest {
                return greatest;
            }
            for (a, b) in [(0, 0), (0, 1), (1, 0), (1, 1)].map(|(s, t)| (of[s][a], of[t][b])) {
                for (a, b) in [(a, b), (b, a)] {
                    let least = &mut least[usize::from(a) * kinds + usize::from(b)];
                    *least = squared.min(*least);
                }
            }
            greatest
        });
    }
    least
}

/// The pairs of intervals (own, neighbor's) that meet across an offset, along one axis. The axes are
/// alike: (i, j) shifts dX as (j, i) shifts dY.
struct Meetings {
    reach: i64,
    /// By offset along the axis, then by parity of the offset across it.
    pairs: Vec<Vec<[u32; 2]>>,
}

impl Meetings {
    fn new(map: &Map, reach: i64) -> Self {
        let shift = |own: i64, across: u64| {
            let along = map.alpha().half().wrapping_mul(own as u64);
            along.wrapping_add(across << 63)
        };
        let pairs = (-reach..=reach)
            .flat_map(|own| [(own, 0), (own, 1)])
            .map(|(own, across)| meet(map, shift(own, across)))
            .collect();
        Self { reach, pairs }
    }

    /// The pairs along an axis across an offset.
    fn across<const D: usize>(&self, offset: &[i64; D], axis: usize) -> &[[u32; 2]] {
        let own = offset[axis];
        let across = offset.iter().sum::<i64>() - own;
        &self.pairs[(own + self.reach) as usize * 2 + (across & 1) as usize]
    }
}

/// The pairs of intervals of which a shift carries at least one unit of the first into the second.
fn meet(map: &Map, shift: u64) -> Vec<[u32; 2]> {
    let side = i128::from(map.alpha().set_side());
    // The circle is longer than twice the set region, so only one representative of the shift counts.
    let shift = i128::from(shift as i64);
    let mut pairs = Vec::new();
    for from in 0..map.intervals() {
        let own = map.interval(from);
        let mut at = (i128::from(own.start) + shift).max(0);
        let end = (i128::from(own.end) + shift).min(side);
        while at < end {
            let to = map.locate(at as u64);
            pairs.push([from as u32, to as u32]);
            at = i128::from(map.interval(to).end);
        }
    }
    pairs
}
