//! The scan: visits all points that may lie within a distance of a place.
//!
//! Undoing the warp takes the place to where the table's points are, and a disk around it into one that
//! is at most [`Stretch::factor`] times as wide. Candidates are products again: columns and rows near
//! it, class by class. Only those whose unwarped distance can be small enough are warped and converted.
//! The distance of the reported coordinates decides.
//!
//! [`Stretch::factor`]: crate::warp::Stretch

use alloc::{boxed::Box, vec::Vec};
use core::ops::{ControlFlow, RangeInclusive};

use super::limits::Visits;
use crate::{
    lattice::{Lattice, Line, Point, PointId},
    pattern::Axis,
    settle::SettledTiles,
    table::{FRACTION_BITS, fixed},
    warp::NearShears,
};

/// Memory that [`scan`] reuses: the columns near a place, by class.
#[derive(Clone, Debug, Default)]
pub(crate) struct Scratch {
    columns: [Vec<NearColumn>; 4],
    settled: Option<Box<SettledTiles>>,
}

#[derive(Clone, Copy, Debug)]
struct NearColumn {
    /// From the unwarped place, in fixed-point units.
    offset: i64,
    line: Line,
}

/// Calls `visit` with the squared distance of every point whose reported coordinates lie within `radius`
/// of `at`, and of some farther ones, until it or a flag breaks. `at` and the disk around it lie within the
/// lattice's limit.
pub(crate) fn scan(
    lattice: &Lattice,
    scratch: &mut Scratch,
    at: [f64; 2],
    radius: f64,
    visits: Option<&Visits>,
    mut visit: impl FnMut(f64, Point) -> ControlFlow<()>,
) -> ControlFlow<()> {
    if lattice.settle().is_some() {
        return scan_settled(lattice, scratch, at, radius, visits, visit);
    }
    let there = at.map(|v| whole(v / lattice.step));
    // Positions relative to `origin` are small.
    let (mut shears, origin, center) = match &lattice.shears {
        Some(shears) => {
            let (mut near, origin) = NearShears::new(shears, there);
            let center = near.invert([0, 1].map(|i| (there[i] - origin[i]) as i64));
            let center = [0, 1].map(|i| origin[i] + i128::from(center[i]));
            (Some(near), origin, center)
        }
        None => (None, there, there),
    };
    let [left, bottom] = [0, 1].map(|i| (center[i] - origin[i]) as i64);
    let reach = unwarped_reach(lattice, at, radius);
    let most = reach * reach;

    let table = lattice.turned.reach();
    list_columns(lattice, &mut scratch.columns, (center[0], table[0]), reach);
    for y in candidates((center[1], table[1]), reach) {
        let Some((class, block)) = lattice.row(y) else {
            continue;
        };
        let offset = (fixed(y) - center[1]) as i64;
        let (vectors, keeps) = (lattice.vectors(block), lattice.keeps(block));
        let columns = &scratch.columns[class.ordinal()];
        if let (Some(visits), None) = (visits, &lattice.grade) {
            visits.row(columns.len())?;
        }
        for column in columns.iter().filter(|column| keeps(&column.line)) {
            let [dx, dy] = vectors[column.line.block as usize];
            let [x_offset, y_offset] = [column.offset + i64::from(dx), offset + i64::from(dy)];
            let (x, y_near) = (x_offset as f64, y_offset as f64);
            if x * x + y_near * y_near > most {
                continue;
            }
            let displaced = [left + x_offset, bottom + y_offset];
            let place = match &mut shears {
                Some(shears) => shears.apply(displaced),
                None => displaced,
            };
            let [x, y_place] = [0, 1].map(|i| lattice.world(origin[i] + i128::from(place[i])));
            let (x_offset, y_offset) = (x - at[0], y_place - at[1]);
            let id = PointId {
                x: column.line.at,
                y,
            };
            let point = Point { id, x, y: y_place };
            if let Some(grade) = &lattice.grade {
                if let Some(visits) = visits {
                    visits.one()?;
                }
                if !lattice.is_left(grade, id, [x, y_place]) {
                    continue;
                }
            }
            if lattice.has_kind(id) && !lattice.without.has(id) {
                visit(x_offset * x_offset + y_offset * y_offset, point)?;
            }
        }
    }
    ControlFlow::Continue(())
}

