//! Planning the sets of a query one after another, each knowing the layers before it.

use std::sync::Arc;

use strew_catalog::{Ready, except::Id};
use strew_config::Limits;
use strew_core::{
    Cursor, ErrorKind, Placement, Plan, PointId, PointSet, Spacing, server::Stop, space::SpaceSet,
};
use strew_error::Error;
use strew_query::{Amount, Kinds, Period, Query, Set, Token, Window, parameters};

use crate::{
    PlannedSet,
    effort::{self, Everywhere, Layers, Selection},
    planned_set::Least,
    resolve::{Resolved, check_reach, kind_distances, least_distance, no_period, resolve, unit},
};

/// Plans sets one after another.
pub(super) struct Planner<'a> {
    pub(super) query: &'a Query,
    pub(super) limits: &'a Limits,
    pub(super) stop: &'a Stop,
    layers: Vec<PointSet>,
    pub(super) volumes: Vec<SpaceSet>,
    pub(super) chains: effort::Chains,
    prices: Layers,
    /// The bytes that counting has kept for all sets.
    kept: usize,
}

/// The most bytes that counting keeps for all sets of a query together: points of small ones, places in the order of
/// others. Those of further sets are found again.
const MOST_KEPT: usize = 2 << 20;

impl<'a> Planner<'a> {
    /// `stop` ends the counting early; the plan is then meaningless.
    pub(super) fn new(query: &'a Query, limits: &'a Limits, stop: &'a Stop) -> Self {
        Self {
            query,
            limits,
            stop,
            layers: vec![],
            volumes: vec![],
            chains: effort::Chains::default(),
            prices: Layers::default(),
            kept: 0,
        }
    }

    /// Plans set number `i`; those before it are planned.
    ///
    /// With a cursor, sets before the cursor's have given all they had, and the cursor's is found
    /// again without counting. Layers that are not wanted have no points, and others keep clear of them all the
    /// same.
    pub(super) fn plan(
        &mut self,
        i: usize,
        set: &Set,
        ready: Option<&Ready>,
    ) -> Result<PlannedSet, Error> {
        if let (Some(table), Some(volume)) = (set.space(), &self.query.region.volume) {
            return self.space(i, set, table, volume);
        }
        let ready = ready.ok_or(Error::Internal("a set of the plane without its table"))?;
        if let Some(period) = set.period {
            return self.period(i, set, period, ready);
        }
        let region = &self.query.region;
        let resolved = resolve(set, ready)?;
        check_reach(set, region.reach())?;
        let cursor = self.query.window.cursor;
        let here = cursor.filter(|token| i == usize::from(token.set));
        let is_unwanted = self.query.only.is_some_and(|only| only != i);
        let is_over = is_unwanted || cursor.is_some_and(|token| i < usize::from(token.set));
        let here = here.filter(|_| !is_unwanted);
        let known = match resolved {
            Resolved::Known(spacing, _) => Ok(spacing),
            Resolved::Count(count) => here.and_then(|token| token.spacing).ok_or(count),
        };
        let points = set.points(ready, known.unwrap_or(Spacing::ONE))?;
        let area = set.area(region);
        let layer = self.keeping_clear(set, points)?;
        let points = lacking(set, ready, layer.clone())?;
        let places = (known.ok()).and_then(|spacing| Everywhere::of(set, spacing, &area));
        let test = self.prices.test(set, places);
        let mut selection = Selection::new(set, points, area, test);
        let plan = match (known, here) {
            (Ok(spacing), _) if is_over || here.is_some() => {
                let cursor = here.map_or_else(nothing, |token| token.mark.in_plane());
                let seen = if is_over { &layer } else { &selection.set };
                let plan = seen.resume_until(selection.area.clone(), cursor, self.stop.clone());
                let plan = plan.map_err(|error| region.too_far(spacing, &error))?;
                match set.amount {
                    // The spacing may give a few points more.
                    Amount::Count(count) => {
                        let left = u128::from(count).saturating_sub(cursor.offset);
                        plan.window(0, Some(left))
                    }
                    _ => plan,
                }
            }
            (Ok(spacing), _) => {
                self.check_rows(&selection, 1.0 + effort::kinds(set))?;
                let area = selection.area.clone();
                let plan = selection.set.within_until(area, self.stop.clone());
                plan.map_err(|error| region.too_far(spacing, &error))?
            }
            (Err(count), here) => {
                let plan = self.count(set, count, &mut selection)?;
                let start = here.map_or(0, |token: Token| token.mark.offset);
                plan.window(start, is_over.then_some(0))
            }
        };
        let plan = match self.kept + plan.kept() > MOST_KEPT {
            true => plan.forgetting(),
            false => plan,
        };
        self.kept += plan.kept();
        let spacing = plan.placement().spacing;
        let candidates = match set.field {
            Some(_) => {
                let placed = selection.set.clone().placed(plan.placement());
                effort::candidates(&selection.with_set(placed))
            }
            None => 0,
        };
        let kinds = match &set.kinds {
            // The first answer reported them.
            Some(_) if cursor.is_some() || is_unwanted => vec![],
            Some(kinds) => self.kind_counts(kinds, &selection, &plan)?,
            None => vec![],
        };
        // The points of a page may be the only ones in many tiles.
        let is_page = self.query.window != Window::default();
        let made = self.prices.test(set, places.filter(|_| !is_page));
        // Only later layers look back.
        if i + 1 < self.query.sets.len() {
            self.prices.push(set, Some(spacing), region.bounds);
            let layer = layer.placed(plan.placement());
            self.layers.push(match &set.region {
                Some(own) => layer.limited_to(own.area.clone()),
                None => layer,
            });
        }
        Ok(PlannedSet::new(
            ready.entry.clone(),
            match resolved {
                Resolved::Known(_, density) => (density, spacing),
                Resolved::Count(_) => (spacing.density(), spacing),
            },
            Least::Known(least_distance(set, ready, spacing, region.reach())),
            Arc::new(plan),
            candidates,
        )
        .priced(set, made, region.bounds)
        .with_kinds(kinds, kind_distances(set, ready, spacing, region.reach())))
    }

