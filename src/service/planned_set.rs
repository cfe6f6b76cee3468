//! A planned set of points of a query.

use std::sync::Arc;

use strew_core::{Region, Spacing};

use super::{
    Entry, PlannedPoints, effort,
    query::{KindDistance, Set},
};

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
    pub plan: PlannedPoints,
    /// The points that counting all of them looks at one by one; none without a field.
    pub candidates: u128,
    /// What making a point takes, in nanoseconds.
    pub(super) nanoseconds: f64,
    /// How many points of the region each of the set's kinds has.
    pub kinds: Vec<u128>,
    /// The distances that their points keep.
    pub kind_distances: Vec<KindDistance>,
    /// How many there are of them, as far as that is known.
    total: u128,
    /// How many points of the query the sets before it have, if it is not before the cursor's.
    pub(super) before: u128,
}

impl PlannedSet {
    pub(super) fn new(
        entry: Arc<Entry>,
        (density, spacing): (f64, Spacing),
        least_distance: f64,
        plan: PlannedPoints,
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

    /// How many points are looked at to make one.
    pub(super) fn looks_by_point(&self, set: &Set) -> f64 {
        match set.field {
            Some(_) => (self.candidates as f64 / self.total.max(1) as f64).max(1.0),
            None => 1.0 / set.share(),
        }
    }
}