/// Runs [`scan`] for points that settle.
fn scan_settled(
    lattice: &Lattice,
    scratch: &mut Scratch,
    at: [f64; 2],
    radius: f64,
    visits: Option<&Visits>,
    mut visit: impl FnMut(f64, Point) -> ControlFlow<()>,
) -> ControlFlow<()> {
    if scratch.settled.is_none() {
        scratch.settled = SettledTiles::new(lattice);
    }
    let Some(tiles) = &mut scratch.settled else {
        return ControlFlow::Continue(());
    };
    let reach = reported_reach(lattice, at, radius) as i128 + 1;
    let within = at.map(|v| {
        let center = whole(v / lattice.step);
        center - reach..center + reach + 1
    });
    let made = |number| visits.map_or(ControlFlow::Continue(()), |visits| visits.row(number));
    tiles.visit(&within, made, |settled| {
        if !lattice.shows(PointId::of(settled.address), settled.share) {
            return ControlFlow::Continue(());
        }
        let [x, y] = settled.place.map(|k| lattice.world(k));
        let (dx, dy) = (x - at[0], y - at[1]);
        let point = Point {
            id: PointId::of(settled.address),
            x,
            y,
        };
        visit(dx * dx + dy * dy, point)
    })
}

/// The integer part of a number. Conversions to 64 bits are faster.
fn whole(v: f64) -> i128 {
    if v.abs() < 1e18 {
        i128::from(v as i64)
    } else {
        v as i128
    }
}

/// The largest distance along each axis, in fixed-point units, of a point whose reported coordinates lie within
/// `radius`.
fn reported_reach(lattice: &Lattice, at: [f64; 2], radius: f64) -> f64 {
    // Reported coordinates and quotients err by a few parts in 2⁵³ of their size.
    let rounding = (at[0].abs().max(at[1].abs()) + radius) / lattice.step * (4.0 * f64::EPSILON);
    radius / lattice.step * (1.0 + 1e-12) + rounding + 4.0
}

/// The largest distance from the unwarped place, in fixed-point units, of a point whose reported
/// coordinates lie within `radius`.
fn unwarped_reach(lattice: &Lattice, at: [f64; 2], radius: f64) -> f64 {
    let (stretch, reported) = (lattice.stretch, reported_reach(lattice, at, radius));
    stretch.factor * (reported + stretch.slack) + stretch.slack
}

/// The lattice coordinates around a center whose points, with some least and greatest displacement, may lie
/// within `reach`.
fn candidates((center, [least, most]): (i128, [i32; 2]), reach: f64) -> RangeInclusive<i64> {
    let reach = reach as i128 + 1;
    let first = center - reach - i128::from(most);
    let last = center + reach - i128::from(least);
    (first >> FRACTION_BITS) as i64..=(last >> FRACTION_BITS) as i64
}

fn list_columns(
    lattice: &Lattice,
    columns: &mut [Vec<NearColumn>; 4],
    center: (i128, [i32; 2]),
    reach: f64,
) {
    let range = candidates(center, reach);
    // Columns of a class have one parity, so few lists grow.
    let number = range.end().saturating_sub(*range.start()).clamp(0, 62) as usize;
    for list in &mut *columns {
        list.clear();
        list.reserve(number / 2 + 1);
    }
    for x in range {
        if let Some((class, index)) = lattice.pattern.visit(Axis::X, x) {
            columns[class.ordinal()].push(NearColumn {
                offset: (fixed(x) - center.0) as i64,
                line: lattice.line(x, index),
            });
        }
    }
}
