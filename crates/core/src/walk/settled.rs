//! The walk of points that settle: piece by piece, each with the points around it that matter.
//!
//! # The problem
//!
//! Where a point settles depends on its neighbors, so it cannot be made from its row and column alone, and a region
//! cannot be counted from its corners. Yet the count must be exact before the first point.
//!
//! # Filling
//!
//! A piece is up to [`PIECE`] rows of a band. Its points are placed by their ranks, together with those around it; the
//! [`Settler`] moves them; and those that end inside the region are written in the order of their addresses, that of
//! all walks. Pieces decide only the cost: a point goes to the same place in every piece.
//!
//! # Counting
//!
//! A point moves no farther than `most_move`. So most points are decided by the places where their ranks left them:
//!
//! ```text
//!      far outside │ near: settle │ near: settle │ deep inside
//!     ─────────────┼──────────────┼──────────────┼─────────────
//!                    ← most_move  ▲  most_move →
//!                              the outline
//! ```
//!
//! - In a box with the same share everywhere, whole pieces whose points all stay inside are counted in closed form, as
//!   a thinned set (`sure_rows`).
//! - Else the points of a piece are listed, which takes no steps, and decided by the box, and by tiles that lie inside
//!   or outside of the area as a whole.
//! - Only the others settle, in boxes that join those of neighboring tiles, because each box needs the points around
//!   it, too. Where the set keeps clear of others, that is all points but those far outside.
//!
//! # Invariants
//!
//! - No point that is decided before it settles can cross the outline, and the others meet the same [`Inside`] as in
//!   filling. So the count is the number of points that filling writes.
//! - A walk holds the points of one piece and those around it, whatever the size of the plan. Small scopes settle once:
//!   `find_few_settled` keeps their points when they are counted.

use alloc::{sync::Arc, vec, vec::Vec};
use core::ops::Range;

use super::{
    bands::{PIECE, Rows, Tile, write_found},
    count::count,
    few::Few,
    inside::{Inside, Tiles},
    scope::Scope,
    sieve::Sieve,
    sifting::Halves,
};
use crate::{
    kernel::{Backend, Format},
    lattice::{BAND_WIDTH, Found, PATCH_HEIGHT, PointId, clip_to_band, places_of},
    near::{Guard, Mask},
    settle::{Box2, Placed, Settled, Settler, add_place, common, joined, widened},
    shape::Area,
    table::fixed,
};

/// About how far around a box points matter to those in it, in greatest moves, in sets without kinds.
const MARGIN: i128 = 16;

/// A scope that may have up to this many points settles at once, when it is counted, and its points are kept: 12 bytes
/// each. More than for others, because settling again costs more.
const FEW: f64 = 8192.0;

/// The settled points of a scope, piece by piece.
#[derive(Clone, Debug)]
pub(super) struct Pieces {
    scope: Arc<Scope>,
    settler: Settler,
    /// The box in which points lie in the end, and the one in which these were placed.
    bounds: Box2,
    around: Box2,
    clear: Guard,
    halves: Halves,
    /// The part of the scope's area in the current band; `None` for all of it.
    near: Option<Area>,
}

impl Pieces {
    /// The points of a scope, whose lattice settles; `None` of others.
    pub(super) fn new(scope: &Arc<Scope>) -> Option<Self> {
        let settler = Settler::new(&scope.lattice)?;
        let bounds = [scope.x.bounds.clone(), scope.y.bounds.clone()];
        let sieve = scope.sieve.as_ref();
        Some(Self {
            around: settler.moves.around(&bounds),
            bounds,
            clear: sieve.map_or_else(|| Mask::default().guard(None), Sieve::guard),
            settler,
            scope: scope.clone(),
            halves: Halves::default(),
            near: None,
        })
    }

    /// Moves to the next band in which the area has anything, before the first of its rows is taken.
    fn next_band(&mut self, rows: &mut Rows) {
        let whole = self.scope.sieve.as_ref().and_then(Sieve::area);
        let (Some(whole), true) = (whole, rows.is_new_band()) else {
            return;
        };
        let mut halves = core::mem::take(&mut self.halves);
        let near = halves.next(whole, &mut rows.ahead, |area, bands| {
            let x = &self.scope.x.all;
            let columns = x.start.max(bands.start * BAND_WIDTH)..x.end.min(bands.end * BAND_WIDTH);
            let within = self.places(&[columns, rows.all.clone()]);
            let ends = widened(&within, self.settler.moves.most(&within));
            area.focus(&self.settler.moves.region(&ends))
        });
        self.near = near.cloned();
        self.halves = halves;
    }

    /// The box of the places of the points of some columns and rows that may end inside.
    fn places(&self, piece: &[Range<i64>; 2]) -> Box2 {
        let lattice = &self.scope.lattice;
        if piece.iter().any(Range::is_empty) {
            return [0..0, 0..0];
        }
        common(&places_of(lattice, piece), &self.around)
    }

