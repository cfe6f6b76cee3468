//! Ground: the points of another set around a piece of work, listed in bulk and marked on grids.
//!
//! # The problem
//!
//! A set that keeps clear of another one loses every point that has a point of the other set nearer than the distance.
//! `Clearance` decides that for any place by a search in the unbounded lattice, which visits the lattice points that
//! the warp may have moved there. A plan tests thousands of neighboring places, and their searches visit the same
//! points again and again.
//!
//! # The idea
//!
//! The piece of a walk is cut into tiles. The other set's points in the box around a tile are listed by one search and
//! sorted into cells; a test then reads a few cells:
//!
//! ```text
//!        a piece                     the box around a tile
//!     ┌──────┬──────┬──────┐        ┌──────────────────┐
//!     │      │marked│      │        │ ·      ·      ·  │   wider than the tile by the distance,
//!     ├──────┼──────┼──────┤        │   ┌──────────┐ · │   and a little for what rounds: it has
//!     │      │marked│marked│        │ · │  tile    │   │   every point that can decide about a
//!     └──────┴──────┴──────┘        │   └──────────┘   │   place in the tile
//!                                   └──────────────────┘
//! ```
//!
//! [`Marked`] has two grids of that box. A *fine* cell, half a distance wide or wider, has one bit: whether any listed
//! point may be near a place in it. That bit decides most places. *Coarse* cells are as wide as the distance, or as
//! three quarters of a spacing if that is more; the other places are compared with the points of the coarse cells
//! around them, some three by three.
//!
//! # When a tile is listed
//!
//! Listing costs as much as some searches, and it is not known beforehand how many places of a tile will be tested. So
//! places are searched for one by one until the searches in the tile have cost as much as its list would; then it is
//! listed. A tile thus costs at most twice the cheaper of both ways, whatever the places are. Costs are estimates
//! in visits of points, not times, so they are the same on every machine.
//!
//! # Invariants
//!
//! - A test compares dx·dx + dy·dy < distance·distance in `f64` on the coordinates of points, as a search does. So the
//!   answers do not show which way decided, and pieces may be chosen freely.
//! - Cells round, but monotonically: the cell of a coordinate never falls where the coordinate grows. So the cells
//!   between those of x − `room` and x + `room` hold every point between, however each of them was rounded.
//! - Where coordinates are too coarse for the tiles, far from the origin, or where a piece would have too many tiles or
//!   a tile too many points, there is no ground, and places are searched for.
//! - All tiles together hold at most `most_held` points. Beyond that all of them are dropped and begin anew.

use alloc::{vec, vec::Vec};

use crate::shape::Region;

/// The most tiles of a piece. Where there would be more, the other set is so dense that searches are cheaper.
const MOST_TILES: f64 = 4096.0;

/// The tiles of a piece.
#[derive(Clone, Debug)]
pub(super) struct Ground {
    /// The piece; `None` if nothing is known of the places.
    piece: Option<Piece>,
    tiles: Vec<Tile>,
    /// The number of points in all tiles, and the most. Beyond it all tiles are left and made again when they are
    /// needed.
    held: usize,
    most_held: usize,
}

#[derive(Clone, Debug)]
struct Piece {
    within: Region,
    /// The number of tiles, their sides and the reciprocals of these, by axis.
    tiles: [usize; 2],
    side: [f64; 2],
    per_side: [f64; 2],
    /// How far a place may be outside of its tile by rounding.
    slack: f64,
}

/// The points around a tile.
#[derive(Clone, Debug)]
enum Tile {
    /// Its points are not listed; the cost of the searches in it so far.
    Searched(f64),
    Marked(Marked),
}

/// The points that are known around a place.
#[derive(Debug)]
pub(super) enum Known<'a> {
    /// None: the place is outside the piece.
    Nothing,
    /// None: the points of its tile, which has this number, are not listed.
    In(usize),
    /// All points around it.
    All(&'a Marked),
}

impl Ground {
    /// No piece, and tiles that hold up to `most` points.
    pub(super) const fn new(most: usize) -> Self {
        Self {
            piece: None,
            tiles: Vec::new(),
            held: 0,
            most_held: most,
        }
    }

