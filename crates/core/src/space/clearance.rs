//! The points that keep clear of other sets, which keep clear of further sets themselves.
//!
//! A [`Clearance`] lists each of these sets once, however many others keep clear of it, and remembers what it made. Space
//! is cut into tiles for each set. The points of a set in a tile are made when a place in or beside it is first tested, and
//! whether one of them stays is decided once, when it first lies near a tested place. So a chain of sets costs the sum of
//! its members, not their product.
//!
//! Where few places are tested, each looks at the points around itself instead. All ways compare the same coordinates.

use alloc::{collections::BTreeMap, sync::Arc, vec, vec::Vec};
use core::ops::Range;

use super::{
    Batch, Region, Volume,
    lattice::{Lattice, fixed},
    mask::{ClearOf, Mask},
    point::{Point, PointId},
    scope::Scope,
    settled::{self, AnyWalk},
    walk::few,
};
use crate::{kernel::Backend, stop::Stop};

/// The sides of a tile, in mean spacings of the set. They are flat because walks go plane by plane.
const TILE: [f64; 3] = [16.0, 16.0, 2.0];
/// The sides of tiles of thinned sets grow up to this factor.
const THINNED: f64 = 4.0;
/// Fewer tested places for each tile look for points by themselves.
const WORTH: f64 = 4.0;
/// The most points that are kept of a set, 24 bytes each; beyond that its tiles are dropped and made again.
const MOST: usize = 1 << 19;
/// A tile without points counts as this many.
const EMPTY: usize = 16;

/// The sets that the points of a scope keep clear of, and the points of these sets that are known.
#[derive(Clone, Debug, Default)]
pub(super) struct Clearance {
    own: Vec<Edge>,
    /// Each keeps clear of earlier ones alone.
    others: Vec<Other>,
}

/// The distance that is kept from another set.
#[derive(Clone, Debug)]
struct Edge {
    other: usize,
    distance: f64,
    /// Whether too few places are tested to make tiles.
    is_rare: bool,
}

/// A set that others keep clear of.
#[derive(Clone, Debug)]
struct Other {
    lattice: Lattice,
    /// The mask of the set, and the part of it that the sets before do not decide.
    mask: Mask,
    within: Mask,
    edges: Vec<Edge>,
    sides: [f64; 3],
    tiles: BTreeMap<[i64; 3], Tile>,
    held: usize,
}

/// The points of a tile, by the cells of a grid.
#[derive(Clone, Debug, Default)]
struct Tile {
    corner: [f64; 3],
    /// The inverse of the side of a cell.
    scale: f64,
    cells: [usize; 3],
    /// For each cell where its points begin; then the end. Empty without points.
    starts: Vec<u32>,
    points: Vec<[f64; 3]>,
    /// Whether each of them stays, once that is decided.
    stays: Vec<Option<bool>>,
}

impl Clearance {
    /// The sets that the points of a scope keep clear of.
    pub(super) fn new(scope: &Scope) -> Self {
        let mut others = Vec::new();
        let mut own = list(&scope.clear, &mut others);
        let spacing = scope.lattice.spacing_kept();
        let sides = [0, 1, 2].map(|axis| scope.region.max()[axis] - scope.region.min()[axis]);
        let places: f64 = sides.iter().map(|side| side / spacing).product();
        for edge in &mut own {
            let tile = others[edge.other].sides;
            let tiles: f64 = (0..3).map(|axis| sides[axis] / tile[axis] + 1.0).product();
            edge.is_rare = places < WORTH * tiles;
        }
        Self { own, others }
    }

    /// Removes the points of a batch of a scope that are too near others.
    pub(super) fn sift(&mut self, scope: &Scope, batch: &mut Batch) {
        if self.own.is_empty() || scope.stop.is_raised() {
            return;
        }
        let origin = batch.origin;
        for edge in &self.own {
            batch.retain(|place| {
                let place = |axis| fixed(origin[axis]) + i64::from(place[axis]);
                let at = scope.lattice.at([0, 1, 2].map(place));
                !edge.is_near(&mut self.others, at, &scope.stop)
            });
        }
    }
}

