//! How large a window has to be, by a few looks at the field.

use alloc::{vec, vec::Vec};

use super::reach::{Extent, Reach, whole_room};
use crate::{sample::lattice::Grade, shape::Region};

/// The places along each axis of a box at which a field is looked at to guess how sparse it is.
const SAMPLES: usize = 9;

/// About where the points lie that matter to those in a box, whose region is given, in units of a window; `unit` of
/// them are a spacing.
pub(super) fn guess(
    grade: &Grade,
    (region, own): (Region, Extent),
    reaches: &[Reach],
    unit: f64,
) -> Extent {
    let ([left, bottom], [right, top]) = (region.min(), region.max());
    let is_constant = grade.known().is_some();
    let samples = if is_constant { 1 } else { SAMPLES };
    let part = |i: usize| i as f64 / (SAMPLES - 1) as f64;
    let parts = || (0..samples).flat_map(|i| (0..samples).map(move |k| [part(i), part(k)]));
    let at = parts().map(|[a, b]| [left + a * (right - left), bottom + b * (top - bottom)]);
    let at: Vec<[f64; 2]> = at.collect();
    let mut shares = vec![0.0; at.len()];
    grade.shares(&at, &mut shares);
    let sparse = shares.iter().filter(|share| **share > 0.0);
    let least = sparse.fold(1.0f64, |a, b| a.min(*b));
    // Points between the samples and around them may be sparser.
    let (least, slack) = if is_constant {
        (least, 1.0)
    } else {
        (0.8 * least, 1.1)
    };
    if is_constant {
        return own.widened(whole_room(reaches, [least; 2], unit));
    }
    let mut all = own;
    for (parts, share) in parts().zip(shares) {
        let room = whole_room(reaches, [share.max(least), least], slack * unit);
        all = all.and(own.place(parts).widened(room));
    }
    all
}
