//! The fixed numbers of the file format.

use alloc::{format, string::String};

use crate::error::{Error, ErrorKind};

/// The version of the file format that this release writes and reads.
///
/// ```
/// use strew_core::{Table, table::FORMAT_VERSION};
///
/// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// assert_eq!(table.to_bytes()[8..12], FORMAT_VERSION.to_le_bytes());
/// # Ok::<(), strew_core::Error>(())
/// ```
pub const FORMAT_VERSION: u32 = 1;

/// The size of the largest table file, in bytes: more than the largest map needs.
///
/// ```
/// use strew_core::{Table, map::MAX_RADIUS, table::MAX_FILE_BYTES};
///
/// let largest = Table::undisplaced("sqrt(3)".parse()?, MAX_RADIUS, "pattern")?;
/// assert!((largest.to_bytes().len() as u64) < MAX_FILE_BYTES);
/// # Ok::<(), strew_core::Error>(())
/// ```
pub const MAX_FILE_BYTES: u64 = 64 << 20;

pub(super) const MAGIC: [u8; 8] = *b"\x89STREW\r\n";
pub(super) const HEADER_BYTES: usize = 24;
pub(super) const DIGEST_BYTES: usize = 32;
pub(super) const MAX_SECTIONS: u32 = 64;
/// The section of the vectors of points in space.
pub(super) const CUBE: [u8; 4] = *b"CUBE";
/// The section of the order in which blocks leave.
pub(super) const RANKS: [u8; 4] = *b"rank";
/// The section of the digest of the table that labels are of.
pub(super) const BASE: [u8; 4] = *b"BASE";
/// The section of the kinds of points.
pub(super) const MIX: [u8; 4] = *b"kind";

/// The bytes of a block's position in the order: 2, or 4 in maps of more than 2¹⁶ blocks.
pub(super) const fn position_bytes(blocks: usize) -> usize {
    if blocks <= 1 << 16 { 2 } else { 4 }
}

/// Refuses a file of more than [`MAX_FILE_BYTES`].
pub(super) fn check_size(bytes: u64) -> Result<(), Error> {
    if bytes <= MAX_FILE_BYTES {
        return Ok(());
    }
    let (value, allowed) = (
        format!("{bytes} bytes"),
        format!("at most {MAX_FILE_BYTES} bytes"),
    );
    let kind = ErrorKind::TableTooLarge;
    Err(Error::new(kind, "the table file", value, allowed))
}

/// Checks size, magic and version of a file of `have` bytes that begins with `header`. Returns the number of sections.
pub(super) fn check_header(have: u64, header: &[u8]) -> Result<u32, Error> {
    const FILE: &str = "the table file";
    let refused = |kind, allowed: String, problem| {
        let error = Error::new(kind, FILE, format!("{have} bytes long"), allowed);
        Err(error.because(problem))
    };
    check_size(have)?;
    let long = |need: u64| format!("{need} bytes long");
    let short = |need: u64| refused(ErrorKind::TableTruncated, long(need), "truncated");
    let least = (HEADER_BYTES + DIGEST_BYTES) as u64;
    let Some((magic, numbers)) = header.split_first_chunk() else {
        return short(least);
    };
    if *magic != MAGIC {
        let value = format!("{magic:02x?} in its first 8 bytes");
        let allowed = "89 'STREW' 0d 0a: this is not a Strew table";
        return Err(Error::new(ErrorKind::Table, FILE, value, allowed));
    }
    let (&[version, sections, low, high], []) = numbers.as_chunks() else {
        return short(least);
    };
    let [version, sections] = [version, sections].map(u32::from_le_bytes);
    if version != FORMAT_VERSION {
        let problem = match version < FORMAT_VERSION {
            true => "written by an older release",
            false => "written by a newer release",
        };
        let allowed = format!("{FORMAT_VERSION}, the version this release reads");
        let field = "the format version of the table file";
        return Err(Error::new(ErrorKind::TableVersion, field, version, allowed).because(problem));
    }
    if sections > MAX_SECTIONS {
        let allowed = format!("at most {MAX_SECTIONS}");
        let field = "the number of sections of the table file";
        return Err(Error::new(ErrorKind::Table, field, sections, allowed));
    }
    let stated = u64::from(u32::from_le_bytes(low)) | u64::from(u32::from_le_bytes(high)) << 32;
    if have < stated.max(least) {
        return short(stated.max(least));
    }
    if have > stated {
        let allowed = format!("{}, as its header states", long(stated));
        return refused(ErrorKind::Table, allowed, "oversized");
    }
    Ok(sections)
}
