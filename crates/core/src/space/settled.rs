//! Points of space that settle: how they are listed, and the walk over them, piece by piece.
//!
//! A piece is a slab of a column of planes, cut into tiles. The points around a tile are listed where the warp left them,
//! all of them settle (`settle/` has the steps), and those of the tile that end inside are given in the order of
//! their addresses. Pieces and tiles decide only the cost: a point goes to the same place in each.

use alloc::{sync::Arc, vec, vec::Vec};
use core::ops::Range;

use super::{
    Batch, Volume, closed,
    columns::{COLUMN_BITS, columns, coordinates},
    lattice::{Lattice, fixed},
    mask::Other,
    point::{Point, PointId},
    scope::{Scope, TILE, common, power, tile},
    walk::{Walk, few},
};
use crate::{
    kernel::Backend,
    lattice::{Grade, Keep, Settle, Without},
    near::clear::Clear,
    settle::{LEAST_IN_SPACE, List, Listed, Moves, Pieces, Placed, Request, Settler, Settling},
    shape::Prism,
    stop::Stop,
    table::{FRACTION_BITS, Mix},
};

/// The least height of a piece, in lattice units at full density.
const LEAST_HEIGHT: f64 = 64.0;
/// About the most points of a piece that is higher.
const MOST: f64 = 400_000.0;

/// Lists points of space where they were placed.
#[derive(Clone, Debug)]
pub(crate) struct Lister(Lattice);

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
        without: Without::default(),
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
        visit: &mut dyn FnMut(List<'_, Found, 3>),
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

impl Request<3> for Scope {
    type Set = Lister;
    type Outline = Prism;
    type Other = Other;

    fn settler(&self) -> Option<Settler<Lister, 3>> {
        settler(&self.lattice)
    }

    fn bounds(&self) -> [Range<i128>; 3] {
        (self.bounds.clone()).map(|range| range.start.into()..range.end.into())
    }

    fn shape(&self) -> Option<&Volume> {
        self.volume.as_ref()
    }

    fn clear(&self) -> Option<Clear<Other, 3>> {
        (!self.clear.is_empty()).then(|| self.clearance())
    }

    fn stop(&self) -> &Stop {
        &self.stop
    }

    fn places(&self, addresses: &[Range<i64>; 3]) -> [Range<i128>; 3] {
        (self.placed(addresses)).map(|[least, most]| least.into()..i128::from(most) + 1)
    }

    fn shows(&self, address: [i64; 3], share: f64) -> bool {
        self.lattice.shows(PointId::of(address), share)
    }

    fn at(&self, place: [i128; 3]) -> [f64; 3] {
        self.lattice.at(place.map(|k| k as i64))
    }

    fn count_all(&self, addresses: &[Range<i64>; 3]) -> Option<u128> {
        let is_known = self.lattice.grade.is_none();
        is_known.then(|| closed::count_all(&self.lattice, addresses) - self.missing(addresses))
    }
}

/// A walk over the points of a scope that settle.
#[derive(Clone, Debug)]
pub(super) struct SettledWalk {
    pub(super) pieces: Pieces<Scope, 3>,
    /// The addresses that are walked, and the first one unless that is the first of all.
    ranges: [Range<i64>; 3],
    start: Option<[i64; 3]>,
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
        let pieces = Pieces::new(scope)?;
        let ranges = scope.clip(ranges);
        let columns = [0, 1].map(|axis| columns(&ranges[axis]));
        let at = match start {
            Some([x, y, z]) => [x >> COLUMN_BITS, y >> COLUMN_BITS, z],
            None => [columns[0].start, columns[1].start, ranges[2].start],
        };
        let along = [0, 1].map(|axis| ranges[axis].end - ranges[axis].start);
        let density = scope.lattice.table.map().alpha().set_side_f64();
        let density = density * density * density;
        let (moves, around) = (&pieces.settler.moves, &pieces.inside.around);
        Some(Self {
            sides: [height(moves, around, along, density), tile(moves, around)],
            pieces,
            ranges,
            start,
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
        if self.pieces.inside.request.stop.is_raised() || !xs.contains(&x) || !ys.contains(&y) {
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
        if self.pieces.inside.request.stop.is_raised() {
            return;
        }
        let column = |[x, y, _]: [i64; 3]| [x >> COLUMN_BITS, y >> COLUMN_BITS];
        let start = self.start.filter(|at| column(*at) == column(origin));
        let reversed = |[x, y, z]: [i64; 3]| [z, y, x];
        self.pieces.settle(tile, None, &mut |settled| {
            let address = settled.address;
            if start.is_none_or(|start| reversed(address) >= reversed(start)) {
                found.push((
                    [0, 1, 2].map(|i| (settled.place[i] as i64 - fixed(origin[i])) as i32),
                    [0, 1, 2].map(|i| (address[i] - origin[i]) as i32),
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
    let mut is = |placed: &Placed<3>| placed.address == id.lattice();
    let settled = settler(lattice);
    let settled = settled.and_then(|mut settler| settler.settled(placed.map(i128::from), &mut is));
    let place = settled.map_or(placed, |place| place.map(|k| k as i64));
    Some(lattice.point_at(id, place))
}
