//! Freedom: the part of each move that a point makes.
//!
//! f = min(1, 256 (1 − s)) / (1 + e⁴), and 0 for shares below 1/1600, where e says how much the field changes around
//! the point's place: the greater of E(1)/.4 and E(1.8)/.7, where E(r) is the largest |λ/s − 1| at r local spacings to
//! the left and right, below and above. So at full density nothing moves, and near edges little does.
//!
//! Where e is at most [`GENTLE`], 1/(1 + e⁴) counts as 1, and from [`STEEP`] on as 0. So bounds of the field's slopes
//! over a tile spare nearly all of the eight looks: where a field changes by less than a seventh across a local
//! spacing, its points are free. At GENTLE the part left out is 1.5 %, at STEEP .4 %.

use alloc::vec::Vec;

use super::LEAST_SHARE;
use crate::{
    sample::lattice::{Grade, Settle},
    shape::Region,
};

/// Up to here a field counts as constant around a point.
const GENTLE: f64 = 0.35;

/// From here on a point stays.
const STEEP: f64 = 4.0;

/// The distances of looks in local spacings, and the relative change there that counts as 1.
const LOOKS: [[f64; 2]; 2] = [[1.0, 0.4], [1.8, 0.7]];

/// The sides of a tile in bits of a window's units: 64 grid units.
const TILE_BITS: u32 = 19;

/// A point whose freedom is wanted.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    /// Its number in the window.
    pub(super) point: u32,
    /// Its place from the window's corner, in the window's units.
    pub(super) from_corner: [i32; 2],
    pub(super) share: f64,
}

/// The memory to find freedoms out.
#[derive(Clone, Debug, Default)]
pub(super) struct Freedoms {
    candidates: Vec<Candidate>,
    /// Bounds of the slopes by tile, as far as they are known, and the number of tiles across.
    tiles: Vec<Option<f64>>,
    places: Vec<[f64; 2]>,
    shares: Vec<f64>,
    looked: Vec<u32>,
}

/// The distance of a local spacing at a share, in units of the spacing at full density.
pub(super) fn local(share: f64) -> f64 {
    1.0 / root(share.max(LEAST_SHARE))
}

/// The square root, which rounds alike everywhere.
pub(super) fn root(v: f64) -> f64 {
    super::instruction::sqrt(v)
}

/// The eight places around a place at which a field is looked at.
pub(super) fn around([x, y]: [f64; 2], share: f64, spacing: f64) -> [[f64; 2]; 8] {
    let [a, b] = LOOKS.map(|[far, _]| far * spacing * local(share));
    [
        [x - a, y],
        [x + a, y],
        [x, y - a],
        [x, y + a],
        [x - b, y],
        [x + b, y],
        [x, y - b],
        [x, y + b],
    ]
}

/// The freedom of a point, by its share and those [`around`] it.
pub(super) fn freedom(share: f64, around: [f64; 8]) -> f32 {
    let [near, far] = around.as_chunks::<4>().0 else {
        return 0.0;
    };
    let change = |shares: &[f64; 4], whole: f64| {
        let most = shares.iter().fold(0.0f64, |most, other| {
            let change = (other - share).abs();
            if change > most { change } else { most }
        });
        most / share / whole
    };
    let (a, b) = (change(near, LOOKS[0][1]), change(far, LOOKS[1][1]));
    let e = if a > b { a } else { b };
    let part = if e <= GENTLE {
        1.0
    } else if e < STEEP {
        let squared = e * e;
        1.0 / (1.0 + squared * squared)
    } else {
        0.0
    };
    (part * inside(share)) as f32
}

/// The freedom of a point that no field thins, at the set's share. With all points these are those of the near step.
pub(super) fn constant(share: f64) -> f64 {
    if share < 1.0 { inside(share) } else { 1.0 }
}

