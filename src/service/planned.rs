//! Planning: a checked query with its tables becomes plans whose exact counts are known.

use std::sync::Arc;

use strew_core::{
    Placement, Plan, Spacing, Warp,
    sample::{ClearOf, CountError, Cursor, DistanceError, Layer, Selection},
};

use super::{
    Catalog, Entry, Error, Limits,
    attributes::PointAttributes,
    cache::Ready,
    encode::{Attributes, Part},
    query::{Amount, Query, Resolved, ResolvedSet, Set, Token},
};

/// A query with its tables and plans: the exact count is known, no point is made yet.
#[derive(Clone, Debug)]
pub struct Planned {
    /// The query.
    pub query: Query,
    /// Its sets of points, planned: the windows of them that are asked for.
    pub sets: Vec<PlannedSet>,
    /// How many points of the query come before the window.
    offset: u128,
    count: u128,
    /// Where the points after the window begin.
    next: Option<Token>,
    identity: [u8; 32],
}

/// A planned set of points.
#[derive(Clone, Debug)]
pub struct PlannedSet {
    /// The table that answers.
    pub entry: Arc<Entry>,
    /// What the amount became: points per unit of area.
    pub density: f64,
    /// What the amount became: the mean spacing.
    pub spacing: Spacing,
    /// No two points are nearer than this.
    pub least_distance: f64,
    /// The points.
    pub plan: Plan,
}

/// A set of points with its table, when there is no region.
#[derive(Clone, Debug)]
pub struct Placed {
    /// The set.
    pub set: Set,
    /// The table.
    pub ready: Ready,
    /// Where its points are.
    pub placement: Placement,
    /// As answers echo it.
    pub resolved: ResolvedSet,
}

impl Placed {
    /// A set laid into the world.
    ///
    /// # Errors
    /// [`Error::Invalid`] for a distance that cannot be kept, or a count.
    pub fn new(set: Set, ready: Ready) -> Result<Self, Error> {
        let Some((spacing, density)) = resolve(&set, &ready)? else {
            return Err(set.fault("count", "", "it needs a region", super::query::AMOUNT));
        };
        let least = least_distance(&set, &ready, spacing);
        Ok(Self {
            resolved: set.resolved(&[], density, spacing, least),
            placement: set.placement(spacing),
            set,
            ready,
        })
    }
}

