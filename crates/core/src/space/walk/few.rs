//! The points of a small scope, all at once.
//!
//! Rows of a few points are not worth templates, nor the warp of each patch shears of its own.

use core::ops::Range;

use super::{relative, world};
use crate::{
    kernel::{Backend, PLANES, compiled, warp_all},
    space::{
        Batch,
        columns::{Lines, columns, coordinates},
        lattice::fixed,
        scope::{Scope, common},
    },
    table::FRACTION_BITS,
};

/// The longest side, in lattice units: shears of a patch serve all of its points, and offsets fit.
const LONGEST: i64 = 256;
/// Origins are multiples of the distance of the knots of the warp.
const KNOT: i64 = 32;

/// The points of a scope that is clear of nothing and stays, with ids, unless it is too long.
pub(in crate::space) fn few(scope: &Scope) -> Option<Batch> {
    let ranges = &scope.all;
    let length = |range: &Range<i64>| range.end - range.start;
    if !scope.clear.is_empty()
        || scope.room > 0
        || ranges.iter().any(|range| length(range) > LONGEST)
    {
        return None;
    }
    let mut batch = Batch::default();
    if ranges.iter().any(Range::is_empty) {
        return Some(batch);
    }
    batch.restart(ranges.clone().map(|range| range.start & !(KNOT - 1)));
    let mut lines = Lines::default();
    for x in columns(&ranges[0]) {
        for y in columns(&ranges[1]) {
            let part = [
                common(&coordinates(x), &ranges[0]),
                common(&coordinates(y), &ranges[1]),
            ];
            lines.list(&scope.lattice, batch.origin[0], part);
            add(scope, &lines, &mut batch);
        }
    }
    if scope.lattice.shears.is_some() {
        warp(scope, &mut batch);
    }
    let ends = relative(&scope.bounds, batch.origin);
    if scope.lattice.shears.is_some() {
        compiled(Backend::best(), || batch.retain_between(&ends));
    }
    if let Some(volume) = &scope.volume {
        let origin = batch.origin;
        batch.retain(|place| volume.contains(world(scope, origin, place)));
    }
    scope.lattice.sift(&mut batch);
    Some(batch)
}

/// Adds the points of a column that lie in the bounds before the warp.
fn add(scope: &Scope, lines: &Lines, batch: &mut Batch) {
    let lattice = &scope.lattice;
    let map = lattice.table.map();
    let origin = batch.origin;
    let ends = relative(&scope.before, origin);
    let mut length = batch.len();
    for at in scope.all[2].clone() {
        let Some(visit) = lattice.pattern.visit(2, at) else {
            continue;
        };
        let plane = map.locate(visit.index);
        let z = (at - origin[2]) as i32;
        for row in &lines.y {
            if row.others ^ row.own != visit.others ^ visit.own {
                continue;
            }
            let points =
                &lines.x[usize::from(visit.others ^ row.own)][usize::from(row.own ^ visit.own)];
            let first = lattice.number([0, row.block as usize, plane]);
            let [dx, dy, dz] = lattice.vectors(plane, row.block as usize);
            let y = (row.at - origin[1]) as i32;
            let most = length + points.at.len();
            if batch.ids.len() < most {
                batch
                    .places
                    .iter_mut()
                    .for_each(|list| list.resize(2 * most, 0));
                batch.ids.resize(2 * most, [0; 3]);
            }
            let [xs, ys, zs] = batch.places.each_mut().map(|list| &mut list[length..most]);
            let ids = &mut batch.ids[length..most];
            let mut kept = 0;
            for ((&x, &block), &index) in points.at.iter().zip(&points.blocks).zip(&points.indices)
            {
                let block = usize::from(block);
                let place = [
                    x + dx[block],
                    (y << FRACTION_BITS) + dy[block],
                    (z << FRACTION_BITS) + dz[block],
                ];
                [xs[kept], ys[kept], zs[kept]] = place;
                ids[kept] = [x >> FRACTION_BITS, y, z];
                let mut is_inside = true;
                for (place, ends) in place.iter().zip(&ends) {
                    is_inside &= (ends.start <= *place) & (*place < ends.end);
                }
                if lattice.cut.is_some() {
                    is_inside &= lattice.keeps(first + block, index);
                }
                kept += usize::from(is_inside);
            }
            length += kept;
        }
    }
    batch.truncate(length);
}

/// Warps the points.
fn warp(scope: &Scope, batch: &mut Batch) {
    /// The number of positions that are warped is a multiple of this.
    const WHOLE: usize = 32;
    let (Some(shears), false) = (&scope.lattice.shears, batch.is_empty()) else {
        return;
    };
    let (origin, length) = (batch.origin, batch.len());
    let ranges = [0, 1, 2].map(|axis| {
        let [least, most] = scope.lattice.turned.reach[axis].map(i64::from);
        let range = &scope.all[axis];
        let place = |v: i64| fixed(v - origin[axis]);
        [place(range.start) + least, place(range.end - 1) + most].map(|v| v as i32)
    });
    let patch = shears.patch(origin, ranges, scope.lattice.turned.reach);
    batch.pad(WHOLE);
    for (shears, [a, b]) in patch.planes.iter().zip(PLANES) {
        if let Ok(places) = batch.places.get_disjoint_mut([a, b]) {
            warp_all(Backend::best(), shears, places.map(|list| &mut list[..]));
        }
    }
    batch
        .places
        .iter_mut()
        .for_each(|list| list.truncate(length));
}
