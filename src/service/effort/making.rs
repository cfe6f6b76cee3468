//! What making the points of a plan takes: the price of its blocks.

use strew_core::Region;

use super::layers::look;
#[cfg(feature = "daemon")]
use crate::service::Lane;
use crate::service::{planned::Planned, planned_set::PlannedSet, query::Set};

/// A point that is copied and written, in nanoseconds.
const POINT: f64 = 50.0;
/// A value of an attribute.
const VALUE: f64 = 20.0;
/// A point that is thinned out, and one of a field that is looked at.
const PASSED: f64 = 0.15;
const LOOKED_AT: f64 = 30.0;
/// A point that stays looks at the field around it: how steep it is decides how far it moves.
const AROUND: f64 = 4.0;
/// A normal looks at the heights on four sides.
const SLOPE: f64 = 4.0;
/// The most points of a block.
const BLOCK: u128 = 1 << 15;
/// What a block may take among short work, in nanoseconds.
const SHORT_BLOCK: f64 = 5e6;
/// The least size of a block, in bytes.
const LEAST_BLOCK: f64 = 1024.0;
/// The fewest bytes of a point in a block.
const POINT_BYTES: f64 = 8.0;

/// What making a point of a set takes, in nanoseconds, where testing a place against other layers takes `test` and
/// so many points are looked at to make one.
pub(in crate::service) fn point(set: &Set, looks: f64, test: f64, within: Region) -> f64 {
    let field = set.field.as_ref().map(|field| &field.spec);
    let passed = match field {
        Some(_) => {
            let look = look(field, within);
            looks * (LOOKED_AT + look) + AROUND * look
        }
        None => looks * PASSED,
    };
    let varied = set.kinds.iter().flat_map(|kinds| &kinds.fields);
    let varied = look(varied.map(|(_, field)| &field.spec), within);
    let ground = set.terrain.as_ref().map_or(0.0, |terrain| {
        let is_sloped = terrain.has_normals || terrain.align.is_some();
        let looks = if is_sloped { 1.0 + SLOPE } else { 1.0 };
        looks * look([&terrain.field.spec], within)
    });
    let values = set.attributes.as_slice().len() as f64;
    // Points that are not clear are tested, too.
    POINT + VALUE * values + passed + varied + ground + test * looks.min(AROUND)
}

/// The lane in which the blocks of an answer are made.
#[cfg(feature = "daemon")]
pub(in crate::service) fn block_lane(planned: &Planned) -> Lane {
    let block = |set: &PlannedSet| set.plan.count().min(BLOCK) as f64 * set.nanoseconds;
    match planned.sets.iter().any(|set| block(set) > SHORT_BLOCK) {
        true => Lane::Long,
        false => Lane::Short,
    }
}

/// The size of the blocks of an answer whose settings allow `most` bytes: less where points are costly, so that a
/// block takes some milliseconds. The same on every machine.
pub(in crate::service) fn block_bytes(planned: &Planned, most: usize) -> usize {
    let dearest = planned.sets.iter().map(|set| set.nanoseconds);
    let points = SHORT_BLOCK / dearest.fold(POINT, f64::max);
    let bytes = (points * POINT_BYTES).max(LEAST_BLOCK);
    if points >= BLOCK as f64 || bytes >= most as f64 {
        most
    } else {
        bytes as usize
    }
}

/// What a rate is charged for the points of a plan: those that are considered to make them, or the microseconds that
/// this takes if they are more. With `keep`, points that are thinned out are considered, too, also after the last
/// one; in a field also those that are counted and left out.
#[must_use]
pub fn considered(planned: &Planned) -> u128 {
    let bounds = planned.query.region.bounds;
    let [width, height] = super::sides(bounds);
    let is_counted = planned.query.window.cursor.is_none();
    let considered = |(set, planned): (&Set, &PlannedSet)| {
        let count = planned.plan.count() as f64;
        let microseconds = count * planned.nanoseconds * 1e-3;
        if set.field.is_some() {
            let made = count * planned.looks_by_point(set);
            let all = match is_counted {
                true => made.max(planned.candidates as f64),
                false => made,
            };
            return all.max(microseconds);
        }
        let most = width * height * planned.spacing.density();
        let all = ((count + 1.0) / set.share() - 1.0).min(most).max(count);
        all.max(microseconds)
    };
    let sets = planned.query.sets.iter().zip(&planned.sets);
    let all: f64 = sets.map(considered).sum();
    all.round() as u128
}
