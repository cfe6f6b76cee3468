//! The moves of points in a field: the ladder's rule where the share is not the same all around.
//!
//! The ladder places the points of one share. Where the share changes from point to point, neighbors are at
//! different stages of it: one has moved because another leaves, which its other neighbors have not done yet. So
//! moves take longer where a field is steep, and points go only a part of the way where it is steeper still.

use crate::table::{Displacement, Ladder, Stage, TurnedTable, between};

/// The relative change of the share across a local spacing up to which a field counts as constant.
const GENTLE: f64 = 1.0 / 256.0;

/// The relative change at which about half of a move is left, as its reciprocal. On the table `blue` with 129
/// intervals, in a ramp of five octaves over 400 spacings, `δ_min` is 0.15 at 1/33, 0.32 at 1/60, 0.34 at 1/64 and
/// 0.38 at 1/72, but the variance of counts at shares near 1/32 is 0.113, 0.118, 0.119 and 0.121.
const STEEP: f64 = 64.0;

/// The places around a place, a local spacing away, at which a field is looked at for its steepness.
#[inline(always)]
pub(crate) fn around([x, y]: [f64; 2], share: f64, spacing: f64) -> [[f64; 2]; 4] {
    let far = spacing / square_root(share);
    [[x - far, y], [x + far, y], [x, y - far], [x, y + far]]
}

/// The square root, which rounds alike everywhere.
#[inline(always)]
fn square_root(v: f64) -> f64 {
    #[cfg(feature = "std")]
    return v.sqrt();
    #[cfg(not(feature = "std"))]
    libm::sqrt(v)
}

/// The square of how steep a field is at a place of a share, which is not 0, by the shares [`around`] it: the relative
/// change to the farther one of each axis. 0 where that is [`GENTLE`].
#[inline(always)]
pub(crate) fn steepness(share: f64, [left, right, below, above]: [f64; 4]) -> f64 {
    let change = |a: f64, b: f64| {
        let (a, b) = ((a - share).abs(), (b - share).abs());
        if a > b { a } else { b }
    };
    let (x, y) = (change(left, right), change(below, above));
    let beyond = (x * x + y * y) / (share * share) - GENTLE * GENTLE;
    if beyond > 0.0 { beyond } else { 0.0 }
}

/// Whether the [`steepness`] is 0 at all places with shares from `least` on, by bounds of the change along x and y
/// for each world unit up to a local spacing from the places.
pub(crate) fn is_gentle(least: f64, [x, y]: [f64; 2], spacing: f64) -> bool {
    // With room for what rounds.
    let change = square_root(x * x + y * y) * spacing / square_root(least);
    change * 1.01 + 1e-12 <= GENTLE * least
}

/// The time by which events begin earlier and end later where a field has the square of a [`steepness`]: by the units
/// of a stage's way that a share of 1 takes.
#[inline(always)]
pub(crate) fn longer(per_share: f64, share: f64, steepness: f64) -> f64 {
    per_share * (share * square_root(steepness))
}

/// The part of a move that is left, by the square of a [`steepness`].
#[inline(always)]
pub(crate) fn damping(steepness: f64) -> f64 {
    1.0 / (1.0 + STEEP * STEEP * steepness)
}

/// The displacement in a field of the block at a position of the order, whose displacement at full density is
/// `full`, at a place of a share, which is not 0. `around` looks up the shares [`around`] the place, if they matter.
#[inline]
pub(crate) fn moved(
    (turned, ladder): (&TurnedTable, &Ladder),
    position: usize,
    full: Displacement,
    share: f64,
    around: impl FnOnce() -> [f64; 4],
) -> Displacement {
    let stage = ladder.stage(share);
    if stage == Stage::FULL {
        return full;
    }
    let steepness = steepness(share, around());
    let stage = stage.spread_by(longer(stage.per_share(), share, steepness));
    let to = turned.moved(ladder, stage, position);
    between(full, to, damping(steepness))
}
