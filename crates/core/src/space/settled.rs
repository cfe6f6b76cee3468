//! Points of space that settle: how they are listed, and the walk over them, piece by piece.
//!
//! A piece is a slab of a column of planes, cut into tiles. The points around a tile are listed where the warp left them,
//! all of them settle (`settle/` has the steps), and those of the tile that end inside are given in the order of
//! their addresses. Pieces and tiles decide only the cost: a point goes to the same place in each.

use alloc::{boxed::Box, sync::Arc, vec, vec::Vec};
use core::ops::Range;

use super::{
    Batch,
    columns::{COLUMN_BITS, columns, coordinates},
    lattice::{Lattice, fixed},
    point::{Point, PointId},
    scope::{Scope, State, TILE, common, power, tile},
    walk::{Walk, few},
};
use crate::{
    kernel::Backend,
    lattice::{Grade, Keep, Settle},
    settle::{LEAST_IN_SPACE, List, Listed, Moves, Placed, Settler, Settling},
    table::{FRACTION_BITS, Mix},
};

/// The least height of a piece, in lattice units at full density.
const LEAST_HEIGHT: f64 = 64.0;
/// About the most points of a piece that is higher.
const MOST: f64 = 400_000.0;

/// Lists points of space where they were placed.
#[derive(Clone, Debug)]
pub(super) struct Lister(Lattice);

/// The place and the address of a point relative to the origin of a batch.
type Found = ([i32; 3], [i32; 3]);

impl Listed<3> for Found {
    #[inline(always)]
    fn address(&self) -> [i64; 3] {
        self.1.map(i64::from)
    }

    #[inline(always)]
    fn place(&self) -> [i32; 3] {
        self.0
    }
}

/// A settler of the points of a lattice; `None` if they stay.
fn settler(lattice: &Lattice) -> Option<Settler<Lister, 3>> {
    let (settle, grade) = lattice.settling()?;
    let placement = lattice.placement.with_settle(Settle::OFF);
    let still = Lattice {
        without: Vec::new(),
        ..lattice.replaced(placement.with_lod(Keep::ALL))
    };
    Some(Settler::of(Lister(still), grade, settle))
}

impl Settling<3> for Lister {
    type Found = Found;

    fn mix(&self) -> Option<&Mix> {
        None
    }

    fn kind_of(&self, _: [i64; 3]) -> Option<u8> {
        None
    }

    fn side(&self) -> f64 {
        self.0.table.map().alpha().set_side_f64()
    }

    fn spacing(&self) -> f64 {
        self.0.placement.spacing.get()
    }

    fn step(&self) -> f64 {
        self.0.step
    }

    fn certified(&self) -> f64 {
        let relative = self.0.table.least_distance();
        let relative = relative.with_warp(self.0.placement.warp);
        relative * f64::from(1u32 << FRACTION_BITS) / self.side()
    }

    fn looked_at(&self, place: [i128; 3]) -> [f64; 3] {
        self.0.at(place.map(|k| k as i64))
    }

