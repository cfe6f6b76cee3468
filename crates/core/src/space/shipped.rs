//! The table built into this crate (feature `tables`).

use super::table::Table;
use crate::{once::Once, table::shipped::shipped};

/// The file of the default table of points in space: profile `blue`, α = (5−√3)/2, 21 intervals.
///
/// ```
/// use strew_core::space::{BLUE, SpaceSet, Table};
///
/// let table = Table::from_bytes(BLUE)?;
/// assert_eq!(table.map().intervals(), 21);
/// let set = SpaceSet::blue();
/// assert_eq!((set.table(), table.profile()), (&table, "blue"));
/// // No two points are nearer than this many mean spacings.
/// assert!(set.least_distance() > 0.74);
/// # Ok::<(), strew_core::Error>(())
/// ```
pub const BLUE: &[u8] = include_bytes!("../../tables/space-blue-5-sqrt3-over-2-r16.strew");

/// The default table.
pub(super) fn blue() -> Table {
    static READ: Once<Table> = Once::new();
    READ.get_or(|| shipped(BLUE))
}