impl Planned {
    /// Plans a query on its sets' tables.
    ///
    /// # Errors
    /// [`Error::Invalid`] if the region reaches farther than points can be told apart, or an amount
    /// cannot be had; [`Error::TooManyRows`] if counting would take too long.
    pub fn new(query: Query, tables: &[Ready], limits: &Limits) -> Result<Self, Error> {
        let digests: Vec<&str> = tables.iter().map(|t| t.entry.digest.as_str()).collect();
        let identity = query.identity(&digests);
        if let Some(token) = query.window.cursor {
            let fault = |fault| Error::Invalid(vec![fault]);
            token.check(&identity).map_err(fault)?;
        }
        let mut planner = Planner {
            query: &query,
            limits,
            layers: vec![],
        };
        let mut sets = vec![];
        for (i, (set, ready)) in query.sets.iter().zip(tables).enumerate() {
            sets.push(planner.plan(i, set, ready)?);
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
    ///
    /// # Errors
    /// As [`new`](Self::new), or [`Error::Internal`] if a table cannot be read any more.
    pub fn from_catalog(catalog: &Catalog, query: Query, limits: &Limits) -> Result<Self, Error> {
        let ready = |set: &Set| {
            let entry = catalog.entry(&set.key).ok_or_else(Error::lost_table)?;
            Ready::load(&entry)
        };
        let tables: Vec<Ready> = query.sets.iter().map(ready).collect::<Result<_, _>>()?;
        Self::new(query, &tables, limits)
    }

    /// Narrows the sets' plans to the query's window.
    fn cut(&mut self) {
        let window = &self.query.window;
        // What comes before the cursor is not there any more; it only counts for the offset.
        let (first, before) = match window.cursor {
            Some(token) => (usize::from(token.set), token.before + token.cursor.offset),
            None => (0, 0),
        };
        let mut skip = u128::from(window.offset);
        let mut room = window.limit.map_or(u128::MAX, u128::from);
        let mut skipped = 0;
        // The points of the sets before the one at hand.
        let mut earlier = window.cursor.map_or(0, |token| token.before);
        for (i, set) in self.sets.iter_mut().enumerate().skip(first) {
            let whole = &set.plan;
            let part = whole.window(skip, Some(room));
            let left_out = skip.min(whole.count());
            skip -= left_out;
            skipped += left_out;
            room -= part.count();
            let rest = whole.count() - left_out - part.count();
            if rest > 0 && self.next.is_none() && room == 0 {
                self.next = part
                    .next_cursor()
                    .map(|cursor| token(&self.identity, i, earlier, cursor));
            }
            earlier += whole.offset() + whole.count();
            self.count += part.count();
            set.plan = part;
        }
        self.offset = before + skipped;
    }

    /// How many points the answer has. Regions can hold more than 64 bits count, so this is wider
    /// than any limit.
    #[must_use]
    pub const fn count(&self) -> u128 {
        self.count
    }

    /// How many points of the query come before those of the answer.
    #[must_use]
    pub const fn offset(&self) -> u128 {
        self.offset
    }

    /// Where the query goes on after the answer, if it does.
    #[must_use]
    pub const fn next(&self) -> Option<Token> {
        self.next
    }

    /// The first set's table: the only one's, without layers.
    #[must_use]
    pub fn entry(&self) -> &Entry {
        &self.sets[0].entry
    }

    /// The query in parts of as many points, give or take one: where each begins, if it is not
    /// empty, and how many points it has.
    #[must_use]
    pub fn split(&self, parts: u32) -> Vec<(Token, u64)> {
        let parts = u128::from(parts.max(1));
        let bound = |i: u128| i * (self.count / parts) + i.min(self.count % parts);
        let size = |i: u128| u64::try_from(bound(i + 1) - bound(i)).unwrap_or(u64::MAX);
        let places = (0..parts).filter_map(|i| Some((self.place(bound(i))?, size(i))));
        places.collect()
    }

    /// The place of point number `k` of the answer.
    fn place(&self, mut k: u128) -> Option<Token> {
        let first = self.query.window.cursor;
        let first = first.map_or(0, |token| usize::from(token.set));
        for (i, set) in self.sets.iter().enumerate().skip(first) {
            if k < set.plan.count() {
                let cursor = set.plan.window(k, None).cursor()?;
                return Some(self.token(i, cursor));
            }
            k -= set.plan.count();
        }
        None
    }

    /// What to hand back to go on from a place in one of the sets.
    #[must_use]
    pub fn token(&self, set: usize, cursor: Cursor) -> Token {
        let (first, before) = match self.query.window.cursor {
            Some(token) => (usize::from(token.set), token.before),
            None => (0, 0),
        };
        let sets = self.sets[..set].iter().skip(first);
        let before = before + sets.map(|set| set.plan.total()).sum::<u128>();
        token(&self.identity, set, before, cursor)
    }

    /// The parts of the answer.
    #[must_use]
    pub fn parts(&self) -> Vec<Part> {
        let part = |(set, planned): (&Set, &PlannedSet)| {
            let plan = planned.plan.clone();
            let has_attributes = !set.attributes.as_slice().is_empty();
            let attributes = has_attributes.then(|| {
                let bound = set.attributes.bind(plan.sampler(), plan.placement());
                Arc::new(PointAttributes::new(&set.attributes, bound)) as Arc<dyn Attributes>
            });
            Part {
                layer: self.query.is_layered.then(|| set.name.clone()),
                attributes,
                plan,
            }
        };
        self.query.sets.iter().zip(&self.sets).map(part).collect()
    }

    /// The query as answers echo it.
    #[must_use]
    pub fn resolved(&self) -> Resolved {
        let all = &self.query.sets;
        let resolved = |(set, planned): (&Set, &PlannedSet)| {
            let PlannedSet {
                density,
                spacing,
                least_distance,
                ..
            } = *planned;
            set.resolved(all, density, spacing, least_distance)
        };
        let mut sets: Vec<ResolvedSet> = all.iter().zip(&self.sets).map(resolved).collect();
        let set = (!self.query.is_layered).then(|| sets.remove(0));
        Resolved {
            bbox: self.query.region.bbox(),
            region: self.query.region.echo.clone(),
            set,
            layers: sets,
            offset: self.offset,
            limit: self.query.window.limit,
        }
    }
}

fn token(identity: &[u8; 32], set: usize, before: u128, cursor: Cursor) -> Token {
    Token::new(
        identity,
        u16::try_from(set).unwrap_or(u16::MAX),
        before,
        cursor,
    )
}

/// Plans sets one after another, each knowing the layers before it.
struct Planner<'a> {
    query: &'a Query,
    limits: &'a Limits,
    layers: Vec<Arc<Layer>>,
}

impl Planner<'_> {
    fn plan(&mut self, i: usize, set: &Set, ready: &Ready) -> Result<PlannedSet, Error> {
        let region = &self.query.region;
        let clear = self.clear_of(set)?;
        let resolved = resolve(set, ready)?;
        let unit = Spacing::new(1.0).map_err(|_| Error::Internal("one is not a spacing"))?;
        let mut selection = Selection {
            placement: set.placement(resolved.map_or(unit, |(spacing, _)| spacing)),
            area: set.area(region),
            clear: clear.into(),
        };
        let plan = match (resolved, self.query.window.cursor) {
            (Some((spacing, _)), Some(token)) if i <= usize::from(token.set) => {
                // Sets before the cursor's have given all they had.
                let nothing = Cursor {
                    offset: 0,
                    total: 0,
                    at: token.cursor.at,
                };
                let is_here = i == usize::from(token.set);
                let cursor = if is_here { token.cursor } else { nothing };
                let plan = ready.sampler.resume(selection.clone(), cursor);
                plan.map_err(|error| region.too_far(spacing, &error))?
            }
            (Some((spacing, _)), _) => {
                self.check_rows(&selection)?;
                self.check_clearing(&selection)?;
                let plan = ready.sampler.select(selection.clone());
                plan.map_err(|error| region.too_far(spacing, &error))?
            }
            (None, cursor) => {
                let whole = self.count(set, ready, &mut selection)?;
                match cursor {
                    Some(token) if i < usize::from(token.set) => whole.window(whole.count(), None),
                    Some(token) if i == usize::from(token.set) => whole.from_cursor(token.cursor),
                    _ => whole,
                }
            }
        };
        let spacing = plan.placement().spacing;
        selection.placement.spacing = spacing;
        self.layers.push(Arc::new(Layer {
            sampler: ready.sampler.clone(),
            placement: selection.placement,
            area: set.region.as_ref().map(|own| own.area.clone()),
            clear: selection.clear,
        }));
        Ok(PlannedSet {
            entry: ready.entry.clone(),
            density: resolved.map_or(spacing.density(), |(_, density)| density),
            least_distance: least_distance(set, ready, spacing),
            spacing,
            plan,
        })
    }

