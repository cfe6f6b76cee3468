//! The extents of groups of points that will be warped together: which cells of the warp they can touch.

use alloc::vec::Vec;

use crate::{
    sample::space::{Extents, GROUP},
    table::FRACTION_BITS,
};

/// Extends the extents of groups by points of a row from a position on, whose columns are in fixed-point units.
pub(super) fn cover(extents: &mut Vec<Extents>, start: usize, columns: &[i32], [y, z]: [i32; 2]) {
    let mut rest = columns;
    let mut position = start;
    while !rest.is_empty() {
        let group = position / GROUP;
        let (here, after) = rest.split_at(((group + 1) * GROUP - position).min(rest.len()));
        let [first, last] = [here[0], here[here.len() - 1]].map(|x| x >> FRACTION_BITS);
        let row = [[first, last], [y, y], [z, z]];
        match extents.get_mut(group) {
            Some(all) => {
                for (ends, [least, most]) in all.iter_mut().zip(row) {
                    *ends = [ends[0].min(least), ends[1].max(most)];
                }
            }
            None => extents.push(row),
        }
        position += here.len();
        rest = after;
    }
}
