//! Plans: the points of a request, counted; windows of them; and the points block by block, and one by one.

use alloc::{boxed::Box, sync::Arc, vec, vec::Vec};
use core::{marker::PhantomData, ops::Range};

use super::{
    Batch, Cursor, Members, Point, Region, Volume,
    clearance::AnyWalk,
    count,
    format::{Format, write},
    lattice::Lattice,
    mask::Mask,
    point::PointId,
    scope::Scope,
    table::Table,
    walk::Rows,
};
use crate::{
    F32, F64, Placement, Points,
    error::Error,
    kernel::Backend,
    methods::{planned, windows},
    stop::Stop,
    window::{Window, Windowed},
};

/// The points of a volume, counted exactly before the first is made.
///
/// Points come in an order of their own: columns of 1024 × 1024 lattice units by x, then y; in a column planes by z, in a
/// plane rows by y, in a row points by x, all of them by their lattice addresses.
///
/// ```
/// use strew_core::space::{Ball, SpaceSet, Table};
///
/// let set = SpaceSet::new(Table::undisplaced("sqrt(3)".parse()?, 5, "pattern")?).seed(7);
/// let plan = set.within(Ball::new([0.0; 3], 9.0)?)?;
/// assert_eq!(plan.iter().count() as u128, plan.count());
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Plan {
    pub(super) scope: Arc<Scope>,
    pub(super) window: Window<PointId>,
    /// All points of the request, if they are few.
    pub(super) kept: Option<Arc<Batch>>,
}

impl Plan {
    /// The plan of a volume, which is counted unless its count is known.
    pub(super) fn new(
        lattice: &Lattice,
        mask: &Mask,
        volume: Volume,
        stop: Stop,
        total: Option<u128>,
    ) -> Result<Self, Error> {
        let scope = Arc::new(Scope::new(lattice, mask, &volume, stop)?);
        let mut kept = None;
        let total = match total {
            Some(total) => total,
            None if scope.is_small() => {
                let points = count::keep(&scope);
                let count = points.len() as u128;
                kept = Some(Arc::new(points));
                count
            }
            None => count::count(&scope, &scope.all),
        };
        if scope.stop.is_raised() {
            return Err(Stop::error());
        }
        Ok(Self {
            scope,
            window: Window::whole(total),
            kept,
        })
    }

    /// The points in a format, block by block.
    #[must_use]
    pub fn blocks<F: Format>(&self) -> Blocks<F> {
        let Window {
            start,
            offset,
            count,
            total,
        } = self.window;
        let blocks = match &self.kept {
            Some(kept) => {
                let points = offset as usize..(offset + count) as usize;
                Blocks::kept(self.scope.clone(), kept.clone(), points)
            }
            None => Blocks::walk(self.scope.clone(), start.map(PointId::lattice), count),
        };
        blocks.of(offset, total)
    }

    /// The points, one by one.
    #[must_use]
    pub fn iter(&self) -> Members {
        Members::new(self.blocks(), self.window.count, self.placement().seed)
    }

    /// The plan with a flag that stops counting and making points, in place of the one it had. Once it is raised, blocks
    /// end early.
    ///
    /// ```
    /// use strew_core::{server::Stop, space::{SpaceSet, Table}};
    ///
    /// let plan = SpaceSet::new(Table::undisplaced("sqrt(3)".parse()?, 5, "pattern")?).chunk(99.0, [0, 0, 0])?;
    /// let stop = Stop::new();
    /// stop.raise();
    /// assert!((plan.stopped_by(stop).to_vec().len() as u128) < 99 * 99 * 99);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn stopped_by(mut self, stop: Stop) -> Self {
        self.scope = Arc::new(Scope {
            stop,
            ..(*self.scope).clone()
        });
        self
    }
}

planned!(
    Plan,
    Table,
    3,
    "strew_core::space::SpaceSet::new(strew_core::space::Table::undisplaced(\"sqrt(3)\".parse()?, 5, \"pattern\")?).chunk(20.0, [0, 0, 0])?"
);

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

windows!(
    Plan,
    Cursor,
    "strew_core::space::SpaceSet::new(strew_core::space::Table::undisplaced(\"sqrt(3)\".parse()?, 5, \"pattern\")?).chunk(20.0, [0, 0, 0])?"
);

/// The points of a plan in a format, block by block.
///
/// ```
/// use strew_core::space::{SpaceSet, Table};
///
/// let plan = SpaceSet::new(Table::undisplaced("sqrt(3)".parse()?, 5, "pattern")?).chunk(20.0, [0, 0, 0])?;
/// let (mut blocks, mut block) = (plan.blocks_f32(), [[0.0; 3]; 1000]);
/// let mut points = 0;
/// loop {
///     match blocks.fill(&mut block) {
///         0 => break,
///         filled => points += filled,
///     }
/// }
/// assert_eq!(points as u128, plan.count());
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Blocks<F: Format> {
    scope: Arc<Scope>,
    source: Source<F>,
    /// The number of points to come.
    left: u128,
    /// The number of points of the request before these, and of all.
    offset: u128,
    total: u128,
    format: PhantomData<F>,
}

