//! Where the points of a set come from: an area of the plane, or one period.
//!
//! Everything that plans, cuts and encodes points sees this; only packed coordinates without further columns come
//! straight from a plan of the plane.

use strew_core::{
    Attributes, Blocks, BoundAttributes, Cursor, Error, PeriodicBlocks, PeriodicPlan, Plan, Point,
    PointId, Points, Region,
    server::{self, Stop},
};

/// The planned points of a set.
#[derive(Clone, Debug)]
pub enum PlannedPoints {
    /// Those in an area.
    Plane(Plan),
    /// Those of a period.
    Period(PeriodicPlan),
}

impl From<Plan> for PlannedPoints {
    fn from(plan: Plan) -> Self {
        Self::Plane(plan)
    }
}

impl PlannedPoints {
    /// The plan of an area.
    #[must_use]
    pub const fn plane(&self) -> Option<&Plan> {
        match self {
            Self::Plane(plan) => Some(plan),
            Self::Period(_) => None,
        }
    }

    /// The exact number of points.
    #[must_use]
    pub const fn count(&self) -> u128 {
        match self {
            Self::Plane(plan) => plan.count(),
            Self::Period(plan) => plan.count(),
        }
    }

    /// The number of points of the whole, of which this may be a window.
    #[must_use]
    pub const fn total(&self) -> u128 {
        match self {
            Self::Plane(plan) => plan.total(),
            Self::Period(plan) => plan.total(),
        }
    }

    /// The number of points before the window.
    #[must_use]
    pub const fn offset(&self) -> u128 {
        match self {
            Self::Plane(plan) => plan.offset(),
            Self::Period(plan) => plan.offset(),
        }
    }

    /// Whether it is less than the whole.
    #[must_use]
    pub const fn is_window(&self) -> bool {
        match self {
            Self::Plane(plan) => plan.is_window(),
            Self::Period(plan) => plan.is_window(),
        }
    }

    /// The points after the first `offset`, at most `limit`.
    #[must_use]
    pub fn window(&self, offset: u128, limit: Option<u128>) -> Self {
        match self {
            Self::Plane(plan) => Self::Plane(plan.window(offset, limit)),
            Self::Period(plan) => Self::Period(plan.window(offset, limit)),
        }
    }

    /// The places of points of some numbers below the count, each greater than the one before.
    #[must_use]
    pub(super) fn cursors(&self, numbers: &[u128]) -> Vec<Option<Cursor>> {
        match self {
            Self::Plane(plan) => {
                let windows = server::windows(plan, numbers).into_iter();
                windows.map(|window| window.cursor()).collect()
            }
            Self::Period(plan) => {
                let cursor = |&k: &u128| plan.window(k, None).cursor();
                numbers.iter().map(cursor).collect()
            }
        }
    }

    /// The place of the first point, if there is one.
    #[must_use]
    pub fn cursor(&self) -> Option<Cursor> {
        match self {
            Self::Plane(plan) => plan.cursor(),
            Self::Period(plan) => plan.cursor(),
        }
    }

    /// A cursor from which the same points come, if there are any. Finding it takes no time, unlike
    /// [`cursor`](Self::cursor): from the beginning on no address is needed.
    #[must_use]
    pub fn beginning(&self) -> Option<Cursor> {
        match self {
            Self::Plane(plan) if plan.offset() == 0 => (plan.count() > 0).then(|| Cursor {
                offset: 0,
                total: plan.total(),
                at: PointId { x: 0, y: 0 },
            }),
            _ => self.cursor(),
        }
    }

    /// The place of the first point after the window, if there is one.
    #[must_use]
    pub fn next_cursor(&self) -> Option<Cursor> {
        match self {
            Self::Plane(plan) => plan.next_cursor(),
            Self::Period(plan) => plan.next_cursor(),
        }
    }

    /// A box around the points.
    #[must_use]
    pub fn region(&self) -> Region {
        match self {
            Self::Plane(plan) => plan.region(),
            Self::Period(plan) => plan.region(),
        }
    }

    /// Its lower corner.
    #[must_use]
    pub fn origin(&self) -> [f64; 2] {
        match self {
            Self::Plane(plan) => plan.origin(),
            Self::Period(_) => [0.0; 2],
        }
    }

    /// The mean spacing at full density.
    #[must_use]
    pub fn spacing(&self) -> f64 {
        match self {
            Self::Plane(plan) => plan.placement().spacing.get(),
            Self::Period(plan) => plan.set().spacing(),
        }
    }

    /// The values that the points have for some attributes.
    ///
    /// # Errors
    /// If the table has other kinds than these attributes.
    pub fn attributes(&self, attributes: &Attributes) -> Result<BoundAttributes, Error> {
        match self {
            Self::Plane(plan) => plan.attributes(attributes),
            Self::Period(plan) => plan.attributes(attributes),
        }
    }

    /// The points, block by block.
    #[must_use]
    pub fn walk(&self) -> Walk {
        match self {
            Self::Plane(plan) => Walk::Plane(Box::new(plan.blocks())),
            Self::Period(plan) => Walk::Period(Box::new(plan.blocks())),
        }
    }

    /// What is counted from here on stops with this flag. Windows of periods count little.
    #[must_use]
    pub(super) fn stopped_by(self, stop: &Stop) -> Self {
        match self {
            Self::Plane(plan) => Self::Plane(server::stopped_by(plan, stop.clone())),
            Self::Period(_) => self,
        }
    }
}

/// Points on their way out.
#[derive(Debug)]
pub enum Walk {
    /// Those in an area.
    Plane(Box<Blocks<Points>>),
    /// Those of a period.
    Period(Box<PeriodicBlocks>),
}

impl Walk {
    /// Fills a block with the next points and returns their number.
    pub fn fill(&mut self, out: &mut [Point]) -> usize {
        match self {
            Self::Plane(blocks) => blocks.fill(out),
            Self::Period(blocks) => blocks.fill(out),
        }
    }

    /// The place after the points so far, if there are more.
    #[must_use]
    pub fn cursor(&self) -> Option<Cursor> {
        match self {
            Self::Plane(blocks) => blocks.cursor(),
            Self::Period(blocks) => blocks.cursor(),
        }
    }
}
