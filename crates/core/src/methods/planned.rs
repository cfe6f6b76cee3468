//! The methods of plans, the same in the plane, in space and of periods.

/// The windows of a plan, which is [`Windowed`](crate::window::Windowed) and has a field `window`. In the examples, `$make`
/// makes a plan of more than 700 points.
macro_rules! windows {
    ($Plan:ty, $Cursor:ty, $make:literal) => {
        impl $Plan {
            /// The number of points.
            #[must_use]
            pub const fn count(&self) -> u128 {
                self.window.count
            }

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

            /// Whether the plan leaves out points of its request.
            #[must_use]
            pub const fn is_window(&self) -> bool {
                self.window.count < self.window.total
            }

            /// The points from number `offset` of this plan on, at most `limit`; none from its end on. In a box without
            /// warp the place is found in O(log), elsewhere in time proportional to the rows, or in space to the surface.
            ///
            /// ```
            #[doc = concat!("# let plan = ", $make, ";")]
            /// let page = plan.window(50, Some(2));
            /// assert_eq!((page.count(), page.offset(), page.total()), (2, 50, plan.count()));
            /// # Ok::<(), strew_core::Error>(())
            /// ```
            #[must_use]
            pub fn window(&self, offset: u128, limit: Option<u128>) -> Self {
                self.window_from(offset, limit)
            }

            /// The points of the request from one of its [cursors](crate::Cursor) on, found without counting.
            #[must_use]
            pub fn from_cursor(&self, cursor: $Cursor) -> Self {
                self.window_at(cursor)
            }

            /// The place of the first point, or `None` if there are no points.
            #[must_use]
            pub fn cursor(&self) -> Option<$Cursor> {
                self.first_cursor()
            }

            /// The place of the first point of the request after the plan's last, or `None` at the end.
            ///
            /// ```
            #[doc = concat!("# let plan = ", $make, ";")]
            /// let next = plan.window(0, Some(50)).next_cursor().expect("there are more");
            /// assert_eq!(plan.from_cursor(next).offset(), 50);
            /// assert_eq!(plan.next_cursor(), None);
            /// # Ok::<(), strew_core::Error>(())
            /// ```
            #[must_use]
            pub fn next_cursor(&self) -> Option<$Cursor> {
                self.cursor_after()
            }

            /// The places of the points of some numbers, which ascend; `None` from the plan's end on. Finding many takes
            /// little longer than finding one.
            ///
            /// ```
            #[doc = concat!("# let plan = ", $make, ";")]
            /// let cursors = plan.cursors(&[50, 600]);
            /// assert_eq!(cursors[1], plan.window(600, None).cursor());
            /// # Ok::<(), strew_core::Error>(())
            /// ```
            #[must_use]
            pub fn cursors(&self, numbers: &[u128]) -> Vec<Option<$Cursor>> {
                self.cursors_at(numbers)
            }

            /// The plan cut into `parts` windows, one after another, whose sizes differ by at most one. 0 parts count as
            /// 1.
            ///
            /// ```
            #[doc = concat!("# let plan = ", $make, ";")]
            /// let counts: Vec<u128> = plan.window(0, Some(10)).split(4).map(|part| part.count()).collect();
            /// assert_eq!(counts, [3, 3, 2, 2]);
            /// # Ok::<(), strew_core::Error>(())
            /// ```
            pub fn split(&self, parts: u32) -> impl Iterator<Item = Self> + use<> {
                self.clone().split_in(parts)
            }
        }
    };
}

/// The points of a plan, which has a `scope`, and its iterators. In the examples, `$make` makes a plan.
macro_rules! planned {
    ($Plan:ty, $Table:ty, $dimensions:literal, $make:literal) => {
        impl $Plan {
            /// The number of points, or `None` if it does not fit `usize`.
            #[must_use]
            pub fn len(&self) -> Option<usize> {
                usize::try_from(self.count()).ok()
            }

            /// Whether there are no points.
            #[must_use]
            pub const fn is_empty(&self) -> bool {
                self.window.count == 0
            }

            /// All points as a vector, in order.
            ///
            /// # Panics
            /// If they exceed the address space or the memory, as all vectors do; see [`len`](Self::len).
            #[must_use]
            pub fn to_vec(&self) -> Vec<Point> {
                let mut points = vec![Point::default(); self.len().unwrap_or(usize::MAX)];
                let filled = self.blocks_points().fill(&mut points);
                points.truncate(filled);
                points
            }

            /// The points as `f32` coordinates relative to [`origin`](Self::origin), block by block; see
            /// [`blocks`](Self::blocks).
            #[must_use]
            pub fn blocks_f32(&self) -> Blocks<F32> {
                self.blocks()
            }

            /// The points as `f64` world coordinates, block by block; see [`blocks`](Self::blocks).
            #[must_use]
            pub fn blocks_f64(&self) -> Blocks<F64> {
                self.blocks()
            }

            /// The points with their ids, block by block; see [`blocks`](Self::blocks).
            #[must_use]
            pub fn blocks_points(&self) -> Blocks<Points> {
                self.blocks()
            }

            /// A box around all points: the requested region, if that was a box.
            #[must_use]
            pub fn region(&self) -> Region {
                self.scope.region
            }

            /// The lower corner of the requested chunk, or else of the [region](Self::region), in world coordinates. [`F32`]
            /// coordinates and [`Offsets`](crate::Offsets) are relative to it; in a chunk to the exact corner, which this
            /// rounds to `f64`.
            #[must_use]
            pub fn origin(&self) -> [f64; $dimensions] {
                self.scope.corner.at
            }

            /// The table of the set.
            #[must_use]
            pub fn table(&self) -> &$Table {
                &self.scope.lattice.table
            }

            /// Spacing, seed, warp and share of the set.
            #[must_use]
            pub fn placement(&self) -> Placement {
                self.scope.lattice.placement
            }
        }

        impl IntoIterator for $Plan {
            type Item = <Members as Iterator>::Item;
            type IntoIter = Members;

            fn into_iter(self) -> Members {
                self.iter()
            }
        }

        impl IntoIterator for &$Plan {
            type Item = <Members as Iterator>::Item;
            type IntoIter = Members;

            fn into_iter(self) -> Members {
                self.iter()
            }
        }
    };
}

pub(crate) use {planned, windows};
