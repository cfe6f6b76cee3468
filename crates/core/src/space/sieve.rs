//! The walk over the points of a scope that keep clear of other sets.
//!
//! The other set's points around a patch of the walk are made once and laid into a grid, in which each point looks around
//! itself. Where they would be too many, each point looks for those near it alone. Both compare the same coordinates.

use alloc::{sync::Arc, vec, vec::Vec};
use core::ops::Range;

use super::{
    batch::Batch,
    columns::COLUMN_BITS,
    lattice::{Lattice, fixed},
    mask::{ClearOf, Mask},
    point::{Point, PointId},
    scope::Scope,
    volume::{Region, Volume},
    walk::{PATCH_BITS, SLAB_BITS, Walk},
};
use crate::{sample::Backend, stop::Stop};

/// The most points of another set that are made together.
const MANY: f64 = 500_000.0;

/// A walk over the points of a scope that its mask leaves.
#[derive(Clone, Debug)]
pub(super) struct Sifted {
    walk: Walk,
    scope: Arc<Scope>,
    ranges: [Range<i64>; 3],
    /// The origin of the patch that the others are made for.
    origin: Option<[i64; 3]>,
    others: Vec<Others>,
}

/// The points of another set around a patch.
#[derive(Clone, Debug)]
enum Others {
    Grid(Grid),
    /// Too many to be made together.
    Each,
}

/// Points by the cells of a grid.
#[derive(Clone, Debug)]
struct Grid {
    corner: [f64; 3],
    /// The inverse of the side of a cell.
    scale: f64,
    cells: [usize; 3],
    /// For each cell where its points begin; then the end.
    starts: Vec<u32>,
    points: Vec<[f64; 3]>,
}

impl Sifted {
    /// As [`Walk::new`].
    pub(super) fn new(
        scope: Arc<Scope>,
        ranges: &[Range<i64>; 3],
        start: Option<[i64; 3]>,
        wants_ids: bool,
    ) -> Self {
        Self {
            walk: Walk::new(scope.clone(), ranges, start, wants_ids),
            ranges: scope.clip(ranges),
            scope,
            origin: None,
            others: Vec::new(),
        }
    }

    pub(super) fn backend(&self) -> Backend {
        self.walk.backend
    }

    pub(super) fn set_backend(&mut self, backend: Backend) {
        self.walk.backend = backend;
    }

    /// Fills a batch with the next points, at least one. Returns false if there are none.
    pub(super) fn next(&mut self, out: &mut Batch) -> bool {
        while self.walk.next(out) {
            if !self.scope.clear.is_empty() {
                self.sift(out);
            }
            if !out.is_empty() {
                return true;
            }
        }
        false
    }

    /// Removes the points that are too near others.
    fn sift(&mut self, out: &mut Batch) {
        let (scope, origin) = (&*self.scope, out.origin);
        if self.origin != Some(origin) {
            let sizes = [1 << COLUMN_BITS, 1 << PATCH_BITS, 1 << SLAB_BITS];
            let patch = [0, 1, 2].map(|axis| {
                let range = &self.ranges[axis];
                let end = (origin[axis] + sizes[axis]).min(range.end);
                origin[axis].max(range.start)..end
            });
            let around = scope.spread(&patch);
            let others = scope.clear.iter();
            self.others = others
                .map(|clear| Others::around(clear, &around, &scope.stop))
                .collect();
            self.origin = Some(origin);
        }
        for (clear, others) in scope.clear.iter().zip(&self.others) {
            out.retain(|place| {
                let at = [0, 1, 2].map(|axis| {
                    let place = fixed(origin[axis]) + i64::from(place[axis]);
                    scope.lattice.world(place)
                });
                match others {
                    Others::Grid(grid) => !grid.has_near(at, clear.distance),
                    Others::Each => !is_near(clear, at, &scope.stop),
                }
            });
        }
    }
}

impl Others {
    fn around(clear: &ClearOf, around: &Region, stop: &Stop) -> Self {
        let region = grown(clear, around);
        let spacing = clear.lattice.placement.spacing.get();
        let sides = [0, 1, 2].map(|axis| (region.max()[axis] - region.min()[axis]) / spacing);
        let about: f64 = sides.into_iter().product();
        if about > MANY {
            return Self::Each;
        }
        let mut points = Vec::with_capacity(about as usize);
        visit(clear, &region, stop, |at| {
            points.push(at);
            true
        });
        // A little wider, so that rounding puts no point that is near two cells away.
        let side = clear.distance.max(spacing) * (1.0 + 1e-9);
        Self::Grid(Grid::new(&region, side, &points))
    }
}

