//! What counting the points of a selection takes, known before it begins.
//!
//! The unit is a lattice row that is counted by itself, about a microsecond.

use strew_core::{Area, PointSet, Region, Spacing, Warp, server};

use super::{
    Lane, Placed, Planned, PlannedSet, Ready,
    query::{Nearest, Query, Set},
    resolve::{Resolved, resolve},
    single::MOST_WITHIN,
};

/// About how many lattice units a mean spacing has.
const UNITS: f64 = 3.0;
/// The rows that are looked at together, in mean spacings.
const STRIP: f64 = 256.0 / UNITS;
/// Points beside an outline are compared with every edge in their strip; so much of a row takes one
/// comparison for each unit of outline and each edge.
const COMPARISON: f64 = 5e-4;

/// Looking at a point of a field takes this much of a row.
const CANDIDATE: f64 = 0.03;

/// About how often an area is counted to find the spacing of a count; in a field less often.
const COUNTS: f64 = 32.0;
const COUNTS_IN_FIELD: f64 = 12.0;

/// About how often an area is counted to find the spacing of a count of a set.
pub(super) const fn counts(set: &Set) -> f64 {
    match set.field {
        Some(_) => COUNTS_IN_FIELD,
        None => COUNTS,
    }
}

/// How often an area is counted to know how many points of each kind it has.
pub(super) fn kinds(set: &Set) -> f64 {
    set.kinds
        .as_ref()
        .map_or(0.0, |kinds| match kinds.vary_by_place() {
            // All kinds at once.
            true => 1.0,
            false => kinds.shares().kinds() as f64,
        })
}

/// A request for points, as far as it decides what counting costs.
#[derive(Clone, Debug)]
pub(super) struct Selection {
    /// The set, without what the area says.
    pub(super) set: PointSet,
    /// Where points are requested.
    pub(super) area: Area,
    /// Whether points are looked at one by one: to keep clear of others, or for kinds whose shares vary.
    pub(super) looks_at_all: bool,
}

/// What takes more rows than this, in rows of warped sets, is planned in the lane for long work:
/// some ten milliseconds.
const SHORT_ROWS: f64 = 30_000.0;
/// A row of a set without warp takes this much of one with warp.
const PLAIN: f64 = 0.1;
/// Blocks for which more points than this are considered are made in the lane for long work.
const SHORT_BLOCK: f64 = 2e7;

/// What planning a query takes, in rows of warped sets. Sets with more than `most` rows take none:
/// they are refused.
pub(super) fn planning(query: &Query, tables: &[Ready], most: u64) -> f64 {
    // With a cursor nothing is counted.
    if query.window.cursor.is_some() {
        return 0.0;
    }
    let sets = query.sets.iter().zip(tables);
    let rows = sets.map(|(set, ready)| counted(query, set, ready));
    rows.filter(|(rows, _)| *rows <= most as f64)
        .map(|(rows, weight)| rows * weight)
        .sum()
}

/// What counting a period takes, in rows: nothing if it has all points.
pub(super) fn rows_of_period(set: &Set) -> f64 {
    /// Looking at a point of a period takes this much of a row; at its kind, too.
    const LOOK: f64 = 0.1;
    let points = set.period.map_or(0.0, |period| period.twin.points() as f64);
    let looks = f64::from(u8::from(set.is_part())) + f64::from(u8::from(set.kinds.is_some()));
    points * LOOK * looks
}

/// The lane in which something is planned that takes this many rows.
pub(super) fn lane(rows: f64) -> Lane {
    if rows > SHORT_ROWS {
        Lane::Long
    } else {
        Lane::Short
    }
}

/// The rows that are counted to plan a set, and how much of a row of a warped set each takes.
fn counted(query: &Query, set: &Set, ready: &Ready) -> (f64, f64) {
    if set.period.is_some() {
        return (rows_of_period(set), 1.0);
    }
    let bounds = query.region.bbox();
    let (spacing, counts) = match resolve(set, ready) {
        Err(_) => return (0.0, 0.0),
        Ok(Resolved::Known(spacing, _)) => (Some(spacing), 1.0 + kinds(set)),
        Ok(Resolved::Count(count)) => {
            let [min_x, min_y, max_x, max_y] = bounds;
            let area = (max_x - min_x) * (max_y - min_y);
            let guess = (area * set.share() / count.max(1) as f64).sqrt();
            (Spacing::new(guess).ok(), counts(set) + kinds(set))
        }
    };
    // What cannot be planned is refused then.
    let points = spacing.and_then(|spacing| set.points(ready, spacing).ok());
    let Some(points) = points else {
        return (0.0, 0.0);
    };
    let selection = Selection {
        set: points,
        area: set.area(&query.region),
        looks_at_all: !set.clear_of.is_empty() || set.varies(),
    };
    let is_plain = selection.set.placement().warp == Warp::OFF && !selection.looks_at_all;
    let is_plain = is_plain && set.field.is_none();
    let weight = if is_plain { PLAIN } else { 1.0 };
    // Seeking an offset counts again.
    let seeks = 1.0 + f64::from(u8::from(query.window.offset > 0));
    (rows_and_edges(&selection) * counts, weight * seeks)
}

/// The lane in which the blocks of an answer are made: points that are thinned out take as long as
/// those that stay.
pub(super) fn block_lane(planned: &Planned) -> Lane {
    /// The most points of a block.
    const BLOCK: u128 = 1 << 15;
    let sets = planned.query.sets.iter().zip(&planned.sets);
    let is_long = sets.into_iter().any(|(set, planned)| {
        let block = planned.plan.count().min(BLOCK) as f64;
        block * planned.looks_by_point(set) > SHORT_BLOCK
    });
    if is_long { Lane::Long } else { Lane::Short }
}