    fn period(
        &self,
        i: usize,
        set: &Set,
        period: Period,
        ready: &Ready,
    ) -> Result<PlannedSet, Error> {
        let Resolved::Known(spacing, density) = resolve(set, ready)? else {
            return Err(Error::Internal("a period with a count was not refused"));
        };
        let points = set.periodic(&ready.table, period).map_err(no_period)?;
        let cursor = self.query.window.cursor;
        let here = cursor.filter(|token| i == usize::from(token.set));
        let unfinished = |_| Error::Internal("a plan was stopped before its request ended");
        let plan = match here {
            Some(token) => points.resume(token.mark.in_plane()),
            None => {
                let rows = effort::rows_of_period(set);
                let limit = self.limits.max_rows;
                if rows > limit as f64 {
                    let rows = rows as u128;
                    return Err(Error::TooManyRows { rows, limit });
                }
                points.plan_until(self.stop).map_err(unfinished)?
            }
        };
        let kinds = match &set.kinds {
            Some(kinds) if cursor.is_none() => {
                let counts = points.kind_counts_until(self.stop).map_err(unfinished)?;
                let count = |name: &str| {
                    counts
                        .get(usize::from(kinds.variants.number(name)?))
                        .copied()
                };
                let names = kinds.variants.variants().names();
                names.map(|name| count(name).unwrap_or(0).into()).collect()
            }
            _ => vec![],
        };
        let candidates = match set.field {
            Some(_) => points.len().into(),
            None => 0,
        };
        let unit = unit(set, ready, spacing);
        let least = Least::Known(least_distance(set, ready, unit, period.side));
        let distances = kind_distances(set, ready, unit, period.side);
        let plan = Arc::new(plan);
        let planned = PlannedSet::new(
            ready.entry.clone(),
            (density, spacing),
            least,
            plan,
            candidates,
        );
        let planned = planned.priced(set, 0.0, self.query.region.bounds);
        Ok(planned.with_kinds(kinds, distances))
    }

    /// The number of a plan's points of each kind, in the order of their names.
    fn kind_counts(
        &self,
        kinds: &Kinds,
        selection: &Selection,
        plan: &Plan,
    ) -> Result<Vec<u128>, Error> {
        let set = selection.set.clone().placed(plan.placement());
        let unfinished = |_| Error::Internal("a plan was stopped before its request ended");
        let mut counts = set
            .kind_counts_until(&selection.area, self.stop)
            .map_err(unfinished)?;
        // A number of points can leave out a few that lie inside.
        let beyond = plan.next_cursor().map(|next| plan.from_cursor(next));
        for point in beyond.iter().flat_map(Plan::iter) {
            if let Some(kind) = set.kind_of(point.id()) {
                counts[usize::from(kind)] -= 1;
            }
        }
        let names = kinds.variants.variants().names();
        let kind = |name: &str| Some(usize::from(kinds.variants.number(name)?));
        let count = |name: &str| counts.get(kind(name)?).copied();
        Ok(names.map(|name| count(name).unwrap_or(0)).collect())
    }

