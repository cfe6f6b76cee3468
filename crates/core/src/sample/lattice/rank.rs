//! The rank of a point: its place in the order in which points leave when a set is thinned.
//!
//! The table has the order of its blocks (see [`Ranks`](crate::table::Ranks)). Points do not move when others
//! leave, and the points that are left are whole blocks and a strip of one more. Mean power below ν = 0.5 and
//! δ_min of what is left, in units of the thinned set, on the twin 265/153:
//!
//! | λ | random | blue, 63 intervals | blue, 129 |
//! |---|---|---|---|
//! | 1/2 | 0.50 | 0.069, 0.50 | 0.065, 0.51 |
//! | 1/4 | 0.75 | 0.072, 0.45 | 0.065, 0.44 |
//! | 1/16 | 0.94 | 0.085, 0.51 | 0.066, 0.45 |
//! | 1/64 | 0.98 | 0.074, 0.50 | 0.068, 0.47 |

use super::PointId;
use crate::{pattern::Pattern, table::TurnedTable};

/// The largest number below 1.
const GREATEST: f64 = 1.0 - f64::EPSILON / 2.0;

/// The rank of a point of a turned table's pattern, in [0, 1); the greatest for an address without a point.
pub(crate) fn rank(turned: &TurnedTable, pattern: &Pattern, id: PointId) -> f64 {
    let (index_x, index_y) = pattern.index(id.x, id.y);
    let map = turned.table().map();
    let (Some(x), Some(y)) = (map.interval_of(index_x), map.interval_of(index_y)) else {
        return GREATEST;
    };
    let (order, interval) = (turned.order(), map.interval(x));
    let position = order.position(y * map.intervals() + x);
    let (offset, length) = (index_x - interval.start, interval.end - interval.start);
    order.rank(position, offset, length)
}

/// The kind of a point of a turned table's pattern; `None` for an address without a point, and for a table without
/// kinds.
pub(crate) fn kind(turned: &TurnedTable, pattern: &Pattern, id: PointId) -> Option<u8> {
    let (index_x, index_y) = pattern.index(id.x, id.y);
    let map = turned.table().map();
    let block = [map.interval_of(index_x)?, map.interval_of(index_y)?];
    let labels = turned.labels()?;
    Some(labels.kind(map.intervals(), block, index_x))
}