    /// The part of the scope's area that matters to points that end in a box.
    fn area(&self, within: &Box2) -> Option<Area> {
        let whole = self.scope.sieve.as_ref().and_then(Sieve::area);
        let area = self.near.as_ref().or(whole)?;
        Some(area.focus(&self.settler.moves.region(within)))
    }

    /// Calls `visit` for the settled points of some columns and rows of a band that lie inside, in their order.
    fn settle(&mut self, piece: &[Range<i64>; 2], mut visit: impl FnMut(Settled)) {
        let within = self.places(piece);
        if within.iter().any(Range::is_empty) {
            return;
        }
        let ends = widened(&within, self.settler.moves.most(&within));
        let area = self.area(&ends);
        let state = area.as_ref().map_or(Some(true), Area::is_all_or_nothing);
        if state == Some(false) {
            return;
        }
        let lattice = &self.scope.lattice;
        let is_deep = common(&ends, &self.bounds) == ends;
        let is_inside = is_deep && state == Some(true) && self.clear.is_empty();
        let by = (lattice, &self.settler);
        let inside = Inside::new((&self.bounds, &ends), area, &self.clear, by);
        let wants = |placed: &Placed| {
            holds(piece, placed.address)
                && (is_deep || placed.side(&self.bounds) != Some(false))
                && lattice.shows(PointId::of(placed.address), placed.share)
        };
        self.settler.settle(&within, wants, |settled| {
            if is_inside || inside.holds(&settled) {
                visit(settled);
            }
        });
    }

    /// The number of settled points of some columns and rows of a band that lie inside. `thinned` has the same points
    /// where they were placed, if shares are the same everywhere.
    fn count(&mut self, piece: &[Range<i64>; 2], thinned: Option<&Scope>) -> u128 {
        let within = self.places(piece);
        if within.iter().any(Range::is_empty) {
            return 0;
        }
        let lattice = &self.scope.lattice;
        let is_guarded = !self.clear.is_empty();
        let ends = widened(&within, self.settler.moves.most(&within));
        let area = self.area(&ends);
        let state = area.as_ref().map_or(Some(true), Area::is_all_or_nothing);
        let [columns, rows] = piece;
        match (state, thinned) {
            (Some(false), _) => return 0,
            (Some(true), Some(thinned)) if !is_guarded && common(&ends, &self.bounds) == ends => {
                return count(thinned, columns, rows);
            }
            _ => {}
        }
        let tiles = Tiles::new(&within);
        // By tile: whether the area has all or nothing of it and around.
        let state = |tile: Box2| {
            let ends = common(&ends, &widened(&tile, self.settler.moves.most(&tile)));
            let area = area.as_ref()?;
            area.focus(&self.settler.moves.region(&ends))
                .is_all_or_nothing()
        };
        let states: Vec<Option<bool>> = match area {
            Some(_) => tiles.boxes().map(state).collect(),
            None => tiles.boxes().map(|_| Some(true)).collect(),
        };
        let bounds = &self.bounds;
        let decide = |placed: &Placed| match (placed.side(bounds), states[tiles.of(placed.place)]) {
            (Some(false), _) | (_, Some(false)) => Some(false),
            (Some(true), Some(true)) if !is_guarded => Some(true),
            _ => None,
        };
        let is_own = |placed: &Placed| {
            holds(piece, placed.address) && lattice.shows(PointId::of(placed.address), placed.share)
        };
        let mut number = 0;
        // By tile: the box of the points that have to settle.
        let mut unsure: Vec<Option<Box2>> = vec![None; states.len()];
        self.settler.list(&within, |placed| {
            if is_own(&placed) {
                match decide(&placed) {
                    Some(is_inside) => number += u128::from(is_inside),
                    None => add_place(&mut unsure[tiles.of(placed.place)], placed.place),
                }
            }
        });
        let margin = MARGIN * i128::from(self.settler.moves.most(&within));
        let margin = (margin as f64 * self.settler.width()) as i128;
        for some in joined(unsure.into_iter().flatten(), margin) {
            if self.scope.stop.is_raised() {
                break;
            }
            let ends = common(&ends, &widened(&some, self.settler.moves.most(&some)));
            let near = area
                .as_ref()
                .map(|area| area.focus(&self.settler.moves.region(&ends)));
            let by = (lattice, &self.settler);
            let inside = Inside::new((bounds, &ends), near, &self.clear, by);
            let wants = |placed: &Placed| is_own(placed) && decide(placed).is_none();
            self.settler.settle(&some, wants, |settled| {
                number += u128::from(inside.holds(&settled));
            });
        }
        number
    }

