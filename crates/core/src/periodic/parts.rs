//! Parts of a period: the points of a share, of a kind, or in a field.
//!
//! These points are defined as in the plane. A field is looked at in the period alone, so what tiles is its part in
//! [0, L)².

use alloc::{sync::Arc, vec, vec::Vec};

use super::PeriodicSet;
use crate::{
    LeastDistance,
    attribute::{Attributes, BoundAttributes, Indices},
    error::Error,
    field::Field,
    lattice::{Grade, Keep, Placement, Point, PointId, Settle, Spacing, check_kind},
    stop::Stop,
    table::{Displacement, FRACTION_BITS},
    warp::Warp,
};

impl PeriodicSet {
    /// The points of a share of the lowest [ranks](Self::rank), as in [`PointSet::keep`](crate::PointSet::keep).
    ///
    /// # Errors
    /// As [`Keep::new`].
    ///
    /// ```
    /// use strew_core::{PeriodicSet, Table};
    ///
    /// # let table = Table::undisplaced("(5-sqrt(3))/2".parse()?, 49, "pattern")?;
    /// let tile = PeriodicSet::new(table, 5000)?.seed(7);
    /// let half = tile.clone().keep(0.5)?;
    /// assert!(half.iter().all(|p| tile.rank(p.id()) < Some(0.5)));
    /// assert!((half.count() as f64 / tile.len() as f64 - 0.5).abs() < 0.01);
    /// // They settle, across the seam as well, unless they are to stay where ranks left them.
    /// let far = half.clone().lod(0.5)?.point(half.iter().next().expect("points").id());
    /// assert!(far.is_none_or(|p| half.point(p.id()) == Some(p) && tile.point(p.id()) != Some(p)));
    /// assert!(half.settle(0)?.iter().all(|p| tile.point(p.id()) == Some(p)));
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn keep(mut self, share: f64) -> Result<Self, Error> {
        self.parts.keep = Keep::new(share)?;
        Ok(self)
    }

    /// The level of detail: a share of the points that the set has otherwise, none of which moves.
    ///
    /// # Errors
    /// As [`Keep::new`].
    pub fn lod(mut self, share: f64) -> Result<Self, Error> {
        self.parts.lod = Keep::new(share)?;
        Ok(self)
    }

    /// The number of steps by which points settle, as [`PointSet::settle`](crate::PointSet::settle).
    ///
    /// # Errors
    /// As [`Settle::new`].
    pub fn settle(mut self, steps: u32) -> Result<Self, Error> {
        self.parts.settle = Settle::new(steps)?;
        Ok(self)
    }

    /// The points of one kind, as in [`PointSet::only`](crate::PointSet::only).
    ///
    /// # Errors
    /// [`ErrorKind::Kinds`](crate::ErrorKind::Kinds) if the table has no such kind.
    pub fn only(mut self, kind: u8) -> Result<Self, Error> {
        check_kind(kind, self.kinds())?;
        self.parts.kind = Some(kind);
        Ok(self)
    }

    /// The number of kinds of the table, 0 if it has none.
    fn kinds(&self) -> usize {
        let mix = self.table.mix();
        mix.map_or(0, |mix| mix.shares().kinds())
    }

    /// The set in a field, as in [`PointSet::in_field`](crate::PointSet::in_field): the share of the points at
    /// each place of [0, L)². The field is not evaluated elsewhere. If it has the period L, or vanishes at the seam,
    /// copies of the set continue one another.
    #[cfg(feature = "fields")]
    #[must_use]
    pub fn in_field(&self, field: impl Field + 'static) -> Self {
        let mut set = self.clone();
        set.parts.field = Some(Grade::new(Arc::new(field), 1.0));
        set
    }

    /// The kind of a point of the period, kept or not. `None` for a table without kinds and for an id without a
    /// point.
    #[must_use]
    pub fn kind_of(&self, id: PointId) -> Option<u8> {
        let (_, index) = self.indices(id)?;
        self.kind_at(index)
    }

    /// The rank of a point, from 0 to 1: its place in the order in which points leave when the set is thinned.
    /// The points of rank below a share are even at every share. `None` if no point has the id.
    #[must_use]
    pub fn rank(&self, id: PointId) -> Option<f64> {
        let (_, index) = self.indices(id)?;
        Some(self.rank_at(index))
    }

