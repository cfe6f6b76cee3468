//! Where a walk is.

/// The place of the next point in a band.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    /// The current row; the end of the rows when a new band is due.
    pub(super) y: i64,
    /// The number of columns of the row's template that are done.
    pub(super) done: usize,
    /// The lattice column where the current row begins, if it is the first of a window.
    pub(super) from: Option<i64>,
}

impl Place {
    pub(super) const fn row(y: i64) -> Self {
        Self {
            y,
            done: 0,
            from: None,
        }
    }

    /// Whether nothing of the row is done.
    pub(super) const fn is_fresh(&self) -> bool {
        self.done == 0 && self.from.is_none()
    }

    pub(super) const fn next_row(&mut self) {
        *self = Self::row(self.y + 1);
    }
}
