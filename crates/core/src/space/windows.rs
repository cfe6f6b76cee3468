//! Windows: parts of a request's points, and the cursors between them.

use alloc::vec::Vec;

use super::{Cursor, count, plan::Plan, point::PointId};
use crate::window::{Window, Windowed};

impl Windowed for Plan {
    type Id = PointId;

    fn part(&self) -> Window<PointId> {
        self.window
    }

    fn part_mut(&mut self) -> &mut Window<PointId> {
        &mut self.window
    }

    fn locate(&self, numbers: &[u128]) -> Vec<Option<PointId>> {
        let places = match &self.kept {
            Some(kept) => {
                let address = |&k: &u128| kept.address(usize::try_from(k).ok()?);
                numbers.iter().map(address).collect()
            }
            None => count::locate_all(&self.scope, numbers),
        };
        places.into_iter().map(|at| at.map(PointId::of)).collect()
    }
}

impl Plan {
    /// The number of points of the whole request, of which the plan may be a window.
    #[must_use]
    pub const fn total(&self) -> u128 {
        self.window.total
    }

    /// The number of points of the request that come before the plan's.
    #[must_use]
    pub const fn offset(&self) -> u128 {
        self.window.offset
    }

    /// Whether the plan is less than the whole request.
    #[must_use]
    pub const fn is_window(&self) -> bool {
        self.window.count < self.window.total
    }

    /// The points from number `offset` of this plan on, at most `limit`; none from its end on.
    ///
    /// ```
    /// use strew_core::space::{Region, SpaceSet, Table};
    ///
    /// let set = SpaceSet::new(Table::undisplaced("sqrt(3)".parse()?, 5, "pattern")?);
    /// // 10¹⁸ points, of which two in the middle are made.
    /// let plan = set.within(Region::new([-5e5; 3], [5e5; 3])?)?;
    /// assert_eq!(plan.window(plan.count() / 2, Some(2)).to_vec().len(), 2);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn window(&self, offset: u128, limit: Option<u128>) -> Self {
        self.window_from(offset, limit)
    }

    /// The points of the request from one of its [cursors](Cursor) on, found without counting.
    #[must_use]
    pub fn from_cursor(&self, cursor: Cursor) -> Self {
        self.window_at(cursor)
    }

    /// The plan cut into `parts` windows, one after another, whose sizes differ by at most one. 0 parts count as 1.
    pub fn split(&self, parts: u32) -> impl Iterator<Item = Self> + use<> {
        self.clone().split_in(parts)
    }

    /// The place of the first point, or `None` if there are no points.
    #[must_use]
    pub fn cursor(&self) -> Option<Cursor> {
        self.first_cursor()
    }

    /// The places of the points of some numbers, which ascend; `None` from the plan's end on. Finding many takes little
    /// longer than finding one.
    ///
    /// ```
    /// use strew_core::space::{SpaceSet, Table};
    ///
    /// let plan = SpaceSet::new(Table::undisplaced("sqrt(3)".parse()?, 5, "pattern")?).chunk(20.0, [0, 0, 0])?;
    /// let cursors = plan.cursors(&[50, 600]);
    /// assert_eq!(cursors[1], plan.window(600, None).cursor());
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn cursors(&self, numbers: &[u128]) -> Vec<Option<Cursor>> {
        self.cursors_at(numbers)
    }

    /// The place of the first point of the request after the plan's last, or `None` at the end.
    #[must_use]
    pub fn next_cursor(&self) -> Option<Cursor> {
        self.cursor_after()
    }
}
