//! Reading what a table is without reading the table: its head, its history and its seal.
//!
//! A folder may hold thousands of tables. What each is found by stands in a few hundred bytes; the vectors are
//! passed over.

use alloc::{string::String, vec, vec::Vec};

use super::{
    layout::{CUBE, DIGEST_BYTES, HEADER_BYTES, MIX, check_header},
    read::{HeadSection, read_prov, wrong},
};
use crate::{
    error::Error,
    pattern::Alpha,
    table::{Digest, Provenance},
};

/// The head of a table file: its description of itself. Its vectors are neither read nor checked.
///
/// ```
/// use strew_core::{Table, table::Head};
///
/// let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let file = table.to_bytes();
/// let head = Head::read(file.len() as u64, |at, bytes| {
///     bytes.copy_from_slice(&file[at as usize..][..bytes.len()]);
///     Ok::<(), strew_core::Error>(())
/// })??;
/// assert_eq!((head.profile.as_str(), head.alpha, head.radius), ("pattern", table.alpha(), 20));
/// assert_eq!((head.digest, head.intervals as usize), (table.digest(), table.map().intervals()));
/// assert_eq!((&head.provenance, head.has_kinds), (table.provenance(), false));
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Head {
    /// The name of the noise profile.
    pub profile: String,
    /// The α of the pattern.
    pub alpha: Alpha,
    /// The half-width R of the map.
    pub radius: u32,
    /// The intervals of the map per axis, as stated.
    pub intervals: u32,
    /// Whether the points have kinds.
    pub has_kinds: bool,
    /// Whether the points lie in space: [`space::Table`](crate::space::Table) reads the file.
    pub is_space: bool,
    /// The history.
    pub provenance: Provenance,
    /// The digest that the file states. [`Table::from_bytes`](crate::Table::from_bytes) checks it.
    pub digest: Digest,
}

/// The most bytes of a head or a history: more than the format's limits of texts and lists allow in practice.
const MAX_SECTION_BYTES: u64 = 1 << 20;

impl Head {
    /// Reads the head of a file of `bytes` bytes; `at` fills a slice from a place of the file.
    ///
    /// # Errors
    /// The errors of `at`; within, one of the `Table…` kinds or [`ErrorKind::Alpha`](crate::ErrorKind::Alpha), naming
    /// the part of the file that is wrong.
    pub fn read<E>(
        bytes: u64,
        mut at: impl FnMut(u64, &mut [u8]) -> Result<(), E>,
    ) -> Result<Result<Self, Error>, E> {
        let mut header = [0; HEADER_BYTES];
        let header = &mut header[..bytes.min(HEADER_BYTES as u64) as usize];
        at(0, header)?;
        let sections = match check_header(bytes, header) {
            Ok(sections) => sections,
            Err(error) => return Ok(Err(error)),
        };
        let end = bytes - DIGEST_BYTES as u64;
        let mut found = Found::default();
        let mut place = HEADER_BYTES as u64;
        for _ in 0..sections {
            let mut name = [0; 12];
            if end.saturating_sub(place) < name.len() as u64 {
                return Ok(Err(wrong(b"none", place as usize, "cut short".into())));
            }
            at(place, &mut name)?;
            let (tag, length) = name.split_at(4);
            let mut eight = [0; 8];
            eight.copy_from_slice(length);
            let length = u64::from_le_bytes(eight);
            place += name.len() as u64;
            if length > end - place {
                return Ok(Err(wrong(tag, place as usize, "cut short".into())));
            }
            if let b"HEAD" | b"PROV" = tag {
                if length > MAX_SECTION_BYTES {
                    return Ok(Err(wrong(tag, place as usize, "too long".into())));
                }
                let mut payload = vec![0; length as usize];
                at(place, &mut payload)?;
                found.file(tag, payload, place as usize);
            }
            found.has_kinds |= tag == MIX;
            found.is_space |= tag == CUBE;
            place += length;
        }
        let mut seal = [0; DIGEST_BYTES];
        at(end, &mut seal)?;
        Ok(found.into_head(Digest::from_bytes(seal)))
    }
}

/// The sections that were met.
#[derive(Default)]
struct Found {
    head: Option<(Vec<u8>, usize)>,
    prov: Option<(Vec<u8>, usize)>,
    has_kinds: bool,
    is_space: bool,
}

impl Found {
    fn file(&mut self, tag: &[u8], payload: Vec<u8>, at: usize) {
        let slot = match tag {
            b"HEAD" => &mut self.head,
            _ => &mut self.prov,
        };
        *slot = Some((payload, at));
    }

    fn into_head(self, digest: Digest) -> Result<Head, Error> {
        let missing = |tag: &[u8]| wrong(tag, HEADER_BYTES, "missing".into());
        let (head, head_at) = self.head.ok_or_else(|| missing(b"HEAD"))?;
        let (prov, prov_at) = self.prov.ok_or_else(|| missing(b"PROV"))?;
        let head = HeadSection::read(&head, head_at)?;
        Ok(Head {
            alpha: head.alpha,
            profile: head.profile,
            radius: head.radius,
            intervals: head.intervals,
            has_kinds: self.has_kinds,
            is_space: self.is_space,
            provenance: read_prov(&prov).map_err(|p| wrong(b"PROV", prov_at, p))?,
            digest,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{error::ErrorKind, table::Table};

    fn read(file: &[u8]) -> Result<Head, Error> {
        let read = Head::read(file.len() as u64, |at, bytes| {
            let part = file.get(at as usize..at as usize + bytes.len());
            part.map(|part| bytes.copy_from_slice(part))
                .ok_or("beyond the file")
        });
        read.expect("nothing is read beyond the file")
    }

    #[test]
    fn a_file_that_is_cut_or_not_a_table_is_refused_like_the_whole() {
        let table = Table::undisplaced("sqrt(3)".parse().expect("valid"), 9, "a").expect("small");
        let file = table.to_bytes();
        for length in 0..file.len() {
            let (head, whole) = (read(&file[..length]), Table::from_bytes(&file[..length]));
            let error = head.expect_err("cut");
            assert_eq!(error.kind(), ErrorKind::TableTruncated);
            assert_eq!(error.value(), alloc::format!("{length} bytes long"));
            assert_eq!(whole, Err(error));
        }
        for (at, byte) in [(0, 0), (8, 9), (12, 200), (16, 1), (24, b'X'), (28, 255)] {
            let mut bad = file.clone();
            bad[at] = byte;
            assert!(read(&bad).is_err(), "byte {at}");
        }
    }
}