    /// The exact number of points of the set in a period.
    #[must_use]
    pub fn count(&self) -> u64 {
        if self.has_all() {
            return self.len();
        }
        (0..self.twin.period()).map(|y| self.count_row(y)).sum()
    }

    /// The number of points of each kind, the rarest first; empty for a table without kinds.
    pub(crate) fn kind_counts_until(&self, stop: &Stop) -> Result<Vec<u64>, Error> {
        let mut counts = vec![0; self.kinds()];
        if counts.is_empty() {
            return Ok(counts);
        }
        for y in 0..self.twin.period() {
            if stop.is_raised() {
                return Err(Stop::error());
            }
            for index in self.indices_of_row(y) {
                if let Some(kind) = self.kind_at(index.1) {
                    counts[usize::from(kind)] += 1;
                }
            }
        }
        Ok(counts)
    }

    /// The mean spacing of all points of the period, L/√N.
    #[must_use]
    pub const fn spacing(&self) -> f64 {
        // N is t².
        self.side / self.twin.t() as f64
    }

    /// The least distance between any two points, in the period or across its seam, in world units: a guarantee,
    /// as [`PointSet::least_distance`](crate::PointSet::least_distance) is. 0 for points in a field that settle; where
    /// others settle, those of a kind keep the distance of all.
    #[must_use]
    pub fn least_distance(&self) -> f64 {
        let settles = self.parts.settling().is_some();
        if settles && self.parts.field.is_some() {
            return 0.0;
        }
        let of_kind = self.parts.kind.filter(|_| !settles);
        let of_kind = of_kind.and_then(|kind| self.table.least_distance_of(kind, kind));
        let least = of_kind.unwrap_or_else(|| self.table.least_distance());
        self.reported(least)
    }

    /// The least distance between a point of one kind and one of another, or between two of the same kind, as
    /// [`PointSet::least_distance_of`](crate::PointSet::least_distance_of). `None` if the table has no such kinds.
    #[must_use]
    pub fn least_distance_of(&self, a: u8, b: u8) -> Option<f64> {
        Some(self.reported(self.table.least_distance_of(a, b)?))
    }

    /// A least distance of the table in this period.
    fn reported(&self, least: LeastDistance) -> f64 {
        // The twin's grid units are a little shorter or longer than those of the table's α.
        let unit = self.side / self.twin.period() as f64;
        let spacing = unit / self.table.alpha().set_side_f64();
        let warp = self.strength();
        // A side that no spacing of the plane leads to has distances without that margin.
        match Spacing::new(spacing) {
            Ok(spacing) => least.reported(spacing, warp, self.side),
            Err(_) => least.with_warp(warp) * spacing,
        }
    }

    /// The strength of the warp.
    pub(super) fn strength(&self) -> Warp {
        self.own_warp.unwrap_or(Placement::default_warp(self.seed))
    }

    /// The values that the points of the period have for some attributes.
    ///
    /// # Errors
    /// As [`PointSet::attributes`](crate::PointSet::attributes).
    pub fn attributes(&self, attributes: &Attributes) -> Result<BoundAttributes, Error> {
        BoundAttributes::of(attributes, (&self.table, self.seed), Arc::new(self.clone()))
    }

    /// Whether it has all points of the period.
    pub(super) fn has_all(&self) -> bool {
        let parts = &self.parts;
        [parts.keep, parts.lod] == [Keep::ALL; 2] && parts.kind.is_none() && parts.field.is_none()
    }

    /// The number of points in a row.
    pub(super) fn count_row(&self, y: u64) -> u64 {
        if self.has_all() {
            let row = self.row(y);
            return row.map_or(0, |(parity, _)| self.columns(y, parity).len() as u64);
        }
        self.indices_of_row(y).count() as u64
    }

