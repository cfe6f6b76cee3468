//! The kinds of a set's points.

use alloc::{vec, vec::Vec};

use super::PointSet;
use crate::{
    error::{Error, ErrorKind},
    sample::{
        area::Area,
        lattice::{Placement, Point, PointId, VaryingKinds, check_kind},
        plan::Plan,
    },
    stop::Stop,
    table::Shares,
};

impl PointSet {
    /// The set with kinds whose shares vary from place to place, in place of those of its table. Neither ids nor
    /// places change. The points of each kind are counted one by one.
    ///
    /// # Errors
    /// [`ErrorKind::Kinds`] if the second order is of another map.
    ///
    /// ```
    /// use std::sync::Arc;
    /// use strew_core::{PointSet, Table, VaryingKinds};
    ///
    /// let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
    /// let right = |[x, _]: [f64; 2]| if x < 0.0 { 0.0 } else { 1.0 };
    /// let kinds = VaryingKinds::new(&table, "1:1".parse()?, vec![Some(Arc::new(right)), None])?;
    /// let set = PointSet::new(table).with_varying_kinds(kinds.clone())?;
    /// // To the left all points are of the other kind.
    /// assert_eq!(set.clone().only(0)?.chunk(20.0, [-1, 0])?.count(), 0);
    /// assert_eq!(set.clone().only(1)?.chunk(20.0, [-1, 0])?.count(), set.chunk(20.0, [-1, 0])?.count());
    /// let other = Table::undisplaced("sqrt(3)".parse()?, 15, "pattern")?;
    /// assert!(PointSet::new(other).with_varying_kinds(kinds).is_err());
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn with_varying_kinds(self, kinds: VaryingKinds) -> Result<Self, Error> {
        if kinds.order().map() != self.table().map() {
            let field = "the second order";
            let (value, allowed) = ("of another map", "of the map of the table");
            return Err(Error::new(ErrorKind::Kinds, field, value, allowed));
        }
        Ok(Self {
            lattice: self.lattice.with_varied(kinds),
            ..self
        })
    }

