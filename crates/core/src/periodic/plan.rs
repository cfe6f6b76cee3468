//! The points of periods, and their plans: an exact count, windows and cursors, and blocks of points.
//!
//! The plan of a period: as a [`Plan`](crate::Plan), but in rows and then columns.

use alloc::{sync::Arc, vec::Vec};
use core::ops::Range;

use super::{PeriodicSet, torus::Strip};
use crate::{
    attribute::{Attributes, BoundAttributes},
    error::Error,
    lattice::{Point, PointId},
    methods::windows,
    plan::member::Member,
    shape::Region,
    stop::Stop,
    window::{Cursor, Window, Windowed},
};

/// A period made ready: the exact number of its points, of which a window can be cut.
///
/// ```
/// use strew_core::{PeriodicSet, Point, Table};
///
/// # let table = Table::undisplaced("(5-sqrt(3))/2".parse()?, 49, "pattern")?;
/// let tile = PeriodicSet::new(table, 5000)?.seed(7);
/// let plan = tile.plan();
/// assert_eq!(plan.count(), 5041);
/// let page = plan.window(1000, Some(500));
/// let mut points = [Point::default(); 600];
/// assert_eq!(page.blocks().fill(&mut points), 500);
/// assert_eq!(Some(points[0].id), tile.iter().nth(1000).map(|p| p.id()));
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct PeriodicPlan {
    set: PeriodicSet,
    /// The number of points before each row and after the last, if they are counted.
    before: Option<Arc<[u64]>>,
    /// Its start is an address with no point of the window before it.
    window: Window<PointId>,
}

const ORIGIN: PointId = PointId { x: 0, y: 0 };

impl PeriodicSet {
    /// The points of a period, in the order of their ids: rows of the lattice, then columns. They are made one
    /// by one; memory does not grow with their number.
    pub fn iter(&self) -> impl Iterator<Item = Member> + use<> {
        self.rows(0..self.twin.period())
    }

    /// The points with a row of the lattice in a range, for work in parallel. Rows from the
    /// [period](crate::Twin::period) on have none.
    pub fn rows(&self, rows: Range<u64>) -> impl Iterator<Item = Member> + use<> {
        let set = self.clone();
        let mut walk = Walk::of_rows(&set, rows);
        core::iter::from_fn(move || Some(Member::new(walk.next(&set)?, set.seed)))
    }

    /// The point with an id, or `None` if there is none in the period.
    #[must_use]
    pub fn point(&self, id: PointId) -> Option<Member> {
        let (at, index) = self.indices(id)?;
        let point = self.point_at(at, index, |id, place| match Strip::new(self, 0) {
            Some(mut strip) => strip.one(self, id, place),
            None => self.wrapped(place),
        })?;
        Some(Member::new(point, self.seed))
    }

    /// The period, counted. A set that has [parts](Self::keep) of the period only is counted point by point.
    #[must_use]
    pub fn plan(&self) -> PeriodicPlan {
        let before = self.before(&Stop::default()).unwrap_or_default();
        PeriodicPlan::new(self, before)
    }

    /// Runs [`plan`](Self::plan), whose counting a flag stops.
    pub(crate) fn plan_until(&self, stop: &Stop) -> Result<PeriodicPlan, Error> {
        Ok(PeriodicPlan::new(self, self.before(stop)?))
    }

    /// The number of points before each row and after the last.
    fn before(&self, stop: &Stop) -> Result<Arc<[u64]>, Error> {
        let mut before = Vec::with_capacity(self.twin.period() as usize + 1);
        let mut sum = 0;
        before.push(0);
        for y in 0..self.twin.period() {
            if stop.is_raised() {
                return Err(Stop::error());
            }
            sum += self.count_row(y);
            before.push(sum);
        }
        Ok(before.into())
    }

    /// The points of a period from a [cursor](Cursor) on, without counting.
    #[must_use]
    pub fn resume(&self, cursor: Cursor) -> PeriodicPlan {
        let total = cursor.total.min(self.len().into());
        let offset = cursor.offset.min(total);
        PeriodicPlan {
            set: self.clone(),
            before: None,
            window: Window {
                start: Some(cursor.at),
                offset,
                count: total - offset,
                total,
            },
        }
    }
}

impl Windowed for PeriodicPlan {
    type Id = PointId;

    fn part(&self) -> Window<PointId> {
        self.window
    }

    fn part_mut(&mut self) -> &mut Window<PointId> {
        &mut self.window
    }

    fn locate(&self, numbers: &[u128]) -> Vec<Option<PointId>> {
        let place = |k: &u128| Some(self.place(k.checked_sub(self.window.offset)? as u64));
        numbers.iter().map(place).collect()
    }
}

impl PeriodicPlan {
    fn new(set: &PeriodicSet, before: Arc<[u64]>) -> Self {
        let total = before.last().copied().unwrap_or_default();
        Self {
            set: set.clone(),
            before: Some(before),
            window: Window::whole(total.into()),
        }
    }

    /// The set whose period it is.
    #[must_use]
    pub const fn set(&self) -> &PeriodicSet {
        &self.set
    }

    /// The box [0, L)².
    #[must_use]
    pub fn region(&self) -> Region {
        Region::between([0.0; 2], [self.set.length(); 2])
    }

