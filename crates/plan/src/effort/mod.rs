//! The price of a request, known before its work begins: rows to count, points to make, neighbors to find.
//!
//! The unit of counting is a lattice row that is counted by itself, about a microsecond. Prices count rows, points and
//! looks at fields and read no clock, so a request has the same price on every machine.

mod layers;
mod making;
mod neighbors;
mod point;
mod volume;

use strew_core::{
    Area, Placement, PointSet, Region, Spacing, Warp,
    server::Stop,
    space::{SpaceSet, Volume},
};

use crate::{
    Lane,
    resolve::{Resolved, resolve},
};
use layers::look;
pub(super) use layers::{Everywhere, Layers};
pub use making::block_bytes;
pub use making::block_lane;
pub use making::considered;
pub use making::splitting;
pub use neighbors::Neighbors;
use point::LOOKED_AT;
pub(super) use point::counts;
pub use point::point;
use strew_catalog::Ready;
use strew_error::Error;
use strew_query::{Amount, Query, Set};
pub(super) use volume::{
    Chains, candidates as candidates_in_space, guess as guess_in_space,
    lacking as lacking_in_space, least as least_in_space, test as test_in_space,
};

/// The approximate number of lattice units in a mean spacing.
const UNITS: f64 = 3.0;
/// Comparing a point with a side of a polygon takes this share of a row, and sorting a side in its strips this much.
const COMPARISON: f64 = 6e-4;
const SIDE: f64 = 0.5;

/// Counting a row takes this many nanoseconds, and making a point to test whether it is clear of others this many.
pub(super) const ROW: f64 = 1e3;
const TESTED: f64 = 200.0;
/// How long the number of points in a field is estimated, how long looking up the bounds of a piece takes beside the
/// look at its field, and the fewest pieces.
const ESTIMATE: f64 = 5e5;
const BOUNDS: f64 = 100.0;
const LEAST_PIECES: usize = 16;

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

/// A request for points, reduced to the parts that decide the price of counting.
#[derive(Clone, Debug)]
pub(super) struct Selection {
    /// The set, without its area.
    pub(super) set: PointSet,
    /// Where points are requested.
    pub(super) area: Area,
    /// The time for each point, in nanoseconds, if points are made and looked at one by one: to keep clear of others,
    /// or for kinds whose shares vary.
    by_point: f64,
    /// The time of a look at the field, in nanoseconds.
    look: f64,
    /// The time to find the points that are left out by their ids, in rows.
    lacked: f64,
}

impl Selection {
    /// The points of a set in an area, where testing a place against other layers takes `test` nanoseconds.
    pub(super) fn new(set: &Set, points: PointSet, area: Area, test: f64) -> Self {
        let within = area.bounds();
        let varied = set.kinds.iter().flat_map(|kinds| &kinds.fields);
        let varied = varied.map(|(_, field)| &field.spec);
        let own = set.field.as_ref().map(|field| &field.spec);
        let of = |within| (look(varied, within), look(own, within));
        let (varied, look) = within.map_or((0.0, 0.0), of);
        let made = match (varied > 0.0, test > 0.0) {
            (true, _) => ROW,
            (false, true) => TESTED,
            (false, false) => 0.0,
        };
        let unit = points.placement().spacing.get() * points.table().alpha().set_side_f64();
        Self {
            lacked: within.map_or(0.0, |within| point::lacking(set, unit, &within) / ROW),
            set: points,
            area,
            by_point: made + test + varied,
            look,
        }
    }

    /// The points of another set with the same fields.
    pub(super) fn with_set(&self, set: PointSet) -> Self {
        Self {
            set,
            ..self.clone()
        }
    }

    /// Whether the area has an end within the reach of the set.
    pub(super) fn is_near(&self) -> bool {
        let limit = self.set.limit();
        self.area.bounds().is_some_and(|bounds| {
            let mut corners = bounds.min().into_iter().chain(bounds.max());
            corners.all(|value| value.abs() <= limit)
        })
    }

    /// Whether points are looked at one by one whatever the area.
    fn looks_at_all(&self) -> bool {
        self.by_point > 0.0
    }
}

/// Queries with more rows than this, in rows of warped sets, are planned in the lane for long work: it takes
/// some milliseconds.
const SHORT_ROWS: f64 = 3_000.0;
/// A row of a set without warp takes this much of one with warp.
const PLAIN: f64 = 0.1;