/// The edges to some sets, which are added to the list with those that they keep clear of.
fn list(clear: &[ClearOf], others: &mut Vec<Other>) -> Vec<Edge> {
    let mut edges = Vec::with_capacity(clear.len());
    for ClearOf {
        lattice,
        mask,
        distance,
    } in clear
    {
        let known = others
            .iter()
            .position(|other| other.lattice.is_same(lattice) && other.mask.is_same(mask));
        let other = known.unwrap_or_else(|| {
            let edges = list(&mask.clear, others);
            others.push(Other::new(lattice, mask, edges));
            others.len() - 1
        });
        for side in &mut others[other].sides {
            *side = side.max(*distance);
        }
        edges.push(Edge {
            other,
            distance: *distance,
            is_rare: false,
        });
    }
    edges
}

impl Edge {
    /// Whether a point of the other set is nearer to a place than it may be.
    fn is_near(&self, others: &mut [Other], at: [f64; 3], stop: &Stop) -> bool {
        let (earlier, rest) = others.split_at_mut(self.other);
        let (other, distance) = (&mut rest[0], self.distance);
        // More than rounding takes.
        let room = at.map(|v| distance * (1.0 + 1e-9) + v.abs() * 1e-15);
        let [min, max] = [-1.0, 1.0].map(|sign| [0, 1, 2].map(|i| at[i] + sign * room[i]));
        if self.is_rare {
            let around = Region::between(min, max);
            let mut found = false;
            other.visit(&around, stop, |at_other| {
                found = is_nearer(at_other, at, distance)
                    && !other
                        .edges
                        .iter()
                        .any(|edge| edge.is_near(earlier, at_other, stop));
                !found
            });
            return found;
        }
        let [first, last] =
            [min, max].map(|p| [0, 1, 2].map(|i| libm::floor(p[i] / other.sides[i]) as i64));
        for z in first[2]..=last[2] {
            for y in first[1]..=last[1] {
                for x in first[0]..=last[0] {
                    let is_known = other.make([x, y, z], stop);
                    let Some(tile) = other.tiles.get_mut(&[x, y, z]).filter(|_| is_known) else {
                        return false;
                    };
                    let stays = |point| {
                        !other
                            .edges
                            .iter()
                            .any(|edge| edge.is_near(earlier, point, stop))
                    };
                    if tile.has_near(at, [min, max], distance, stays) {
                        return true;
                    }
                }
            }
        }
        false
    }
}

impl Other {
    fn new(lattice: &Lattice, mask: &Mask, edges: Vec<Edge>) -> Self {
        let spacing = lattice.placement.spacing.get();
        let wide = (lattice.spacing_kept() / spacing).min(THINNED);
        Self {
            lattice: lattice.clone(),
            mask: mask.clone(),
            within: mask.of_itself(),
            edges,
            sides: TILE.map(|side| side * spacing * wide),
            tiles: BTreeMap::new(),
            held: 0,
        }
    }

    /// Makes a tile if it is not known. Returns false once the flag is raised.
    fn make(&mut self, at: [i64; 3], stop: &Stop) -> bool {
        if self.tiles.contains_key(&at) {
            return true;
        }
        if stop.is_raised() {
            return false;
        }
        let corner = |by: i64| [0, 1, 2].map(|i| at[i].saturating_add(by) as f64 * self.sides[i]);
        let region = Region::between(corner(0), corner(1));
        let mut points = Vec::new();
        self.visit(&region, stop, |point| {
            points.push(point);
            true
        });
        let holds = points.len().max(EMPTY);
        if self.held + holds > MOST {
            self.tiles.clear();
            self.held = 0;
        }
        self.held += holds;
        let tile = Tile::new(&region, self.lattice.spacing_kept(), &points);
        self.tiles.insert(at, tile);
        true
    }

    /// Visits the places of the points in a box, also of those that earlier sets remove, until one is refused.
    fn visit(&self, region: &Region, stop: &Stop, mut each: impl FnMut([f64; 3]) -> bool) {
        let limit = self.lattice.limit();
        let [min, max] = [region.min(), region.max()].map(|v| v.map(|v| v.clamp(-limit, limit)));
        let region = Region::between(min, max);
        let Some(mask) = self.within.focused(&region) else {
            return;
        };
        let volume = Volume::Region(region);
        // Beyond the limit there are no points.
        let Ok(scope) = Scope::new(&self.lattice, &mask, &volume, stop.clone()) else {
            return;
        };
        let scope = Arc::new(scope);
        let mut all =
            |batch: &Batch| (0..batch.len()).all(|i| each(self.lattice.at(batch.place(i))));
        let few = if scope.is_small() { few(&scope) } else { None };
        if let Some(few) = few {
            all(&few);
            return;
        }
        let mut walk = AnyWalk::new(scope.clone(), &scope.all, None, false);
        let mut batch = Batch::default();
        while walk.next(&mut batch) && all(&batch) {}
    }
}

