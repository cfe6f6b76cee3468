//! What counting the points of a selection takes, known before it begins.
//!
//! The unit is a lattice row that is counted by itself, about a microsecond.

use strew_core::{Area, PointSet, Region, Spacing, Warp, server};

/// About how many lattice units a mean spacing has.
const UNITS: f64 = 3.0;
/// The rows that are looked at together, in mean spacings.
const STRIP: f64 = 256.0 / UNITS;
/// Points beside an outline are compared with every edge in their strip; so much of a row takes one
/// comparison for each unit of outline and each edge.
const COMPARISON: f64 = 5e-4;

/// A request for points, as far as it decides what counting costs.
#[derive(Clone, Debug)]
pub(super) struct Selection {
    /// The set, without what the area says.
    pub(super) set: PointSet,
    /// Where points are requested.
    pub(super) area: Area,
    /// Whether the set keeps clear of others.
    pub(super) keeps_clear: bool,
}

/// The number of rows that are counted one by one, or points tested, which takes as long: none for a
/// box without warp.
pub(super) fn rows(selection: &Selection) -> f64 {
    let area = &selection.area;
    let placement = selection.set.placement();
    let is_box = matches!(area, Area::Region(_));
    let is_closed = placement.warp == Warp::OFF && !selection.keeps_clear;
    let Some(bounds) = area.bounds().filter(|_| !(is_box && is_closed)) else {
        return 0.0;
    };
    let spacing = placement.spacing.get();
    let [width, height] = sides(bounds);
    let along = server::outline(area, bounds) * UNITS / spacing;
    let across = if is_box {
        0.0
    } else {
        height * UNITS / spacing
    };
    let cleared = if selection.keeps_clear {
        width * height * placement.spacing.density() * placement.keep.get()
    } else {
        0.0
    };
    along + across + cleared
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
/// there is none to pass.
pub(super) fn least_spacing(selection: &Selection, most: f64) -> f64 {
    /// Each step goes this far.
    const STEP: f64 = 0.8;
    if rows(selection) == 0.0 {
        return 0.0;
    }
    let mut trial = selection.clone();
    loop {
        let mut placement = trial.set.placement();
        let spacing = placement.spacing.get();
        let Ok(next) = Spacing::new(spacing * STEP) else {
            return spacing;
        };
        placement.spacing = next;
        trial.set = trial.set.placed(placement);
        if rows(&trial) > most || rows_and_edges(&trial) > most {
            return spacing;
        }
    }
}

fn sides(region: Region) -> [f64; 2] {
    [0, 1].map(|i| region.max()[i] - region.min()[i])
}
