//! The points of some addresses of a request that settle: those that end inside, and their number.
//!
//! # The problem
//!
//! Where a point settles depends on its neighbors, so it cannot be made from its address alone, and a region cannot be
//! counted from its corners. Yet the count must be exact before the first point.
//!
//! # Filling
//!
//! The points of a piece and those around it are placed by their ranks; the [`Settler`] moves them; and those that end
//! inside come in the order of their addresses. A point goes to the same place in every piece.
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
//! - Where shares are the same everywhere, pieces that stay inside are counted in closed form, as thinned sets.
//! - Else the points of a piece are listed, which takes no steps, and decided by the box, and by tiles that lie inside
//!   or outside of the shape as a whole.
//! - Only the others settle, in boxes that join those of neighboring tiles, because each box needs the points around
//!   it, too. Where the set keeps clear of others, that is all points but those far outside.
//!
//! No point that is decided before it settles can cross the outline, so the count is the number that filling writes.

use alloc::{sync::Arc, vec, vec::Vec};
use core::{array::from_fn, cell::RefCell, fmt::Debug, ops::Range};

use super::{
    lister::Settling,
    moves::{Moves, Placed, Settled, add_place, joined, widened},
    window::Settler,
};
use crate::{
    lattice::bounds::common_box,
    near::clear::{Clear, OtherSet},
    parts::CLEARANCE,
    shape::{Outlined, Shape},
    stop::Stop,
};

/// About how far around a box points matter to those in it, in greatest moves, in sets without kinds.
const MARGIN: i128 = 16;

/// A shape of more parts is reduced to tiles before points are compared with it.
const MANY: usize = 64;

/// A request for points that settle, in the plane or in space.
pub(crate) trait Request<const D: usize>: Clone + Debug {
    type Set: Settling<D>;
    type Outline: Outlined<D>;
    type Other: OtherSet<D>;

    /// The settler of the set; `None` if its points stay.
    fn settler(&self) -> Option<Settler<Self::Set, D>>;

    /// The box in which points lie in the end.
    fn bounds(&self) -> [Range<i128>; D];

    /// The shape in which they lie, if not in all of the box.
    fn shape(&self) -> Option<&Shape<D, Self::Outline>>;

    /// The sets that they keep clear of, if there are some.
    fn clear(&self) -> Option<Clear<Self::Other, D>>;

    /// Ends counting early.
    fn stop(&self) -> &Stop;

    /// The box of the places of the points of some addresses, before they settle.
    fn places(&self, addresses: &[Range<i64>; D]) -> [Range<i128>; D];

    /// Whether a point of a share is one of those that are wanted.
    fn shows(&self, address: [i64; D], share: f64) -> bool;

    /// The world coordinates of a place.
    fn at(&self, place: [i128; D]) -> [f64; D];

    /// The number of points of some addresses, wherever they end, if it is known without listing them.
    fn count_all(&self, addresses: &[Range<i64>; D]) -> Option<u128>;
}

/// The settled points of a request, piece by piece.
#[derive(Clone, Debug)]
pub(crate) struct Pieces<R: Request<D>, const D: usize> {
    pub(crate) settler: Settler<R::Set, D>,
    pub(crate) inside: Inside<R, D>,
}

/// The conditions on settled points.
#[derive(Clone, Debug)]
pub(crate) struct Inside<R: Request<D>, const D: usize> {
    pub(crate) request: Arc<R>,
    moves: Moves<D>,
    /// The box in which points lie in the end, and the one in which these were placed.
    pub(crate) bounds: [Range<i128>; D],
    pub(crate) around: [Range<i128>; D],
    clear: Option<RefCell<Clear<R::Other, D>>>,
}

/// A shape of a request.
type ShapeOf<R, const D: usize> = Shape<D, <R as Request<D>>::Outline>;

/// A piece: where its points were placed, where they may end, and what of the shape matters there.
struct Piece<S, const D: usize> {
    within: [Range<i128>; D],
    ends: [Range<i128>; D],
    shape: Option<S>,
    /// Whether all of them end inside wherever they go.
    is_inside: bool,
}

impl<R: Request<D>, const D: usize> Pieces<R, D> {
    /// The points of a request that settle; `None` if they stay.
    pub(crate) fn new(request: &Arc<R>) -> Option<Self> {
        let (settler, bounds) = (request.settler()?, request.bounds());
        let inside = Inside {
            around: settler.moves.around(&bounds),
            moves: settler.moves.clone(),
            bounds,
            clear: request.clear().map(RefCell::new),
            request: request.clone(),
        };
        Some(Self { settler, inside })
    }

