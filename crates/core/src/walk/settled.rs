//! The walk of points that settle: piece by piece, each with the points around it that matter.
//!
//! A piece is up to [`PIECE`] rows of a band; `settle::pieces` has its points. A walk holds the points of one piece and
//! those around it, whatever the size of the plan. Small scopes settle once: `find_few_settled` keeps their points when
//! they are counted.

use alloc::{sync::Arc, vec, vec::Vec};
use core::ops::Range;

use super::{
    bands::{PIECE, Rows, Tile, write_found},
    count::count,
    few::Few,
    scope::Scope,
    sieve::Sieve,
    sifting::Halves,
};
use crate::{
    kernel::{Backend, Format},
    lattice::{BAND_WIDTH, Found, PATCH_HEIGHT, PointId, clip_to_band, places_of},
    near::{Other, clear::Clear},
    parts::CLEARANCE,
    settle::{self, Lister, Request, Settled, Settler},
    shape::{Area, Polygon},
    stop::Stop,
    table::fixed,
};

/// A scope that may have up to this many points settles at once, when it is counted, and its points are kept: 12 bytes
/// each. More than for others, because settling again costs more.
const FEW: f64 = 8192.0;

impl Request<2> for Scope {
    type Set = Lister;
    type Outline = Polygon;
    type Other = Other;

    fn settler(&self) -> Option<Settler> {
        Settler::new(&self.lattice)
    }

    fn bounds(&self) -> [Range<i128>; 2] {
        [self.x.bounds.clone(), self.y.bounds.clone()]
    }

    fn shape(&self) -> Option<&Area> {
        self.sieve.as_ref().and_then(Sieve::area)
    }

    fn clear(&self) -> Option<Clear<Other, 2>> {
        let sieve = self.sieve.as_ref();
        let sieve = sieve.filter(|sieve| CLEARANCE && sieve.is_guarded())?;
        let (clear, stop) = (&sieve.mask().clear, self.stop.clone());
        Some(Clear::new(clear, Some(&self.region), stop))
    }

    fn stop(&self) -> &Stop {
        &self.stop
    }

    fn places(&self, addresses: &[Range<i64>; 2]) -> [Range<i128>; 2] {
        places_of(&self.lattice, addresses)
    }

    fn shows(&self, address: [i64; 2], share: f64) -> bool {
        self.lattice.shows(PointId::of(address), share)
    }

    fn at(&self, place: [i128; 2]) -> [f64; 2] {
        place.map(|k| self.lattice.world(k))
    }

    fn count_all(&self, [columns, rows]: &[Range<i64>; 2]) -> Option<u128> {
        let share = self.lattice.constant_share();
        let share = share.filter(|_| !self.lattice.picks())?;
        let mut thinned = self.with_lattice(self.lattice.in_constant(share));
        thinned.sieve = thinned.sieve.map(Sieve::of_box);
        Some(count(&thinned, columns, rows))
    }
}

/// The settled points of a scope, band by band.
#[derive(Clone, Debug)]
pub(super) struct Pieces {
    all: settle::Pieces<Scope, 2>,
    halves: Halves,
    /// The part of the scope's area in the current band; `None` for all of it.
    near: Option<Area>,
}

impl Pieces {
    /// The points of a scope, whose lattice settles; `None` of others.
    pub(super) fn new(scope: &Arc<Scope>) -> Option<Self> {
        Some(Self {
            all: settle::Pieces::new(scope)?,
            halves: Halves::default(),
            near: None,
        })
    }

    const fn scope(&self) -> &Arc<Scope> {
        &self.all.inside.request
    }

    /// Moves bands that are ahead to the first one in which the area has anything.
    fn next_band(&mut self, ahead: &mut Range<i64>) {
        let (inside, halves) = (&self.all.inside, &mut self.halves);
        let Scope { x, y, .. } = &*inside.request;
        let Some(whole) = inside.request.shape() else {
            return;
        };
        let near = halves.next(whole, ahead, |area, bands| {
            let columns = bands.start * BAND_WIDTH..bands.end * BAND_WIDTH;
            let columns = columns.start.max(x.all.start)..columns.end.min(x.all.end);
            let within = inside.places(&[columns, y.all.clone()]);
            inside.focus(area, &inside.ends(&within))
        });
        self.near = near.cloned();
    }
}

