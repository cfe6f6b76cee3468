//! Pinning a table: a query that names the digest of its table is answered by that one or not at
//! all, so that its answer never changes.

use crate::service::{Catalog, Error, Fault, Key};

/// What a digest looks like.
pub(super) const DIGEST: &str = "64 hexadecimal digits, as in the header strew-table";

/// The pattern of a digest.
pub(super) const PATTERN: &str = "^[0-9a-fA-F]{64}$";

/// Checks that a pin is a digest.
///
/// # Errors
/// A [`Fault`] of `table`.
pub(super) fn read(pin: Option<&str>) -> Result<(), Fault> {
    let is_digest =
        |text: &str| text.len() == 64 && text.bytes().all(|byte| byte.is_ascii_hexdigit());
    match pin {
        Some(text) if !is_digest(text) => {
            Err(Fault::new("table", text, "it is not a digest", DIGEST))
        }
        _ => Ok(()),
    }
}

/// Checks that the table of `key` is the pinned one.
///
/// # Errors
/// [`Error::OtherTable`] if it is not.
pub(super) fn compare(pin: Option<&str>, catalog: &Catalog, key: &Key) -> Result<(), Error> {
    let Some(pin) = pin else { return Ok(()) };
    let entry = catalog.entry(key).ok_or_else(Error::lost_table)?;
    if pin.eq_ignore_ascii_case(&entry.digest) {
        return Ok(());
    }
    Err(Error::OtherTable {
        pinned: pin.to_ascii_lowercase(),
        loaded: entry.digest.clone(),
    })
}
