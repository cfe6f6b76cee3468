//! A planned set of points of a query.

use std::sync::Arc;

use strew_catalog::Entry;
use strew_core::{Region, Spacing, space::SpaceSet};
use strew_encode::Source;
use strew_query::{KindDistance, Set};

use crate::{effort, resolve};

#[derive(Clone, Debug)]
pub(super) enum Least {
    Known(f64),
    /// Of points in space within ±`reach`: the first query of a table looks at all pairs of its blocks, so it is
    /// computed only when an answer states it.
    InSpace(Box<SpaceSet>, f64),
}

#[derive(Clone, Debug)]
pub struct PlannedSet {
    pub entry: Arc<Entry>,
    /// Points per unit of area, from the amount.
    pub density: f64,
    pub spacing: Spacing,
    /// No two points are nearer than this.
    least_distance: Least,
    pub plan: Arc<dyn Source>,
    /// The points that counting all of them looks at one by one; none without a field.
    pub candidates: u128,
    /// The time to make a point, in nanoseconds.
    pub(super) nanoseconds: f64,
    /// The number of points of each of the set's kinds in the region.
    pub kinds: Vec<u128>,
    pub kind_distances: Vec<KindDistance>,
    /// The number of the set's points, as far as it is known.
    total: u128,
    /// The number of points in the query's sets before this one, unless it comes before the cursor's set.
    pub(super) before: u128,
}

impl PlannedSet {
    pub(super) fn new(
        entry: Arc<Entry>,
        (density, spacing): (f64, Spacing),
        least_distance: Least,
        plan: Arc<dyn Source>,
        candidates: u128,
    ) -> Self {
        Self {
            entry,
            density,
            spacing,
            least_distance,
            total: plan.total(),
            plan,
            candidates,
            nanoseconds: 0.0,
            kinds: vec![],
            kind_distances: vec![],
            before: 0,
        }
    }

    /// No two of the points of a set are nearer than this.
    pub(super) fn least_distance(&self, set: &Set) -> f64 {
        match &self.least_distance {
            Least::Known(least) => *least,
            Least::InSpace(points, reach) => resolve::least_distance_in_space(set, points, *reach),
        }
    }

    /// The set with the numbers of points of its kinds and the distances that these keep.
    pub(super) fn with_kinds(self, kinds: Vec<u128>, kind_distances: Vec<KindDistance>) -> Self {
        Self {
            kinds,
            kind_distances,
            ..self
        }
    }

    /// The set with what making a point takes, where testing a place against other layers takes `test`
    /// nanoseconds.
    pub(super) fn priced(mut self, set: &Set, test: f64, within: Region) -> Self {
        self.nanoseconds = effort::point(set, self.looks_by_point(set), test, within);
        self
    }

    /// The set with what counting all of its points takes, in rows, as a part of making each of them.
    pub(super) fn after(mut self, rows: f64) -> Self {
        self.nanoseconds += rows * effort::ROW / self.total.max(1) as f64;
        self
    }

    pub(super) fn looks_by_point(&self, set: &Set) -> f64 {
        match set.field {
            Some(_) => (self.candidates as f64 / self.total.max(1) as f64).max(1.0),
            None => 1.0 / set.share(),
        }
    }
}
