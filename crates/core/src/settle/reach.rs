//! How far points reach: which others matter to where they go, and how large a window has to be for that, by a few looks
//! at the field.

use alloc::{vec, vec::Vec};
use core::array::from_fn;

use super::{
    cells::Places,
    freedom::{root, weight},
    kin::LEAST_OF_KIN,
    plain::{greater, lesser},
    step::{Kernel, STEP, WHOLE},
};
use crate::{lattice::Grade, shape::Region};

/// Room for what rounds, in units of a window.
const ROOM: i64 = 4;

/// The number of successive points, which are near each other, whose reach is found at once.
const NEAR: usize = 16;

/// How far the pushes of a step reach.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reach {
    /// Those of all points, in local spacings.
    all: f64,
    /// Those of points of a kind, in local spacings of the kind, and the least part of all points that a kind counts
    /// as.
    kin: Option<[f64; 2]>,
}

impl Reach {
    pub(super) fn new(kernel: &Kernel, kin: Option<(&Kernel, f64)>) -> Self {
        let widest = |kernel: &Kernel| f64::from(kernel.reach.max(kernel.near));
        Self {
            all: widest(kernel),
            kin: kin.map(|(kernel, part)| [widest(kernel), part]),
        }
    }

    /// The greatest reach, in local spacings.
    pub(super) fn widest(&self) -> f64 {
        let kin = self.kin.map_or(0.0, |[reach, part]| reach / root(part));
        self.all.max(kin)
    }

    /// The greatest reach of points of some weights, in spacings at full density.
    fn between(&self, [a, b]: [f64; 2]) -> f64 {
        let all = self.all * root(2.0 / (a + b));
        self.kin.map_or(all, |[reach, part]| {
            // In the plane, where there are kinds, weights are shares.
            let counted = |share: f64| (part * share).max(LEAST_OF_KIN);
            // With room for shares that round.
            all.max(reach * 1.000_001 * root(2.0 / (counted(a) + counted(b))))
        })
    }
}

/// How far a point may have gone along each axis before step number `t`, which counts from 0, in local spacings.
fn moved_before(t: usize) -> f64 {
    f64::from(WHOLE).min(f64::from(STEP) * t as f64)
}

/// How far from a point of a weight, along each axis, others may be that push it in step number `t`, which counts from
/// 0, if none is sparser than `least`: by the places where they were placed, in spacings at full density.
fn room(reach: &Reach, t: usize, weights: [f64; 2]) -> f64 {
    let [a, b] = weights.map(|weight| 1.0 / root(weight));
    reach.between(weights) + moved_before(t) * (a + b)
}

/// [`room`] in units of a window, and a little for what rounds.
pub(super) fn step_room(reach: &Reach, t: usize, weights: [f64; 2], unit: f64) -> i64 {
    (room(reach, t, weights) * unit) as i64 + ROOM
}

/// How far from a point others may be that matter to where it goes in all steps, in units of a window.
pub(super) fn whole_room(reaches: &[Reach], weights: [f64; 2], unit: f64) -> i64 {
    let steps = reaches.iter().enumerate();
    steps
        .map(|(t, reach)| step_room(reach, t, weights, unit))
        .sum()
}

/// The ranges of a box along its axes, from a window's corner.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extent<const D: usize> {
    pub(super) min: [i64; D],
    pub(super) max: [i64; D],
}

impl<const D: usize> Extent<D> {
    pub(super) const NONE: Self = Self {
        min: [i64::MAX; D],
        max: [i64::MIN; D],
    };

    /// Adds places between some ends, with room around them.
    pub(super) fn add(&mut self, [min, max]: [[f32; D]; 2], room: i64) {
        for i in 0..D {
            self.min[i] = self.min[i].min(min[i] as i64 - room);
            self.max[i] = self.max[i].max(max[i] as i64 + room);
        }
    }

    #[inline(always)]
    pub(super) fn holds(&self, at: [f32; D]) -> bool {
        // Beyond what single precision holds there are no points.
        let [min, max] = [self.min, self.max].map(|v| v.map(|v| v as f32));
        let mut holds = true;
        for i in 0..D {
            holds &= (min[i] <= at[i]) & (at[i] <= max[i]);
        }
        holds
    }