/// A walk over points that settle.
#[derive(Clone, Debug)]
pub(super) struct SettledWalk {
    pieces: Pieces,
    pub(super) backend: Backend,
    rows: Rows,
    /// The first address, if the walk begins within a piece.
    from: Option<PointId>,
    origin: [i64; 2],
    found: Vec<Found>,
    taken: usize,
}

impl SettledWalk {
    /// A walk over some bands and rows of a scope whose lattice settles, from an address on if there is one.
    fn new(pieces: Pieces, bands: Range<i64>, rows: Range<i64>, start: Option<PointId>) -> Self {
        let mut rows = Rows::new(bands, rows);
        if let Some(at) = start {
            rows.ahead.start = at.x.div_euclid(BAND_WIDTH);
            if rows.all.contains(&at.y) && !rows.ahead.is_empty() {
                rows.band = rows.ahead.start;
                rows.ahead.start += 1;
                rows.next = at.y;
            }
        }
        Self {
            pieces,
            backend: Backend::best(),
            rows,
            from: start,
            origin: [0; 2],
            found: Vec::new(),
            taken: 0,
        }
    }

    /// All bands and rows of a scope, from an address on if there is one.
    pub(super) fn from(pieces: Pieces, start: Option<PointId>) -> Self {
        let (bands, rows) = (pieces.scope().bands(), pieces.scope().y.all.clone());
        Self::new(pieces, bands, rows, start)
    }

    /// The band and the rows of a tile.
    pub(super) fn of_tile(pieces: Pieces, tile: &Tile) -> Self {
        Self::new(pieces, tile.band..tile.band + 1, tile.rows.clone(), None)
    }

    /// Works by another backend.
    pub(super) const fn set_backend(&mut self, backend: Backend) {
        self.backend = backend;
        self.pieces.all.settler.set_backend(backend);
    }

    /// Finds the points of the next piece. `false` after the last one, and once the flag is raised: what points keep
    /// clear of is not known then.
    fn next_piece(&mut self) -> bool {
        self.found.clear();
        self.taken = 0;
        if self.rows.is_new_band() {
            self.pieces.next_band(&mut self.rows.ahead);
        }
        let Some((band, rows)) = self.rows.take() else {
            return false;
        };
        self.origin = [band * BAND_WIDTH, rows.start.div_euclid(PIECE) * PIECE];
        let columns = clip_to_band(band, &self.pieces.scope().x.all);
        let (found, origin) = (&mut self.found, self.origin);
        let from = self.from.take();
        let Pieces { all, near, .. } = &mut self.pieces;
        all.settle(&[columns, rows], near.as_ref(), &mut |settled| {
            let is_before = from.is_some_and(|at| {
                let [x, y] = settled.address;
                y == at.y && x < at.x
            });
            if !is_before {
                found.push(found_at(origin, &settled));
            }
        });
        if self.pieces.scope().stop.is_raised() {
            self.found.clear();
            return false;
        }
        true
    }

    /// Fills `out` with the next points, and only a part of it at the end. Returns the number written.
    pub(super) fn fill<F: Format>(&mut self, format: &F, out: &mut [F::Item]) -> usize {
        let mut filled = 0;
        while filled < out.len() {
            let left = &self.found[self.taken..];
            if left.is_empty() {
                if !self.next_piece() {
                    break;
                }
                continue;
            }
            let number = left.len().min(out.len() - filled);
            let (left, out) = (left.iter().copied(), &mut out[filled..][..number]);
            write_found((format, self.backend), self.origin, left, out);
            self.taken += number;
            filled += number;
        }
        filled
    }