    /// The points of one kind. Kinds are those of the table's [mix](crate::Table::mix), or those that
    /// [vary](Self::with_varying_kinds), numbered in the order of the shares, the rarest first.
    ///
    /// It is a set like any other: its areas, chunks, windows and searches have the points of the whole set that
    /// are of this kind, with the same ids and at the same places. Spacing and density remain those of the whole
    /// set. [`min_distance`](Self::min_distance), [`least_distance`](Self::least_distance) and
    /// [`exactly`](Self::exactly) mean the points of this kind.
    ///
    /// # Errors
    /// [`ErrorKind::Kinds`] if the table has no such kind.
    ///
    /// ```
    /// use strew_core::{ErrorKind, PointSet, Region, Table, table::{Mix, Ranks}};
    ///
    /// let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
    /// let mix = Mix::scattered(table.map(), "1:3".parse()?)?;
    /// let ranks = Ranks::new((0..mix.labels().len() as u32).collect())?;
    /// let set = PointSet::new(table.with_mix(mix, ranks)?).seed(7);
    /// let region = Region::new([0.0, 0.0], [1e6, 1e6])?;
    /// // In closed form, as all counts of boxes.
    /// let rare = set.clone().only(0)?.count(region)?;
    /// assert!((rare as f64 / 0.25e12 - 1.0).abs() < 1e-6);
    /// assert_eq!(rare + set.clone().only(1)?.count(region)?, set.count(region)?);
    /// assert_eq!(set.only(2).unwrap_err().kind(), ErrorKind::Kinds);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn only(self, kind: u8) -> Result<Self, Error> {
        check_kind(kind, self.kinds())?;
        Ok(Self {
            lattice: self.lattice.of_kind(kind),
            ..self
        })
    }

    /// The number of kinds, 0 if there are none.
    fn kinds(&self) -> usize {
        self.lattice.kind_parts().map_or(0, Shares::kinds)
    }

    /// The kind of [all points](Self::only) of the set, or `None` if it was not limited to one.
    ///
    /// ```
    /// use strew_core::{PointSet, Table};
    ///
    /// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
    /// assert_eq!(PointSet::new(table).kind(), None);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn kind(&self) -> Option<u8> {
        self.lattice.kind()
    }

    /// The kind of a point, kept or not. `None` for a table without kinds and for an id without a point.
    ///
    /// ```
    /// use strew_core::{PointSet, Table, table::{Mix, Ranks}};
    ///
    /// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
    /// let mix = Mix::scattered(table.map(), "1:3".parse()?)?;
    /// let ranks = Ranks::new((0..mix.labels().len() as u32).collect())?;
    /// let set = PointSet::new(table.with_mix(mix, ranks)?).seed(7);
    /// let rare = set.clone().only(0)?;
    /// for point in set.chunk(20.0, [0, 0])? {
    ///     let id = point.id();
    ///     assert_eq!(rare.point(id), (set.kind_of(id) == Some(0)).then_some(point));
    /// }
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn kind_of(&self, id: PointId) -> Option<u8> {
        self.lattice.kind_of(id)
    }

    /// The number of points of each kind in an area, the rarest kind first; empty for a table without kinds. It
    /// takes the time of counting each kind: see [`within`](Self::within).
    ///
    /// # Errors
    /// As [`within`](Self::within).
    ///
    /// ```
    /// use strew_core::{Circle, PointSet, Table, table::{Mix, Ranks}};
    ///
    /// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
    /// let mix = Mix::scattered(table.map(), "1:3".parse()?)?;
    /// let ranks = Ranks::new((0..mix.labels().len() as u32).collect())?;
    /// let set = PointSet::new(table.with_mix(mix, ranks)?).seed(7);
    /// let lake = Circle::new([0.0, 0.0], 100.0)?;
    /// let counts = set.kind_counts(lake.clone())?;
    /// assert_eq!(counts[0] + counts[1], set.count(lake)?);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn kind_counts(&self, area: impl Into<Area>) -> Result<Vec<u128>, Error> {
        self.kind_counts_until(&area.into(), &Stop::default())
    }

    /// Runs [`kind_counts`](Self::kind_counts), whose counting a flag stops.
    pub(crate) fn kind_counts_until(&self, area: &Area, stop: &Stop) -> Result<Vec<u128>, Error> {
        if self.lattice.is_varied() {
            return self.varied_counts(area, stop);
        }
        let own = self.lattice.kind();
        let count = |kind: u8| {
            if own.is_some_and(|own| own != kind) {
                return Ok(0);
            }
            let lattice = self.lattice.clone().of_kind(kind);
            let plan = Plan::new(&lattice, &self.mask, area.clone(), stop.clone(), None)?;
            Ok(plan.count())
        };
        (0..self.kinds() as u8).map(count).collect()
    }

    /// Counts the points of each kind one by one, where the shares of kinds vary.
    fn varied_counts(&self, area: &Area, stop: &Stop) -> Result<Vec<u128>, Error> {
        let plan = Plan::new(&self.lattice, &self.mask, area.clone(), stop.clone(), None)?;
        let mut counts = vec![0; self.kinds()];
        let (mut blocks, mut block) = (plan.blocks_points(), [Point::default(); 1024]);
        loop {
            let filled = blocks.fill(&mut block);
            if stop.is_raised() {
                return Err(Stop::error());
            }
            if filled == 0 {
                return Ok(counts);
            }
            let kinds = block[..filled].iter();
            for kind in kinds.filter_map(|point| self.lattice.kind_of(point.id)) {
                counts[usize::from(kind)] += 1;
            }
        }
    }

    /// The least distance between a point of one kind and one of another, or between two of the same kind, in
    /// world units: a guarantee, as [`least_distance`](Self::least_distance) is. `None` if the table has no such
    /// kinds. Where shares vary it is that of any two points.
    ///
    /// ```
    /// use strew_core::{PointSet, Table, table::{Mix, Ranks}};
    ///
    /// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
    /// let mix = Mix::scattered(table.map(), "1:3".parse()?)?;
    /// let ranks = Ranks::new((0..mix.labels().len() as u32).collect())?;
    /// let set = PointSet::new(table.with_mix(mix, ranks)?).seed(7);
    /// let apart = set.least_distance_of(0, 1).expect("kinds of the table");
    /// assert!(apart >= set.least_distance());
    /// assert_eq!(set.least_distance_of(0, 0), Some(set.only(0)?.least_distance()));
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn least_distance_of(&self, a: u8, b: u8) -> Option<f64> {
        if self.lattice.is_varied() {
            let are_kinds = usize::from(a.max(b)) < self.kinds();
            return are_kinds.then(|| self.least_distance());
        }
        let least = self.table().least_distance_of(a, b)?;
        let Placement { spacing, warp, .. } = self.placement();
        Some(least.reported(spacing, warp, 0.0))
    }
}