    /// The columns and the indices of the points of a row.
    fn indices_of_row(&self, y: u64) -> impl Iterator<Item = (u64, [u64; 2])> + '_ {
        let row = self.row(y);
        let columns = row.map_or(&[][..], |(parity, _)| self.columns(y, parity));
        let index_y = row.map_or(0, |(_, index)| index);
        let all = columns.iter().map(move |&(x, index)| (x, [index, index_y]));
        all.filter(move |&(x, index)| self.displacement([x, y], index).is_some())
    }

    /// The block of a pair of indices.
    fn block_at(&self, index: [u64; 2]) -> [usize; 2] {
        index.map(|index| self.blocks[index as usize] as usize)
    }

    /// The distance of dX from the start of its block's interval, and the length of that, in units of the period.
    fn within_block(&self, index_x: u64) -> (u64, u64) {
        let block = self.blocks[index_x as usize];
        let start = self.blocks.partition_point(|&other| other < block);
        let end = self.blocks.partition_point(|&other| other <= block);
        (index_x - start as u64, (end - start) as u64)
    }

    pub(super) fn rank_at(&self, index: [u64; 2]) -> f64 {
        let [block_x, block_y] = self.block_at(index);
        let order = self.made.turned.order();
        let position = order.position(block_y * self.table.map().intervals() + block_x);
        let (offset, length) = self.within_block(index[0]);
        order.rank(position, offset, length)
    }

    fn kind_at(&self, index: [u64; 2]) -> Option<u8> {
        let labels = self.made.turned.labels()?;
        let [block_x, block_y] = self.block_at(index);
        let map = self.table.map();
        // The middle of the unit of dX, at its place in the interval of the map.
        let (offset, length) = self.within_block(index[0]);
        let interval = map.interval(block_x);
        let middle = u128::from(interval.end - interval.start) * u128::from(2 * offset + 1);
        let at = interval.start + (middle / u128::from(2 * length)) as u64;
        Some(labels.kind(map.intervals(), [block_x, block_y], at))
    }

    /// The displacement of all points with some indices.
    pub(super) fn vector(&self, index: [u64; 2]) -> Displacement {
        let [block_x, block_y] = self.block_at(index);
        self.made.turned.row(block_y)[block_x]
    }

    /// The displacement of the point of an address with some indices, or `None` if the set has none there.
    fn displacement(&self, at: [u64; 2], index: [u64; 2]) -> Option<Displacement> {
        let parts = &self.parts;
        if parts.kind.is_some() && self.kind_at(index) != parts.kind {
            return None;
        }
        let vector = self.vector(index);
        let share = match &parts.field {
            None if self.has_all() => return Some(vector),
            None => parts.keep.get(),
            Some(field) => {
                let place = self.moved(at.map(|v| v as i64), vector);
                field.times(parts.keep.get()).share(self.wrapped(place))
            }
        };
        (self.rank_at(index) < parts.lod.get() * share).then_some(vector)
    }

    /// The fixed-point place of an address with a displacement. Those of its copies differ by periods.
    pub(super) fn moved(&self, at: [i64; 2], vector: Displacement) -> [i64; 2] {
        let placed = [0, 1].map(|i| (at[i] << FRACTION_BITS) + i64::from(vector[i]));
        match &self.made.shears {
            Some(shears) => shears.apply(placed),
            None => placed,
        }
    }

    /// A fixed-point place in [0, L)².
    pub(super) fn wrapped(&self, place: [i64; 2]) -> [f64; 2] {
        let period = (self.twin.period() as i64) << FRACTION_BITS;
        let step = self.step();
        place.map(|v| v.rem_euclid(period) as f64 * step)
    }

    /// A fixed-point unit in world units. A period has less than 2⁴⁶ of them, so rounding never carries a coordinate
    /// to L.
    pub(super) fn step(&self) -> f64 {
        self.side / ((self.twin.period() as i64) << FRACTION_BITS) as f64
    }

    /// The point of an address with some indices, if the set has it. `settled` says where it settles, with its
    /// fixed-point place before.
    pub(super) fn point_at(
        &self,
        at: [u64; 2],
        index: [u64; 2],
        settled: impl FnOnce(PointId, [i64; 2]) -> [f64; 2],
    ) -> Option<Point> {
        let vector = self.displacement(at, index)?;
        let [x, y] = at.map(|v| v as i64);
        let id = PointId { x, y };
        let [x, y] = settled(id, self.moved([x, y], vector));
        Some(Point { id, x, y })
    }
}

impl Indices for PeriodicSet {
    fn rank(&self, id: PointId) -> f64 {
        Self::rank(self, id).unwrap_or(1.0_f64.next_down())
    }

    fn kind(&self, id: PointId) -> Option<u8> {
        self.kind_of(id)
    }
}