    /// The address after the points written.
    pub(super) fn place(&self) -> PointId {
        match self.found.get(self.taken) {
            Some(found) => {
                let [x, y] = found.address();
                PointId {
                    x: self.origin[0] + x,
                    y: self.origin[1] + y,
                }
            }
            None => self.from.unwrap_or_else(|| self.rows.place()),
        }
    }
}

/// A settled point relative to an origin.
fn found_at(origin: [i64; 2], settled: &Settled) -> Found {
    let [x, y] = settled.address;
    let place = [0, 1].map(|i| (settled.place[i] - fixed(origin[i])) as i32);
    Found::new(place, [x - origin[0], y - origin[1]])
}

/// The number of settled points of a scope, whose bands are halved down to parts with known numbers and pieces. `mark` is
/// called with the first address of each part and the number of points before it.
pub(super) fn count_settled(mut pieces: Pieces, mut mark: impl FnMut(PointId, u128)) -> u128 {
    let scope = pieces.scope().clone();
    let (mut bands, mut number) = (scope.bands(), 0);
    loop {
        pieces.next_band(&mut bands);
        let Some(band) = bands.next() else {
            return number;
        };
        // The next part is the last one.
        let mut open = vec![scope.y.all.clone()];
        while let Some(rows) = open.pop() {
            let Range { start: y, end } = rows;
            let piece = [clip_to_band(band, &scope.x.all), rows];
            let known = pieces.all.known(&piece, pieces.near.as_ref());
            let [next, middle] = [y + PIECE, y.midpoint(end)].map(|v| v.div_euclid(PIECE) * PIECE);
            let middle = middle.max(next);
            if known.is_none() && middle < end {
                open.extend([middle..end, y..middle]);
                continue;
            }
            if scope.stop.is_raised() {
                return number;
            }
            let x = band * BAND_WIDTH;
            mark(PointId { x, y }, number);
            number += known.unwrap_or_else(|| pieces.all.count(&piece, pieces.near.as_ref()));
        }
    }
}

/// The address of point number `k` of a scope, from an address on before which `before` points lie; `None` if there are
/// fewer, or if the scope's stop flag is raised.
pub(super) fn locate_settled(
    pieces: Pieces,
    start: Option<PointId>,
    mut before: u128,
    k: u128,
) -> Option<PointId> {
    let scope = pieces.scope().clone();
    let mut walk = SettledWalk::from(pieces, start);
    while !scope.stop.is_raised() {
        if !walk.next_piece() {
            return None;
        }
        let number = walk.found.len() as u128;
        if k < before + number {
            walk.taken = (k - before) as usize;
            return Some(walk.place());
        }
        before += number;
    }
    None
}

/// The points of a small scope in their order. `None` if it is not small.
pub(super) fn find_few_settled(pieces: &mut Pieces) -> Option<Few> {
    let scope = pieces.scope().clone();
    let (columns, rows) = (scope.x.all.clone(), scope.y.all.clone());
    let lengths = [&columns, &rows].map(|range| range.end.saturating_sub(range.start).max(0));
    if lengths.iter().any(|length| *length > BAND_WIDTH) {
        return None;
    }
    let side = scope.lattice.table.alpha().set_side_f64();
    let area = lengths[0] as f64 * lengths[1] as f64;
    let settle::Pieces { settler, inside } = &pieces.all;
    if area * side * side * settler.moves.greatest_share(&inside.around) > FEW {
        return None;
    }
    let mut settled = Vec::new();
    let (all, near) = (&mut pieces.all, pieces.near.as_ref());
    all.settle(&[columns, rows], near, &mut |point| settled.push(point));
    settled.sort_unstable_by_key(|point: &Settled| {
        let [x, y] = point.address;
        (x.div_euclid(BAND_WIDTH), y, x)
    });
    let mut few = Few::default();
    for point in &settled {
        let [x, y] = point.address;
        let origin = [
            x.div_euclid(BAND_WIDTH) * BAND_WIDTH,
            y.div_euclid(PATCH_HEIGHT) * PATCH_HEIGHT,
        ];
        few.add(origin, found_at(origin, point));
    }
    Some(few)
}
