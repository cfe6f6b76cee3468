//! Files of labels: the kinds and ranks of a table, without its vectors.
//!
//! A table that has both beside its vectors takes eleven bytes for each block, and its labels three of them. A library
//! that embeds the table embeds labels for several shares beside it.

use alloc::{format, vec, vec::Vec};

use super::{
    layout::{BASE, MIX, RANKS, Reader, framed, kind, rank},
    read::{mix, ranks, sections, wrong},
};
use crate::{
    error::{Error, ErrorKind},
    table::{Digest, Mix, Ranks, Table},
};

/// A file of labels of a table.
pub(crate) fn write_labels(of: &Table, own: &Mix, order: &Ranks) -> Vec<u8> {
    let mut bytes = framed(vec![
        (BASE, of.digest().as_bytes().to_vec()),
        (RANKS, rank(order)),
        (MIX, kind(own)),
    ]);
    let digest = Digest::of(&bytes);
    bytes.extend(digest.as_bytes());
    bytes
}

/// The kinds and ranks in a file of labels of a table.
pub(crate) fn read_labels(bytes: &[u8], of: &Table) -> Result<(Mix, Ranks), Error> {
    let (found, _) = sections(bytes)?;
    let (base, base_at) = found.need(&BASE)?;
    let rank = found.need(&RANKS)?;
    let kind = found.need(&MIX)?;
    let mut reader = Reader::new(base);
    let digest = reader.array("a digest").and_then(|digest| {
        reader.end("a digest")?;
        Ok(Digest::from_bytes(digest))
    });
    let digest = digest.map_err(|problem| wrong(&BASE, base_at, problem))?;
    if digest != of.digest() {
        let allowed = format!("{}, that of the table `{}`", of.digest(), of.profile());
        let field = "the digest of the table that the labels are of";
        return Err(Error::new(ErrorKind::Table, field, digest, allowed));
    }
    let blocks = of.displacements().len();
    Ok((mix(kind, of.map())?, ranks(rank, blocks)?))
}

#[cfg(test)]
mod tests {
    use alloc::string::ToString;

    use super::*;

    /// A small table, and labels of it.
    fn labelled() -> (Table, Mix, Ranks) {
        let table = Table::undisplaced("sqrt(3)".parse().expect("valid"), 9, "p").expect("small");
        let mix = Mix::scattered(table.map(), "1:3".parse().expect("valid")).expect("near");
        let blocks = table.displacements().len() as u32;
        let ranks = Ranks::new((0..blocks).rev().collect()).expect("an order");
        (table, mix, ranks)
    }

    #[test]
    fn damaged_and_foreign_labels_are_refused() {
        let (table, mix, ranks) = labelled();
        let file = table.labels_of(&mix, &ranks);
        for at in 0..file.len() {
            let mut bad = file.clone();
            bad[at] ^= 1;
            assert!(table.with_labels(&bad).is_err(), "byte {at}");
            assert!(table.with_labels(&file[..at]).is_err(), "cut at {at}");
        }
        let says = |error: Error, part: &str| {
            let text = error.to_string();
            assert!(text.contains(part), "{text}");
        };
        let other = Table::undisplaced("sqrt(2)".parse().expect("valid"), 9, "q").expect("small");
        let error = other.with_labels(&file).expect_err("of another table");
        says(error, "the digest of the table that the labels are of is");
        let error = Table::from_bytes(&file).expect_err("no table");
        says(
            error,
            "labels of another table: Table::with_labels reads them",
        );
        let error = table.with_labels(&table.to_bytes()).expect_err("a table");
        says(error, "section BASE of the table file");
    }

    #[test]
    fn sealed_nonsense_is_refused_or_other_labels() {
        let (table, mix, ranks) = labelled();
        let file = table.labels_of(&mix, &ranks);
        let body = file.len() - 32;
        for at in 8..body {
            for change in [1u8, 0x80] {
                let mut bytes = file[..body].to_vec();
                bytes[at] ^= change;
                let seal = Digest::of(&bytes);
                bytes.extend(seal.as_bytes());
                if let Ok(read) = table.with_labels(&bytes) {
                    let (mix, ranks) = (read.mix().expect("one"), read.ranks().expect("some"));
                    assert_eq!(table.labels_of(mix, ranks), bytes, "byte {at}");
                }
            }
        }
    }
}