/// Where points come from.
#[derive(Clone, Debug)]
enum Source<F: Format> {
    Rows(Box<Rows<F>>),
    Walk(Box<Walking>),
    Kept(Arc<Batch>, Range<usize>),
}

/// A walk and the batch that it filled last.
#[derive(Clone, Debug)]
struct Walking {
    walk: AnyWalk,
    backend: Backend,
    batch: Batch,
    /// The points of the batch that were written.
    written: usize,
}

impl<F: Format> Blocks<F> {
    /// The next `left` points of a scope from a place on.
    pub(super) fn walk(scope: Arc<Scope>, start: Option<[i64; 3]>, left: u128) -> Self {
        let lattice = &scope.lattice;
        let is_plain = lattice.shears.is_none() && !lattice.is_sifted() && scope.room == 0;
        let source = if is_plain && scope.clear.is_empty() {
            Source::Rows(Box::new(Rows::new(scope.clone(), start)))
        } else {
            let walk = AnyWalk::new(scope.clone(), &scope.all, start, F::HAS_IDS);
            Source::Walk(Box::new(Walking {
                walk,
                backend: Backend::best(),
                batch: Batch::default(),
                written: 0,
            }))
        };
        Self {
            scope,
            source,
            left,
            offset: 0,
            total: left,
            format: PhantomData,
        }
    }

    /// Some points that were kept.
    pub(super) fn kept(scope: Arc<Scope>, kept: Arc<Batch>, points: Range<usize>) -> Self {
        Self {
            scope,
            left: points.len() as u128,
            offset: 0,
            total: points.len() as u128,
            source: Source::Kept(kept, points),
            format: PhantomData,
        }
    }

    /// The same blocks as a part of a request.
    pub(super) fn of(mut self, offset: u128, total: u128) -> Self {
        (self.offset, self.total) = (offset, total);
        self
    }

    /// Sets the backend; see [`Backend`]. The points are the same.
    #[must_use]
    pub fn with_backend(mut self, backend: Backend) -> Self {
        match &mut self.source {
            Source::Rows(rows) => rows.backend = backend,
            Source::Walk(walking) => {
                walking.backend = backend;
                walking.walk.set_backend(backend);
            }
            Source::Kept(..) => {}
        }
        self
    }

    /// Fills a slice with the next points. Returns the number of points written: less than the slice holds only at the
    /// end.
    pub fn fill(&mut self, out: &mut [F::Item]) -> usize {
        let most = usize::try_from(self.left)
            .unwrap_or(usize::MAX)
            .min(out.len());
        let mut filled = 0;
        while filled < most {
            let room = &mut out[filled..most];
            match &mut self.source {
                Source::Kept(batch, points) => {
                    let from = points.start;
                    points.start += room.len();
                    write::<F>(&self.scope, batch, from, Backend::best(), room);
                    filled = most;
                }
                Source::Rows(rows) => {
                    let number = rows.fill(room);
                    filled += number;
                    if number == 0 {
                        self.left = 0;
                        return filled;
                    }
                    // The cursor is the address of the next point.
                    if F::HAS_IDS && filled as u128 != self.left {
                        rows.prepare();
                    }
                }
                Source::Walk(walking) => {
                    let Walking {
                        walk,
                        backend,
                        batch,
                        written,
                    } = &mut **walking;
                    if *written == batch.len() {
                        *written = 0;
                        if !walk.next(batch) {
                            batch.restart([0; 3]);
                            self.left = 0;
                            return filled;
                        }
                    }
                    let number = room.len().min(batch.len() - *written);
                    let from = *written;
                    *written += number;
                    write::<F>(&self.scope, batch, from, *backend, &mut room[..number]);
                    filled += number;
                    // The cursor is the address of the next point.
                    if *written == batch.len() && filled as u128 != self.left {
                        *written = 0;
                        if !walk.next(batch) {
                            batch.restart([0; 3]);
                        }
                    }
                }
            }
        }
        self.left -= filled as u128;
        self.offset += filled as u128;
        filled
    }
}

impl Blocks<Points> {
    /// The place of the next point, if there is one and some were taken.
    #[must_use]
    pub fn cursor(&self) -> Option<Cursor> {
        if self.left == 0 {
            return None;
        }
        let at = match &self.source {
            Source::Kept(batch, points) => batch.address(points.start),
            Source::Walk(walking) => walking.batch.address(walking.written),
            Source::Rows(rows) => rows.peek().map(|point| point.id.lattice()),
        };
        Some(Cursor {
            offset: self.offset,
            total: self.total,
            at: PointId::of(at?),
        })
    }
}