/// The freedom of a point where the field counts as constant.
pub(super) fn inside(share: f64) -> f64 {
    if share < Settle::LEAST_SHARE {
        return 0.0;
    }
    let part = 256.0 * (1.0 - share);
    if part < 1.0 { part.max(0.0) } else { 1.0 }
}

/// Whether a point that was placed at a share goes back from where the share is another one.
pub(super) fn slipped(share: f64, there: f64) -> bool {
    there < 0.5 * share || there > 2.0 * share
}

impl Freedoms {
    pub(super) fn clear(&mut self) {
        self.candidates.clear();
    }

    pub(super) fn add(&mut self, candidate: Candidate) {
        self.candidates.push(candidate);
    }

    /// Finds the freedoms of all candidates. `found` is called with the number of each, its freedom, and whether the
    /// field is so gentle that it cannot slip. `place` has the world coordinates of a point.
    pub(super) fn find(
        &mut self,
        grade: &Grade,
        (spacing, per_unit): (f64, f64),
        place: impl Fn(u32) -> [f64; 2],
        mut found: impl FnMut(u32, f32, bool),
    ) {
        self.places.clear();
        self.looked.clear();
        let Some(first) = self.candidates.first() else {
            return;
        };
        let start = (first.from_corner, first.from_corner);
        let (low, high) = self.candidates.iter().fold(start, |(low, high), c| {
            let v = c.from_corner;
            (
                [low[0].min(v[0]), low[1].min(v[1])],
                [high[0].max(v[0]), high[1].max(v[1])],
            )
        });
        let corner = low.map(|v| v >> TILE_BITS);
        let across = [0, 1].map(|i| ((high[i] >> TILE_BITS) - corner[i] + 1) as usize);
        self.tiles.clear();
        self.tiles.resize(across[0] * across[1], None);
        for (number, candidate) in self.candidates.iter().enumerate() {
            let Candidate {
                point,
                from_corner,
                share,
            } = *candidate;
            if !(Settle::LEAST_SHARE..1.0).contains(&share) {
                found(point, 0.0, true);
                continue;
            }
            let tile = [0, 1].map(|i| ((from_corner[i] >> TILE_BITS) - corner[i]) as usize);
            let slope = &mut self.tiles[tile[1] * across[0] + tile[0]];
            let slope = *slope.get_or_insert_with(|| {
                let at = place(point);
                let side = f64::from(1u32 << TILE_BITS) * per_unit;
                let room = SPARSE_LOOK * spacing;
                let into =
                    [0, 1].map(|i| f64::from(from_corner[i] & ((1 << TILE_BITS) - 1)) * per_unit);
                let min = [0, 1].map(|i| at[i] - into[i] - room);
                let max = [0, 1].map(|i| at[i] - into[i] + side + room);
                let is_far = (0..2).any(|i| max[i] - min[i] < 1e-9 * at[i].abs());
                if is_far {
                    return f64::INFINITY;
                }
                let [x, y] = grade.slopes(&Region::between(min, max));
                if x > y { x } else { y }
            });
            let reach = LOOKS[1][0] * local(share);
            let steepest = LOOKS
                .iter()
                .fold(0.0f64, |most, [far, whole]| most.max(far / whole));
            // With room for what rounds.
            let change = slope * spacing * local(share) / share * steepest * 1.000_1 + 1e-9;
            if reach <= SPARSE_LOOK && change <= GENTLE {
                found(point, inside(share) as f32, true);
            } else {
                self.looked.push(number as u32);
                self.places.extend(around(place(point), share, spacing));
            }
        }
        self.shares.clear();
        self.shares.resize(self.places.len(), 0.0);
        grade.shares(&self.places, &mut self.shares);
        for (&number, around) in self.looked.iter().zip(self.shares.as_chunks::<8>().0) {
            let Candidate { point, share, .. } = self.candidates[number as usize];
            found(point, freedom(share, *around), false);
        }
    }
}

/// How far around a tile its slopes are bounded, in spacings; points whose looks go farther look.
const SPARSE_LOOK: f64 = 8.0;