    /// Calls `visit` for the settled points of some addresses that lie inside, in their order. No other part of the shape
    /// than `near` matters to them, if that is known.
    pub(crate) fn settle(
        &mut self,
        addresses: &[Range<i64>; D],
        near: Option<&ShapeOf<R, D>>,
        visit: &mut dyn FnMut(Settled<D>),
    ) {
        let Self { settler, inside } = self;
        let Some(piece) = inside.piece(addresses, near) else {
            return;
        };
        let outline = inside.outline(&piece.ends, piece.shape);
        let mut wants = |placed: &Placed<D>| {
            inside.wants(addresses, placed)
                && (piece.is_inside || placed.side(&inside.bounds) != Some(false))
        };
        settler.settle(&piece.within, &mut wants, &mut |settled| {
            if piece.is_inside || inside.holds(&settled, &outline) {
                visit(settled);
            }
        });
    }

    /// The number of settled points of some addresses that lie inside, if it is known without listing them; see
    /// [`settle`](Self::settle).
    pub(crate) fn known(
        &self,
        addresses: &[Range<i64>; D],
        near: Option<&ShapeOf<R, D>>,
    ) -> Option<u128> {
        match self.inside.piece(addresses, near) {
            None => Some(0),
            Some(piece) if piece.is_inside => self.inside.request.count_all(addresses),
            Some(_) => None,
        }
    }

    /// The number of settled points of some addresses that lie inside; see [`settle`](Self::settle).
    pub(crate) fn count(
        &mut self,
        addresses: &[Range<i64>; D],
        near: Option<&ShapeOf<R, D>>,
    ) -> u128 {
        let Self { settler, inside } = self;
        let Some(piece) = inside.piece(addresses, near) else {
            return 0;
        };
        let (within, bounds) = (&piece.within, &inside.bounds);
        let tiles = Tiles::new(within);
        let focused = |part: &[Range<i128>; D]| {
            let ends = common_box(&piece.ends, &inside.ends(part));
            let shape = (piece.shape.as_ref()).map(|shape| inside.focus(shape, &ends));
            (ends, shape)
        };
        // By tile: whether the shape has all or nothing of it and around.
        let state = |tile| match focused(&tile) {
            (_, Some(shape)) => shape.is_all_or_nothing(),
            (_, None) => Some(true),
        };
        let states: Vec<Option<bool>> = tiles.boxes().map(state).collect();
        let decide = |placed: &Placed<D>| {
            let state = states[tiles.of(placed.place)];
            match (placed.side(bounds), state) {
                (Some(false), _) | (_, Some(false)) => Some(false),
                (Some(true), Some(true)) if inside.clear.is_none() => Some(true),
                _ => None,
            }
        };
        let mut number = 0;
        // By tile: the box of the points that have to settle.
        let mut unsure: Vec<Option<[Range<i128>; D]>> = vec![None; states.len()];
        settler.list(within, |placed| {
            if inside.wants(addresses, &placed) {
                match decide(&placed) {
                    Some(is_inside) => number += u128::from(is_inside),
                    None => add_place(&mut unsure[tiles.of(placed.place)], placed.place),
                }
            }
        });
        let margin = MARGIN * i128::from(inside.moves.most(within));
        let margin = (margin as f64 * settler.width()) as i128;
        for some in joined(unsure.into_iter().flatten(), margin) {
            if inside.request.stop().is_raised() {
                break;
            }
            let (ends, shape) = focused(&some);
            let outline = inside.outline(&ends, shape);
            let mut wants =
                |placed: &Placed<D>| inside.wants(addresses, placed) && decide(placed).is_none();
            settler.settle(&some, &mut wants, &mut |settled| {
                number += u128::from(inside.holds(&settled, &outline));
            });
        }
        number
    }
}

impl<R: Request<D>, const D: usize> Inside<R, D> {
    /// The box of the places of the points of some addresses that may end inside.
    pub(crate) fn places(&self, addresses: &[Range<i64>; D]) -> [Range<i128>; D] {
        match addresses.iter().any(Range::is_empty) {
            true => from_fn(|_| 0..0),
            false => common_box(&self.request.places(addresses), &self.around),
        }
    }

    /// The box in which points end that were placed in another one.
    pub(crate) fn ends(&self, within: &[Range<i128>; D]) -> [Range<i128>; D] {
        widened(within, self.moves.most(within))
    }

    /// A shape reduced to what matters to points that end in a box.
    pub(crate) fn focus(&self, shape: &ShapeOf<R, D>, ends: &[Range<i128>; D]) -> ShapeOf<R, D> {
        shape.focus(&self.moves.region(ends))
    }

