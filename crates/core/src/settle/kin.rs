//! Kin: points of a kind, which push each other once more.
//!
//! # The problem
//!
//! Where all points settle alike, all of them together are even, but each kind stays as grainy as its labels left it
//! among the points of low ranks.
//!
//! # The idea
//!
//! The points of a kind are a set of their own, whose share is the kind's part of the share. So in each step they push
//! each other by the same rule a second time, with one more kernel and with distances in local spacings of the
//! kind:
//!
//! ```text
//!     o = max(part · s, 1/800)             u = |d|² (o_i + o_j) / 2σ²
//!     W(u) = (a · part^(−3/32) · max(0, 1 − u/ρ²))⁴
//! ```
//!
//! The sum of these pushes is cut to ±.15 local spacings along each axis, and joins that of all points before the point
//! goes. Each kind is summed in a pass of its own, whose cells have its points only: a rare kind reaches farther, but
//! finds as few neighbors.
//!
//! Kernels of this sort bring points of different kinds nearer to each other, and ranks leave pairs where a field is so
//! steep that points hardly move. So a point with a near neighbor moves more freely, and goes past it ([`Past`]).
//!
//! # Which kinds
//!
//! Those with a part from 1/8 to 4/5 of all points. A rarer kind would reach so far that chunks needed many more
//! points around them, and few of its points have another one in reach; a denser one is nearly all points, and what its
//! own power can be is decided by the others (docs/kinds.md). If a set has none of these, its points settle as without
//! kinds. Kinds whose shares vary do not push each other: points are where those of the table put them.

use alloc::vec::Vec;

use super::{
    LEAST_SHARE,
    cells::{Cells, Places},
    freedom::root,
    plain::Root,
    step::{Kernel, Scale},
};
use crate::{
    kernel::Backend,
    lattice::{Lattice, Settle},
    table::{Mix, Shares},
};

/// The least and the greatest part of all points of a kind whose points push each other.
const PARTS: [f64; 2] = [1.0 / 8.0, 4.0 / 5.0];

/// Shares of a kind count as at least this: some 28 spacings. So reaches are bounded.
pub(super) const LEAST_OF_KIN: f64 = 1.0 / 800.0;

/// The greatest push of the points of a kind in a step along each axis, in local spacings of all points.
const MOST: f32 = 0.15;

/// The steps of a set with such kinds: the pushes of all points, and of those of a kind.
#[derive(Clone, Copy, Debug)]
pub(super) struct Steps {
    pub(super) all: &'static [Kernel],
    kin: &'static [[f32; 2]],
}

/// The points of a window by kinds, and their pushes.
#[derive(Clone, Debug)]
pub(super) struct Kin<const D: usize> {
    steps: Steps,
    least_part: f64,
    kinds: Vec<Kind<D>>,
    cells: Cells<D>,
    sums: [Vec<i32>; D],
}

#[derive(Clone, Debug)]
struct Kind<const D: usize> {
    part: f64,
    is_in: bool,
    /// The factor of its pushes.
    strength: f64,
    /// The numbers of its points in the window.
    points: Vec<u32>,
    /// Its points; weights are those of shares of the kind.
    places: Places<D>,
}

impl<const D: usize> Kin<D> {
    /// The kinds of a table's mix, if points of some of them push each other. Kinds that vary leave points where those of
    /// the table put them.
    pub(super) fn new(mix: Option<&Mix>, settle: Settle) -> Option<Self> {
        if settle.is_near() {
            return None;
        }
        let shares = mix?.shares();
        let least_part = least_part(shares)?;
        let kind = |kind: usize| {
            let part = shares.of(kind as u8);
            Kind {
                part,
                is_in: is_in(part),
                strength: 1.0 / root(root(root(root(root(part * part * part))))),
                points: Vec::new(),
                places: Places::default(),
            }
        };
        Some(Self {
            steps: Steps::of(settle),
            least_part,
            kinds: (0..shares.kinds()).map(kind).collect(),
            cells: Cells::default(),
            sums: [const { Vec::new() }; D],
        })
    }

    pub(super) const fn steps(&self) -> Steps {
        self.steps
    }

    /// The pushes of points of a kind of part 1 in step number `t`, which counts from 0.
    pub(super) fn kernel(&self, t: usize) -> Kernel {
        self.steps.of_kin(t, 1.0)
    }

    /// The least part of all points of a kind whose points push each other.
    pub(super) const fn least_part(&self) -> f64 {
        self.least_part
    }

    /// Forgets the points.
    pub(super) fn clear(&mut self) {
        for kind in &mut self.kinds {
            kind.points.clear();
            kind.places.clear();
        }
    }

