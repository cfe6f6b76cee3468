//! Planning: a checked query with its tables becomes plans whose exact counts are known.

use std::sync::{Arc, OnceLock};

use strew_catalog::{Entry, Ready};
use strew_config::Limits;
use strew_core::{Member, PeriodicSet, PointId, PointSet, server::Stop, space::SpaceSet};
use strew_encode::{Attributes, Bound, Mark, Part};
use strew_error::{Error, integer::Long};
use strew_query::{Amount, Query, Resolved, ResolvedSet, Set, Token, other_kinds};

use crate::{
    attributes::PointAttributes,
    planned_set::PlannedSet,
    planner::{self, Planner},
    resolve,
    store::{self, Anew},
    terrain::{Ground, OnTerrain},
    volume,
};

/// A query with its tables and plans: the exact count is known, no point is made yet.
#[derive(Clone, Debug)]
pub struct Planned {
    pub query: Box<Query>,
    pub sets: Vec<PlannedSet>,
    /// The number of the query's points before the window.
    offset: u128,
    count: u128,
    /// Where the points after the window begin.
    next: Option<Token>,
    /// The key that seals cursors, once one is made or read.
    identity: OnceLock<[u8; 32]>,
}

/// A set of points with its table, when there is no region.
#[derive(Clone, Debug)]
pub struct Placed {
    pub set: Box<Set>,
    pub points: PlacedPoints,
    pub(super) attributes: Bound,
    pub(super) ground: Option<Ground>,
    pub resolved: ResolvedSet,
}

impl Placed {
    /// A set laid into the world at once, in the calling thread: what a command line needs.
    pub fn at_once(set: Box<Set>) -> Result<Self, Error> {
        if set.space().is_some() {
            return Self::in_space(set);
        }
        let ready = store::ready(&set, &Anew)?;
        Self::new(set, ready)
    }

    pub fn in_space(set: Box<Set>) -> Result<Self, Error> {
        let table = set
            .space()
            .ok_or(Error::Internal("a set of the plane in space"))?;
        let resolve::Resolved::Known(spacing, density) = resolve::in_space(&set, table)? else {
            return Err(Error::Internal("a single point of a count"));
        };
        let points = volume::lacking(&set, set.points_in_space(table, spacing)?)?;
        let least = resolve::least_distance_in_space(&set, &points, 0.0);
        Ok(Self {
            resolved: set.resolved(&[], density, spacing, least, (&[], &[])),
            attributes: points
                .attributes(&set.attributes)
                .map(Bound::Space)
                .map_err(other_kinds)?,
            points: PlacedPoints::Space(Box::new(points)),
            ground: None,
            set,
        })
    }

    pub fn new(set: Box<Set>, ready: Ready) -> Result<Self, Error> {
        let resolve::Resolved::Known(spacing, density) = resolve::resolve(&set, &ready)? else {
            return Err(set.fault(
                "count",
                "",
                "needs a region",
                "density, spacing or min_distance",
            ));
        };
        let unit = resolve::unit(&set, &ready, spacing);
        let least = resolve::least_distance(&set, &ready, unit, 0.0);
        let distances = resolve::kind_distances(&set, &ready, unit, 0.0);
        let points = match set.period {
            Some(period) => PlacedPoints::Period(
                set.periodic(&ready.table, period)
                    .map_err(resolve::no_period)?,
            ),
            None => {
                let points = planner::lacking(&set, &ready, set.points(&ready, spacing)?)?;
                PlacedPoints::Plane(Box::new(points))
            }
        };
        Ok(Self {
            resolved: set.resolved(&[], density, spacing, least, (&[], &distances)),
            attributes: points.attributes(&set.attributes).map_err(other_kinds)?,
            points,
            ground: set
                .terrain
                .clone()
                .map(|terrain| Ground::new(terrain, spacing.get())),
            set,
        })
    }
}

#[derive(Clone, Debug)]
pub enum PlacedPoints {
    Plane(Box<PointSet>),
    Period(PeriodicSet),
    Space(Box<SpaceSet>),
}

impl PlacedPoints {
    pub fn point(&self, id: PointId) -> Option<Member> {
        match self {
            Self::Plane(points) => points.point(id),
            Self::Period(points) => points.point(id),
            Self::Space(_) => None,
        }
    }

    pub fn block(&self, id: PointId) -> Option<[usize; 2]> {
        match self {
            Self::Plane(points) => points.block(id),
            Self::Period(points) => points.block(id),
            Self::Space(_) => None,
        }
    }

