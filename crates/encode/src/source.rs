//! Where the points of a part come from: an area of the plane, one period, or a volume of space.
//!
//! Everything that plans, cuts and encodes points sees a [`Source`]; only packed coordinates without further columns
//! come straight from a plan of the plane.

use std::{fmt, sync::Arc};

use strew_core::{
    Attributes, Blocks, BoundAttributes, Error, PeriodicBlocks, PeriodicPlan, Plan, Point, Points,
    Region, server::Stop, space,
};

use crate::place::{Height, Located, Mark};

/// Planned points: their exact number is known, and none is made yet.
pub trait Source: fmt::Debug + Send + Sync {
    /// The plan of an area of the plane, if it is one.
    fn plane(&self) -> Option<&Plan> {
        None
    }

    /// The plan of a volume of space, if it is one.
    fn space(&self) -> Option<&space::Plan> {
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
    fn marks(&self, numbers: &[u128]) -> Vec<Option<Mark>> {
        let mark = |&number: &u128| self.window(number, None).mark();
        numbers.iter().map(mark).collect()
    }

    /// The place of the first point, if there is one.
    fn mark(&self) -> Option<Mark>;

    /// A place from which the same points come, if there are any, where finding it takes no time, unlike
    /// [`mark`](Self::mark).
    fn beginning(&self) -> Option<Mark> {
        self.mark()
    }

    /// The place of the first point after the window, if there is one.
    fn next_mark(&self) -> Option<Mark>;

    /// A box around the points; of a volume its shadow along z.
    fn region(&self) -> Region;

    /// Its lower corner.
    fn origin(&self) -> [f64; 2];

    /// The bounds along z of points in space; `None` in the plane.
    fn heights(&self) -> Option<[f64; 2]> {
        None
    }

    /// The mean spacing at full density.
    fn spacing(&self) -> f64;

    /// The values that the points have for some attributes.
    ///
    /// # Errors
    /// If the table has other kinds than these attributes.
    fn attributes(&self, attributes: &Attributes) -> Result<Bound, Error>;

    /// The points, block by block.
    fn walk(&self) -> Box<dyn Walk>;

    /// A source of the same points whose counting stops with a flag.
    fn stopped_by(&self, stop: &Stop) -> Arc<dyn Source>;
}

/// The attributes of the points of a source.
#[derive(Clone, Debug)]
pub enum Bound {
    /// In the plane.
    Plane(BoundAttributes),
    /// In space.
    Space(space::BoundAttributes),
}

/// Points on their way out.
pub trait Walk: fmt::Debug + Send {
    /// Fills a block with the next points and returns their number. In space `heights` has theirs afterwards, and
    /// nothing else.
    fn fill(&mut self, out: &mut [Point], heights: &mut Vec<Height>) -> usize;

    /// The place after the points so far, if there are more.
    fn mark(&self) -> Option<Mark>;
}

/// The methods that all plans have under the same names.
macro_rules! common {
    ($bound:path) => {
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

        fn mark(&self) -> Option<Mark> {
            self.cursor().map(Into::into)
        }

        fn next_mark(&self) -> Option<Mark> {
            self.next_cursor().map(Into::into)
        }

        fn attributes(&self, attributes: &Attributes) -> Result<Bound, Error> {
            self.attributes(attributes).map($bound)
        }
    };
}

/// The methods that plans of unbounded sets have, too.
macro_rules! unbounded {
    ($bound:path) => {
        common!($bound);

        fn marks(&self, numbers: &[u128]) -> Vec<Option<Mark>> {
            let cursors = self.cursors(numbers).into_iter();
            cursors.map(|cursor| cursor.map(Into::into)).collect()
        }

        fn beginning(&self) -> Option<Mark> {
            from_beginning(self)
        }

        fn spacing(&self) -> f64 {
            self.placement().spacing.get()
        }

        fn stopped_by(&self, stop: &Stop) -> Arc<dyn Source> {
            Arc::new(self.clone().stopped_by(stop.clone()))
        }
    };
}

impl Source for Plan {
    unbounded!(Bound::Plane);

    fn plane(&self) -> Option<&Plan> {
        Some(self)
    }

    fn region(&self) -> Region {
        self.region()
    }

    fn origin(&self) -> [f64; 2] {
        self.origin()
    }

    fn walk(&self) -> Box<dyn Walk> {
        Box::new(self.blocks())
    }
}

impl Source for PeriodicPlan {
    common!(Bound::Plane);

    fn region(&self) -> Region {
        self.region()
    }

    fn origin(&self) -> [f64; 2] {
        [0.0; 2]
    }

    fn spacing(&self) -> f64 {
        self.set().spacing()
    }

    fn walk(&self) -> Box<dyn Walk> {
        Box::new(self.blocks())
    }

    /// Windows of periods count little.
    fn stopped_by(&self, _: &Stop) -> Arc<dyn Source> {
        Arc::new(self.clone())
    }
}

impl Source for space::Plan {
    unbounded!(Bound::Space);

    fn space(&self) -> Option<&space::Plan> {
        Some(self)
    }

    fn region(&self) -> Region {
        self.region().shadow()
    }

    fn heights(&self) -> Option<[f64; 2]> {
        let region = self.region();
        Some([region.min()[2], region.max()[2]])
    }

    fn origin(&self) -> [f64; 2] {
        let [x, y, _] = self.origin();
        [x, y]
    }

    fn walk(&self) -> Box<dyn Walk> {
        Box::new(Volume {
            blocks: self.blocks_points(),
            points: vec![],
        })
    }
}

/// The beginning of a plan: from the first point of the whole on no address is needed.
fn from_beginning(plan: &impl Source) -> Option<Mark> {
    if plan.offset() != 0 {
        return plan.mark();
    }
    (plan.count() > 0).then(|| Mark {
        offset: 0,
        total: plan.total(),
        at: [0; 3],
    })
}

/// The methods of both kinds of blocks of the plane.
macro_rules! walks {
    ($($blocks:ty),+) => {
        $(impl Walk for $blocks {
            fn fill(&mut self, out: &mut [Point], _: &mut Vec<Height>) -> usize {
                self.fill(out)
            }

            fn mark(&self) -> Option<Mark> {
                self.cursor().map(Into::into)
            }
        })+
    };
}

walks!(Blocks<Points>, PeriodicBlocks);

/// The points of a volume on their way out.
#[derive(Debug)]
struct Volume {
    blocks: space::Blocks<Points>,
    points: Vec<space::Point>,
}

impl Walk for Volume {
    fn fill(&mut self, out: &mut [Point], heights: &mut Vec<Height>) -> usize {
        if self.points.len() < out.len() {
            self.points.resize(out.len(), space::Point::default());
        }
        let filled = self.blocks.fill(&mut self.points[..out.len()]);
        heights.clear();
        for (out, point) in out.iter_mut().zip(&self.points[..filled]) {
            let (flat, height) = Located::parted(point);
            *out = flat;
            heights.push(height);
        }
        filled
    }

    fn mark(&self) -> Option<Mark> {
        self.blocks.cursor().map(Into::into)
    }
}
