//! The addresses of a period that have points, and points of it that settle, across its seam as well.
//!
//! The settler sees the torus as a plane that repeats: addresses and places do not wrap, so a copy of a point is a point
//! of its own, which goes where all others go. A field repeats as well. Points settle in strips of rows, as wide as the
//! period; where they end does not depend on the strips.

use alloc::{sync::Arc, vec::Vec};
use core::ops::Range;

use super::PeriodicSet;
use crate::{
    field::Field,
    kernel::Backend,
    lattice::{BAND_WIDTH, Found, Grade, PATCH_HEIGHT, PointId, Settle},
    settle::{Box2, List, Placed, Settler, Settling},
    shape::Region,
    table::{FRACTION_BITS, Mix, fixed},
};

/// Strips have so many rows, and at most about so many addresses.
const LEAST_ROWS: u64 = 16;
const MOST_ROWS: u64 = 256;
const ADDRESSES: u64 = 1 << 22;

/// The settled points of some rows of a period.
#[derive(Clone, Debug)]
pub(super) struct Strip {
    settler: Settler<Torus>,
    /// [`Torus::reach`].
    reach: [[i64; 2]; 2],
    rows: Range<u64>,
    /// Strips end here.
    end: u64,
    /// Addresses as row and column, ascending, and where their points are in [0, L)².
    points: Vec<([u64; 2], [f64; 2])>,
}

impl Strip {
    /// None of the rows of a set up to an end yet; `None` if its points do not settle.
    pub(super) fn new(set: &PeriodicSet, end: u64) -> Option<Self> {
        let settle = set.parts.settling()?;
        let grade = set.parts.grade(set.side);
        let torus = Torus::new(set);
        Some(Self {
            reach: torus.reach(),
            settler: Settler::of(torus, grade, settle),
            rows: 0..0,
            end,
            points: Vec::new(),
        })
    }

    /// Where a point of an address before the end has settled.
    pub(super) fn place(&mut self, set: &PeriodicSet, [x, y]: [u64; 2]) -> [f64; 2] {
        if !self.rows.contains(&y) {
            self.settle(set, y..self.end);
        }
        let found = self.points.binary_search_by_key(&[y, x], |&(at, _)| at);
        found.map_or([0.0; 2], |i| self.points[i].1)
    }

    /// Where the point of an address has settled that was placed somewhere, without its row.
    pub(super) fn one(&mut self, set: &PeriodicSet, id: PointId, place: [i64; 2]) -> [f64; 2] {
        let mut wants = |placed: &Placed| PointId::of(placed.address) == id;
        let settled = self.settler.settled(place.map(i128::from), &mut wants);
        set.wrapped(settled.map_or(place, |settled| settled.map(|k| k as i64)))
    }

    /// Settles some of the next rows: few at first.
    fn settle(&mut self, set: &PeriodicSet, rows: Range<u64>) {
        let period = set.twin.period();
        let most = (ADDRESSES / period).clamp(LEAST_ROWS, MOST_ROWS);
        let next = 2 * (self.rows.end - self.rows.start);
        self.rows = rows.start..rows.end.min(rows.start + next.clamp(LEAST_ROWS, most));
        self.points.clear();
        let reach = self.reach.map(|ends| ends.map(i128::from));
        let around = |start: u64, end: u64, axis: usize| {
            let [least, most] = reach[axis];
            fixed(start as i64) + least..fixed(end as i64) + most
        };
        for start in (0..period).step_by(BAND_WIDTH as usize) {
            let columns = start..period.min(start + BAND_WIDTH as u64);
            let within = [
                around(columns.start, columns.end, 0),
                around(self.rows.start, self.rows.end, 1),
            ];
            let wanted = |address: [i64; 2]| match address.map(|v| u64::try_from(v).ok()) {
                [Some(x), Some(y)] if columns.contains(&x) && self.rows.contains(&y) => {
                    Some([y, x])
                }
                _ => None,
            };
            let points = &mut self.points;
            self.settler.settle(
                &within,
                &mut |placed| wanted(placed.address).is_some(),
                &mut |settled| {
                    let at = settled.place.map(|k| k as i64);
                    points.extend(wanted(settled.address).map(|id| (id, set.wrapped(at))));
                },
            );
        }
        self.points.sort_unstable_by_key(|&(at, _)| at);
    }
}

