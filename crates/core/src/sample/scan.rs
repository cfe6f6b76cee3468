//! All points that may lie within a distance of a place, found in the lattice around it.
//!
//! Undoing the warp takes the place to where the table's points are, and a disc around it into one
//! that is [`Stretch::factor`] times as wide at most. Candidates are products again: the columns and
//! the rows near it, class by class. Only those whose unwarped distance can be near enough are
//! warped and converted; what decides is the distance of the coordinates reported.

use alloc::vec::Vec;
use core::ops::{ControlFlow, RangeInclusive};

use super::{Frame, Point, PointId, Sampler, fixed, stretch::Stretch, warp::NearShears};
use crate::{
    pattern::{Axis, Class},
    table::FRACTION_BITS,
};

/// Memory for [`scan`] to reuse: the columns near a place, by class.
#[derive(Clone, Debug, Default)]
pub(super) struct Scratch([Vec<Column>; 4]);

#[derive(Clone, Copy, Debug)]
struct Column {
    x: i64,
    /// From the unwarped place, in fixed-point units.
    offset: i64,
    block: u32,
}

/// What is scanned: the points of a frame.
#[derive(Clone, Copy)]
pub(super) struct Field<'a> {
    pub(super) sampler: &'a Sampler,
    pub(super) frame: &'a Frame,
    pub(super) stretch: Stretch,
}

impl Field<'_> {
    /// Calls `visit` with the squared distance of every point whose reported coordinates lie within
    /// `radius` of `at`, and of some farther ones, until it breaks. `at` is within the limit, the
    /// radius so small that its lattice neighborhood is.
    pub(super) fn scan(
        &self,
        scratch: &mut Scratch,
        at: [f64; 2],
        radius: f64,
        mut visit: impl FnMut(f64, Point) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let Self { sampler, frame, .. } = *self;
        let there = at.map(|v| (v / frame.step) as i128);
        let center = frame.shears.map_or(there, |shears| shears.invert(there));
        // Positions relative to `origin` are small.
        let (mut shears, origin) = match &frame.shears {
            Some(shears) => {
                let (near, origin) = NearShears::new(shears, center);
                (Some(near), origin)
            }
            None => (None, center),
        };
        let [left, bottom] = [0, 1].map(|i| (center[i] - origin[i]) as i64);
        let reach = self.unwarped(at, radius);
        let most = reach * reach;

        self.list_columns(&mut scratch.0, center[0], reach);
        for y in self.candidates(Axis::Y, center[1], reach) {
            let Some((x_parity, index)) = frame.pattern.visit(Axis::Y, y) else {
                continue;
            };
            let class = Class {
                x: x_parity,
                y: (y & 1) as u8,
            };
            let offset = (fixed(y) - center[1]) as i64;
            let vectors = sampler.row(sampler.map().locate(index));
            for column in &scratch.0[class.ordinal()] {
                let [dx, dy] = vectors[column.block as usize];
                let [x_off, y_off] = [column.offset + i64::from(dx), offset + i64::from(dy)];
                let (x, y_near) = (x_off as f64, y_off as f64);
                if x * x + y_near * y_near > most {
                    continue;
                }
                let displaced = [left + x_off, bottom + y_off];
                let [px, py] = match &mut shears {
                    Some(shears) => shears.apply(displaced),
                    None => displaced,
                };
                let [px, py] = [self.world(origin[0], px), self.world(origin[1], py)];
                let (x_off, y_off) = (px - at[0], py - at[1]);
                let point = Point {
                    id: PointId { x: column.x, y },
                    x: px,
                    y: py,
                };
                visit(x_off * x_off + y_off * y_off, point)?;
            }
        }
        ControlFlow::Continue(())
    }

    /// The world coordinate of a position relative to an origin.
    #[inline]
    fn world(&self, origin: i128, relative: i64) -> f64 {
        self.frame.world(origin + i128::from(relative))
    }

    /// How far, in fixed-point units, a point may be from the unwarped place whose reported
    /// coordinates lie within `radius`.
    fn unwarped(&self, at: [f64; 2], radius: f64) -> f64 {
        let step = self.frame.step;
        // Reported coordinates and quotients are good to a few parts in 2⁵³ of their size.
        let rounding = (at[0].abs().max(at[1].abs()) + radius) / step * (4.0 * f64::EPSILON);
        let reported = radius / step * (1.0 + 1e-12) + rounding + 4.0;
        self.stretch.factor * (reported + self.stretch.slack) + self.stretch.slack
    }

    /// The lattice coordinates along an axis whose points may be that near.
    fn candidates(&self, axis: Axis, center: i128, reach: f64) -> RangeInclusive<i64> {
        let [least, most] = self.sampler.reach[axis as usize];
        let reach = reach as i128 + 1;
        let first = center - reach - i128::from(most);
        let last = center + reach - i128::from(least);
        (first >> FRACTION_BITS) as i64..=(last >> FRACTION_BITS) as i64
    }

    fn list_columns(&self, columns: &mut [Vec<Column>; 4], center: i128, reach: f64) {
        columns.iter_mut().for_each(Vec::clear);
        for x in self.candidates(Axis::X, center, reach) {
            let Some((y_parity, index)) = self.frame.pattern.visit(Axis::X, x) else {
                continue;
            };
            let class = Class {
                x: (x & 1) as u8,
                y: y_parity,
            };
            columns[class.ordinal()].push(Column {
                x,
                offset: (fixed(x) - center) as i64,
                block: self.sampler.map().locate(index) as u32,
            });
        }
    }
}