    /// The layers that a set keeps clear of, with the distances.
    fn clear_of(&self, set: &Set) -> Result<Vec<ClearOf>, Error> {
        let clear = set.clear_of.iter().map(|&(place, distance)| {
            let layer = self.layers.get(place).cloned();
            let layer = layer.ok_or(Error::Internal("a layer is not planned yet"))?;
            ClearOf::new(layer, distance).map_err(|error| {
                let allowed = format!("above 0, at most {:e}", error.limit);
                set.fault(
                    "clear_of",
                    distance,
                    "the distance is out of range",
                    allowed,
                )
            })
        });
        clear.collect()
    }

    /// The plan with exactly as many points as are asked for.
    fn count(&self, set: &Set, ready: &Ready, selection: &mut Selection) -> Result<Plan, Error> {
        let Amount::Count(count) = set.amount else {
            return Err(Error::Internal("an amount is not resolved"));
        };
        let limit = self.limits.max_points;
        if count > limit {
            let count = count.into();
            return Err(Error::TooManyPoints { count, limit });
        }
        // About what it will be, to know what counting takes.
        let [min_x, min_y, max_x, max_y] = self.query.region.bbox();
        let side = (max_x - min_x).sqrt() * (max_y - min_y).sqrt();
        let guess = side * (set.keep.get() / count as f64).sqrt();
        if let Ok(spacing) = Spacing::new(guess) {
            selection.placement.spacing = spacing;
            self.check_rows(selection)?;
        }
        let allowed = super::query::AMOUNT;
        let plan = ready.sampler.select_count(selection, count.into());
        plan.map_err(|error| match error {
            CountError::Plan(error) => self
                .query
                .region
                .too_far(selection.placement.spacing, &error),
            other => set.fault("count", count, other.to_string(), allowed),
        })
    }

