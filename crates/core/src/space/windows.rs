//! Windows: parts of a request's points, and the cursors between them.

use alloc::vec::Vec;

use super::{
    count,
    cursor::Cursor,
    plan::{Plan, Window},
    point::PointId,
};

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
        let window = self.window;
        let offset = offset.min(window.count);
        let count = (window.count - offset).min(limit.unwrap_or(u128::MAX));
        let mut start = window.start;
        if offset > 0 && count > 0 {
            start = self.locate(window.offset + offset);
        }
        self.with_window(Window {
            start,
            offset: window.offset + offset,
            count,
            total: window.total,
        })
    }

    /// The points of the request from one of its [cursors](Cursor) on, found without counting.
    ///
    /// ```
    /// use strew_core::space::{SpaceSet, Table};
    ///
    /// let plan = SpaceSet::new(Table::undisplaced("sqrt(3)".parse()?, 5, "pattern")?).chunk(20.0, [0, 0, 0])?;
    /// let cursor = plan.window(50, None).cursor().expect("not empty");
    /// assert_eq!(plan.from_cursor(cursor).to_vec(), plan.to_vec()[50..]);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn from_cursor(&self, cursor: Cursor) -> Self {
        let total = self.window.total;
        let offset = cursor.offset.min(total);
        self.with_window(Window {
            start: (offset > 0).then_some(cursor.at.lattice()),
            offset,
            count: total - offset,
            total,
        })
    }

    /// The plan cut into `parts` windows, one after another, whose sizes differ by at most one. 0 parts count as 1.
    ///
    /// ```
    /// use strew_core::space::{SpaceSet, Table};
    ///
    /// let plan = SpaceSet::new(Table::undisplaced("sqrt(3)".parse()?, 5, "pattern")?).chunk(20.0, [0, 0, 0])?;
    /// let counts: Vec<u128> = plan.window(0, Some(10)).split(4).map(|part| part.count()).collect();
    /// assert_eq!(counts, [3, 3, 2, 2]);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn split(&self, parts: u32) -> impl Iterator<Item = Self> + use<> {
        /// The most parts that are found together.
        const AT_ONCE: u128 = 4096;
        let parts = u128::from(parts.max(1));
        let (quotient, rest) = (self.count() / parts, self.count() % parts);
        let start = move |i: u128| i * quotient + i.min(rest);
        let plan = self.clone();
        (0..parts.div_ceil(AT_ONCE)).flat_map(move |batch| {
            let numbers = batch * AT_ONCE..parts.min((batch + 1) * AT_ONCE);
            let starts: Vec<u128> = numbers.clone().map(start).collect();
            let cursors = plan.cursors(&starts).into_iter();
            let part = |(i, cursor): (u128, Option<Cursor>)| {
                let from = cursor.map_or_else(
                    || plan.window(plan.count(), None),
                    |at| plan.from_cursor(at),
                );
                from.window(0, Some(start(i + 1) - start(i)))
            };
            numbers.zip(cursors).map(part).collect::<Vec<_>>()
        })
    }

    /// The place of the first point, or `None` if there are no points.
    ///
    /// ```
    /// use strew_core::space::{SpaceSet, Table};
    ///
    /// let plan = SpaceSet::new(Table::undisplaced("sqrt(3)".parse()?, 5, "pattern")?).chunk(20.0, [0, 0, 0])?;
    /// let cursor = plan.window(50, None).cursor().expect("not empty");
    /// assert_eq!((cursor.offset, cursor.at), (50, plan.to_vec()[50].id));
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn cursor(&self) -> Option<Cursor> {
        self.cursors(&[0]).pop().flatten()
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
        let Window {
            start,
            offset,
            count,
            total,
        } = self.window;
        let inside = &numbers[..numbers.partition_point(|&k| k < count)];
        // The place of the first point may be known.
        let first = start.map_or(0, |_| inside.partition_point(|&k| k == 0));
        let sought: Vec<u128> = inside[first..].iter().map(|k| offset + k).collect();
        let known = core::iter::repeat_n(start, first);
        let found = known.chain(self.locate_all(&sought));
        let mut cursors: Vec<Option<Cursor>> = inside
            .iter()
            .zip(found)
            .map(|(k, at)| {
                let (offset, at) = (offset + k, PointId::of(at?));
                Some(Cursor { offset, total, at })
            })
            .collect();
        cursors.resize(numbers.len(), None);
        cursors
    }

    /// The place of the first point of the request after the plan's last, or `None` at the end.
    ///
    /// ```
    /// use strew_core::space::{SpaceSet, Table};
    ///
    /// let plan = SpaceSet::new(Table::undisplaced("sqrt(3)".parse()?, 5, "pattern")?).chunk(20.0, [0, 0, 0])?;
    /// let next = plan.window(0, Some(50)).next_cursor().expect("there are more");
    /// assert_eq!(plan.from_cursor(next).offset(), 50);
    /// assert_eq!(plan.next_cursor(), None);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn next_cursor(&self) -> Option<Cursor> {
        let total = self.window.total;
        let offset = self.window.offset + self.window.count;
        let at = PointId::of(self.locate(offset)?);
        Some(Cursor { offset, total, at })
    }

    /// The address of point number `k` of the request; `None` from its end on.
    fn locate(&self, k: u128) -> Option<[i64; 3]> {
        let is_inside = k < self.window.total;
        is_inside.then(|| self.locate_all(&[k]).pop().flatten())?
    }

    /// The addresses of points of the request of some numbers, which ascend.
    fn locate_all(&self, numbers: &[u128]) -> Vec<Option<[i64; 3]>> {
        match &self.kept {
            Some(kept) => {
                let address = |&k: &u128| kept.address(usize::try_from(k).ok()?);
                numbers.iter().map(address).collect()
            }
            None => count::locate_all(&self.scope, numbers),
        }
    }

    fn with_window(&self, window: Window) -> Self {
        Self {
            window,
            ..self.clone()
        }
    }
}
