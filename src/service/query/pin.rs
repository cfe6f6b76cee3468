//! Pinning a table: a query that names the digest of its table is answered by that one or not at
//! all, so that its answer never changes.

use crate::service::{Entry, Error, Fault};

/// What a digest looks like.
pub(super) const DIGEST: &str = "64 hexadecimal digits, as in the header strew-table";

/// The pattern of a digest.
pub(super) const PATTERN: &str = "^[0-9a-fA-F]{64}$";

/// Checks that a pin is a digest; `path` is put before the name of the field.
///
/// # Errors
/// A [`Fault`] of `table`.
pub(super) fn read(pin: Option<&str>, path: &str) -> Result<(), Fault> {
    let is_digest =
        |text: &str| text.len() == 64 && text.bytes().all(|byte| byte.is_ascii_hexdigit());
    match pin {
        Some(text) if !is_digest(text) => {
            let field = format!("{path}table");
            Err(Fault::new(&field, text, "it is not a digest", DIGEST))
        }
        _ => Ok(()),
    }
}

/// Checks that a table is the pinned one.
///
/// # Errors
/// [`Error::OtherTable`] if it is not.
pub(super) fn compare(pin: Option<&str>, entry: &Entry) -> Result<(), Error> {
    let Some(pin) = pin else { return Ok(()) };
    if pin.eq_ignore_ascii_case(&entry.digest) {
        return Ok(());
    }
    Err(Error::OtherTable {
        pinned: pin.to_ascii_lowercase(),
        loaded: entry.digest.clone(),
    })
}
