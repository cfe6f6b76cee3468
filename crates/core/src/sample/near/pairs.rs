//! The pairs of blocks that meet, and the least distances of their points.

use alloc::{vec, vec::Vec};

use crate::{
    map::Map,
    pattern::{Axis, Pattern},
    sort,
    table::{FRACTION_BITS, Labels, Shares, Table},
};

/// √(2/√3): the distance of neighbors in a hexagonal lattice, in mean spacings. No point set keeps a
/// larger least distance.
pub(super) const HEXAGONAL: f64 = 1.074_569_931_823_542;

/// The largest lattice offset of a pair. It suffices for t ≥ 0.017 with the longest displacements;
/// sparser patterns, α below 1.035, guarantee nothing.
const MAX_REACH: i64 = 320;

/// The pairs of blocks of a table, by lattice offset.
struct Pairs<'a> {
    table: &'a Table,
    meetings: Meetings,
    /// The least squared distance of any pair across an offset, and the offset, ascending.
    offsets: Vec<(u64, i64, i64)>,
}

impl<'a> Pairs<'a> {
    /// The pairs that can be up to `most` fixed-point units apart; `None` if they are too far apart in the
    /// lattice.
    fn new(table: &'a Table, most: f64) -> Option<Self> {
        // Displacements differ by the span at most, so only offsets within it and the distance matter.
        let span = table
            .reach()
            .map(|[low, high]| i64::from(high) - i64::from(low));
        let reach = span.map(|s| (s.saturating_add(most as i64) >> FRACTION_BITS) + 1);
        if reach[0].max(reach[1]) > MAX_REACH {
            return None;
        }
        let mut offsets = Vec::new();
        for j in 0..=reach[1] {
            // The other half of the offsets has the same pairs.
            let first = if j == 0 { 1 } else { -reach[0] };
            for i in first..=reach[0] {
                let gap = |v: i64, span: i64| ((v.abs() << FRACTION_BITS) - span).max(0);
                offsets.push((norm(gap(i, span[0]), gap(j, span[1])), i, j));
            }
        }
        // Offsets that can be nearest come first; most of the others are never visited.
        sort::by_key(&mut offsets, |&(nearest, i, j)| {
            (nearest, i * i + j * j, i, j)
        });
        Some(Self {
            table,
            meetings: Meetings::new(table.map(), reach[0].max(reach[1])),
            offsets,
        })
    }

    /// Calls `visit` with the numbers of both blocks and the squared distance of every pair across an offset.
    #[inline]
    fn visit(&self, i: i64, j: i64, mut visit: impl FnMut(usize, usize, u64)) {
        let (vectors, n) = (self.table.displacements(), self.table.map().intervals());
        let (x, y) = (i << FRACTION_BITS, j << FRACTION_BITS);
        let columns = self.meetings.of(i, j);
        for row in self.meetings.of(j, i) {
            let [own, other] = row.map(|row| row as usize * n);
            for column in columns {
                let (a, b) = (own + column[0] as usize, other + column[1] as usize);
                let dx = x + i64::from(vectors[b][0]) - i64::from(vectors[a][0]);
                let dy = y + i64::from(vectors[b][1]) - i64::from(vectors[a][1]);
                visit(a, b, norm(dx, dy));
            }
        }
    }
}

/// The hexagonal distance of a share of a table's points, in fixed-point units.
fn hexagonal(table: &Table, share: f64) -> f64 {
    HEXAGONAL / libm::sqrt(share) / table.alpha().set_side_f64() * f64::from(1u32 << FRACTION_BITS)
}

/// The least squared distance over all pairs of blocks that meet, in fixed-point units.
pub(super) fn least_squared(table: &Table) -> u64 {
    let most = hexagonal(table, 1.0);
    let Some(pairs) = Pairs::new(table, most) else {
        return 0;
    };
    let mut least = (most * most) as u64 + 1;
    for &(nearest, i, j) in &pairs.offsets {
        if nearest >= least {
            break;
        }
        pairs.visit(i, j, |_, _, squared| least = least.min(squared));
    }
    least
}

/// The least squared distances of pairs by the kinds of their points, row by row, in fixed-point units; at most
/// those of a hexagonal lattice of the rarer kind.
pub(super) fn least_of_kinds(table: &Table, shares: &Shares, labels: &Labels) -> Vec<u64> {
    let kinds = shares.kinds();
    let most = |a: usize, b: usize| {
        // Kinds ascend by share.
        let most = hexagonal(table, shares.of(a.min(b) as u8));
        (most * most) as u64 + 1
    };
    let mut least: Vec<u64> = (0..kinds * kinds)
        .map(|i| most(i / kinds, i % kinds))
        .collect();
    let Some(pairs) = Pairs::new(table, hexagonal(table, shares.of(0))) else {
        return vec![0; kinds * kinds];
    };
    let n = table.map().intervals();
    // A split block is of two kinds.
    let mut second = labels.all().to_vec();
    for split in labels.splits() {
        let [x, y] = split.block.map(|v| v as usize);
        second[y * n + x] = split.kinds[1];
    }
    let of = [labels.all(), &second];
    for &(nearest, i, j) in &pairs.offsets {
        let greatest = least.iter().copied().max().unwrap_or(0);
        if nearest >= greatest {
            break;
        }
        pairs.visit(i, j, |a, b, squared| {
            if squared >= greatest {
                return;
            }
            for (a, b) in [(0, 0), (0, 1), (1, 0), (1, 1)].map(|(s, t)| (of[s][a], of[t][b])) {
                for (a, b) in [(a, b), (b, a)] {
                    let least = &mut least[usize::from(a) * kinds + usize::from(b)];
                    *least = squared.min(*least);
                }
            }
        });
    }
    least
}

/// The squared length, for components below 2³⁰.
fn norm(x: i64, y: i64) -> u64 {
    (x * x + y * y) as u64
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
        let pattern = Pattern::new(map.alpha());
        let pairs = (-reach..=reach)
            .flat_map(|own| [(own, 0), (own, 1)])
            .map(|(own, across)| meet(map, pattern.axis_index(Axis::X, own, across)))
            .collect();
        Self { reach, pairs }
    }

    fn of(&self, own: i64, across: i64) -> &[[u32; 2]] {
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
