//! The conditions that a settled point of a piece must meet, tile by tile.

use alloc::vec::Vec;

use crate::{
    lattice::Lattice,
    near::Guard,
    settle::{Box2, Settled, Settler, common},
    shape::Area,
};

/// The sides of the tiles that are compared with an outline as a whole, in bits of fixed-point units: 128 grid units.
const TILE_BITS: u32 = 27;

/// An area of more parts is reduced to tiles before points are compared with it.
const MANY: usize = 64;

/// A box cut into tiles.
pub(super) struct Tiles<'a> {
    within: &'a Box2,
    corner: [i128; 2],
    across: [usize; 2],
}

impl<'a> Tiles<'a> {
    /// The tiles of a box that is not empty.
    pub(super) fn new(within: &'a Box2) -> Self {
        let corner = [0, 1].map(|i| within[i].start >> TILE_BITS);
        let across = |i: usize| (((within[i].end - 1) >> TILE_BITS) - corner[i] + 1) as usize;
        Self {
            within,
            corner,
            across: [across(0), across(1)],
        }
    }

    /// The boxes of all tiles.
    pub(super) fn boxes(&self) -> impl Iterator<Item = Box2> + '_ {
        (0..self.across[0] * self.across[1]).map(|i| {
            let at = [i % self.across[0], i / self.across[0]];
            let tile = [0, 1].map(|axis| {
                let start = (self.corner[axis] + at[axis] as i128) << TILE_BITS;
                start..start + (1 << TILE_BITS)
            });
            common(&tile, self.within)
        })
    }

    /// Whether a place is in the box.
    fn has(&self, place: &[i128; 2]) -> bool {
        self.within
            .iter()
            .zip(place)
            .all(|(range, k)| range.contains(k))
    }

    /// The number of the tile of a place in the box.
    pub(super) fn of(&self, place: [i128; 2]) -> usize {
        let [x, y] = [0, 1].map(|i| ((place[i] >> TILE_BITS) - self.corner[i]) as usize);
        y * self.across[0] + x
    }
}

/// The conditions that a settled point of a piece must meet.
pub(super) struct Inside<'a> {
    bounds: &'a Box2,
    area: Option<Area>,
    /// The area in each tile of the box in which points end, if it has many parts.
    tiles: Option<(Tiles<'a>, Vec<Area>)>,
    clear: &'a Guard,
    lattice: &'a Lattice,
}

impl<'a> Inside<'a> {
    /// The conditions for points that end in a box: within bounds, and in an area that is reduced to the box.
    pub(super) fn new(
        (bounds, ends): (&'a Box2, &'a Box2),
        area: Option<Area>,
        clear: &'a Guard,
        (lattice, settler): (&'a Lattice, &Settler),
    ) -> Self {
        let many = area.as_ref().filter(|area| area.parts() > MANY);
        let tiles = many.map(|area| {
            let tiles = Tiles::new(ends);
            let reduced = tiles
                .boxes()
                .map(|tile| area.focus(&settler.moves.region(&tile)));
            let reduced = reduced.collect();
            (tiles, reduced)
        });
        Self {
            bounds,
            area,
            tiles,
            clear,
            lattice,
        }
    }

    /// Whether a point that has settled lies inside.
    pub(super) fn holds(&self, settled: &Settled) -> bool {
        let [x, y] = &settled.place;
        if !self.bounds[0].contains(x) || !self.bounds[1].contains(y) {
            return false;
        }
        let tiles = self
            .tiles
            .as_ref()
            .filter(|(tiles, _)| tiles.has(&settled.place));
        let in_tile = tiles.map(|(tiles, areas)| &areas[tiles.of(settled.place)]);
        let Some(area) = in_tile.or(self.area.as_ref()) else {
            return self.clear.is_clear(self.at(settled));
        };
        let at = self.at(settled);
        area.contains(at) && self.clear.is_clear(at)
    }

    fn at(&self, settled: &Settled) -> [f64; 2] {
        settled.place.map(|k| self.lattice.world(k))
    }
}