/// A periodic set, as the settler sees it.
#[derive(Clone, Debug)]
struct Torus {
    set: PeriodicSet,
    found: Vec<Found>,
    shares: Vec<f64>,
}

impl Torus {
    fn new(set: &PeriodicSet) -> Self {
        Self {
            set: set.clone(),
            found: Vec::new(),
            shares: Vec::new(),
        }
    }

    /// The least and the greatest distance of places from their addresses along each axis, in fixed-point units.
    fn reach(&self) -> [[i64; 2]; 2] {
        let made = &self.set.made;
        let drift = made.shears.as_ref().map_or(0, |shears| shears.most());
        let reach = made.turned.reach();
        reach.map(|[least, most]| [i64::from(least) - drift, i64::from(most) + drift + 1])
    }

    /// The part of the points between two addresses that a row has, as unwrapped columns and their indices.
    fn columns(&self, y: i64, all: Range<i64>) -> impl Iterator<Item = (i64, [u64; 2])> + '_ {
        let period = self.set.twin.period() as i64;
        let row = y.rem_euclid(period) as u64;
        let found = self.set.row(row).into_iter();
        found.flat_map(move |(parity, index_y)| {
            let columns = self.set.columns(row, parity);
            let copies = all.start.div_euclid(period)..=(all.end - 1).div_euclid(period);
            let all = all.clone();
            copies.flat_map(move |copy| {
                let from = copy * period;
                let before = |end: i64| columns.partition_point(|&(x, _)| (x as i64) < end - from);
                let own = &columns[before(all.start)..before(all.end)];
                own.iter()
                    .map(move |&(x, index_x)| (x as i64 + from, [index_x, index_y]))
            })
        })
    }
}

impl Settling<2> for Torus {
    type Found = Found;

    fn mix(&self) -> Option<&Mix> {
        self.set.table.mix()
    }

    fn kind_of(&self, address: [i64; 2]) -> Option<u8> {
        let period = self.set.twin.period() as i64;
        let [x, y] = address.map(|v| v.rem_euclid(period));
        self.set.kind_of(PointId { x, y })
    }

    fn side(&self) -> f64 {
        self.set.twin.t() as f64 / self.set.twin.period() as f64
    }

    fn spacing(&self) -> f64 {
        self.set.spacing()
    }

    fn step(&self) -> f64 {
        self.set.step()
    }

    fn certified(&self) -> f64 {
        let table = &self.set.table;
        let relative = table.least_distance().with_warp(self.set.strength());
        relative * f64::from(1u32 << FRACTION_BITS) / table.alpha().set_side_f64()
    }

    fn looked_at(&self, place: [i128; 2]) -> [f64; 2] {
        self.set.wrapped(place.map(|k| k as i64))
    }