    fn attributes(&self, attributes: &strew_core::Attributes) -> Result<Bound, strew_core::Error> {
        match self {
            Self::Plane(points) => points.attributes(attributes).map(Bound::Plane),
            Self::Period(points) => points.attributes(attributes).map(Bound::Plane),
            Self::Space(points) => points.attributes(attributes).map(Bound::Space),
        }
    }
}

impl Planned {
    pub fn new(
        query: impl Into<Box<Query>>,
        tables: &[Ready],
        limits: &Limits,
    ) -> Result<Self, Error> {
        Self::unless_stopped(query, tables, limits, &Stop::default())
    }

    /// Like [`new`](Self::new), but ends early once `stop` is raised.
    pub fn unless_stopped(
        query: impl Into<Box<Query>>,
        tables: &[Ready],
        limits: &Limits,
        stop: &Stop,
    ) -> Result<Self, Error> {
        let planned = Self::plan(query.into(), tables, limits, stop);
        if stop.is_raised() {
            return Err(Error::Internal(
                "a plan was stopped before its request ended",
            ));
        }
        planned
    }

    fn plan(
        query: Box<Query>,
        tables: &[Ready],
        limits: &Limits,
        stop: &Stop,
    ) -> Result<Self, Error> {
        let identity = OnceLock::new();
        if let Some(token) = query.window.cursor {
            let identity = identity.get_or_init(|| {
                let sets = query.sets.iter();
                let digests: Vec<&str> = sets.map(|set| set.entry.digest.as_str()).collect();
                query.identity(&digests)
            });
            token.check(identity)?;
        }
        let mut planner = Planner::new(&query, limits, stop);
        let mut sets = Vec::with_capacity(query.sets.len());
        for (i, set) in query.sets.iter().enumerate() {
            sets.push(planner.plan(i, set, tables.get(i))?);
        }
        let mut planned = Self {
            sets,
            offset: 0,
            count: 0,
            next: None,
            identity,
            query,
        };
        planned.cut();
        Ok(planned)
    }

    /// Plans a query at once, in the calling thread: what a command line needs.
    pub fn at_once(query: Query, limits: &Limits) -> Result<Self, Error> {
        let tables = Self::tables(&query)?;
        Self::new(query, &tables, limits)
    }

    /// The tables of a query's sets, read or made in the calling thread.
    pub fn tables(query: &Query) -> Result<Vec<Ready>, Error> {
        // Tables in space are ready as they are.
        let flat = query.sets.iter().filter(|set| set.space().is_none());
        flat.map(|set| store::ready(set, &Anew)).collect()
    }

    fn cut(&mut self) {
        let window = &self.query.window;
        // The plan has no points before the cursor; they only count for the offset.
        let (first, mut earlier) = window
            .cursor
            .map_or((0, 0), |token| (usize::from(token.set), token.before));
        let here = window.cursor.map_or(0, |token| token.mark.offset);
        let mut skip = u128::from(window.offset);
        let mut room = window.limit.map_or(u128::MAX, u128::from);
        let mut rest = None;
        self.offset = earlier.saturating_add(here);
        for (i, set) in self.sets.iter_mut().enumerate().skip(first) {
            let whole = &set.plan;
            let part = match skip == 0 && whole.count() <= room {
                true => whole.clone(),
                false => whole.window(skip, Some(room)),
            };
            let left_out = skip.min(whole.count());
            set.before = earlier;
            earlier = earlier.saturating_add(whole.offset() + whole.count());
            skip -= left_out;
            room -= part.count();
            if left_out + part.count() < whole.count() {
                rest = rest.or(Some(i));
            }
            self.offset = self.offset.saturating_add(left_out);
            self.count += part.count();
            set.plan = part;
        }
        self.next = rest.and_then(|i| self.token(i, self.sets[i].plan.next_mark()?));
    }

    fn digests(&self) -> Vec<&str> {
        let digests = self.sets.iter().map(|set| set.entry.digest.as_str());
        digests.collect()
    }

    /// The token at which a later query resumes: a place in a set.
    pub fn token(&self, i: usize, mark: Mark) -> Option<Token> {
        let (asked, set) = (self.query.sets.get(i)?, self.sets.get(i)?);
        let spacing = matches!(asked.amount, Amount::Count(_)).then_some(set.spacing);
        let number = u16::try_from(i).ok()?;
        Some(Token::new(
            self.identity
                .get_or_init(|| self.query.identity(&self.digests())),
            number,
            set.before,
            mark,
            spacing,
        ))
    }

    /// How many points the answer has. Regions can hold more than 64 bits count, so this is wider
    /// than any limit.
    pub const fn count(&self) -> u128 {
        self.count
    }

