//! The kinds of a set's points.

use alloc::{format, string::String, vec, vec::Vec};

use super::PointSet;
use crate::{
    attribute::Kinds,
    error::{Error, ErrorKind, shown},
    lattice::{Placement, Point, PointId, VaryingKinds, check_kind},
    plan::Plan,
    shape::Area,
    stop::Stop,
    table::{Shares, Table},
};

/// One kind of the points of a set: its number, the rarest first, or its name.
///
/// ```
/// use strew_core::{Kind, Kinds, PointSet, Table};
///
/// assert_eq!(Kind::from("birch"), Kind::Named("birch"));
/// assert_eq!(Kind::from(0), Kind::Number(0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind<'a> {
    /// The number of a kind, in the order of the shares: 0 is the rarest.
    Number(u8),
    /// The name of a kind of a set whose [kinds](PointSet::kinds) have names.
    Named(&'a str),
}

impl From<u8> for Kind<'_> {
    fn from(number: u8) -> Self {
        Self::Number(number)
    }
}

impl<'a> From<&'a str> for Kind<'a> {
    fn from(name: &'a str) -> Self {
        Self::Named(name)
    }
}

impl PointSet {
    /// The set with kinds of points that have names, each of them evenly spread.
    ///
    /// Of a table that has kinds, such as one from a file of `strew forge mix`, they are the names. The
    /// [default](Self::blue) table gets labels for [even](Kinds::even) kinds, or a [joint](Kinds::joint) table in its
    /// place, if those of this ratio are built in: by the features `even-1-3`, `joint-1-3` and their like. Even kinds
    /// change neither ids nor places; the order in which points leave when the set is [thinned](Self::keep) becomes one
    /// that keeps the shares.
    ///
    /// # Errors
    /// [`ErrorKind::Kinds`] if the table has kinds of another ratio, or has none and nothing of this ratio is built in.
    pub fn kinds(self, kinds: Kinds) -> Result<Self, Error> {
        let lattice = match self.lattice.kind_parts() {
            Some(shares) => {
                kinds.check(Some(shares))?;
                self.lattice
            }
            None => {
                let table = built_in(self.table(), &kinds);
                let table = table.ok_or_else(|| not_built_in(self.table(), &kinds))?;
                self.lattice.of_table(table)
            }
        };
        Ok(Self {
            lattice,
            named: Some(kinds),
            ..self
        })
    }

    /// The [named kinds](Self::kinds) of the set, if its kinds have names.
    #[must_use]
    pub const fn named_kinds(&self) -> Option<&Kinds> {
        self.named.as_ref()
    }

    /// The name of the kind of a point, kept or not. `None` for a set whose kinds have no names and for an id without a
    /// point. It takes about as long as [`point`](Self::point).
    #[must_use]
    pub fn kind_name(&self, id: PointId) -> Option<&str> {
        self.named.as_ref()?.name(self.kind_of(id)?)
    }

    /// The set with kinds whose shares vary from place to place, in place of those of its table. Neither ids nor
    /// places change. The points of each kind are counted one by one.
    ///
    /// # Errors
    /// [`ErrorKind::Kinds`] if the second order is of another map.
    pub fn with_varying_kinds(self, kinds: VaryingKinds) -> Result<Self, Error> {
        if kinds.order().map() != self.table().map() {
            let field = "the second order";
            let (value, allowed) = ("of another map", "of the map of the table");
            return Err(Error::new(ErrorKind::Kinds, field, value, allowed));
        }
        let shares = kinds.shares();
        Ok(Self {
            named: self.named.filter(|named| named.shares() == shares),
            lattice: self.lattice.with_varied(kinds),
            ..self
        })
    }

