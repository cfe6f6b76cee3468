//! The ground of a table: which blocks meet across which lattice offsets, and how often.
//!
//! A neighbor at offset (i, j) has its index shifted by a = (αi + j)/2 along X and (αj + i)/2 along
//! Y. So interval u of one point meets interval v of the other on the part of u that the shift
//! carries into v: an overlap of two partitions of [0, t), one of them shifted. The frequency of a
//! pair of *blocks* is the product of the overlaps along the two axes. So no point set is needed. Of a fraction, the
//! ground has the pairs of its periodic twin *of any size*.

use strew_core::{Map, Pattern, Table, table::to_grid_units};

/// A neighbor of a block: an instance of block `to` at lattice offset (i, j).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pair {
    pub(crate) to: u32,
    pub(crate) i: i16,
    pub(crate) j: i16,
    /// The mean number of such neighbors of an instance of the block.
    pub(crate) weight: f32,
}

/// The exact pair frequencies of a map. Lengths are in mean spacings of the full set.
pub(crate) struct Ground {
    /// Intervals along an axis.
    n: usize,
    /// Mean spacings per grid unit.
    pub(crate) scale: f64,
    /// The side of the set region, as a part of the torus.
    side: f64,
    /// For each parity of the other offset, parity of the own offset and interval: the intervals met,
    /// by own offset.
    meetings: Vec<Vec<Meeting>>,
    /// The length of each interval, as a fraction of the torus.
    lengths: Vec<f64>,
    /// The share of all points that each block has.
    pub(crate) shares: Vec<f64>,
}

/// An interval met along one axis.
#[derive(Clone, Copy)]
struct Meeting {
    offset: i16,
    to: u16,
    length: f64,
}

/// Two blocks that meet across the lattice offset (i, j).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Meet {
    pub(crate) to: u32,
    pub(crate) i: i16,
    pub(crate) j: i16,
    /// The area of index space where they do, as a part of the torus. It has the same bits seen from either
    /// block.
    pub(crate) area: f64,
}

impl Ground {
    /// The frequencies of pairs up to `reach` mean spacings apart in the pattern.
    pub(crate) fn new(map: &Map, reach: f64) -> Self {
        Self::scaled(map, reach, map.alpha().set_side_f64())
    }

    /// The same in mean spacings of another pattern, of which `scale` make a grid unit.
    pub(super) fn scaled(map: &Map, reach: f64, scale: f64) -> Self {
        let (n, side) = (map.intervals(), map.alpha().set_side_f64());
        let reach = (reach / scale) as i64 + 1;
        let mut meetings = vec![Vec::new(); 4 * n];
        for own in -reach..=reach {
            for other in 0..2 {
                for overlap in overlaps(map, own, other) {
                    meetings[slot(other, own) * n + overlap.from].push(Meeting {
                        offset: own as i16,
                        to: overlap.to as u16,
                        length: overlap.length,
                    });
                }
            }
        }
        let lengths: Vec<f64> = (0..n).map(|i| length(map, i)).collect();
        let share = |b: usize| lengths[b % n] / side * (lengths[b / n] / side);
        Self {
            n,
            scale,
            side,
            meetings,
            shares: (0..n * n).map(share).collect(),
            lengths,
        }
    }

    /// The area of a block in index space, as a part of the torus.
    pub(super) fn area(&self, block: usize) -> f64 {
        self.lengths[block % self.n] * self.lengths[block / self.n]
    }

    /// The mean number of neighbors that an instance of a block has by a meeting.
    pub(crate) fn weight(&self, block: usize, meet: &Meet) -> f32 {
        (meet.area / (self.shares[block] * self.side * self.side)) as f32
    }

    /// Calls `visit` with every meeting of a block with points less than `range` away, and the squared distance. Points are
    /// moved, by `longest` at most. `alive` says which blocks count.
    pub(crate) fn near(
        &self,
        block: usize,
        (moves, longest): (&[[f64; 2]], f64),
        range: f64,
        alive: impl Fn(usize) -> bool,
        mut visit: impl FnMut(Meet, f64),
    ) {
        let own = moves[block];
        self.meets(block, range + 2.0 * longest, alive, |meet| {
            let to = moves[meet.to as usize];
            let x = self.scale * f64::from(meet.i) + to[0] - own[0];
            let y = self.scale * f64::from(meet.j) + to[1] - own[1];
            let squared = x * x + y * y;
            if squared < range * range {
                visit(meet, squared);
            }
        });
    }