    /// Adds point number `i` of the window, with its kind in the table.
    pub(super) fn add(&mut self, i: usize, kind: Option<u8>, share: f64) {
        let kind = kind.and_then(|kind| self.kinds.get_mut(usize::from(kind)));
        if let Some(kind) = kind.filter(|kind| kind.is_in) {
            let counted = kind.part * share.max(LEAST_SHARE);
            kind.points.push(i as u32);
            kind.places.weight.push(counted.max(LEAST_OF_KIN) as f32);
        }
    }

    /// Sums the pushes of the points of each kind in a step, which counts from 1.
    pub(super) fn push(&mut self, all: &mut Places<D>, step: u8, scale: Scale, backend: Backend) {
        let mut of_kin = core::mem::replace(&mut all.of_kin, [const { Vec::new() }; D]);
        for list in &mut of_kin {
            list.clear();
            list.resize(all.len(), 0);
        }
        for kind in self.kinds.iter_mut().filter(|kind| kind.is_in) {
            kind.follow(all);
            let kernel = self.steps.of_kin(usize::from(step) - 1, kind.strength);
            let work = (&kernel, step);
            self.cells
                .pushes(&mut kind.places, work, scale, backend, &mut self.sums);
            for (list, sums) in of_kin.iter_mut().zip(&self.sums) {
                for (&i, &sum) in kind.points.iter().zip(sums) {
                    let i = i as usize;
                    let most = (MOST * (scale.unit / all.weight[i].sqrt_())) as i32;
                    list[i] = sum.clamp(-most, most);
                }
            }
        }
        all.of_kin = of_kin;
    }
}

impl<const D: usize> Kind<D> {
    /// Puts the points where they are among all of them.
    fn follow(&mut self, all: &Places<D>) {
        let Self { points, places, .. } = self;
        let numbers = || points.iter().map(|&i| i as usize);
        for (own, all) in places.at.iter_mut().zip(&all.at) {
            own.clear();
            own.extend(numbers().map(|i| all[i]));
        }
        places.freedom.clear();
        places.freedom.extend(numbers().map(|i| all.freedom[i]));
        places.until.clear();
        places.until.extend(numbers().map(|i| all.until[i]));
    }
}

/// About how much longer the points of a lattice settle near an outline than those of a set without kinds.
pub(crate) fn weight(lattice: &Lattice) -> f64 {
    let shares = lattice.table.mix().map(Mix::shares);
    // Each pair of a kind pushes twice, and margins are wider.
    shares
        .and_then(least_part)
        .map_or(1.0, |part| 2.0 / root(part))
}

/// Whether points of a kind of a part push each other.
fn is_in(part: f64) -> bool {
    (PARTS[0]..=PARTS[1]).contains(&part)
}

/// The least part of a kind whose points push each other; `None` if there is no such kind.
fn least_part(shares: &Shares) -> Option<f64> {
    let parts = (0..shares.kinds()).map(|kind| shares.of(kind as u8));
    parts.filter(|part| is_in(*part)).reduce(f64::min)
}

impl Steps {
    const fn of(settle: Settle) -> Self {
        match settle.steps() {
            0 | 1 => ONE,
            2 => TWO,
            3 => THREE,
            _ => FOUR,
        }
    }

    /// The pushes of points of a kind in step number `t`, which counts from 0, times a strength.
    fn of_kin(&self, t: usize, strength: f64) -> Kernel {
        let [reach, push] = self.kin[t];
        Kernel {
            reach,
            push: (f64::from(push) * strength) as f32,
            near: reach,
            guard: 0.0,
        }
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

const ONE: Steps = Steps {
    all: &[kernel([2.3, 0.7141, 0.97, 0.6481])],
    kin: &[[2.3, 0.4949]],
};
const TWO: Steps = Steps {
    all: &[
        kernel([2.0, 0.7579, 0.93, 0.5831]),
        kernel([2.28, 0.8002, 0.8, 0.8544]),
    ],
    kin: &[[2.32, 0.5886], [2.35, 0.5623]],
};
const THREE: Steps = Steps {
    all: &[
        kernel([1.707, 0.8447, 1.004, 0.5158]),
        kernel([2.359, 0.7395, 1.021, 0.584]),
        kernel([2.422, 0.7208, 0.761, 0.8591]),
    ],
    kin: &[[2.453, 0.5772], [2.359, 0.6181], [2.392, 0.5285]],
};
const FOUR: Steps = Steps {
    all: &[
        kernel([1.635, 0.8069, 0.885, 0.6309]),
        kernel([2.277, 0.8923, 0.944, 0.6285]),
        kernel([2.008, 0.6801, 0.866, 0.4087]),
        kernel([2.499, 0.767, 0.72, 0.8149]),
    ],
    kin: &[
        [2.101, 0.8467],
        [2.479, 0.6602],
        [2.159, 0.5849],
        [2.31, 0.4356],
    ],
};