    /// The place of a point, by its number in the window.
    fn place(&self, number: u64) -> PointId {
        let mut walk = self.walk();
        let mut left = number;
        if let Some(before) = &self.before
            && number > 0
        {
            let wanted = self.window.offset as u64 + number;
            let y = before.partition_point(|&sum| sum <= wanted).max(1) - 1;
            left = wanted - before[y];
            (walk.y, walk.i) = (y as u64, 0);
        }
        while left > 0 && walk.skip(&self.set) {
            left -= 1;
        }
        walk.id(&self.set)
    }

    /// The walk from the window's start on.
    fn walk(&self) -> Walk {
        Walk::from(&self.set, self.window.start.unwrap_or(ORIGIN))
    }

    /// The points in blocks, in the order of the period: rows, then columns.
    #[must_use]
    pub fn blocks(&self) -> PeriodicBlocks {
        PeriodicBlocks {
            walk: self.walk(),
            set: self.set.clone(),
            total: self.window.total,
            offset: self.window.offset,
            left: self.window.count,
        }
    }

    /// As [`PeriodicSet::attributes`].
    ///
    /// # Errors
    /// As [`PeriodicSet::attributes`].
    pub fn attributes(&self, attributes: &Attributes) -> Result<BoundAttributes, Error> {
        self.set.attributes(attributes)
    }
}

windows!(
    PeriodicPlan,
    Cursor,
    "strew_core::PeriodicSet::new(strew_core::Table::undisplaced(\"(5-sqrt(3))/2\".parse()?, 49, \"pattern\")?, 5000)?.plan()"
);

/// The points of a [plan](PeriodicPlan) in blocks.
///
/// ```
/// use strew_core::{PeriodicSet, Point, Table};
///
/// # let table = Table::undisplaced("(5-sqrt(3))/2".parse()?, 49, "pattern")?;
/// let mut blocks = PeriodicSet::new(table, 5000)?.plan().blocks();
/// let mut block = [Point::default(); 5000];
/// assert_eq!([blocks.fill(&mut block), blocks.fill(&mut block), blocks.fill(&mut block)], [5000, 41, 0]);
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct PeriodicBlocks {
    set: PeriodicSet,
    walk: Walk,
    total: u128,
    offset: u128,
    left: u128,
}

impl PeriodicBlocks {
    /// Fills a block with the next points and returns their number. A block is filled in part only at the end.
    pub fn fill(&mut self, out: &mut [Point]) -> usize {
        let mut filled = 0;
        while filled < out.len() && self.left > 0 {
            let Some(point) = self.walk.next(&self.set) else {
                self.left = 0;
                break;
            };
            out[filled] = point;
            filled += 1;
            self.left -= 1;
            self.offset += 1;
        }
        filled
    }

    /// The place after the points so far, if there are more in the period.
    #[must_use]
    pub fn cursor(&self) -> Option<Cursor> {
        (self.offset < self.total).then(|| Cursor {
            offset: self.offset,
            total: self.total,
            at: self.walk.id(&self.set),
        })
    }
}

/// A place in the walk: a row, and the number of a column among those that may have points.
#[derive(Clone, Debug)]
struct Walk {
    y: u64,
    i: usize,
    /// The end of the rows.
    end: u64,
    strip: Option<Strip>,
}

impl Walk {
    /// The walk through some rows.
    fn of_rows(set: &PeriodicSet, rows: Range<u64>) -> Self {
        let end = rows.end.min(set.twin.period());
        Self {
            y: rows.start,
            i: 0,
            end,
            strip: Strip::new(set, end),
        }
    }

    /// The walk from an address on.
    fn from(set: &PeriodicSet, at: PointId) -> Self {
        let mut walk = Self::of_rows(set, 0..u64::MAX);
        if let Ok(y) = u64::try_from(at.y) {
            let x = u64::try_from(at.x).unwrap_or_default();
            walk.y = y;
            walk.i = walk.columns(set).map_or(0, |(columns, _)| {
                columns.partition_point(|&(column, _)| column < x)
            });
        }
        walk
    }

    /// The columns of the row that may have points, with their dX, and dY.
    fn columns<'a>(&self, set: &'a PeriodicSet) -> Option<(&'a [(u64, u64)], u64)> {
        let (parity, index_y) = (self.y < self.end).then(|| set.row(self.y)).flatten()?;
        Some((set.columns(self.y, parity), index_y))
    }

    /// The address of the next column that may have a point.
    fn id(&self, set: &PeriodicSet) -> PointId {
        let y = self.y as i64;
        match self
            .columns(set)
            .and_then(|(columns, _)| columns.get(self.i))
        {
            Some(&(x, _)) => PointId { x: x as i64, y },
            None => PointId { x: 0, y: y + 1 },
        }
    }

    /// Skips a point that is there, without settling it. `false` after the last one.
    fn skip(&mut self, set: &PeriodicSet) -> bool {
        let strip = self.strip.take();
        let is_found = self.next(set).is_some();
        self.strip = strip;
        is_found
    }

    /// The next point.
    fn next(&mut self, set: &PeriodicSet) -> Option<Point> {
        while self.y < self.end {
            if let Some((columns, index_y)) = self.columns(set) {
                while let Some(&(x, index_x)) = columns.get(self.i) {
                    self.i += 1;
                    let (at, index, strip) = ([x, self.y], [index_x, index_y], &mut self.strip);
                    let point = set.point_at(at, index, |_, place| match strip {
                        Some(strip) => strip.place(set, at),
                        None => set.wrapped(place),
                    });
                    if point.is_some() {
                        return point;
                    }
                }
            }
            self.y += 1;
            self.i = 0;
        }
        None
    }
}