impl Tile {
    /// Points in a box, in cells with about the side `side`.
    fn new(region: &Region, side: f64, unsorted: &[[f64; 3]]) -> Self {
        if unsorted.is_empty() {
            return Self::default();
        }
        let (corner, scale) = (region.min(), 1.0 / side);
        let across = |axis: usize| (region.max()[axis] - corner[axis]) * scale;
        let cells = [0, 1, 2].map(|axis| across(axis) as usize + 1);
        let mut tile = Self {
            corner,
            scale,
            cells,
            starts: vec![0; cells.iter().product::<usize>() + 1],
            points: vec![[0.0; 3]; unsorted.len()],
            stays: vec![None; unsorted.len()],
        };
        let own = |tile: &Self, at: [f64; 3]| {
            tile.number([0, 1, 2].map(|axis| tile.cell(axis, at[axis])))
        };
        for &at in unsorted {
            let cell = own(&tile, at);
            tile.starts[cell] += 1;
        }
        let mut sum = 0;
        for start in &mut tile.starts {
            sum += *start;
            *start = sum;
        }
        // Each point moves the end of its cell down, in the end to where the cell begins.
        for &at in unsorted {
            let cell = own(&tile, at);
            tile.starts[cell] -= 1;
            tile.points[tile.starts[cell] as usize] = at;
        }
        tile
    }

    /// The cell of a coordinate, which never falls where the coordinate grows. A float below 0 becomes 0.
    fn cell(&self, axis: usize, v: f64) -> usize {
        (((v - self.corner[axis]) * self.scale) as usize).min(self.cells[axis] - 1)
    }

    fn number(&self, [i, j, k]: [usize; 3]) -> usize {
        (k * self.cells[1] + j) * self.cells[0] + i
    }

    /// Whether a point that stays is nearer to a place than a distance; all such points lie between two corners.
    fn has_near(
        &mut self,
        at: [f64; 3],
        [min, max]: [[f64; 3]; 2],
        distance: f64,
        mut stays: impl FnMut([f64; 3]) -> bool,
    ) -> bool {
        if self.points.is_empty() {
            return false;
        }
        let [first, last] = [min, max].map(|p| [0, 1, 2].map(|axis| self.cell(axis, p[axis])));
        for k in first[2]..=last[2] {
            for j in first[1]..=last[1] {
                let [from, to] =
                    [first[0], last[0] + 1].map(|i| self.starts[self.number([i, j, k])] as usize);
                let points = self.points[from..to].iter().zip(&mut self.stays[from..to]);
                for (&point, decided) in points {
                    if is_nearer(point, at, distance)
                        && *decided.get_or_insert_with(|| stays(point))
                    {
                        return true;
                    }
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

/// A walk over the points of a scope that its mask leaves.
#[derive(Clone, Debug)]
pub(super) struct Sifted {
    walk: AnyWalk,
    backend: Backend,
    scope: Arc<Scope>,
    clearance: Clearance,
}

impl Sifted {
    /// As [`AnyWalk::new`].
    pub(super) fn new(
        scope: Arc<Scope>,
        ranges: &[Range<i64>; 3],
        start: Option<[i64; 3]>,
        wants_ids: bool,
    ) -> Self {
        Self {
            walk: AnyWalk::new(scope.clone(), ranges, start, wants_ids),
            clearance: Clearance::new(&scope),
            scope,
            backend: Backend::best(),
        }
    }

    pub(super) fn backend(&self) -> Backend {
        self.backend
    }

    pub(super) fn set_backend(&mut self, backend: Backend) {
        self.backend = backend;
        self.walk.set_backend(backend);
    }

    /// Fills a batch with the next points, at least one. Returns false if there are none.
    pub(super) fn next(&mut self, out: &mut Batch) -> bool {
        while self.walk.next(out) {
            self.clearance.sift(&self.scope, out);
            if !out.is_empty() {
                return true;
            }
        }
        false
    }
}

/// The point of an address that a mask leaves.
pub(super) fn point(lattice: &Lattice, mask: &Mask, id: PointId) -> Option<Point> {
    let point = settled::point(lattice, id)?;
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
