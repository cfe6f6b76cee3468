//! Planning the sets of a query one after another, each knowing the layers before it.

use std::sync::Arc;

use strew_core::{
    Plan, PointId, Region, Spacing,
    sample::{ClearOf, CountError, Cursor, DistanceError, Layer, Selection, Stop},
};

use super::{
    Error, Limits, PlannedSet,
    cache::Ready,
    effort,
    query::{self, Amount, Query, Set, Token},
};

/// Plans sets one after another.
pub(super) struct Planner<'a> {
    query: &'a Query,
    limits: &'a Limits,
    stop: &'a Stop,
    layers: Vec<Arc<Layer>>,
}

/// About how often an area is counted to find the spacing of a count.
const COUNTS: f64 = 32.0;

impl<'a> Planner<'a> {
    /// `stop` ends the counting early; what is planned then means nothing.
    pub(super) const fn new(query: &'a Query, limits: &'a Limits, stop: &'a Stop) -> Self {
        Self {
            query,
            limits,
            stop,
            layers: vec![],
        }
    }

    /// Plans set number `i`; those before it are planned.
    ///
    /// With a cursor, sets before the cursor's have given all they had, and the cursor's is found
    /// again without counting.
    pub(super) fn plan(&mut self, i: usize, set: &Set, ready: &Ready) -> Result<PlannedSet, Error> {
        let region = &self.query.region;
        let clear = self.clear_of(set)?;
        let resolved = resolve(set, ready)?;
        let cursor = self.query.window.cursor;
        let here = cursor.filter(|token| i == usize::from(token.set));
        let is_over = cursor.is_some_and(|token| i < usize::from(token.set));
        let known = resolved.map(|(spacing, _)| spacing);
        let known = known.or_else(|| here?.spacing);
        let unit = Spacing::new(1.0).map_err(|_| Error::Internal("one is not a spacing"))?;
        let mut selection = Selection {
            placement: set.placement(known.unwrap_or(unit)),
            area: set.area(region),
            clear: clear.into(),
            stop: self.stop.clone(),
        };
        let plan = match (known, here) {
            (Some(spacing), _) if is_over || here.is_some() => {
                let cursor = here.map_or_else(nothing, |token| token.cursor);
                let plan = ready.sampler.resume(selection.clone(), cursor);
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
            (Some(spacing), _) => {
                self.check_rows(ready, &selection, 1.0)?;
                let plan = ready.sampler.select(selection.clone());
                plan.map_err(|error| region.too_far(spacing, &error))?
            }
            (None, here) => {
                let plan = self.count(set, ready, &mut selection)?;
                let start = here.map_or(0, |token: Token| token.cursor.offset);
                plan.window(start, is_over.then_some(0))
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
        Ok(PlannedSet::new(
            ready.entry.clone(),
            resolved.map_or(spacing.density(), |(_, density)| density),
            least_distance(set, ready, spacing),
            plan,
        ))
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
            self.check_rows(ready, selection, COUNTS)?;
        }
        let least = effort::least_spacing(selection, self.limits.max_rows as f64 / COUNTS);
        let sampler = &ready.sampler;
        let plan = sampler.select_count_from(selection, count.into(), least);
        plan.map_err(|error| match error {
            CountError::Plan(error) => self
                .query
                .region
                .too_far(selection.placement.spacing, &error),
            other => set.fault("count", count, other.to_string(), query::AMOUNT),
        })
    }

    /// Where points have to be counted row by row, there must not be too many, in so many counts.
    fn check_rows(&self, ready: &Ready, selection: &Selection, counts: f64) -> Result<(), Error> {
        let limit = ready.sampler.limit(selection.placement);
        let is_near = |bounds: Region| {
            let mut corners = bounds.min().into_iter().chain(bounds.max());
            corners.all(|value| value.abs() <= limit)
        };
        if !selection.area.bounds().is_some_and(is_near) {
            // There is nothing to count: that it is too far is told when it is planned.
            return Ok(());
        }
        let limit = self.limits.max_rows;
        let most = limit as f64 / counts;
        let mut rows = effort::rows(selection);
        if rows <= most {
            rows = effort::rows_and_edges(selection);
        }
        if rows > most {
            return Err(Error::TooManyRows {
                rows: (rows * counts) as u128,
                limit,
            });
        }
        Ok(())
    }
}

/// The place after the last point.
const fn nothing() -> Cursor {
    Cursor {
        offset: 0,
        total: 0,
        at: PointId { x: 0, y: 0 },
    }
}

/// What an amount is on its table; `None` for a count, which needs a region.
pub(super) fn resolve(set: &Set, ready: &Ready) -> Result<Option<(Spacing, f64)>, Error> {
    let fault = |field, value: f64, detail: String| set.fault(field, value, detail, query::AMOUNT);
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
                            format!("profile `{}`: {error}", set.entry.key.profile)
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

pub(super) fn least_distance(set: &Set, ready: &Ready, spacing: Spacing) -> f64 {
    ready.least.with_warp(set.warp) * spacing.get()
}