    /// A place, by parts of the sides.
    pub(super) fn place(&self, parts: [f64; D]) -> Self {
        let place = from_fn(|i| {
            let side = self.max[i] - self.min[i];
            self.min[i] + (parts[i] * side as f64) as i64
        });
        Self {
            min: place,
            max: place,
        }
    }

    /// With some room on all sides.
    pub(super) fn widened(self, room: i64) -> Self {
        Self {
            min: self.min.map(|v| v - room),
            max: self.max.map(|v| v + room),
        }
    }

    pub(super) fn is_within(&self, other: &Self) -> bool {
        (0..D).all(|i| other.min[i] <= self.min[i] && self.max[i] <= other.max[i])
    }

    pub(super) fn and(self, other: Self) -> Self {
        Self {
            min: from_fn(|i| self.min[i].min(other.min[i])),
            max: from_fn(|i| self.max[i].max(other.max[i])),
        }
    }
}

/// The extent of the points that matter to those that move in step number `t`, which counts from 0, and the least weight
/// of these.
pub(super) fn reached<const D: usize>(
    places: &Places<D>,
    (reach, t): (&Reach, usize),
    unit: f64,
) -> (Extent<D>, f64) {
    let step = t as u8 + 1;
    let Places {
        placed,
        weight,
        freedom,
        until,
        ..
    } = places;
    let least = f64::from(weight.iter().fold(1.0, |a, &b| lesser(b, a)));
    let mut extent = Extent::NONE;
    let mut sparsest = 1.0f64;
    let chunks = weight
        .chunks(NEAR)
        .zip(freedom.chunks(NEAR).zip(until.chunks(NEAR)));
    for (number, (weights, (freedom, until))) in chunks.enumerate() {
        let placed = placed
            .each_ref()
            .map(|list| &list[number * NEAR..][..weights.len()]);
        let (mut min, mut max) = ([f32::INFINITY; D], [-f32::INFINITY; D]);
        let mut low = f32::INFINITY;
        let points = weights.iter().zip(freedom.iter().zip(until));
        for (k, (&weight, (&freedom, &until))) in points.enumerate() {
            if until >= step && freedom > 0.0 {
                for i in 0..D {
                    min[i] = lesser(placed[i][k], min[i]);
                    max[i] = greater(placed[i][k], max[i]);
                }
                low = lesser(weight, low);
            }
        }
        if low <= 1.0 {
            let weight = f64::from(low);
            extent.add([min, max], step_room(reach, t, [weight, least], unit));
            sparsest = sparsest.min(weight);
        }
    }
    (extent, sparsest)
}

/// The places along each axis of a box at which a field is looked at to guess how sparse it is.
const SAMPLES: usize = 9;
const SAMPLES_IN_SPACE: usize = 5;

/// About where the points lie that matter to those in a box, whose region is given, in units of a window; `unit` of
/// them are a spacing.
pub(super) fn guess<const D: usize>(
    grade: &Grade<D>,
    (region, own): (Region<D>, Extent<D>),
    reaches: &[Reach],
    unit: f64,
) -> Extent<D> {
    if let Some(share) = grade.known() {
        return own.widened(whole_room(reaches, [weight::<D>(share); 2], unit));
    }
    let (min, max) = (region.min(), region.max());
    let across = if D == 2 { SAMPLES } else { SAMPLES_IN_SPACE };
    let part = |i: usize| i as f64 / (across - 1) as f64;
    let parts = || {
        let number = across.pow(D as u32);
        (0..number).map(|i| from_fn(|axis| part(i / across.pow(axis as u32) % across)))
    };
    let at = parts().map(|parts: [f64; D]| from_fn(|i| min[i] + parts[i] * (max[i] - min[i])));
    let at: Vec<[f64; D]> = at.collect();
    let mut shares = vec![0.0; at.len()];
    grade.shares(&at, &mut shares);
    let sparse = shares.iter().filter(|share| **share > 0.0);
    let least = sparse.fold(1.0f64, |a, b| a.min(*b));
    // Points between the samples and around them may be sparser.
    let (least, slack) = (0.8 * least, 1.1);
    let mut all = own;
    for (parts, share) in parts().zip(shares) {
        let weights = [share.max(least), least].map(weight::<D>);
        let room = whole_room(reaches, weights, slack * unit);
        all = all.and(own.place(parts).widened(room));
    }
    all
}