    /// Calls `visit` with every meeting of a block within `reach` mean spacings along each axis of the
    /// pattern. `alive` says which blocks count.
    pub(crate) fn meets(
        &self,
        block: usize,
        reach: f64,
        alive: impl Fn(usize) -> bool,
        mut visit: impl FnMut(Meet),
    ) {
        let n = self.n;
        let (bx, by) = (block % n, block / n);
        let most = (reach / self.scale) as i16 + 1;
        let within = |list: &'_ [Meeting]| {
            let start = list.partition_point(|m| m.offset < -most);
            start..list.partition_point(|m| m.offset <= most)
        };
        for (i_parity, j_parity) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            let columns = &self.meetings[slot(j_parity, i_parity) * n + bx];
            let rows = &self.meetings[slot(i_parity, j_parity) * n + by];
            let columns = &columns[within(columns)];
            for row in &rows[within(rows)] {
                for column in columns {
                    let to = row.to as usize * n + column.to as usize;
                    if alive(to) && (column.offset, row.offset) != (0, 0) {
                        visit(Meet {
                            to: to as u32,
                            i: column.offset,
                            j: row.offset,
                            area: column.length * row.length,
                        });
                    }
                }
            }
        }
    }
}

/// The place of two parities in [`Ground::meetings`].
const fn slot(other: i64, own: i64) -> usize {
    ((other & 1) * 2 + (own & 1)) as usize
}

/// The vectors of a table, in mean spacings.
pub(crate) fn moves_of(table: &Table) -> Vec<[f64; 2]> {
    let scale = table.alpha().set_side_f64();
    let vectors = table.displacements().iter();
    vectors
        .map(|v| v.map(|c| to_grid_units(c) * scale))
        .collect()
}

/// Overlaps shorter than this, 2⁻⁴⁰ of the torus, are dropped: they are rounding errors between
/// thresholds of a fraction that coincide.
const ROUNDING: u64 = 1 << 24;

/// The unit of indices, 2⁻⁶⁴ of the torus.
const UNIT: f64 = 1.0 / 18_446_744_073_709_551_616.0;

/// The part of an interval that an offset carries into another interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Overlap {
    pub(crate) from: usize,
    /// The other interval, which is the neighbor's.
    pub(crate) to: usize,
    /// Its length, as a fraction of the torus.
    pub(crate) length: f64,
}

/// The length of an interval, as a fraction of the torus.
pub(crate) fn length(map: &Map, interval: usize) -> f64 {
    let interval = map.interval(interval);
    (interval.end - interval.start) as f64 * UNIT
}

/// The overlaps of a map along an axis at the offset `own` along it and, across it, an offset of the parity of `other`,
/// interval by interval. They serve both axes: the shift of X by (i, j) is that of Y by (j, i).
pub(crate) fn overlaps(map: &Map, own: i64, other: i64) -> Vec<Overlap> {
    let shift = Pattern::new(map.alpha()).index(own, other & 1).0 as i64;
    let side = i128::from(map.alpha().set_side());
    let mut all = Vec::new();
    for from in 0..map.intervals() {
        let interval = map.interval(from);
        // The shifted interval, cut to the set region. In i128 nothing overflows.
        let mut at = (i128::from(interval.start) + i128::from(shift)).max(0);
        let end = (i128::from(interval.end) + i128::from(shift)).min(side);
        while at < end {
            let Some(to) = map.interval_of(at as u64) else {
                break;
            };
            let next = i128::from(map.interval(to).end).min(end);
            let length = (next - at) as u64;
            if length > ROUNDING {
                let length = length as f64 * UNIT;
                all.push(Overlap { from, to, length });
            }
            at = next;
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use strew_core::{Pattern, pattern::Arrangement};

    use super::*;

    #[test]
    fn overlaps_add_up_to_the_frequency_of_the_offset() {
        let map = Map::new("sqrt(3)".parse().expect("valid"), 20).expect("small");
        let side = map.alpha().set_side_f64();
        let along = |own: i64, other: i64| -> f64 {
            let all = overlaps(&map, own, other);
            all.iter().map(|overlap| overlap.length / side).sum()
        };
        for j in -12..=12 {
            for i in -12..=12 {
                let found = along(i, j) * along(j, i);
                let pair = Arrangement::new(Pattern::new(map.alpha()), &[(i, j)]);
                let expected = pair.expect("small").frequency();
                assert!(
                    (found - expected).abs() < 1e-9,
                    "({i}, {j}): {found} {expected}"
                );
            }
        }
    }
}