impl Grid {
    fn new(region: &Region, side: f64, unsorted: &[[f64; 3]]) -> Self {
        let (corner, scale) = (region.min(), 1.0 / side);
        let across = |axis: usize| (region.max()[axis] - corner[axis]) * scale;
        let mut grid = Self {
            corner,
            scale,
            cells: [0, 1, 2].map(|axis| across(axis) as usize + 1),
            starts: Vec::new(),
            points: vec![[0.0; 3]; unsorted.len()],
        };
        let [nx, ny, nz] = grid.cells;
        let mut starts = vec![0u32; nx * ny * nz + 1];
        let of = |at: [f64; 3]| grid.number([0, 1, 2].map(|axis| grid.cell(axis, at[axis])));
        for &at in unsorted {
            starts[of(at) + 1] += 1;
        }
        for i in 1..starts.len() {
            starts[i] += starts[i - 1];
        }
        let mut next = starts.clone();
        let mut points = core::mem::take(&mut grid.points);
        for &at in unsorted {
            let place = &mut next[grid.number([0, 1, 2].map(|axis| grid.cell(axis, at[axis])))];
            points[*place as usize] = at;
            *place += 1;
        }
        (grid.starts, grid.points) = (starts, points);
        grid
    }

    fn cell(&self, axis: usize, v: f64) -> usize {
        // A float below 0 becomes 0.
        (((v - self.corner[axis]) * self.scale) as usize).min(self.cells[axis] - 1)
    }

    fn number(&self, [i, j, k]: [usize; 3]) -> usize {
        (k * self.cells[1] + j) * self.cells[0] + i
    }

    /// Whether a point is nearer to a place than a distance, which is less than the side of a cell.
    fn has_near(&self, at: [f64; 3], distance: f64) -> bool {
        let cells = [0, 1, 2].map(|axis| {
            let own = self.cell(axis, at[axis]);
            own.saturating_sub(1)..(own + 2).min(self.cells[axis])
        });
        for k in cells[2].clone() {
            for j in cells[1].clone() {
                let first = self.number([cells[0].start, j, k]);
                let last = self.number([cells[0].end - 1, j, k]);
                let points = self.starts[first] as usize..self.starts[last + 1] as usize;
                if self.points[points]
                    .iter()
                    .any(|&p| is_nearer(p, at, distance))
                {
                    return true;
                }
            }
        }
        false
    }
}

/// Whether two places are nearer than a distance.
fn is_nearer(a: [f64; 3], b: [f64; 3], distance: f64) -> bool {
    let [dx, dy, dz] = [0, 1, 2].map(|axis| a[axis] - b[axis]);
    dx * dx + dy * dy + dz * dz < distance * distance
}

/// A box grown by the distance that is kept, within the reach of the other set.
fn grown(clear: &ClearOf, region: &Region) -> Region {
    let (wide, limit) = (clear.distance * (1.0 + 1e-12), clear.lattice.limit());
    let min = region
        .min()
        .map(|v| (v - wide).next_down().clamp(-limit, limit));
    let max = region
        .max()
        .map(|v| (v + wide).next_up().next_up().clamp(-limit, limit));
    Region::between(min, max)
}

/// Visits the places of the points of another set in a box, until one is refused.
fn visit(clear: &ClearOf, region: &Region, stop: &Stop, mut each: impl FnMut([f64; 3]) -> bool) {
    let volume = Volume::Region(*region);
    // Beyond the limit there are no points.
    let Ok(scope) = Scope::new(&clear.lattice, &clear.mask, &volume, stop.clone()) else {
        return;
    };
    let scope = Arc::new(scope);
    let mut walk = Sifted::new(scope.clone(), &scope.all, None, false);
    let mut batch = Batch::default();
    while walk.next(&mut batch) {
        for i in 0..batch.len() {
            let at = [0, 1, 2].map(|axis| {
                let place = fixed(batch.origin[axis]) + i64::from(batch.places[axis][i]);
                clear.lattice.world(place)
            });
            if !each(at) {
                return;
            }
        }
    }
}

/// Whether a point of another set is nearer to a place than it may be.
fn is_near(clear: &ClearOf, at: [f64; 3], stop: &Stop) -> bool {
    let mut found = false;
    let region = grown(clear, &Region::between(at, at));
    visit(clear, &region, stop, |other| {
        found |= is_nearer(other, at, clear.distance);
        !found
    });
    found
}

/// The point of an address that a mask leaves.
pub(super) fn point(lattice: &Lattice, mask: &Mask, id: PointId) -> Option<Point> {
    let point = lattice.point(id)?;
    if mask.is_none() {
        return Some(point);
    }
    let at = point.at();
    let volume = Volume::Region(Region::between(at, at.map(f64::next_up)));
    // Beyond the limit there are no points.
    let scope = Arc::new(Scope::new(lattice, mask, &volume, Stop::default()).ok()?);
    let mut walk = Sifted::new(scope.clone(), &scope.all, None, true);
    let mut batch = Batch::default();
    while walk.next(&mut batch) {
        let mut addresses = (0..batch.len()).map(|i| batch.address(i));
        if addresses.any(|address| address == Some(id.lattice())) {
            return Some(point);
        }
    }
    None
}
