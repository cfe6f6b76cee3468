//! The shipped tables, windows of the sets that are served from them, and work with some numbers of threads.

#![allow(dead_code, reason = "each test uses what it needs")]

use std::{fmt::Debug, path::Path};

use strew_core::{PointSet, Region, Table};
use strew_forge::{file_name, measure::Sample, read_table};

/// A table of the repository.
pub fn table(profile: &str, alpha: &str, radius: u32) -> Table {
    let name = file_name(profile, alpha.parse().expect("valid"), radius);
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let places = [crates.join("core/tables"), crates.join("catalog/tables")];
    let path = places.map(|place| place.join(&name));
    let path = path.iter().find(|path| path.exists()).expect("shipped");
    read_table(path).unwrap_or_else(|e| panic!("{e}"))
}

/// A square window of a set with mean spacing 1, away from the origin.
pub fn window(set: &PointSet, corner: [f64; 2], side: f64) -> Sample {
    let region = Region::new(corner, corner.map(|v| v + side)).expect("ordered");
    let plan = set.within(region).expect("near");
    let moved = plan.iter().map(|member| {
        let [x, y] = member.at();
        [x - corner[0], y - corner[1]]
    });
    Sample::window(side, 1.0, moved.collect())
}

/// What is made, which is the same with any number of threads.
pub fn same<T: PartialEq + Debug + Send>(make: impl Fn() -> T + Sync) -> T {
    let [one, three] = [1, 3].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("threads").install(&make)
    });
    assert_eq!(one, three);
    one
}
