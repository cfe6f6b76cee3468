//! The tables built into this crate (feature `tables`).

use super::Table;
use crate::{error::Error, once::Once};

/// The file of the default table: profile `blue`, α = (5−√3)/2, R = 100.
///
/// ```
/// use strew_core::{PointSet, Table, table::BLUE};
///
/// let table = Table::from_bytes(BLUE)?;
/// assert_eq!(table.map().intervals(), 129);
/// assert_eq!(PointSet::blue().table(), &table);
/// # Ok::<(), strew_core::Error>(())
/// ```
pub const BLUE: &[u8] = include_bytes!("../../tables/blue-5-sqrt3-over-2-m.strew");

/// The default table.
pub(crate) fn blue() -> Table {
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
        assert_eq!((table.profile(), table.map().intervals()), ("blue", 129));
    }
}
