//! The price of making the points of a plan, by its blocks.

use strew_core::{Area, Warp};
use strew_query::Set;

use super::{ROW, UNITS, point::POINT, volume};
use crate::{Lane, planned::Planned, planned_set::PlannedSet};

/// The most points of a block.
const BLOCK: u128 = 1 << 15;
/// The longest that making a block may take among short work, in nanoseconds.
const SHORT_BLOCK: f64 = 5e6;
/// The least size of a block, in bytes.
const LEAST_BLOCK: f64 = 1024.0;
/// The fewest bytes of a point in a block.
const POINT_BYTES: f64 = 8.0;

/// The lane in which the blocks of an answer are made.
pub fn block_lane(planned: &Planned) -> Lane {
    let block = |set: &PlannedSet| set.plan.count().min(BLOCK) as f64 * set.nanoseconds;
    match planned.sets.iter().any(|set| block(set) > SHORT_BLOCK) {
        true => Lane::Long,
        false => Lane::Short,
    }
}

/// The size of the blocks of an answer whose settings allow `most` bytes: less where points are costly, so that a
/// block takes some milliseconds. The same on every machine.
pub fn block_bytes(planned: &Planned, most: usize) -> usize {
    let dearest = planned.sets.iter().map(|set| set.nanoseconds);
    let points = SHORT_BLOCK / dearest.fold(POINT, f64::max);
    let bytes = (points * POINT_BYTES).max(LEAST_BLOCK);
    if points >= BLOCK as f64 || bytes >= most as f64 {
        most
    } else {
        bytes as usize
    }
}

/// The points that a rate is charged for a plan: the points considered to make its own, or the microseconds that this
/// takes, if they are more. Considered points include those that `keep` thins out, also after the last one, and in a
/// field those that are counted and left out.
pub fn considered(planned: &Planned) -> u128 {
    let measure = planned.query.region.measure();
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
        let most = measure * planned.density;
        let all = ((count + 1.0) / set.share() - 1.0).min(most).max(count);
        all.max(microseconds)
    };
    let sets = planned.query.sets.iter().zip(&planned.sets);
    let all: f64 = sets.map(considered).sum();
    all.round() as u128
}

/// The rows that are counted to split a plan, or points made, which takes as long: many parts take little more than one.
pub fn splitting(planned: &Planned, parts: u32) -> f64 {
    /// Those of each part: rows are counted by halves, then the places of one, to find where it begins.
    const PART: f64 = 20.0;
    /// Those of ten times as many places in a row of more than a thousand.
    const TENFOLD: f64 = 20.0;
    let query = &planned.query;
    let parts = f64::from(parts.max(1));
    let [min_x, _, max_x, _] = query.region.bbox();
    let rows = |(set, planned): (&Set, &PlannedSet)| {
        if let Some(sought) =
            volume::splitting(query, set, (&*planned.plan, planned.nanoseconds), parts)
        {
            return sought / ROW;
        }
        let Some(placement) = planned.plan.plane().map(strew_core::Plan::placement) else {
            return 0.0;
        };
        let units = UNITS / placement.spacing.get();
        let places = (max_x - min_x) * units;
        let found = parts * (PART + TENFOLD * (places / 1000.0).max(1.0).log10());
        if set.field.is_some() || !set.clear_of.is_empty() {
            return found + planned.plan.total() as f64 * planned.nanoseconds / ROW;
        }
        let area = set.area(&query.region);
        let is_box = matches!(area, Area::Region(_));
        match area.bounds() {
            Some(bounds) if !is_box || placement.warp != Warp::OFF => {
                let along = area.outline(bounds) + bounds.sides()[1];
                found + along * units * (1.0 + 0.5 * parts.log2())
            }
            _ => found,
        }
    };
    let sets = query.sets.iter().zip(&planned.sets);
    sets.map(rows).sum()
}