    fn list(
        &mut self,
        within: &[Range<i128>; 3],
        corner: [i128; 3],
        (grade, backend): (&Grade<3>, Backend),
        mut visit: impl FnMut(List<'_, Found, 3>),
    ) {
        if within.iter().any(Range::is_empty) {
            return;
        }
        let lattice = &self.0;
        let bounds = (within.each_ref()).map(|range| range.start as i64..range.end as i64);
        let scope = Arc::new(Scope::of_places(lattice, bounds));
        let mut give = |batch: &Batch| {
            let origin = batch.origin;
            let place = |i: usize| batch.places.each_ref().map(|list| list[i]);
            let found = (0..batch.len()).map(|i| (place(i), batch.ids[i]));
            let mut shares = vec![0.0; batch.len()];
            grade.shares(&lattice.all_at(batch), &mut shares);
            visit(List {
                found: &found.collect::<Vec<Found>>(),
                shares: &shares,
                address: origin,
                origin: [0, 1, 2]
                    .map(|axis| (i128::from(fixed(origin[axis])) - corner[axis]) as i64),
            });
        };
        if scope.is_small()
            && let Some(few) = few(&scope)
        {
            return give(&few);
        }
        let mut walk = Walk::new(scope.clone(), &scope.all, None, true);
        walk.backend = backend;
        let mut batch = Batch::default();
        while walk.next(&mut batch) {
            give(&batch);
        }
    }
}

/// A walk over the points of a scope that settle.
#[derive(Clone, Debug)]
pub(super) struct SettledWalk {
    scope: Arc<Scope>,
    settler: Settler<Lister, 3>,
    /// The addresses that are walked, and the first one unless that is the first of all.
    ranges: [Range<i64>; 3],
    start: Option<[i64; 3]>,
    /// The box in which points lie in the end, and the one in which these were placed.
    bounds: [Range<i128>; 3],
    around: [Range<i128>; 3],
    /// The height of pieces and the sides of tiles.
    sides: [i64; 2],
    /// The columns along x and y, and where the next piece begins.
    columns: [Range<i64>; 2],
    at: [i64; 3],
}

impl SettledWalk {
    /// The walk over points at addresses of a box, from an address on; `None` if they stay.
    pub(super) fn new(
        scope: &Arc<Scope>,
        ranges: &[Range<i64>; 3],
        start: Option<[i64; 3]>,
    ) -> Option<Self> {
        let settler = settler(&scope.lattice)?;
        let ranges = scope.clip(ranges);
        let columns = [0, 1].map(|axis| columns(&ranges[axis]));
        let bounds = (scope.bounds.clone()).map(|range| range.start.into()..range.end.into());
        let at = match start {
            Some([x, y, z]) => [x >> COLUMN_BITS, y >> COLUMN_BITS, z],
            None => [columns[0].start, columns[1].start, ranges[2].start],
        };
        let around = settler.moves.around(&bounds);
        let along = [0, 1].map(|axis| ranges[axis].end - ranges[axis].start);
        let density = scope.lattice.table.map().alpha().set_side_f64();
        let density = density * density * density;
        Some(Self {
            sides: [
                height(&settler.moves, &around, along, density),
                tile(&settler.moves, &around),
            ],
            scope: scope.clone(),
            around,
            settler,
            ranges,
            start,
            bounds,
            columns,
            at,
        })
    }

    /// Fills a batch with the points of the next piece that has some. Returns false if there are no more.
    pub(super) fn next(&mut self, out: &mut Batch) -> bool {
        while let Some(piece) = self.next_piece() {
            out.restart(piece.each_ref().map(|range| range.start));
            let [_, side] = self.sides;
            let mut found = Vec::new();
            for y in piece[1].clone().step_by(side as usize) {
                for x in piece[0].clone().step_by(side as usize) {
                    let ends = [&(x..x + side), &(y..y + side)];
                    let [xs, ys] = [0, 1].map(|axis| common(ends[axis], &piece[axis]));
                    self.settle(&[xs, ys, piece[2].clone()], out.origin, &mut found);
                }
            }
            found.sort_unstable_by_key(|(_, [x, y, z])| [*z, *y, *x]);
            for (place, address) in found {
                for (list, place) in out.places.iter_mut().zip(place) {
                    list.push(place);
                }
                out.ids.push(address);
            }
            if !out.is_empty() {
                return true;
            }
        }
        false
    }

    /// The addresses of the next piece.
    fn next_piece(&mut self) -> Option<[Range<i64>; 3]> {
        let [xs, ys] = &self.columns;
        let [x, y, z] = self.at;
        if self.scope.stop.is_raised() || !xs.contains(&x) || !ys.contains(&y) {
            return None;
        }
        let [along_x, along_y, along_z] = &self.ranges;
        let [height, _] = self.sides;
        let planes = z..along_z.end.min((z & !(height - 1)) + height);
        let piece = [
            common(&coordinates(x), along_x),
            common(&coordinates(y), along_y),
            planes.clone(),
        ];
        self.at = match (planes.end < along_z.end, y + 1 < ys.end) {
            (true, _) => [x, y, planes.end],
            (false, true) => [x, y + 1, along_z.start],
            (false, false) => [x + 1, ys.start, along_z.start],
        };
        Some(piece)
    }

