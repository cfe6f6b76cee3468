//! Thinning by rank leaves evenly spread sets.

mod shipped;

use strew_core::PointSet;
use strew_forge::measure::{Distances, Spectrum, square_set};

#[test]
fn thinned_sets_are_even_with_every_seed_and_warp() {
    for radius in [49, 100] {
        let table = shipped::table("blue", "(5-sqrt(3))/2", radius);
        for (seed, warp) in [(0, 0.0), (1, 0.0), (2, 0.0), (3, 0.0), (3, 1.0), (4, 1.0)] {
            let set = PointSet::new(table.clone()).seed(seed).warp(warp);
            let set = set.expect("in range");
            for (keep, side) in [
                (0.5, 250.0),
                (0.25, 360.0),
                (0.0625, 600.0),
                (1.0 / 64.0, 1000.0),
            ] {
                let set = set.clone().keep(keep).expect("a share");
                let window = square_set(&set, [0.0; 2], side, keep).expect("near");
                let fraction = window.points().len() as f64 / (side * side);
                assert!((fraction / keep - 1.0).abs() < 0.02, "{keep}: {fraction}");
                let low = Spectrum::of(&window, 0.6).summary(0.05).low_power;
                let delta = Distances::of(&window).delta_min;
                let what = format!("R = {radius}, seed {seed}, warp {warp}, share {keep}");
                // A random choice leaves 1 − share.
                assert!(low < 0.095, "{what}: {low}");
                assert!(delta > 0.37, "{what}: {delta}");
            }
        }
    }
}
