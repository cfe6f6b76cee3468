//! Planning sets of points in space.

use std::sync::Arc;

use strew_catalog::except::Id;
use strew_core::{
    ErrorKind,
    space::{self, SpaceSet},
};
use strew_encode::Mark;
use strew_error::{Error, number};
use strew_query::{Amount, QueryVolume, Set};

use crate::{
    PlannedSet, effort,
    planned_set::Least,
    planner::Planner,
    resolve::{Resolved, check_reach, density_in_space, in_space as placed},
};

impl Planner<'_> {
    /// Plans set number `i` in space; those before it are planned. Cursors and layers are as in the plane.
    pub(super) fn space(
        &mut self,
        i: usize,
        set: &Set,
        table: &space::Table,
        whole: &QueryVolume,
    ) -> Result<PlannedSet, Error> {
        let region = &self.query.region;
        let own = set.region.as_ref().and_then(|own| own.volume.as_ref());
        let volume = whole.and(own);
        let resolved = placed(set, table)?;
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
        let spacing = known.or_else(|count| effort::guess_in_space(set, &volume, count));
        let points = set.points_in_space(table, spacing.map_err(|_| OUT_OF_RANGE)?)?;
        let test = effort::test_in_space(&self.chains, set, &points, (&volume, region.bounds));
        let layer = self.keeping_clear_in_space(set, points)?;
        let points = lacking(set, layer.clone())?;
        let spacing = points.placement().spacing;
        let mark = here.map_or(NOTHING, |token| token.mark).in_space();
        let plan = match (known, here) {
            (Ok(spacing), _) if is_over || here.is_some() => {
                let seen = if is_over { &layer } else { &points };
                let plan = seen.resume_until(volume.clone(), mark, self.stop.clone());
                let plan = plan.map_err(|error| region.too_far(spacing, &error))?;
                match set.amount {
                    // The spacing may give a few points more.
                    Amount::Count(count) => {
                        plan.window(0, Some(u128::from(count).saturating_sub(mark.offset)))
                    }
                    _ => plan,
                }
            }
            (Ok(spacing), _) => {
                let rows = effort::rows_of_volume(&points, &volume, test);
                self.check_rows_in_space(
                    rows + effort::lacking_in_space(set, &points, &volume) / effort::ROW,
                )?;
                let plan = points.within_until(volume.clone(), self.stop.clone());
                plan.map_err(|error| match error.kind() {
                    ErrorKind::Stopped => {
                        Error::Internal("a plan was stopped before its request ended")
                    }
                    _ => region.too_far(spacing, &error),
                })?
            }
            (Err(count), _) => {
                self.check_count(count)?;
                let rows = |points: &SpaceSet| {
                    effort::rows_of_volume(points, &volume, test) * effort::counts(set)
                };
                self.check_rows_in_space(rows(&points))?;
                let least = effort::least_in_space(&points, self.limits.max_rows as f64, rows);
                let plan = points.exactly(count.into(), volume.clone(), least, self.stop);
                let plan = plan.map_err(|error| self.no_count(set, count, (spacing, &error)))?;
                plan.window(mark.offset, is_over.then_some(0))
            }
        };
        let placement = plan.placement();
        let (spacing, points) = (placement.spacing, points.placed(placement));
        let layer = layer.placed(placement);
        let density = match resolved {
            Resolved::Known(_, density) => density,
            Resolved::Count(_) => density_in_space(spacing),
        };
        let own_volume = own.map(|own| &own.volume);
        self.chains.push(Some(&layer), &set.clear_of, own_volume);
        let rows = effort::rows_of_volume(&points, &volume, test);
        let looked_at = |_| effort::candidates_in_space(&points, &volume);
        let candidates = set.field.as_ref().map_or(0, looked_at);
        let least = Least::InSpace(Box::new(points), region.reach());
        if i + 1 < self.query.sets.len() {
            self.volumes.push(match own {
                Some(own) => layer.limited_to(own.volume.clone()),
                None => layer,
            });
        }
        let plan = Arc::new(plan.stopped_by(self.stop.clone()));
        let entry = set.entry.clone();
        let planned = PlannedSet::new(entry, (density, spacing), least, plan, candidates);
        let planned = planned.priced(set, 0.0, region.bounds);
        // All points of the volume are tested for those that stay.
        Ok(match set.clear_of.is_empty() {
            false => planned.after(rows),
            true => planned,
        })
    }

    /// The points of a set that keep clear of the layers it names.
    fn keeping_clear_in_space(&self, set: &Set, points: SpaceSet) -> Result<SpaceSet, Error> {
        let mut pairs = set.clear_of.iter();
        pairs.try_fold(points, |points, &(place, distance)| {
            let layer = self.volumes.get(place);
            let layer = layer.ok_or(Error::Internal("a layer is not planned yet"))?;
            points.clear_of(layer, distance).map_err(|error| {
                let detail = "the distance is out of range";
                set.fault("clear_of", number(distance), detail, error.allowed())
            })
        })
    }

    fn check_rows_in_space(&self, rows: f64) -> Result<(), Error> {
        let limit = self.limits.max_rows;
        match rows > limit as f64 {
            true => Err(Error::TooManyRows {
                rows: rows as u128,
                limit,
            }),
            false => Ok(()),
        }
    }
}

/// A set without its exceptions; the layers after it keep clear of these all the same.
pub(super) fn lacking(set: &Set, points: SpaceSet) -> Result<SpaceSet, Error> {
    let Some(except) = &set.except else {
        return Ok(points);
    };
    let has = |id| matches!(id, Id::Space(id) if points.block(id).is_some());
    except.check(&set.name, has)?;
    let parts = except.parts.iter().map(|part| part.in_space().clone());
    Ok(parts.fold(points, SpaceSet::without))
}

const OUT_OF_RANGE: Error = Error::Internal("a guessed spacing is out of range");

/// The place after the last point.
const NOTHING: Mark = Mark {
    offset: 0,
    total: 0,
    at: [0; 3],
};