    /// Turns to the places of a piece, which is cut into tiles with sides up to `most`, around each of which about
    /// `number` points lie at most. There are none if these are too many, and far from the origin, where numbers are
    /// coarser than the tiles.
    pub(super) fn aim(&mut self, within: Region, most: f64, number: f64) {
        if self
            .piece
            .as_ref()
            .is_some_and(|piece| piece.within == within)
        {
            return;
        }
        self.tiles.clear();
        self.held = 0;
        let is_possible = number <= self.most_held as f64;
        self.piece = Piece::new(within, most).filter(|_| is_possible);
    }

    /// The points that are known around a place.
    #[inline]
    pub(super) fn at(&mut self, place: [f64; 2]) -> Known<'_> {
        let Some(piece) = self.piece.as_ref() else {
            return Known::Nothing;
        };
        let Some(tile) = piece.tile(place) else {
            return Known::Nothing;
        };
        if self.tiles.is_empty() {
            self.tiles = vec![Tile::Searched(0.0); piece.tiles[0] * piece.tiles[1]];
        }
        match &self.tiles[tile] {
            Tile::Searched(_) => Known::In(tile),
            Tile::Marked(marked) => Known::All(marked),
        }
    }

    /// The box around a tile that holds everything nearer than `distance` to any of its places.
    pub(super) fn around(&self, tile: usize, distance: f64) -> Option<Region> {
        let piece = self.piece.as_ref()?;
        let room = distance * (1.0 + 1e-9) + piece.slack;
        let at = [tile % piece.tiles[0], tile / piece.tiles[0]];
        let min = [0, 1].map(|i| piece.within.min()[i] + at[i] as f64 * piece.side[i]);
        let max = [0, 1].map(|i| min[i] + piece.side[i]);
        Some(Region::between(
            min.map(|v| v - room),
            max.map(|v| v + room),
        ))
    }

    /// Adds the cost of a search in a tile. Returns whether listing its points, which costs `all`, is worth it now.
    pub(super) fn is_worth(&mut self, tile: usize, search: f64, all: f64) -> bool {
        let Tile::Searched(cost) = &mut self.tiles[tile] else {
            return false;
        };
        *cost += search;
        *cost >= all
    }

    /// Marks the points of a tile.
    pub(super) fn mark(&mut self, tile: usize, marked: Marked) {
        if self.held + marked.places.len() > self.most_held {
            self.tiles.fill(Tile::Searched(0.0));
            self.held = 0;
        }
        self.held += marked.places.len();
        self.tiles[tile] = Tile::Marked(marked);
    }
}

impl Piece {
    fn new(within: Region, most: f64) -> Option<Self> {
        let (min, max) = (within.min(), within.max());
        let farthest = min
            .iter()
            .chain(&max)
            .fold(0.0, |most: f64, v| most.max(v.abs()));
        let length = [0, 1].map(|i| max[i] - min[i]);
        let number = length.map(|length| libm::ceil(length / most).max(1.0));
        // Not so for numbers that are infinite or not a number.
        let is_possible = number[0] * number[1] <= MOST_TILES && farthest.is_finite();
        let side = [0, 1].map(|i| length[i] / number[i]);
        let slack = 8.0 * f64::EPSILON * farthest;
        let is_fine = side.iter().all(|&side| side > 64.0 * slack);
        (is_possible && is_fine).then(|| Self {
            within,
            tiles: number.map(|number| number as usize),
            side,
            per_side: side.map(|side| 1.0 / side),
            slack: slack + 1e-9 * side[0].max(side[1]),
        })
    }

    /// The number of the tile of a place; `None` outside.
    #[inline]
    fn tile(&self, place: [f64; 2]) -> Option<usize> {
        let (min, max) = (self.within.min(), self.within.max());
        let is_inside = (0..2).all(|i| min[i] <= place[i] && place[i] <= max[i]);
        let [x, y] = [0, 1].map(|i| {
            let number = ((place[i] - min[i]) * self.per_side[i]) as u32 as usize;
            number.min(self.tiles[i] - 1)
        });
        is_inside.then_some(y * self.tiles[0] + x)
    }
}

/// Square cells over a box.
#[derive(Clone, Copy, Debug)]
struct Cells {
    min: [f64; 2],
    per_cell: f64,
    /// Their numbers by axis.
    number: [usize; 2],
}

impl Cells {
    /// Cells with about the side `cell`.
    fn new(within: Region, cell: f64) -> Self {
        let (min, max) = (within.min(), within.max());
        let per_cell = 1.0 / cell;
        Self {
            min,
            per_cell,
            number: [0, 1].map(|i| ((max[i] - min[i]) * per_cell) as usize + 1),
        }
    }

