//! Planning sets of points in space.

use std::sync::Arc;

use strew_core::{
    ErrorKind,
    space::{self, SpaceSet},
};
use strew_encode::Mark;
use strew_error::{Error, number};
use strew_query::{QueryVolume, Set};

use crate::{
    PlannedSet, effort, planned_set::Least, planner::Planner, resolve::check_reach,
    resolve::in_space as placed,
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
        let (points, density) = placed(set, table)?;
        check_reach(set, region.reach())?;
        let spacing = points.placement().spacing;
        let test = self.chains.test(&points, &set.clear_of, &volume);
        let rows = effort::rows_of_volume(&points, &volume, test);
        let own_volume = own.map(|own| &own.volume);
        self.chains.push(Some(&points), &set.clear_of, own_volume);
        let points = self.keeping_clear_in_space(set, points)?;
        let cursor = self.query.window.cursor;
        let here = cursor.filter(|token| i == usize::from(token.set));
        let is_unwanted = self.query.only.is_some_and(|only| only != i);
        let is_over = is_unwanted || cursor.is_some_and(|token| i < usize::from(token.set));
        let plan = match here.filter(|_| !is_unwanted) {
            _ if is_over => points.resume(volume, NOTHING.in_space()),
            Some(token) => points.resume(volume, token.mark.in_space()),
            None => {
                self.check_rows_in_space(rows)?;
                points.within_until(volume, self.stop.clone())
            }
        };
        let plan = plan.map_err(|error| match error.kind() {
            ErrorKind::Stopped => Error::Internal("a plan was stopped before its request ended"),
            _ => region.too_far(spacing, &error),
        })?;
        let least = Least::InSpace(Box::new(points.clone()), region.reach());
        if i + 1 < self.query.sets.len() {
            self.volumes.push(match own {
                Some(own) => points.limited_to(own.volume.clone()),
                None => points,
            });
        }
        let plan = Arc::new(plan.stopped_by(self.stop.clone()));
        let planned = PlannedSet::new(set.entry.clone(), (density, spacing), least, plan, 0);
        let planned = planned.priced(set, 0.0, region.bounds);
        // All points of the volume are tested for those that stay.
        Ok(match test > 0.0 {
            true => planned.after(rows),
            false => planned,
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

/// The place after the last point.
const NOTHING: Mark = Mark {
    offset: 0,
    total: 0,
    at: [0; 3],
};