/// Whether the price of planning a query is found at once: it has nothing but a few boxes.
pub fn is_plain(query: &Query) -> bool {
    let is_box = |set: &Set| set.region.is_none() && set.fields().next().is_none();
    matches!(query.region.area, Area::Region(_))
        && query.sets.len() <= 2
        && query.sets.iter().all(is_box)
}

/// The price of planning a query, in rows of warped sets.
pub fn planning(query: &Query, tables: &[Ready], limit: u64, stop: &Stop) -> Result<f64, Error> {
    if query.region.volume.is_some() {
        let rows = volume::counting(query) / ROW;
        return match rows > limit as f64 {
            true => Err(Error::TooManyRows {
                rows: rows as u128,
                limit,
            }),
            false => Ok(rows),
        };
    }
    // With a cursor nothing is counted.
    if query.window.cursor.is_some() {
        return Ok(0.0);
    }
    let mut layers = Layers::default();
    let (mut all, mut weighted) = (0.0, 0.0);
    for (i, (set, ready)) in query.sets.iter().zip(tables).enumerate() {
        if stop.is_raised() {
            return Err(Error::Internal("a price was not wanted any more"));
        }
        let (rows, price) = counted(query, set, ready, limit as f64 - all, &mut layers);
        if !query.is_counted(i) {
            // Those of later layers may look at its points.
            continue;
        }
        all += rows;
        weighted += price;
        if all > limit as f64 {
            let rows = all as u128;
            return Err(Error::TooManyRows { rows, limit });
        }
    }
    Ok(weighted)
}

/// The rows that counting the points of a set in a volume takes, where testing one against others takes `test`
/// nanoseconds.
pub(super) fn rows_of_volume(points: &SpaceSet, volume: &Volume, test: f64) -> f64 {
    volume::counting_set(points, volume, test) / ROW
}

/// The price of counting a period, in rows: 0 if it has all points.
pub(super) fn rows_of_period(set: &Set) -> f64 {
    /// Looking at a point of a period takes this much of a row; at its kind, too.
    const LOOK: f64 = 0.1;
    let points = set.period.map_or(0.0, |period| period.twin.points() as f64);
    let looks = f64::from(u8::from(set.is_part())) + f64::from(u8::from(set.kinds.is_some()));
    points * LOOK * looks
}

/// The lane in which something is planned that takes this many rows.
pub fn lane(rows: f64) -> Lane {
    if rows > SHORT_ROWS {
        Lane::Long
    } else {
        Lane::Short
    }
}

/// The rows that are counted to plan a set, and the price of these in rows of warped sets.
fn counted(query: &Query, set: &Set, ready: &Ready, most: f64, layers: &mut Layers) -> (f64, f64) {
    if set.period.is_some() {
        let rows = rows_of_period(set);
        return (rows, rows);
    }
    let bounds = query.region.bbox();
    let (spacing, counts) = match resolve(set, ready) {
        Err(_) => (None, 0.0),
        Ok(Resolved::Known(spacing, _)) => (Some(spacing), 1.0 + kinds(set)),
        Ok(Resolved::Count(count)) => {
            let [min_x, min_y, max_x, max_y] = bounds;
            let area = (max_x - min_x) * (max_y - min_y);
            let guess = (area * set.share() / count.max(1) as f64).sqrt();
            (Spacing::new(guess).ok(), counts(set) + kinds(set))
        }
    };
    let places = match set.amount {
        Amount::Count(_) => None,
        _ => spacing.and_then(|spacing| Everywhere::of(set, spacing, &set.area(&query.region))),
    };
    let test = layers.test(set, places);
    layers.push(set, spacing, query.region.bounds);
    // Planning refuses what cannot be planned.
    let points = spacing.and_then(|spacing| set.points(ready, spacing).ok());
    let Some(points) = points else {
        return (0.0, 0.0);
    };
    let selection = Selection::new(set, points, set.area(&query.region), test);
    if !selection.is_near() {
        // Planning reports regions that are too far out.
        return (0.0, 0.0);
    }
    let is_plain = selection.set.placement().warp == Warp::OFF && !selection.looks_at_all();
    let is_plain = is_plain && set.field.is_none();
    let weight = if is_plain { PLAIN } else { 1.0 };
    // Seeking an offset counts again.
    let seeks = 1.0 + f64::from(u8::from(query.window.offset > 0));
    let rows = rows(&selection);
    let edges = edges(&selection, rows, most / counts);
    let times = counts * seeks;
    ((rows + edges) * counts, (rows * weight + edges) * times)
}