    const fn all(&self) -> usize {
        self.number[0] * self.number[1]
    }

    /// The row or column of a coordinate: it never falls where the coordinate grows.
    #[inline(always)]
    fn line(&self, axis: usize, v: f64) -> usize {
        // Conversions to 32 bits are faster.
        let line = ((v - self.min[axis]) * self.per_cell) as u32 as usize;
        line.min(self.number[axis] - 1)
    }

    /// The columns or rows of all coordinates up to `room` from one.
    #[inline(always)]
    fn lines(&self, axis: usize, v: f64, room: f64) -> [usize; 2] {
        [v - room, v + room].map(|v| self.line(axis, v))
    }
}

/// Places in a box, prepared to find whether one of them is near another.
#[derive(Clone, Debug)]
pub(super) struct Marked {
    distance: f64,
    /// Fine cells, and which of them any place is near: the others need no further look.
    fine: Cells,
    is_near: Vec<bool>,
    /// Coarse cells, in which the places are sorted.
    coarse: Cells,
    /// The number of places in all coarse cells before each, row by row, and at last of all places.
    before: Vec<u32>,
    /// The places, cell by cell.
    places: Vec<[f64; 2]>,
}

/// The most fine cells along a side.
const MOST_FINE: f64 = 128.0;

impl Marked {
    /// Places in a box, with a mean distance of neighbors or less than that. Tests are of one distance.
    pub(super) fn new(within: Region, distance: f64, spacing: f64, all: &[[f64; 2]]) -> Self {
        let sides = within.sides();
        let fine = (0.5 * distance).max(sides[0].max(sides[1]) / MOST_FINE);
        let fine = Cells::new(within, fine);
        let coarse = Cells::new(within, distance.max(0.75 * spacing));
        let mut marked = Self {
            distance,
            fine,
            is_near: vec![false; fine.all()],
            coarse,
            before: vec![0; coarse.all() + 1],
            places: vec![[0.0; 2]; all.len()],
        };
        let room = marked.room();
        for place in all {
            let [left, right] = fine.lines(0, place[0], room);
            let [bottom, top] = fine.lines(1, place[1], room);
            for row in bottom..=top {
                let row = row * fine.number[0];
                marked.is_near[row + left..=row + right].fill(true);
            }
        }
        let cell_of = |place: &[f64; 2]| {
            let [x, y] = [0, 1].map(|i| coarse.line(i, place[i]));
            y * coarse.number[0] + x
        };
        for place in all {
            marked.before[cell_of(place)] += 1;
        }
        let mut sum = 0;
        for before in &mut marked.before {
            sum += *before;
            *before = sum;
        }
        // Each place moves the end of its cell down, in the end to where the cell begins.
        for place in all {
            let end = &mut marked.before[cell_of(place)];
            *end -= 1;
            marked.places[*end as usize] = *place;
        }
        marked
    }

    /// Differences of coordinates below the distance after rounding are below this before it.
    const fn room(&self) -> f64 {
        self.distance * (1.0 + 1e-12)
    }

    /// Whether any place is nearer than the distance to another, all of whose surroundings lie in the box.
    #[inline]
    pub(super) fn is_any_near(&self, at: [f64; 2]) -> bool {
        let [x, y] = [0, 1].map(|i| self.fine.line(i, at[i]));
        self.is_near[y * self.fine.number[0] + x] && self.is_any_within(at)
    }

