//! Freedom: the part of each move that a point makes.
//!
//! f = min(1, 256 (1 − s)) / (1 + e⁴), and 0 for shares below 1/1600, where e says how much the field changes around
//! the point's place: the greater of E(1)/.4 and E(1.8)/.7, where E(r) is the largest |λ/s − 1| at r local spacings in
//! both directions of each axis. So at full density nothing moves, and near edges little does.
//!
//! Where e is at most [`GENTLE`], 1/(1 + e⁴) counts as 1, and from [`STEEP`] on as 0. So bounds of the field's slopes
//! over a tile spare nearly all of these looks: where a field changes by less than a seventh across a local
//! spacing, its points are free. At GENTLE the part left out is 1.5 %, at STEEP .4 %.

use alloc::vec::Vec;
use core::array::from_fn;

use super::{LEAST_IN_SPACE, LEAST_SHARE};
use crate::{
    lattice::{Grade, Settle},
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
pub(super) struct Candidate<const D: usize> {
    /// Its number in the window.
    pub(super) point: u32,
    /// Its place from the window's corner, in the window's units.
    pub(super) from_corner: [i32; D],
    pub(super) share: f64,
}

/// The memory to find freedoms out.
#[derive(Clone, Debug, Default)]
pub(super) struct Freedoms<const D: usize> {
    candidates: Vec<Candidate<D>>,
    /// Bounds of the slopes by tile, as far as they are known, and the number of tiles across.
    tiles: Vec<Option<f64>>,
    places: Vec<[f64; D]>,
    shares: Vec<f64>,
    looked: Vec<u32>,
}

/// The weight of a share: the inverse of the squared local spacing, that at full density being 1.
pub(super) fn weight<const D: usize>(share: f64) -> f64 {
    if D == 2 {
        return share.max(LEAST_SHARE);
    }
    let side = libm::cbrt(share.max(LEAST_IN_SPACE));
    side * side
}

/// The distance of a local spacing at a share, in units of the spacing at full density.
pub(super) fn local<const D: usize>(share: f64) -> f64 {
    1.0 / root(weight::<D>(share))
}

/// The square root, which rounds alike everywhere.
pub(super) fn root(v: f64) -> f64 {
    super::plain::sqrt(v)
}

/// The places around a place at which a field is looked at: first those nearby, then those farther off.
fn around<const D: usize>(
    at: [f64; D],
    share: f64,
    spacing: f64,
) -> impl Iterator<Item = [f64; D]> {
    LOOKS.into_iter().flat_map(move |[far, _]| {
        let far = far * spacing * local::<D>(share);
        (0..2 * D).map(move |i| {
            let mut at = at;
            at[i / 2] += if i % 2 == 0 { -far } else { far };
            at
        })
    })
}

/// The freedom of a point, by its share and those [`around`] it.
fn freedom(share: f64, around: &[f64]) -> f32 {
    let (near, far) = around.split_at(around.len() / 2);
    let change = |shares: &[f64], whole: f64| {
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

impl<const D: usize> Freedoms<D> {
    pub(super) fn clear(&mut self) {
        self.candidates.clear();
    }

    pub(super) fn add(&mut self, candidate: Candidate<D>) {
        self.candidates.push(candidate);
    }

    /// Finds the freedoms of all candidates. `found` is called with the number of each, its freedom, and whether the
    /// field is so gentle that it cannot slip. `place` has the world coordinates of a point.
    pub(super) fn find(
        &mut self,
        grade: &Grade<D>,
        (spacing, per_unit): (f64, f64),
        place: impl Fn(u32) -> [f64; D],
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
                from_fn(|i| low[i].min(v[i])),
                from_fn(|i| high[i].max(v[i])),
            )
        });
        let corner = low.map(|v| v >> TILE_BITS);
        let across: [usize; D] = from_fn(|i| ((high[i] >> TILE_BITS) - corner[i] + 1) as usize);
        self.tiles.clear();
        self.tiles.resize(across.iter().product(), None);
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
            let tile = |i: usize| ((from_corner[i] >> TILE_BITS) - corner[i]) as usize;
            let tile = (0..D)
                .rev()
                .fold(0, |number, i| number * across[i] + tile(i));
            let slope = &mut self.tiles[tile];
            let slope = *slope.get_or_insert_with(|| {
                let at = place(point);
                let side = f64::from(1u32 << TILE_BITS) * per_unit;
                let room = SPARSE_LOOK * spacing;
                let into = from_corner.map(|v| f64::from(v & ((1 << TILE_BITS) - 1)) * per_unit);
                let min: [f64; D] = from_fn(|i| at[i] - into[i] - room);
                let max: [f64; D] = from_fn(|i| at[i] - into[i] + side + room);
                let is_far = (0..D).any(|i| max[i] - min[i] < 1e-9 * at[i].abs());
                if is_far {
                    return f64::INFINITY;
                }
                let slopes = grade.slopes(&Region::between(min, max));
                slopes
                    .into_iter()
                    .reduce(|a, b| if a > b { a } else { b })
                    .unwrap_or(0.0)
            });
            let reach = LOOKS[1][0] * local::<D>(share);
            let steepest = LOOKS
                .iter()
                .fold(0.0f64, |most, [far, whole]| most.max(far / whole));
            // With room for what rounds.
            let change = slope * spacing * local::<D>(share) / share * steepest * 1.000_1 + 1e-9;
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
        for (&number, around) in self.looked.iter().zip(self.shares.chunks_exact(4 * D)) {
            let Candidate { point, share, .. } = self.candidates[number as usize];
            found(point, freedom(share, around), false);
        }
    }
}

/// How far around a tile its slopes are bounded, in spacings; points whose looks go farther look.
const SPARSE_LOOK: f64 = 8.0;
