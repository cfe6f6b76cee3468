//! Making a mix: a table whose variants are evenly spread.

use strew_core::{Table, table::Shares};

use super::{Error, Fault};

/// Labels the blocks of a table. Takes seconds.
///
/// # Errors
/// [`Error::Invalid`] if the table has too few blocks for the shares.
pub(super) fn make(table: &Table, shares: &Shares) -> Result<Table, Error> {
    let began = std::time::Instant::now();
    let made = strew_forge::labels(table, shares, &()).map_err(|error| {
        let allowed =
            "weights nearer to each other, fewer variants, a larger map, or spread chance";
        Fault::new("variants", shares, error.to_string(), allowed)
    })?;
    tracing::info!(%shares, seconds = began.elapsed().as_secs_f32(), "made a mix");
    made.ok_or(Error::Internal("a mix was stopped that is still wanted"))
}