    fn is_any_within(&self, at: [f64; 2]) -> bool {
        let (coarse, room, squared) = (&self.coarse, self.room(), self.distance * self.distance);
        let [left, right] = coarse.lines(0, at[0], room);
        let [bottom, top] = coarse.lines(1, at[1], room);
        (bottom..=top).any(|row| {
            let row = row * coarse.number[0];
            let [start, end] = [row + left, row + right + 1].map(|cell| self.before[cell] as usize);
            self.places[start..end].iter().any(|place| {
                let (x, y) = (place[0] - at[0], place[1] - at[1]);
                x * x + y * y < squared
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn places(side: f64, most: usize) -> impl Strategy<Value = Vec<[f64; 2]>> {
        proptest::collection::vec([0.0..side, 0.0..side], 0..most)
    }

    proptest! {
        #[test]
        fn a_grid_finds_what_all_pairs_do(
            all in places(1.0, 60), tested in places(1.0, 40), distance in 1e-3..0.4f64, cell in 1e-2..2.0f64,
            at in prop_oneof![Just([0.0; 2]), [-1e3..1e3f64, -1e3..1e3f64], [-1e14..1e14f64, -1e14..1e14f64]],
        ) {
            let scale = 1.0 + at[0].abs().max(at[1].abs()) * 1e-14;
            let moved = |p: &[f64; 2]| [0, 1].map(|i| at[i] + scale * p[i]);
            let all: Vec<[f64; 2]> = all.iter().map(moved).collect();
            let distance = distance * scale;
            let within = Region::between(at.map(|v| v - scale), at.map(|v| v + 2.0 * scale));
            let marked = Marked::new(within, distance, cell * scale, &all);
            for place in tested.iter().map(moved) {
                let expected = all.iter().any(|p| {
                    let (x, y) = (p[0] - place[0], p[1] - place[1]);
                    x * x + y * y < distance * distance
                });
                prop_assert_eq!(marked.is_any_near(place), expected);
            }
        }

        #[test]
        fn boxes_around_tiles_hold_all_that_is_near(
            min in [-1e6..1e6f64, -1e6..1e6f64], length in [1e-3..1e3f64, 1e-3..1e3f64], most in 1.0..1e3f64,
            at in [0.0..=1.0f64, 0.0..=1.0f64], angle in 0.0..6.3f64, distance in 1e-3..10.0f64,
        ) {
            let max = [0, 1].map(|i| min[i] + length[i]);
            let mut ground = Ground::new(1 << 10);
            ground.aim(Region::between(min, max), most, 1.0);
            let place = [0, 1].map(|i| (min[i] + at[i] * length[i]).min(max[i]));
            let Known::In(tile) = ground.at(place) else {
                // As many tiles as that are none.
                prop_assert!(length[0] / most * length[1] / most > 1000.0);
                return Ok(());
            };
            let around = ground.around(tile, distance).expect("a tile");
            let near = [place[0] + distance * angle.cos(), place[1] + distance * angle.sin()];
            prop_assert!(around.contains(near), "{near:?} {around:?}");
        }
    }

    #[test]
    fn tiles_are_listed_when_searches_have_cost_as_much() {
        let within = Region::between([0.0; 2], [10.0; 2]);
        let mut ground = Ground::new(1 << 10);
        assert!(matches!(ground.at([5.0; 2]), Known::Nothing));
        ground.aim(within, 6.0, 1.0);
        assert!(matches!(ground.at([12.0, 5.0]), Known::Nothing));
        assert!(matches!(ground.at([7.0, 3.0]), Known::In(1)));
        assert!(!ground.is_worth(1, 40.0, 100.0));
        assert!(!ground.is_worth(1, 40.0, 100.0));
        assert!(ground.is_worth(1, 40.0, 100.0));
        let around = ground.around(1, 1.0).expect("a tile");
        ground.mark(1, Marked::new(around, 0.6, 1.0, &[[7.5, 3.0]]));
        let Known::All(marked) = ground.at([7.0, 3.0]) else {
            panic!("marked");
        };
        assert!(marked.is_any_near([7.0, 3.0]) && !marked.is_any_near([6.85, 3.0]));
        // Another piece has other tiles.
        ground.aim(Region::between([0.0; 2], [9.0; 2]), 6.0, 1.0);

        assert!(matches!(ground.at([7.0, 3.0]), Known::In(1)));
    }

    #[test]
    fn few_points_are_held() {
        let mut ground = Ground::new(1 << 10);
        ground.aim(Region::between([0.0; 2], [10.0; 2]), 5.0, 1.0);
        let many = vec![[1.0; 2]; 1 << 9];
        for tile in 0..4 {
            ground.at([1.0; 2]);
            let around = ground.around(tile, 1.0).expect("a tile");
            ground.mark(tile, Marked::new(around, 1.0, 1.0, &many));
            assert!(ground.held <= ground.most_held);
        }
        let held = ground
            .tiles
            .iter()
            .filter(|tile| matches!(tile, Tile::Marked(_)));
        assert_eq!(held.count(), 2);
        // Tiles with more points than that are none.
        ground.aim(Region::between([0.0; 2], [9.0; 2]), 5.0, 2000.0);
        assert!(matches!(ground.at([1.0; 2]), Known::Nothing));
    }
}