    fn list(
        &mut self,
        within: &Box2,
        corner: [i128; 2],
        (grade, _): (&Grade, Backend),
        visit: &mut dyn FnMut(List<'_, Found, 2>),
    ) {
        let reach = self.reach();
        let [columns, rows] = [0, 1].map(|i| {
            let [least, most] = reach[i].map(i128::from);
            let floor = |k: i128| (k >> FRACTION_BITS) as i64;
            floor(within[i].start - most)..floor(within[i].end - least) + 1
        });
        let mut found = core::mem::take(&mut self.found);
        let mut shares = core::mem::take(&mut self.shares);
        for bottom in rows.clone().step_by(PATCH_HEIGHT as usize) {
            for left in columns.clone().step_by(BAND_WIDTH as usize) {
                found.clear();
                shares.clear();
                let address = [left, bottom];
                let patch = left..columns.end.min(left + BAND_WIDTH);
                for y in bottom..rows.end.min(bottom + PATCH_HEIGHT) {
                    for (x, index) in self.columns(y, patch.clone()) {
                        let rank = self.set.rank_at(index);
                        if grade.known().is_some_and(|share| rank >= share) {
                            continue;
                        }
                        let place = self.set.moved([x, y], self.set.vector(index));
                        let is_inside = |i: usize| within[i].contains(&i128::from(place[i]));
                        let share = grade.share(self.set.wrapped(place));
                        if is_inside(0) && is_inside(1) && rank < share {
                            let place =
                                [0, 1].map(|i| (place[i] - (address[i] << FRACTION_BITS)) as i32);
                            found.push(Found::new(place, [x - left, y - bottom]));
                            shares.push(share);
                        }
                    }
                }
                visit(List {
                    found: &found,
                    shares: &shares,
                    address,
                    origin: [0, 1].map(|i| (fixed(address[i]) - corner[i]) as i64),
                });
            }
        }
        (self.found, self.shares) = (found, shares);
    }
}

/// A field whose part in [0, L)² repeats.
pub(super) struct Repeated {
    pub(super) field: Grade,
    pub(super) side: f64,
}

impl Repeated {
    /// A coordinate in [0, L], as of `rem_euclid`, which is only in std.
    fn wrapped(&self, v: f64) -> f64 {
        let rest = v % self.side;
        if rest < 0.0 { rest + self.side } else { rest }
    }

    /// The parts of a box in [0, L)², and whether it is one part, without a seam.
    fn parts(&self, within: &Region) -> (Vec<Region>, bool) {
        let along = |i: usize| {
            let (min, max) = (within.min()[i], within.max()[i]);
            let start = self.wrapped(min);
            let end = start + (max - min);
            match (end - start >= self.side, end > self.side) {
                (true, _) => alloc::vec![[0.0, self.side]],
                (_, true) => alloc::vec![[start, self.side], [0.0, end - self.side]],
                _ => alloc::vec![[start, end]],
            }
        };
        let [xs, ys] = [along(0), along(1)];
        // With room for what rounds.
        let room = (within.min().map(f64::abs).into_iter())
            .chain(within.max().map(f64::abs))
            .fold(self.side, f64::max)
            * 1e-14;
        let parts = xs.iter().flat_map(|x| {
            let of = move |y: &[f64; 2]| {
                Region::between([x[0] - room, y[0] - room], [x[1] + room, y[1] + room])
            };
            ys.iter().map(of)
        });
        (parts.collect(), xs.len() * ys.len() == 1)
    }
}

impl Field for Repeated {
    fn share(&self, at: [f64; 2]) -> f64 {
        // What is a little below 0 rounds to L.
        let wrapped = at.map(|v| self.wrapped(v));
        self.field
            .share(wrapped.map(|v| if v < self.side { v } else { 0.0 }))
    }

    fn bounds(&self, within: &Region) -> [f64; 2] {
        let (parts, _) = self.parts(within);
        let bounds = parts.iter().map(|part| self.field.bounds(part));
        bounds.fold([1.0, 0.0], |[low, high], [a, b]| [a.min(low), b.max(high)])
    }

    fn slopes(&self, within: &Region) -> [f64; 2] {
        match self.parts(within) {
            (parts, true) => self.field.slopes(&parts[0]),
            _ => [f64::INFINITY; 2],
        }
    }
}

impl super::Parts {
    /// The steps by which points settle, if they do.
    pub(super) fn settling(&self) -> Option<Settle> {
        match self.field {
            Some(_) => Some(self.settle).filter(|settle| !settle.is_off()),
            None => self.settle.of_share(self.keep.get()),
        }
    }

    /// The shares of all points that settle, on a torus of a side.
    fn grade(&self, side: f64) -> Grade {
        let share = self.keep.get();
        match self.field.clone() {
            Some(field) => Grade::new(Arc::new(Repeated { field, side }), share),
            None => Grade::constant(share),
        }
    }
}
