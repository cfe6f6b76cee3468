//! The settler of a lattice of the plane, and settled points near places, kept tile by tile for the places that follow.

use alloc::{boxed::Box, vec::Vec};
use core::ops::ControlFlow;

use super::{Box2, Settled, Settler, lister::Lister};
use crate::lattice::{Lattice, PointId};

/// The most tiles that are kept.
const MOST: usize = 64;

/// The least side of a tile, in bits of fixed-point units: 64 grid units.
const LEAST_BITS: u32 = 26;

/// Settled points by the tiles in which they were placed.
#[derive(Clone, Debug)]
pub(crate) struct SettledTiles {
    settler: Settler,
    tiles: Vec<Tile>,
    /// The place of the tile that is replaced next.
    oldest: usize,
}

#[derive(Clone, Debug)]
struct Tile {
    bits: u32,
    at: [i128; 2],
    points: Vec<Settled>,
}

impl SettledTiles {
    /// No tiles of a lattice whose points settle; `None` of others.
    pub(crate) fn new(lattice: &Lattice) -> Option<Box<Self>> {
        Some(Box::new(Self {
            settler: Settler::new(lattice)?,
            tiles: Vec::new(),
            oldest: 0,
        }))
    }

    /// Calls `visit` for all points that settle in a box, and for others near it, until it breaks. `made` is called
    /// with the number of points of each tile that was made.
    pub(crate) fn visit(
        &mut self,
        within: &Box2,
        mut made: impl FnMut(usize) -> ControlFlow<()>,
        mut visit: impl FnMut(&Settled) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let placed = self.settler.moves.around(within);
        let widest = placed.iter().map(|range| range.end - range.start);
        let widest = widest.fold(0, i128::max);
        let mut bits = LEAST_BITS;
        while widest > 2 << bits {
            bits += 1;
        }
        // A window holds tiles up to the width of a band.
        let bits = bits.min(30);
        let [xs, ys] = placed.map(|range| range.start >> bits..=(range.end - 1) >> bits);
        for y in ys {
            for x in xs.clone() {
                let tile = match self.find(bits, [x, y]) {
                    Some(tile) => tile,
                    None => {
                        let tile = self.make(bits, [x, y]);
                        made(self.settler.listed())?;
                        tile
                    }
                };
                for point in &self.tiles[tile].points {
                    visit(point)?;
                }
            }
        }
        ControlFlow::Continue(())
    }

    fn find(&self, bits: u32, at: [i128; 2]) -> Option<usize> {
        let is = |tile: &Tile| tile.bits == bits && tile.at == at;
        self.tiles.iter().position(is)
    }

    fn make(&mut self, bits: u32, at: [i128; 2]) -> usize {
        let within = at.map(|v| v << bits..(v + 1) << bits);
        let mut points = Vec::new();
        self.settler
            .settle(&within, &mut |_| true, &mut |settled| points.push(settled));
        let tile = Tile { bits, at, points };
        if self.tiles.len() < MOST {
            self.tiles.push(tile);
            return self.tiles.len() - 1;
        }
        let place = self.oldest;
        self.oldest = (place + 1) % MOST;
        self.tiles[place] = tile;
        place
    }
}

impl Settler {
    /// A settler of a lattice whose points settle; `None` of others.
    pub(crate) fn new(lattice: &Lattice) -> Option<Self> {
        let (settle, grade) = (lattice.settle()?, lattice.grade.clone()?);
        Some(Self::of(Lister::new(lattice), grade, settle))
    }

    /// The settled place of an address, or `None` if it has no point.
    pub(crate) fn point(&mut self, lattice: &Lattice, id: PointId) -> Option<[i128; 2]> {
        let place = lattice.place(id)?;
        self.settled(place, &mut |placed| {
            PointId::of(placed.address) == id && lattice.shows(id, placed.share)
        })
    }
}

impl PointId {
    /// The id of an address.
    pub(crate) const fn of([x, y]: [i64; 2]) -> Self {
        Self { x, y }
    }
}