    /// The points of a set that keep clear of the layers it names.
    fn keeping_clear(&self, set: &Set, points: PointSet) -> Result<PointSet, Error> {
        set.clear_of
            .iter()
            .try_fold(points, |points, &(place, distance)| {
                let layer = self.layers.get(place);
                let layer = layer.ok_or(Error::Internal("a layer is not planned yet"))?;
                points.clear_of(layer, distance).map_err(|error| {
                    let allowed = error.allowed().to_owned();
                    set.fault(
                        "clear_of",
                        distance,
                        "the distance is out of range",
                        allowed,
                    )
                })
            })
    }

    /// The plan with exactly `count` points.
    fn count(&self, set: &Set, count: u64, selection: &mut Selection) -> Result<Plan, Error> {
        self.check_count(count)?;
        // A guess of the spacing, to estimate the price of counting.
        let [min_x, min_y, max_x, max_y] = self.query.region.bbox();
        let side = (max_x - min_x).sqrt() * (max_y - min_y).sqrt();
        let guess = side * (set.share() / count as f64).sqrt();
        if let Ok(spacing) = Spacing::new(guess) {
            let placement = selection.set.placement();
            let trial = Placement {
                spacing,
                ..placement
            };
            selection.set = selection.set.clone().placed(trial);
            self.check_rows(selection, effort::counts(set) + effort::kinds(set))?;
        }
        let most = self.limits.max_rows as f64 / (effort::counts(set) + effort::kinds(set));
        let is_in_field = set.field.is_some();
        let least = effort::least_spacing(selection, is_in_field, most, self.stop);
        let Selection {
            set: points, area, ..
        } = &*selection;
        let plan = points.exactly_until(count.into(), area.clone(), least, self.stop);
        plan.map_err(|error| self.no_count(set, count, (points.placement().spacing, &error)))
    }

    /// The error of a number of points that no spacing has, or that was counted near this spacing.
    pub(super) fn no_count(
        &self,
        set: &Set,
        count: u64,
        (spacing, error): (Spacing, &strew_core::Error),
    ) -> Error {
        if !matches!(error.kind(), ErrorKind::Count | ErrorKind::TooDense) {
            return self.query.region.too_far(spacing, error);
        }
        let allowed = match error.allowed() {
            "" => parameters::COUNT.allowed(),
            allowed => allowed.into(),
        };
        set.fault("count", count, error.problem(), allowed)
    }

    /// Refuses a number of points that no answer may have.
    pub(super) fn check_count(&self, count: u64) -> Result<(), Error> {
        let limit = self.limits.max_points;
        match count > limit {
            true => Err(Error::TooManyPoints {
                count: count.into(),
                limit,
            }),
            false => Ok(()),
        }
    }

    /// Checks that the rows of a selection, counted `counts` times, stay within the limit.
    fn check_rows(&self, selection: &Selection, counts: f64) -> Result<(), Error> {
        if !selection.is_near() {
            // There is nothing to count: planning reports that it is too far out.
            return Ok(());
        }
        let limit = self.limits.max_rows;
        let most = limit as f64 / counts;
        let rows = effort::rows_and_edges(selection, most);
        if rows > most {
            return Err(Error::TooManyRows {
                rows: (rows * counts) as u128,
                limit,
            });
        }
        Ok(())
    }
}

/// A set without its exceptions; the layers after it keep clear of these all the same.
pub(super) fn lacking(set: &Set, ready: &Ready, points: PointSet) -> Result<PointSet, Error> {
    let Some(except) = &set.except else {
        return Ok(points);
    };
    let every = set.every_point(ready);
    let has = |id| matches!(id, Id::Plane(id) if every.block(id).is_some());
    except.check(&set.name, has)?;
    let parts = except.parts.iter().map(|part| part.in_plane().clone());
    Ok(parts.fold(points, PointSet::without))
}

/// The place after the last point.
const fn nothing() -> Cursor {
    Cursor {
        offset: 0,
        total: 0,
        at: PointId { x: 0, y: 0 },
    }
}