/// What a search for neighbors takes, known before it begins.
#[derive(Clone, Copy, Debug)]
pub struct Neighbors {
    /// The most bytes that the points and the answer with them hold.
    pub bytes: usize,
    /// Where to search.
    pub lane: Lane,
}

impl Neighbors {
    /// What a search among the points of a set takes.
    #[must_use]
    pub fn of(placed: &Placed, nearest: &Nearest) -> Self {
        /// A point without attributes, and a value, in memory and as text.
        const POINT: usize = 384;
        const VALUE: usize = 160;
        /// More points than this take milliseconds.
        const MANY: usize = 500;
        let within = nearest.radius.map_or(1.0, |radius| {
            // The disk and its rim, generously.
            let across = radius * placed.resolved.density.sqrt() + 2.0;
            across * across * 4.0
        });
        let most = nearest.k.unwrap_or(MOST_WITHIN).min(MOST_WITHIN);
        let most = match (nearest.k, nearest.radius) {
            (Some(_), None) => most,
            _ => most.min(within.ceil() as usize),
        };
        let values = placed.set.attributes.as_slice().len();
        Self {
            bytes: most * (POINT + values * VALUE),
            // In a field there may be nothing for long.
            lane: match most > MANY || placed.set.fields().next().is_some() {
                true => Lane::Long,
                false => Lane::Short,
            },
        }
    }
}

/// The points that are considered to make those of a plan: with `keep`, those that are thinned out,
/// too, also after the last one; in a field also those that are counted and left out.
#[must_use]
pub fn considered(planned: &Planned) -> u128 {
    let bounds = planned.query.region.bounds;
    let [width, height] = sides(bounds);
    let is_counted = planned.query.window.cursor.is_none();
    let considered = |(set, planned): (&Set, &PlannedSet)| {
        let count = planned.plan.count() as f64;
        if set.field.is_some() {
            let made = count * planned.looks_by_point(set);
            return match is_counted {
                true => made.max(planned.candidates as f64),
                false => made,
            };
        }
        let most = width * height * planned.spacing.density();
        ((count + 1.0) / set.share() - 1.0).min(most).max(count)
    };
    let sets = planned.query.sets.iter().zip(&planned.sets);
    let all: f64 = sets.map(considered).sum();
    all.round() as u128
}

/// The points that counting a selection looks at one by one; none without a field.
pub(super) fn candidates(selection: &Selection) -> u128 {
    // Where it is too far out is told when it is planned.
    server::candidates(&selection.set, selection.area.clone()).unwrap_or_default()
}

/// The number of rows that are counted one by one, or points tested, which takes as long: none for a
/// box without warp.
pub(super) fn rows(selection: &Selection) -> f64 {
    let area = &selection.area;
    let placement = selection.set.placement();
    let is_box = matches!(area, Area::Region(_));
    let is_closed = placement.warp == Warp::OFF && !selection.looks_at_all;
    let looks = candidates(selection) as f64 * CANDIDATE;
    let Some(bounds) = area.bounds().filter(|_| !(is_box && is_closed)) else {
        return looks;
    };
    let spacing = placement.spacing.get();
    let [width, height] = sides(bounds);
    let along = server::outline(area, bounds) * UNITS / spacing;
    let across = if is_box {
        0.0
    } else {
        height * UNITS / spacing
    };
    let cleared = if selection.looks_at_all {
        width * height * placement.spacing.density() * placement.keep.get()
    } else {
        0.0
    };
    along + across + cleared + looks
}

/// The same with what polygons of many edges take; bounded by what [`rows`] says.
pub(super) fn rows_and_edges(selection: &Selection) -> f64 {
    let rows = rows(selection);
    let area = &selection.area;
    match area.bounds() {
        Some(bounds) if rows > 0.0 && !matches!(area, Area::Region(_)) => {
            let spacing = selection.set.placement().spacing.get();
            let compared = server::comparisons(area, bounds, STRIP * spacing);
            rows + compared * UNITS / spacing * COMPARISON
        }
        _ => rows,
    }
}

/// The least spacing at which so many rows are not passed, from the selection's own downward; 0 if
/// there is none to pass, whatever the spacing.
pub(super) fn least_spacing(selection: &Selection, is_in_field: bool, most: f64) -> f64 {
    /// Each step goes this far.
    const STEP: f64 = 0.8;
    // In a field there may be rows at smaller spacings alone.
    if rows(selection) == 0.0 && !is_in_field {
        return 0.0;
    }
    let bounds = selection.area.bounds();
    let corners = bounds.map(|bounds| [bounds.min(), bounds.max()].concat());
    let reach = corners
        .iter()
        .flatten()
        .fold(0.0, |reach: f64, v| reach.max(v.abs()));
    let mut trial = selection.clone();
    loop {
        let mut placement = trial.set.placement();
        let spacing = placement.spacing.get();
        let Ok(next) = Spacing::new(spacing * STEP) else {
            return spacing;
        };
        placement.spacing = next;
        trial.set = trial.set.placed(placement);
        if trial.set.limit() < reach {
            return spacing;
        }
        if rows(&trial) > most || rows_and_edges(&trial) > most {
            return spacing;
        }
    }
}

fn sides(region: Region) -> [f64; 2] {
    [0, 1].map(|i| region.max()[i] - region.min()[i])
}