/// The points that counting a selection looks at one by one; none without a field.
pub(super) fn candidates(selection: &Selection) -> u128 {
    // Bounds take longer than a look. Planning reports regions that are too far out.
    let pieces = (ESTIMATE / (BOUNDS + 4.0 * selection.look)) as usize;
    let counted = (selection.set).candidates(selection.area.clone(), pieces.max(LEAST_PIECES));
    counted.unwrap_or_default()
}

/// The number of rows that are counted one by one, or points tested, which takes as long: none for a
/// box without warp.
fn rows(selection: &Selection) -> f64 {
    let area = &selection.area;
    let placement = selection.set.placement();
    let is_box = matches!(area, Area::Region(_));
    let is_closed = placement.warp == Warp::OFF && !selection.looks_at_all();
    let candidates = candidates(selection) as f64;
    let looks = candidates * (LOOKED_AT + selection.look) / ROW + selection.lacked;
    let Some(bounds) = area.bounds() else {
        return looks;
    };
    let looks = looks + settled(selection, bounds, candidates);
    if is_box && is_closed {
        return looks;
    }
    let spacing = placement.spacing.get();
    let [width, height] = bounds.sides();
    let along = area.outline(bounds) * UNITS / spacing;
    let across = if is_box {
        0.0
    } else {
        height * UNITS / spacing
    };
    let cleared = if selection.looks_at_all() {
        let points = width * height * placement.spacing.density() * placement.keep.get();
        points * selection.by_point / ROW
    } else {
        0.0
    };
    along + across + cleared + looks
}

/// The rows that settling the points near an outline takes: some thirty places for each local spacing of it, but no
/// more than all candidates of a field take.
fn settled(selection: &Selection, bounds: Region, candidates: f64) -> f64 {
    /// Nanoseconds for a step of the places of a local spacing, and of those around one point.
    const STEP: f64 = 4000.0;
    let set = &selection.set;
    let Placement { spacing, keep, .. } = set.placement();
    let steps = set.settling();
    if steps == 0.0 {
        return 0.0;
    }
    let share = set.greatest_share(&bounds).min(keep.get());
    let outline = selection.area.outline(bounds) / spacing.get();
    let near = outline * share.sqrt();
    let is_in_field = candidates > 0.0 || selection.look > 0.0;
    let places = if is_in_field {
        near.min(candidates)
    } else {
        near
    };
    places * steps * STEP / ROW
}

/// The rows that the sides of polygons take, beside those along outlines; none if the rows alone exceed `most`.
fn edges(selection: &Selection, rows: f64, most: f64) -> f64 {
    let area = &selection.area;
    let sorted = area.vertices() as f64 * SIDE;
    let is_box = matches!(area, Area::Region(_));
    match area.bounds() {
        Some(bounds) if rows > 0.0 && rows + sorted <= most && !is_box => {
            let spacing = selection.set.placement().spacing;
            sorted + area.comparisons(bounds, spacing.get()) * COMPARISON
        }
        _ => sorted,
    }
}

/// The number of rows, and the work for polygons of many edges unless the rows alone exceed `most`.
pub(super) fn rows_and_edges(selection: &Selection, most: f64) -> f64 {
    let rows = rows(selection);
    rows + edges(selection, rows, most)
}

/// The smallest spacing that stays within `most` rows, searched downward from the selection's own; 0 if there are no
/// rows at any spacing.
pub(super) fn least_spacing(
    selection: &Selection,
    is_in_field: bool,
    most: f64,
    stop: &Stop,
) -> f64 {
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
    let placement = selection.set.placement();
    // The selection some steps further; `None` if it is out of reach or has too many rows.
    let step = |number: i32| {
        let spacing = placement.spacing.get() * STEP.powi(number);
        let spacing = Spacing::new(spacing).ok()?;
        let set = selection.set.clone().placed(Placement {
            spacing,
            ..placement
        });
        if stop.is_raised() || set.limit() < reach {
            return None;
        }
        let trial = selection.with_set(set);
        (rows_and_edges(&trial, most) <= most).then_some(spacing.get())
    };
    // Steps are doubled until one is too far, then halved: each takes as long as looking at all edges.
    let (mut known, mut number, mut length, mut is_over) = (placement.spacing.get(), 0, 1, false);
    while length > 0 {
        match step(number + length) {
            Some(spacing) => (known, number) = (spacing, number + length),
            None => is_over = true,
        }
        length = if is_over { length / 2 } else { length * 2 };
    }
    known
}
