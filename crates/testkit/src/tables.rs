//! Displacement tables for tests.

use std::path::Path;

use strew_core::{
    Map, Table,
    table::{FRACTION_BITS, Figures, Provenance},
};

use crate::random::SplitMix;

/// A table with random displacements of up to half a grid unit along each axis. It has no noise
/// profile to speak of. The same arguments make the same table; every field of its provenance is
/// filled in.
///
/// `alpha` is written as on the command line, such as `(5-sqrt(3))/2`; `radius` is the half-width
/// of the neighborhood map in grid units.
pub fn random(alpha: &str, profile: &str, radius: u32) -> Table {
    let map = Map::new(alpha.parse().expect("valid"), radius).expect("small");
    let mut random = SplitMix::new(1);
    let mut next = || (random.bits() as i32) >> (i32::BITS - FRACTION_BITS);
    let blocks = map.intervals() * map.intervals();
    let displacements = (0..blocks).map(|_| [next(), next()]).collect();
    let provenance = Provenance {
        optimizer: "none".into(),
        parameters: vec![("generator".into(), "splitmix64".into())],
        seed: 1,
        twins: map.twins().take(2).collect(),
        figures: vec![Figures {
            subject: "window".into(),
            seen: false,
            points: 1000,
            values: vec![("delta_min".into(), 0.25)],
        }],
    };
    Table::new(map, profile, displacements, provenance).expect("valid")
}

pub fn write(folder: &Path, name: &str, table: &Table) {
    std::fs::write(folder.join(name), table.to_bytes()).expect("writable");
}