    /// Adds the points of a tile that end inside, relative to an origin.
    fn settle(&mut self, tile: &[Range<i64>; 3], origin: [i64; 3], found: &mut Vec<Found>) {
        let scope = &self.scope;
        let lattice = &scope.lattice;
        if tile.iter().any(Range::is_empty) || scope.stop.is_raised() {
            return;
        }
        let volume = match scope.state(tile, scope.volume.as_ref()) {
            State::Out => return,
            State::In => None,
            State::Test(volume) => volume,
        };
        let places = scope.placed(tile);
        let within = [0, 1, 2].map(|axis| {
            let ([least, most], around) = (places[axis].map(i128::from), &self.around[axis]);
            around.start.max(least)..around.end.min(most + 1)
        });
        let column = |[x, y, _]: [i64; 3]| [x >> COLUMN_BITS, y >> COLUMN_BITS];
        let start = self.start.filter(|at| column(*at) == column(origin));
        let reversed = |[x, y, z]: [i64; 3]| [z, y, x];
        let wants = |placed: &Placed<3>| {
            (0..3).all(|axis| tile[axis].contains(&placed.address[axis]))
                && start.is_none_or(|start| reversed(placed.address) >= reversed(start))
                && placed.side(&self.bounds) != Some(false)
                && lattice.shows(PointId::of(placed.address), placed.share)
        };
        self.settler.settle(&within, wants, |settled| {
            let place = settled.place.map(|k| k as i64);
            let is_inside = (0..3).all(|axis| scope.bounds[axis].contains(&place[axis]));
            let holds = |volume: &super::Volume| volume.contains(lattice.at(place));
            if is_inside && volume.as_ref().is_none_or(holds) {
                found.push((
                    [0, 1, 2].map(|axis| (place[axis] - fixed(origin[axis])) as i32),
                    [0, 1, 2].map(|axis| (settled.address[axis] - origin[axis]) as i32),
                ));
            }
        });
    }
}

/// The height of pieces of a width and depth.
fn height(moves: &Moves<3>, within: &[Range<i128>; 3], sides: [i64; 2], density: f64) -> i64 {
    let share = moves.greatest_share(within).max(LEAST_IN_SPACE);
    let area: f64 = (sides.iter())
        .map(|side| (*side).clamp(1, 1 << COLUMN_BITS) as f64)
        .product();
    let local = 1.0 / libm::cbrt(share);
    let height = (MOST / (area * density * share)).clamp(LEAST_HEIGHT * local, TILE * local);
    // Places are 32-bit offsets from the origin of a piece.
    power(height).min(1 << COLUMN_BITS)
}

/// The point of an address, or `None` if there is none.
pub(super) fn point(lattice: &Lattice, id: PointId) -> Option<Point> {
    let placed = lattice.place(id)?;
    let is = |placed: &Placed<3>| placed.address == id.lattice();
    let settled = settler(lattice);
    let settled = settled.and_then(|mut settler| settler.settled(placed.map(i128::from), is));
    let place = settled.map_or(placed, |place| place.map(|k| k as i64));
    Some(lattice.point_at(id, place))
}

/// A walk over the points of a scope, whether they settle or stay.
#[derive(Clone, Debug)]
pub(super) enum AnyWalk {
    Still(Box<Walk>),
    Settled(Box<SettledWalk>),
}

impl AnyWalk {
    /// As [`Walk::new`].
    pub(super) fn new(
        scope: Arc<Scope>,
        ranges: &[Range<i64>; 3],
        start: Option<[i64; 3]>,
        wants_ids: bool,
    ) -> Self {
        match SettledWalk::new(&scope, ranges, start) {
            Some(walk) => Self::Settled(Box::new(walk)),
            None => Self::Still(Box::new(Walk::new(scope, ranges, start, wants_ids))),
        }
    }

    pub(super) fn set_backend(&mut self, backend: Backend) {
        match self {
            Self::Still(walk) => walk.backend = backend,
            Self::Settled(walk) => walk.settler.set_backend(backend),
        }
    }

    /// Fills a batch with the next points, at least one. Returns false if there are none.
    pub(super) fn next(&mut self, out: &mut Batch) -> bool {
        match self {
            Self::Still(walk) => walk.next(out),
            Self::Settled(walk) => walk.next(out),
        }
    }
}
