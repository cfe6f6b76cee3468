//! The table reader: any file, as it is and with a right digest and length put into it.

use strew_core::{
    PointSet, Region, Table,
    space::{self, SpaceSet},
    table::Digest,
};

const DIGEST_BYTES: usize = 32;
/// Where the header has the size of the whole file.
const SIZE_AT: std::ops::Range<usize> = 16..24;

pub fn run(data: &[u8]) {
    read(data);
    read(&sealed(data));
}

/// The bytes with the size and the digest that a file of them has: the reader goes on to the
/// sections.
fn sealed(data: &[u8]) -> Vec<u8> {
    let mut bytes = data[..data.len().saturating_sub(DIGEST_BYTES)].to_vec();
    let size = (bytes.len() + DIGEST_BYTES) as u64;
    if let Some(place) = bytes.get_mut(SIZE_AT) {
        place.copy_from_slice(&size.to_le_bytes());
    }
    let digest = Digest::of(&bytes);
    bytes.extend(digest.as_bytes());
    bytes
}

fn read(bytes: &[u8]) {
    read_space(bytes);
    let Ok(table) = Table::from_bytes(bytes) else {
        return;
    };
    // What is read is written again so that it reads the same.
    let written = table.to_bytes();
    let again = Table::from_bytes(&written).expect("written by ourselves");
    assert_eq!(again.to_bytes(), written);
    assert_eq!(again.displacements(), table.displacements());
    if table.displacements().len() > 1 << 14 {
        return;
    }
    // It can be sampled, whatever its vectors.
    let set = PointSet::new(table);
    let region = Region::new([-3.0, -2.0], [5.0, 6.0]).expect("ordered");
    for set in [set.clone(), set.seed(3)] {
        let Ok(plan) = set.within(region) else {
            continue;
        };
        let points = plan.to_vec();
        assert_eq!(points.len() as u128, plan.count());
        assert!(points.iter().all(|p| region.contains(p.at())));
    }
}

/// A table of points in space.
fn read_space(bytes: &[u8]) {
    let Ok(table) = space::Table::from_bytes(bytes) else {
        return;
    };
    let written = table.to_bytes();
    let again = space::Table::from_bytes(&written).expect("written by ourselves");
    assert_eq!(again.to_bytes(), written);
    if table.vectors().len() > 1 << 14 {
        return;
    }
    let set = SpaceSet::new(table);
    let region = space::Region::new([-3.0, -2.0, 0.0], [2.0, 3.0, 4.0]).expect("ordered");
    for set in [set.clone(), set.seed(3)] {
        let Ok(plan) = set.within(region) else {
            continue;
        };
        let points = plan.to_vec();
        assert_eq!(points.len() as u128, plan.count());
        assert!(points.iter().all(|p| region.contains(p.at())));
    }
}
