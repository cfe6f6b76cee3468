//! Settling: small steps by which points that were left by their ranks spread evenly.
//!
//! # The problem
//!
//! A set that is thinned, or lies in a field, has the points whose rank is below the share. Ranks spread them as well
//! as an order of the blocks can, which is grainy: mean power below ν = 0.5 of 0.06 to 0.08. A free optimizer would
//! move all points until they are even, but then every point depends on every other one.
//!
//! # The idea
//!
//! Every point makes k small steps, all points at once. A step is the sum of pushes of the neighbors within about 2.5
//! local spacings, so a point depends on others only as far as the reaches of its steps add up to, some 5 to 10
//! local spacings. Neighboring chunks therefore fit, and each point can be found by itself.
//!
//! With p the points and s their shares, each looked up once where the point is placed at full density (not below
//! [`LEAST_SHARE`]), and σ the spacing at full density,
//!
//! ```text
//!     u = |d|² (s_i + s_j) / 2σ²                 d = p_i − p_j: squared distance in the pair's local spacings,
//!                                                in space with the squares of the shares' cubic roots
//!     W(u) = (a · max(0, 1 − u/ρ²))⁴ + (b · max(0, 1 − u/γ²))²
//!     p_i ← p_i + f_i Σ_j d · W(u)               cut to ±.3 local spacings a step and ±.4 in all
//! ```
//!
//! The reach comes from the mean density of the pair, so the pushes of a pair are equal and opposite, and in two
//! dimensions the pressure of such pushes does not depend on the density: no term for it is needed, and the field
//! is not looked at again. (In space it depends a little: on the cubic root of the share.) The freedom f is 0
//! where a field is steep, so that edges stay sharp, and 0 at full density. (Sets with all points make one step of their
//! own instead, with f = 1 and a limit of its own.)
//!
//! The constants ρ, a, γ, b were learned by measuring power and distances (CMA-ES); docs/algorithm.md lists them.
//!
//! # The files
//!
//! `moves` has points before and after they settle, and says how far they may go. `window` finds the points that matter
//! to some others and settles these; `reach` says how far those lie, `lister` lists them, of the plane or of a set that is
//! given. `step` is one step, over points that `cells` has sorted. `freedom` has f. `near` limits the step of sets with
//! all points. `kin` adds the pushes of points of a kind, and `past` lets these go past near neighbors. `tiles` keeps
//! settled points for places that follow. `pieces` finds and counts those that a request has.
//!
//! # Invariants
//!
//! - Where a point goes depends on points within its reach alone, not on which others are looked at, nor in which
//!   order.
//! - A point ends within .4 local spacings of its place along each axis, at most [`MOST_MOVE`] spacings. A point that
//!   was placed deeper inside an outline, or farther outside, is decided without a step.
//! - Where all points keep the distance D of the table's certificate, they keep it after each step: none goes farther
//!   than half of what separates it from D or, in the near step, farther than that toward any neighbor.
//!
//! # Cost
//!
//! A point costs k sums over the points within its reach. A window also lists and moves points around those that are
//! wanted, as far as their reaches add up, so settling many points at once costs less for each.

mod cells;
mod freedom;
mod kin;
mod lister;
mod moves;
mod near;
mod past;
mod pieces;
mod plain;
mod reach;
mod step;
mod tiles;
mod window;

pub(crate) use moves::{Box2, Moves, Placed, Settled};
pub(crate) use pieces::{Pieces, Request};

pub(crate) use kin::weight;
pub(crate) use lister::{List, Listed, Lister, Settling};
use step::Kernel;
pub(crate) use tiles::SettledTiles;
pub(crate) use window::Settler;

use crate::lattice::Settle;

/// Shares below this count as this: 20 spacings between points. So a point's reach is bounded.
pub(crate) const LEAST_SHARE: f64 = 1.0 / 400.0;

/// The same in space: some 5 spacings. What matters to a point fills a ball there.
pub(crate) const LEAST_IN_SPACE: f64 = 1.0 / 100.0;

/// The greatest move along each axis, in spacings at full density.
pub(crate) const MOST_MOVE: f64 = 8.0;

/// The pushes of each step.
const fn kernels<const D: usize>(settle: Settle) -> &'static [Kernel] {
    match settle.steps() {
        steps if D == 3 => IN_SPACE[steps as usize],
        _ if settle.is_near() => &NEAR,
        0 => &[],
        1 => &ONE,
        2 => &TWO,
        3 => &THREE,
        _ => &FOUR,
    }
}

const fn kernel([reach, push, near, guard]: [f32; 4]) -> Kernel {
    Kernel {
        reach,
        push,
        near,
        guard,
    }
}

/// The steps in space, by their number.
const IN_SPACE: [&[Kernel]; 5] = [
    &[],
    &[kernel([2.338, 0.661, 0.942, 0.609])],
    &[
        kernel([2.064, 0.693, 1.127, 0.662]),
        kernel([2.361, 0.672, 0.906, 0.784]),
    ],
    &[
        kernel([1.404, 0.973, 1.118, 0.223]),
        kernel([2.181, 0.77, 0.764, 0.182]),
        kernel([2.588, 0.62, 0.867, 0.688]),
    ],
    &[
        kernel([1.727, 0.842, 1.046, 0.657]),
        kernel([2.335, 0.748, 1.088, 0.614]),
        kernel([2.586, 0.637, 0.911, 0.347]),
        kernel([2.473, 0.514, 0.966, 0.428]),
    ],
];
/// The step of sets with all points.
const NEAR: [Kernel; 1] = [kernel([0.8, 1.249, 0.8, 0.0])];
const ONE: [Kernel; 1] = [kernel([2.395, 0.7388, 0.999, 0.605])];
const TWO: [Kernel; 2] = [
    kernel([2.29, 0.8121, 1.134, 0.5273]),
    kernel([2.403, 0.7474, 0.836, 0.7]),
];
const THREE: [Kernel; 3] = [
    kernel([1.605, 0.8757, 1.108, 0.4764]),
    kernel([2.531, 0.7804, 1.094, 0.5891]),
    kernel([2.462, 0.7751, 0.788, 0.8081]),
];
const FOUR: [Kernel; 4] = [
    kernel([2.312, 0.7987, 1.165, 0.7855]),
    kernel([1.832, 0.8284, 0.797, 0.8006]),
    kernel([2.544, 0.8413, 1.0, 0.0]),
    kernel([2.772, 0.7313, 0.836, 0.3755]),
];