    /// The points of one kind, by its number or its [name](Self::kinds). Kinds are those of the table's
    /// [mix](crate::Table::mix), or those that [vary](Self::with_varying_kinds), numbered in the order of the shares,
    /// the rarest first.
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
    pub fn only<'k>(self, kind: impl Into<Kind<'k>>) -> Result<Self, Error> {
        let kind = self.numbered(kind.into())?;
        Ok(Self {
            lattice: self.lattice.of_kind(kind),
            ..self
        })
    }

    /// The number of a kind that the set has.
    fn numbered(&self, kind: Kind<'_>) -> Result<u8, Error> {
        let number = match (kind, &self.named) {
            (Kind::Number(number), _) => number,
            (Kind::Named(name), Some(named)) => named.numbered(name)?,
            (Kind::Named(name), None) => {
                let (value, allowed) = (format!("`{}`", shown(name)), NO_NAMES);
                return Err(Error::new(ErrorKind::Kinds, "only", value, allowed));
            }
        };
        check_kind(number, self.number_of_kinds())?;
        Ok(number)
    }

    /// The number of kinds, 0 if there are none.
    fn number_of_kinds(&self) -> usize {
        self.lattice.kind_parts().map_or(0, Shares::kinds)
    }

    /// The kind of [all points](Self::only) of the set, or `None` if it was not limited to one.
    #[must_use]
    pub fn kind(&self) -> Option<u8> {
        self.lattice.kind()
    }

    /// The kind of a point, kept or not. `None` for a table without kinds and for an id without a point.
    #[must_use]
    pub fn kind_of(&self, id: PointId) -> Option<u8> {
        self.lattice.kind_of(id)
    }

    /// The number of points of each kind in an area, the rarest kind first; empty for a table without kinds. It
    /// takes the time of counting each kind: see [`within`](Self::within).
    ///
    /// # Errors
    /// As [`within`](Self::within).
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
        (0..self.number_of_kinds() as u8).map(count).collect()
    }

    /// Counts the points of each kind one by one, where the shares of kinds vary.
    fn varied_counts(&self, area: &Area, stop: &Stop) -> Result<Vec<u128>, Error> {
        let plan = Plan::new(&self.lattice, &self.mask, area.clone(), stop.clone(), None)?;
        let mut counts = vec![0; self.number_of_kinds()];
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
    #[must_use]
    pub fn least_distance_of<'k>(
        &self,
        a: impl Into<Kind<'k>>,
        b: impl Into<Kind<'k>>,
    ) -> Option<f64> {
        let a = self.numbered(a.into()).ok()?;
        let b = self.numbered(b.into()).ok()?;
        if self.lattice.is_varied() {
            return Some(self.least_distance());
        }
        let least = self.table().least_distance_of(a, b)?;
        let Placement { spacing, warp, .. } = self.placement();
        Some(least.reported(spacing, warp, 0.0))
    }
}

/// The allowed kinds of a set whose kinds have no names.
const NO_NAMES: &str = "a number: the kinds of the set have no names, which PointSet::kinds sets";

/// The table with the labels, or the joint table, of named kinds, if they are built in.
#[cfg(feature = "tables")]
fn built_in(table: &Table, kinds: &Kinds) -> Option<Table> {
    match kinds.is_joint() {
        true => table.built_in_joint(kinds.shares()),
        false => table.built_in_even(kinds.shares()),
    }
}

#[cfg(not(feature = "tables"))]
fn built_in(_: &Table, _: &Kinds) -> Option<Table> {
    None
}

/// Whether labels may be built in for a table.
#[cfg(feature = "tables")]
fn may_be_built_in(table: &Table) -> bool {
    table.is_default()
}

#[cfg(not(feature = "tables"))]
fn may_be_built_in(_: &Table) -> bool {
    false
}

/// The error of named kinds of which nothing is built in.
fn not_built_in(table: &Table, kinds: &Kinds) -> Error {
    let shares = kinds.shares();
    let (spread, flag) = match kinds.is_joint() {
        true => ("joint", " --joint"),
        false => ("even", ""),
    };
    let built_in = match may_be_built_in(table) {
        true => format!("1:1, 1:3, 1:1:2 or 1:3:10, with features such as `{spread}-1-3`, or "),
        false => String::new(),
    };
    let allowed =
        format!("{built_in}that of a table from `strew forge mix --shares {shares}{flag}`");
    let field = format!("the ratio of {spread} kinds");
    let missing = "the table has no kinds, and none of this ratio are built in";
    Error::new(ErrorKind::Kinds, field, shares, allowed).because(missing)
}