    /// The number of coordinates of each point: 2, or 3 in space.
    pub const fn axes(&self) -> usize {
        if self.query.region.volume.is_some() {
            3
        } else {
            2
        }
    }

    /// The number of the query's points before those of the answer.
    pub const fn offset(&self) -> u128 {
        self.offset
    }

    /// Where the query goes on after the answer, if it does.
    pub const fn next(&self) -> Option<Token> {
        self.next
    }

    /// Where the answer begins, if it has points.
    pub fn beginning(&self) -> Option<Token> {
        let mut sets = self.sets.iter().enumerate();
        let (i, mark) = sets.find_map(|(i, set)| Some((i, set.plan.beginning()?)))?;
        self.token(i, mark)
    }

    /// The first set's table: the only one's, without layers.
    pub fn entry(&self) -> &Entry {
        &self.sets[0].entry
    }

    /// Splits the query into parts of equal size, give or take one point. Returns where each part that is not empty
    /// begins, and its number of points.
    pub fn split(&self, parts: u32) -> Result<Vec<(Token, u64)>, Error> {
        let parts = u128::from(parts.max(1));
        if self.count.div_ceil(parts) > u128::from(u64::MAX) {
            let (count, limit) = (self.count, u64::MAX);
            return Err(Error::TooManyPoints { count, limit });
        }
        let bound = |i: u128| i * (self.count / parts) + i.min(self.count % parts);
        let size = |i: u128| u64::try_from(bound(i + 1) - bound(i)).unwrap_or(u64::MAX);
        // With more parts than points, the rest of the parts are empty.
        let numbers: Vec<u128> = (0..parts.min(self.count)).map(bound).collect();
        let mut places = Vec::with_capacity(numbers.len());
        let first = self.query.window.cursor;
        let first = first.map_or(0, |token| usize::from(token.set));
        let mut before = 0;
        for (i, set) in self.sets.iter().enumerate().skip(first) {
            let end = before + set.plan.count();
            let own = &numbers[places.len()..];
            let own = own[..own.partition_point(|&k| k < end)].iter();
            let own: Vec<u128> = own.map(|k| k - before).collect();
            let marks = set.plan.marks(&own).into_iter();
            places.extend(marks.map(|mark| self.token(i, mark?)));
            before = end;
        }
        let sized = places.into_iter().zip(0..);
        Ok(sized
            .filter_map(|(place, i)| Some((place?, size(i))))
            .collect())
    }

    /// Stops all further work of the plans once this flag is raised.
    pub fn stopped_by(mut self, stop: &Stop) -> Self {
        for set in &mut self.sets {
            set.plan = set.plan.stopped_by(stop);
        }
        self
    }

    pub fn parts(&self) -> Result<Vec<Part>, Error> {
        let part = |(set, planned): (&Set, &PlannedSet)| -> Result<Part, Error> {
            let plan = planned.plan.clone();
            let mut attributes = None;
            if !set.attributes.as_slice().is_empty() {
                let bound = plan.attributes(&set.attributes).map_err(other_kinds)?;
                attributes =
                    Some(Arc::new(PointAttributes::new(&set.attributes, bound))
                        as Arc<dyn Attributes>);
            }
            if let Some(terrain) = &set.terrain {
                let spacing = planned.spacing.get();
                let on = OnTerrain::new(attributes.take(), terrain.clone(), spacing);
                attributes = Some(Arc::new(on));
            }
            Ok(Part {
                layer: self.query.is_layered.then(|| set.name.clone()),
                attributes,
                plan,
            })
        };
        self.query.sets.iter().zip(&self.sets).map(part).collect()
    }

    pub fn resolved(&self) -> Resolved {
        let all = &self.query.sets;
        let resolved = |(set, planned): (&Set, &PlannedSet)| {
            let PlannedSet {
                density,
                spacing,
                ref kinds,
                ref kind_distances,
                ..
            } = *planned;
            set.resolved(
                all,
                density,
                spacing,
                planned.least_distance(set),
                (kinds, kind_distances),
            )
        };
        let mut sets: Vec<ResolvedSet> = all.iter().zip(&self.sets).map(resolved).collect();
        let set = (!self.query.is_layered).then(|| sets.remove(0));
        let world = self.query.world.as_ref();
        let only = self.query.only.and_then(|only| all.get(only));
        Resolved {
            bbox: self.query.region.corners(),
            region: self.query.region.echo.clone(),
            world: world.map(|world| world.name.clone()),
            world_digest: world.map(|world| world.digest.clone()),
            only_layer: only.map(|set| set.name.clone()),
            set,
            layers: sets,
            offset: Long(self.offset),
            limit: self.query.window.limit.map(Long),
        }
    }
}
