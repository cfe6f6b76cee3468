//! Damaged, truncated and foreign files.

use alloc::{string::ToString, vec, vec::Vec};

use super::{
    MAX_FILE_BYTES,
    layout::{DIGEST_BYTES, HEADER_BYTES},
};
use crate::{
    error::ErrorKind,
    map::Map,
    table::{Digest, Figures, Mix, Provenance, Ranks, Table},
};

fn table() -> Table {
    let map = Map::new("(5-sqrt(3))/2".parse().expect("valid"), 5).expect("small");
    let n = map.intervals() * map.intervals();
    let displacements = (0..n as i32).map(|i| [i << 16, -(i << 14)]).collect();
    let provenance = Provenance {
        optimizer: "gaussian".into(),
        parameters: vec![("sigma".into(), "1".into())],
        seed: 7,
        twins: map.twins().take(2).collect(),
        figures: vec![Figures {
            subject: "twin 71/41".into(),
            seen: true,
            points: 5041,
            values: vec![("low_power".into(), 4e-6)],
        }],
    };
    Table::new(map, "blue", displacements, provenance).expect("valid")
}

/// Replaces the digest after a deliberate change.
fn resealed(mut bytes: Vec<u8>) -> Vec<u8> {
    let body = bytes.len() - DIGEST_BYTES;
    let digest = Digest::of(&bytes[..body]);
    bytes[body..].copy_from_slice(digest.as_bytes());
    bytes
}

#[test]
fn every_flipped_bit_is_caught() {
    let bytes = table().to_bytes();
    for at in 0..bytes.len() {
        for bit in 0..8 {
            let mut damaged = bytes.clone();
            damaged[at] ^= 1 << bit;
            assert!(Table::from_bytes(&damaged).is_err(), "byte {at} bit {bit}");
        }
    }
}

#[test]
fn other_damage_has_its_own_name() {
    let good = table().to_bytes();
    let refused = |bytes: &[u8]| {
        let error = Table::from_bytes(bytes).expect_err("damaged");
        (error.kind(), error.to_string())
    };
    let (kind, text) = refused(&[good.clone(), vec![0]].concat());
    assert_eq!(kind, ErrorKind::Table);
    assert!(text.contains("oversized"), "{text}");
    for (version, says) in [(0u32, "older"), (9, "newer")] {
        let mut bytes = good.clone();
        bytes[8..12].copy_from_slice(&version.to_le_bytes());
        let (kind, text) = refused(&resealed(bytes));
        assert_eq!(kind, ErrorKind::TableVersion);
        assert!(text.contains(says), "{text}");
    }
    let (kind, text) = refused(&[b'#'; 400]);
    assert_eq!(kind, ErrorKind::Table);
    assert!(text.contains("not a Strew table"), "{text}");
    let (kind, _) = refused(&vec![0; MAX_FILE_BYTES as usize + 1]);
    assert_eq!(kind, ErrorKind::TableTooLarge);
}

/// A table with every optional section.
fn mixed() -> Table {
    let table = table();
    let blocks = table.displacements().len();
    let mix = Mix::scattered(table.map(), "1:3".parse().expect("valid")).expect("near");
    assert!(!mix.splits().is_empty());
    let ranks = Ranks::new((0..blocks as u32).rev().collect()).expect("an order");
    table.with_mix(mix, ranks).expect("fits")
}

#[test]
fn tables_and_mixes_round_trip() {
    for table in [table(), mixed()] {
        let bytes = table.to_bytes();
        let read = Table::from_bytes(&bytes).expect("valid");
        assert_eq!((&read, read.mix()), (&table, table.mix()));
        assert_eq!(read.to_bytes(), bytes);
    }
    let table = mixed();
    // Another order keeps the kinds, another map does not.
    let ranks = Ranks::new((0..table.displacements().len() as u32).collect()).expect("an order");
    assert_eq!(
        table.with_ranks(ranks.clone()).expect("fits").mix(),
        table.mix()
    );
    let map = Map::new("1.63".parse().expect("valid"), 5).expect("small");
    let n = map.intervals();
    assert_eq!(n * n, table.displacements().len());
    let other = Table::new(map, "blue", vec![[0, 0]; n * n], Provenance::default());
    let mix = table.mix().expect("a mix").clone();
    let error = other
        .expect("valid")
        .with_mix(mix, ranks)
        .expect_err("another map");
    assert!(error.to_string().starts_with("mix is "), "{error}");
}

#[test]
fn sealed_nonsense_is_refused_with_its_place() {
    for table in [table(), mixed()] {
        refuses_nonsense(table.to_bytes());
    }
}

fn refuses_nonsense(good: Vec<u8>) {
    // Every byte of the content is changed in turn and sealed with a right digest: nothing panics, and
    // what is accepted round-trips.
    for at in HEADER_BYTES..good.len() - DIGEST_BYTES {
        for change in [1u8, 0x80, 0xff] {
            let mut bytes = good.clone();
            bytes[at] ^= change;
            let bytes = resealed(bytes);
            // An optional section with another name is skipped.
            if let Ok(table) = Table::from_bytes(&bytes)
                && table.to_bytes()[12] == bytes[12]
            {
                assert_eq!(table.to_bytes(), bytes, "byte {at}");
            }
        }
    }
    let mut unknown = good.clone();
    unknown[HEADER_BYTES..HEADER_BYTES + 4].copy_from_slice(b"WHAT");
    let error = Table::from_bytes(&resealed(unknown)).expect_err("unknown section");
    assert!(alloc::format!("{error}").contains("WHAT"), "{error}");
}

#[test]
fn optional_sections_of_later_releases_are_skipped() {
    let good = table().to_bytes();
    let mut bytes = good[..good.len() - DIGEST_BYTES].to_vec();
    bytes.extend(*b"hint");
    bytes.extend(3u64.to_le_bytes());
    bytes.extend([1, 2, 3]);
    bytes.extend([0; DIGEST_BYTES]);
    bytes[12] += 1;
    let size = bytes.len() as u64;
    bytes[16..24].copy_from_slice(&size.to_le_bytes());
    let read = Table::from_bytes(&resealed(bytes)).expect("skips unknown sections");
    assert_eq!(read.displacements(), table().displacements());
}

#[test]
fn parts_out_of_range_are_refused() {
    let table = table();
    let make = |profile: &str, vectors: Vec<[i32; 2]>| {
        Table::new(table.map().clone(), profile, vectors, Provenance::default())
    };
    let good = table.displacements().to_vec();
    for name in ["", "Blue", "blue noise", "ä", &"x".repeat(33)] {
        let error = make(name, good.clone()).expect_err(name);
        assert_eq!(error.field(), "profile");
    }
    assert!(make("blue", good[1..].to_vec()).is_err());
    let mut long = good.clone();
    long[3] = [i32::MIN, 0];
    assert!(make("blue", long).is_err());
}