    /// The piece of some addresses; `None` if none of its points end inside.
    fn piece(
        &self,
        addresses: &[Range<i64>; D],
        near: Option<&ShapeOf<R, D>>,
    ) -> Option<Piece<ShapeOf<R, D>, D>> {
        let within = self.places(addresses);
        if within.iter().any(Range::is_empty) || self.moves.greatest_share(&within) <= 0.0 {
            return None;
        }
        let ends = self.ends(&within);
        let shape = near.or_else(|| self.request.shape());
        let shape = shape.map(|shape| self.focus(shape, &ends));
        let state = shape.as_ref().map_or(Some(true), Shape::is_all_or_nothing);
        let is_deep = common_box(&ends, &self.bounds) == ends;
        (state != Some(false)).then(|| Piece {
            is_inside: state == Some(true) && is_deep && self.clear.is_none(),
            within,
            ends,
            shape,
        })
    }

    /// Whether a point has one of some addresses, and is one of those that are requested, wherever it ends.
    fn wants(&self, addresses: &[Range<i64>; D], placed: &Placed<D>) -> bool {
        holds(addresses, &placed.address) && self.request.shows(placed.address, placed.share)
    }

    /// A shape for points that end in a box.
    fn outline(
        &self,
        ends: &[Range<i128>; D],
        shape: Option<ShapeOf<R, D>>,
    ) -> Outline<ShapeOf<R, D>, D> {
        let many = shape.as_ref().filter(|shape| shape.parts() > MANY);
        let tiles = many.map(|shape| {
            let tiles = Tiles::new(ends);
            let reduced = (tiles.boxes().map(|tile| self.focus(shape, &tile))).collect();
            (tiles, reduced)
        });
        Outline { shape, tiles }
    }

    /// Whether a point that has settled lies inside, and clear of other sets.
    fn holds(&self, settled: &Settled<D>, outline: &Outline<ShapeOf<R, D>, D>) -> bool {
        let place = settled.place;
        if !holds(&self.bounds, &place) {
            return false;
        }
        let tiles = outline.tiles.as_ref();
        let tiles = tiles.filter(|(tiles, _)| holds(&tiles.within, &place));
        let in_tile = tiles.map(|(tiles, shapes)| &shapes[tiles.of(place)]);
        let at = self.request.at(place);
        let is_in = |shape: &ShapeOf<R, D>| shape.contains(at);
        let is_in = in_tile.or(outline.shape.as_ref()).is_none_or(is_in);
        let clear = self.clear.as_ref().filter(|_| CLEARANCE && is_in);
        clear.map_or(is_in, |clear| clear.borrow_mut().permits(at))
    }
}

/// The shape that settled points must be in.
struct Outline<S, const D: usize> {
    shape: Option<S>,
    /// The shape in each tile of the box in which points end, if it has many parts.
    tiles: Option<(Tiles<D>, Vec<S>)>,
}

/// Whether an address is one of some.
fn holds<T: PartialOrd, const D: usize>(ranges: &[Range<T>; D], at: &[T; D]) -> bool {
    ranges.iter().zip(at).all(|(range, v)| range.contains(v))
}

/// A box cut into tiles.
struct Tiles<const D: usize> {
    within: [Range<i128>; D],
    corner: [i128; D],
    across: [usize; D],
}

impl<const D: usize> Tiles<D> {
    /// The sides of tiles in bits of fixed-point units: 128 grid units in the plane, 16 in space.
    const BITS: u32 = if D == 2 { 27 } else { 24 };

    /// The tiles of a box that is not empty.
    fn new(within: &[Range<i128>; D]) -> Self {
        let corner: [i128; D] = from_fn(|i| within[i].start >> Self::BITS);
        Self {
            across: from_fn(|i| (((within[i].end - 1) >> Self::BITS) - corner[i] + 1) as usize),
            within: within.clone(),
            corner,
        }
    }

    /// The boxes of all tiles.
    fn boxes(&self) -> impl Iterator<Item = [Range<i128>; D]> + '_ {
        (0..self.across.iter().product()).map(|mut rest: usize| {
            let tile = from_fn(|axis| {
                let start = (self.corner[axis] + (rest % self.across[axis]) as i128) << Self::BITS;
                rest /= self.across[axis];
                start..start + (1 << Self::BITS)
            });
            common_box(&tile, &self.within)
        })
    }

    /// The number of the tile of a place in the box.
    fn of(&self, place: [i128; D]) -> usize {
        let along = |axis: usize| ((place[axis] >> Self::BITS) - self.corner[axis]) as usize;
        let add = |number: usize, axis: usize| number * self.across[axis] + along(axis);
        (0..D).rev().fold(0, add)
    }
}
