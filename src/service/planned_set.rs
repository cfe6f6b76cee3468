//! A planned set of points of a query.

use std::sync::Arc;

use strew_core::{Plan, Spacing};

use super::Entry;

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
    /// How many points of the query the sets before it have, if it is not before the cursor's.
    pub(super) before: u128,
}

impl PlannedSet {
    pub(super) fn new(entry: Arc<Entry>, density: f64, least_distance: f64, plan: Plan) -> Self {
        Self {
            entry,
            density,
            spacing: plan.placement().spacing,
            least_distance,
            plan,
            before: 0,
        }
    }
}
