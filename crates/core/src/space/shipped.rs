//! The table built into this crate (feature `tables`).

use super::table::Table;
use crate::{error::Error, once::Once};

/// The file of the default table of points in space: profile `blue`, α = (5−√3)/2, 21 intervals.
///
/// ```
/// use strew_core::space::{BLUE, SpaceSet, Table};
///
/// let table = Table::from_bytes(BLUE)?;
/// assert_eq!(table.map().intervals(), 21);
/// assert_eq!(SpaceSet::blue().table(), &table);
/// # Ok::<(), strew_core::Error>(())
/// ```
pub const BLUE: &[u8] = include_bytes!("../../tables/space-blue-5-sqrt3-over-2-r16.strew");

/// The default table.
pub(super) fn blue() -> Table {
    static READ: Once<Result<Table, Error>> = Once::new();
    let table = READ.get_or(|| Table::from_bytes(BLUE));
    // A test reads it.
    table.unwrap_or_else(|error| unreachable!("the table built into the crate is valid: {error}"))
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_default_table_is_blue() {
        let table = super::blue();
        assert_eq!((table.profile(), table.map().intervals()), ("blue", 21));
        assert!(table.least_distance().relative() > 0.66);
    }
}