    /// Where points have to be counted row by row, there must not be too many.
    fn check_rows(&self, selection: &Selection) -> Result<(), Error> {
        let is_box = matches!(selection.area, strew_core::Area::Region(_));
        let is_warped = selection.placement.warp != Warp::OFF;
        if is_box && !is_warped && selection.clear.is_empty() {
            return Ok(());
        }
        let Some(bounds) = selection.area.bounds() else {
            return Ok(());
        };
        let [width, height] = [0, 1].map(|i| bounds.max()[i] - bounds.min()[i]);
        // A lattice unit is about a third of the mean spacing.
        let unit = selection.placement.spacing.get() / 3.0;
        let rows = if is_box { width + height } else { height } / unit;
        let limit = self.limits.max_rows;
        if rows > limit as f64 {
            return Err(Error::TooManyRows {
                rows: rows as u128,
                limit,
            });
        }
        Ok(())
    }

    /// What keeps clear of layers is counted point by point: there must not be too many to look at.
    fn check_clearing(&self, selection: &Selection) -> Result<(), Error> {
        let limit = self.limits.max_points;
        if selection.clear.is_empty() {
            return Ok(());
        }
        let Some(bounds) = selection.area.bounds() else {
            return Ok(());
        };
        let [width, height] = [0, 1].map(|i| bounds.max()[i] - bounds.min()[i]);
        let placement = selection.placement;
        let about = width * height * placement.spacing.density() * placement.keep.get();
        if about > limit as f64 {
            let count = about as u128;
            return Err(Error::TooManyPoints { count, limit });
        }
        Ok(())
    }
}

/// What an amount is on its table; `None` for a count, which needs a region.
fn resolve(set: &Set, ready: &Ready) -> Result<Option<(Spacing, f64)>, Error> {
    let fault =
        |field, value: f64, detail: String| set.fault(field, value, detail, super::query::AMOUNT);
    let wrong = |field, value: f64| {
        move |error: strew_core::sample::SpacingError| fault(field, value, error.to_string())
    };
    match set.amount {
        Amount::Density(density) => {
            let spacing = Spacing::from_density(density).map_err(wrong("density", density))?;
            Ok(Some((spacing, density)))
        }
        Amount::Spacing(value) => {
            let spacing = Spacing::new(value).map_err(wrong("spacing", value))?;
            Ok(Some((spacing, spacing.density())))
        }
        Amount::MinDistance(distance) => {
            let spacing = ready
                .least
                .spacing_for(distance, set.warp)
                .map_err(|error| {
                    let detail = match error {
                        DistanceError::NoPromise { .. } => {
                            format!("profile `{}`: {error}", set.key.profile)
                        }
                        other => other.to_string(),
                    };
                    fault("min_distance", distance, detail)
                })?;
            Ok(Some((spacing, spacing.density())))
        }
        Amount::Count(_) => Ok(None),
    }
}

fn least_distance(set: &Set, ready: &Ready, spacing: Spacing) -> f64 {
    ready.least.with_warp(set.warp) * spacing.get()
}