    /// The rows of a band whose points are all inside wherever they go, if shares are the same everywhere.
    fn sure_rows(&self, columns: &Range<i64>) -> Range<i64> {
        let Scope {
            lattice, y, sieve, ..
        } = &*self.scope;
        let none = y.all.end..y.all.end;
        if sieve.is_some() || lattice.constant_share().is_none() || columns.is_empty() {
            return none;
        }
        let most = i128::from(self.settler.moves.most(&self.bounds));
        let [x_ends, y_ends] = places_of(lattice, &[columns.clone(), y.all.clone()]);
        let is_inside =
            self.bounds[0].start <= x_ends.start - most && x_ends.end + most <= self.bounds[0].end;
        if !is_inside {
            return none;
        }
        // How far places are from the addresses of their rows.
        let below = fixed(y.all.start) - y_ends.start + most;
        let above = y_ends.end - fixed(y.all.end - 1) + most;
        let up = |k: i128| -((-k) >> crate::table::FRACTION_BITS) as i64;
        let start = up(self.bounds[1].start + below).clamp(y.all.start, y.all.end);
        let end = up(self.bounds[1].end - above).clamp(start, y.all.end);
        // Whole pieces.
        let start = -(-start).div_euclid(PIECE) * PIECE;
        let end = end.div_euclid(PIECE) * PIECE;
        if start < end { start..end } else { none }
    }
}

/// Whether an address is in some columns and rows.
fn holds([columns, rows]: &[Range<i64>; 2], [x, y]: [i64; 2]) -> bool {
    columns.contains(&x) && rows.contains(&y)
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
        let (bands, rows) = (pieces.scope.bands(), pieces.scope.y.all.clone());
        Self::new(pieces, bands, rows, start)
    }

    /// The band and the rows of a tile.
    pub(super) fn of_tile(pieces: Pieces, tile: &Tile) -> Self {
        Self::new(pieces, tile.band..tile.band + 1, tile.rows.clone(), None)
    }

    /// Works by another backend.
    pub(super) const fn set_backend(&mut self, backend: Backend) {
        self.backend = backend;
        self.pieces.settler.set_backend(backend);
    }

    /// Finds the points of the next piece. `false` after the last one.
    fn next_piece(&mut self) -> bool {
        self.found.clear();
        self.taken = 0;
        self.pieces.next_band(&mut self.rows);
        let Some((band, rows, _)) = self.rows.take(|_| 0..0) else {
            return false;
        };
        self.origin = [band * BAND_WIDTH, rows.start.div_euclid(PIECE) * PIECE];
        let columns = clip_to_band(band, &self.pieces.scope.x.all);
        let (found, origin) = (&mut self.found, self.origin);
        let from = self.from.take();
        self.pieces.settle(&[columns, rows], |settled| {
            let is_before = from.is_some_and(|at| {
                let [x, y] = settled.address;
                y == at.y && x < at.x
            });
            if !is_before {
                found.push(found_at(origin, &settled));
            }
        });
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

/// The number of settled points of a scope. `mark` is called with the first address of each piece and the number of
/// points before it.
pub(super) fn count_settled(mut pieces: Pieces, mut mark: impl FnMut(PointId, u128)) -> u128 {
    let scope = pieces.scope.clone();
    let share = scope.lattice.constant_share();
    let share = share.filter(|_| !scope.lattice.picks());
    let thinned = share.map(|share| {
        let lattice = scope.lattice.in_constant(share);
        let mut thinned = scope.with_lattice(lattice);
        thinned.sieve = None;
        thinned
    });
    let mut rows = Rows::new(scope.bands(), scope.y.all.clone());
    let mut number = 0;
    while !scope.stop.is_raised() {
        pieces.next_band(&mut rows);
        let sure = |band| pieces.sure_rows(&clip_to_band(band, &scope.x.all));
        let Some((band, rows, is_sure)) = rows.take(sure) else {
            break;
        };
        let columns = clip_to_band(band, &scope.x.all);
        let start = PointId {
            x: band * BAND_WIDTH,
            y: rows.start,
        };
        mark(start, number);
        number += match &thinned {
            Some(thinned) if is_sure => count(thinned, &columns, &rows),
            _ => pieces.count(&[columns, rows], thinned.as_ref()),
        };
    }
    number
}

/// The address of point number `k` of a scope, from an address on before which `before` points lie; `None` if there are
/// fewer, or if the scope's stop flag is raised.
pub(super) fn locate_settled(
    pieces: Pieces,
    start: Option<PointId>,
    mut before: u128,
    k: u128,
) -> Option<PointId> {
    let scope = pieces.scope.clone();
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
    let scope = pieces.scope.clone();
    let (columns, rows) = (scope.x.all.clone(), scope.y.all.clone());
    let lengths = [&columns, &rows].map(|range| range.end.saturating_sub(range.start).max(0));
    if lengths.iter().any(|length| *length > BAND_WIDTH) {
        return None;
    }
    let side = scope.lattice.table.alpha().set_side_f64();
    let area = lengths[0] as f64 * lengths[1] as f64;
    if area * side * side * pieces.settler.moves.greatest_share(&pieces.around) > FEW {
        return None;
    }
    let mut settled = Vec::new();
    pieces.settle(&[columns, rows], |point| settled.push(point));
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
