//! Files of tables of points in space: their names, reading, writing.

use std::path::Path;

use strew_core::{Alpha, space::Table};

use crate::{
    ForgeError,
    file::{file_name, is_space, read_bytes, write_whole},
};

/// Returns the usual name of a table's file: that of a table of the plane with `space-` before it, such as
/// `space-blue-5-sqrt3-over-2-r16.strew`.
///
/// ```
/// let name = strew_forge::space::table_file_name("blue", "sqrt(3)".parse()?, 16);
/// assert_eq!(name, "space-blue-sqrt3-r16.strew");
/// # Ok::<(), strew_core::Error>(())
/// ```
#[must_use]
pub fn table_file_name(profile: &str, alpha: Alpha, radius: u32) -> String {
    format!("space-{}", file_name(profile, alpha, radius))
}

/// Reads and checks a table file of points in space. Returns `None` for a table of the plane, and for a file whose head is
/// that of no table.
///
/// # Errors
/// [`ForgeError::File`] if it cannot be read, [`ForgeError::TooLarge`] if it has more than [`MAX_FILE_BYTES`](strew_core::table::MAX_FILE_BYTES),
/// [`ForgeError::NotATable`] if its content is damaged beyond the head.
pub fn read_table(path: &Path) -> Result<Option<Table>, ForgeError> {
    let bytes = read_bytes(path)?;
    if !is_space(&bytes) {
        return Ok(None);
    }
    let table = Table::from_bytes(&bytes).map_err(|source| ForgeError::NotATable {
        path: path.to_owned(),
        source,
    })?;
    Ok(Some(table))
}

/// Writes a table file, whole or not at all; see [`write_table`](crate::write_table).
///
/// # Errors
/// [`ForgeError::File`] if a step fails; a file that was at `path` is then unchanged.
pub fn write_table(path: &Path, table: &Table) -> Result<(), ForgeError> {
    write_whole(path, &table.to_bytes())
}
