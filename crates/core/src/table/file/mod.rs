//! The table file: a header, tagged sections, a digest. All numbers are little-endian.
//!
//! ```text
//! 0   8  magic: 89 'STREW' 0d 0a (a text-mode transfer damages it)
//! 8   4  format version
//! 12  4  number of sections
//! 16  8  size of the whole file
//! 24  …  sections: 4 letters, u64 length, that many bytes
//! −32 32 BLAKE3 of everything before
//! ```
//!
//! `HEAD`: α as text, R, n, profile. `PROV`: the history. `DISP`: n² pairs of i32, row by row. A reader
//! skips a section it does not know if the name starts with a lower-case letter, so later releases can
//! add sections without a new format. Optional:
//!
//! `rank`: for each block its position in the order in which blocks leave, 0 for the last one; 2 bytes,
//! or 4 in maps of more than 2¹⁶ blocks. `kind`: a list of the parts of the shares as u16, ascending, in lowest
//! terms, and for each block the number of its kind, one byte.
//!
//! Labels of a table that has none are a file of their own (`labels`): `BASE` with the digest of that table,
//! `rank` and `kind`.
//!
//! A table of points in space has `CUBE` in place of `DISP`: n³ triples of i16, in units of 2⁻¹² grid units. The block
//! (i, j, k) of the intervals of dX, dY and dZ is number (k·n + j)·n + i.
//!
//! `read` reads what `layout` writes.

mod head;
mod labels;
mod layout;
mod read;
#[cfg(test)]
mod tests;

pub use head::Head;
pub(super) use labels::{read_labels, write_labels};
pub use layout::{FORMAT_VERSION, MAX_FILE_BYTES};
pub(super) use layout::{digest, write};
pub(super) use read::read;
