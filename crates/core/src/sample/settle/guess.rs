//! How large a window has to be, by a few looks at the field.

use alloc::{vec, vec::Vec};
use core::array::from_fn;

use super::{
    freedom::weight,
    reach::{Extent, Reach, whole_room},
};
use crate::{sample::lattice::Grade, shape::Region};

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
