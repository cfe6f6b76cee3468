//! Where the points of a part come from: an area of the plane, or one period.
//!
//! Everything that plans, cuts and encodes points sees a [`Source`]; only packed coordinates without further columns
//! come straight from a plan of the plane. A new kind of set, such as points in space, is one more implementation.

use std::{fmt, sync::Arc};

use strew_core::{
    Attributes, Blocks, BoundAttributes, Cursor, Error, PeriodicBlocks, PeriodicPlan, Plan, Point,
    PointId, Points, Region,
    server::{self, Stop},
};

/// Planned points: their exact number is known, and none is made yet.
pub trait Source: fmt::Debug + Send + Sync {
    /// The plan of an area of the plane, if it is one.
    fn plane(&self) -> Option<&Plan> {
        None
    }

    /// The exact number of points.
    fn count(&self) -> u128;

    /// The number of points of the whole, of which this may be a window.
    fn total(&self) -> u128;

    /// The number of points before the window.
    fn offset(&self) -> u128;

    /// Whether it is less than the whole.
    fn is_window(&self) -> bool;

    /// The points after the first `offset`, at most `limit`.
    fn window(&self, offset: u128, limit: Option<u128>) -> Arc<dyn Source>;

    /// The places of points of some numbers below the count, each greater than the one before.
    fn cursors(&self, numbers: &[u128]) -> Vec<Option<Cursor>>;

    /// The place of the first point, if there is one.
    fn cursor(&self) -> Option<Cursor>;

    /// A cursor from which the same points come, if there are any, where finding it takes no time, unlike
    /// [`cursor`](Self::cursor).
    fn beginning(&self) -> Option<Cursor> {
        self.cursor()
    }

    /// The place of the first point after the window, if there is one.
    fn next_cursor(&self) -> Option<Cursor>;

    /// A box around the points.
    fn region(&self) -> Region;

    /// Its lower corner.
    fn origin(&self) -> [f64; 2];

    /// The mean spacing at full density.
    fn spacing(&self) -> f64;

    /// The values that the points have for some attributes.
    ///
    /// # Errors
    /// If the table has other kinds than these attributes.
    fn attributes(&self, attributes: &Attributes) -> Result<BoundAttributes, Error>;

    /// The points, block by block.
    fn walk(&self) -> Box<dyn Walk>;

    /// A source of the same points whose counting stops with a flag.
    fn stopped_by(&self, stop: &Stop) -> Arc<dyn Source>;
}

/// Points on their way out.
pub trait Walk: fmt::Debug + Send {
    /// Fills a block with the next points and returns their number.
    fn fill(&mut self, out: &mut [Point]) -> usize;

    /// The place after the points so far, if there are more.
    fn cursor(&self) -> Option<Cursor>;
}

/// The methods that plans of the plane and of periods have under the same names.
macro_rules! common {
    () => {
        fn count(&self) -> u128 {
            self.count()
        }

        fn total(&self) -> u128 {
            self.total()
        }

        fn offset(&self) -> u128 {
            self.offset()
        }

        fn is_window(&self) -> bool {
            self.is_window()
        }

        fn window(&self, offset: u128, limit: Option<u128>) -> Arc<dyn Source> {
            Arc::new(self.window(offset, limit))
        }

        fn cursor(&self) -> Option<Cursor> {
            self.cursor()
        }

        fn next_cursor(&self) -> Option<Cursor> {
            self.next_cursor()
        }

        fn region(&self) -> Region {
            self.region()
        }

        fn attributes(&self, attributes: &Attributes) -> Result<BoundAttributes, Error> {
            self.attributes(attributes)
        }

        fn walk(&self) -> Box<dyn Walk> {
            Box::new(self.blocks())
        }
    };
}

impl Source for Plan {
    common!();

    fn plane(&self) -> Option<&Plan> {
        Some(self)
    }

    fn cursors(&self, numbers: &[u128]) -> Vec<Option<Cursor>> {
        let windows = server::windows(self, numbers).into_iter();
        windows.map(|window| window.cursor()).collect()
    }

    /// From the beginning on no address is needed.
    fn beginning(&self) -> Option<Cursor> {
        if self.offset() != 0 {
            return self.cursor();
        }
        (self.count() > 0).then(|| Cursor {
            offset: 0,
            total: self.total(),
            at: PointId { x: 0, y: 0 },
        })
    }

    fn origin(&self) -> [f64; 2] {
        self.origin()
    }

    fn spacing(&self) -> f64 {
        self.placement().spacing.get()
    }

    fn stopped_by(&self, stop: &Stop) -> Arc<dyn Source> {
        Arc::new(server::stopped_by(self.clone(), stop.clone()))
    }
}

impl Source for PeriodicPlan {
    common!();

    fn cursors(&self, numbers: &[u128]) -> Vec<Option<Cursor>> {
        let cursor = |&number: &u128| self.window(number, None).cursor();
        numbers.iter().map(cursor).collect()
    }

    fn origin(&self) -> [f64; 2] {
        [0.0; 2]
    }

    fn spacing(&self) -> f64 {
        self.set().spacing()
    }

    /// Windows of periods count little.
    fn stopped_by(&self, _: &Stop) -> Arc<dyn Source> {
        Arc::new(self.clone())
    }
}

/// The methods of both kinds of blocks.
macro_rules! walks {
    ($($blocks:ty),+) => {
        $(impl Walk for $blocks {
            fn fill(&mut self, out: &mut [Point]) -> usize {
                self.fill(out)
            }

            fn cursor(&self) -> Option<Cursor> {
                self.cursor()
            }
        })+
    };
}

walks!(Blocks<Points>, PeriodicBlocks);
