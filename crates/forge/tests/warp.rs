//! The seeded warp makes sets isotropic, and sets of different seeds unrelated.

mod shipped;

use strew_core::{PointSet, table::Figures};
use strew_forge::{
    judge::{RING_WIDTH, figures},
    measure::{Sample, Shared, Spectrum, square_set},
};

const OFF: f64 = 0.0;
const ON: f64 = 1.0;

/// A window of `side`² mean spacings away from the origin.
fn window(seed: u64, warp: f64, side: f64) -> Sample {
    let table = shipped::table("blue", "(5-sqrt(3))/2", 49);
    let set = PointSet::new(table).seed(seed).warp(warp);
    let corner = 1000.0 * seed as f64;
    square_set(&set.expect("in range"), [corner, -corner], side, 1.0).expect("near")
}

fn measured(subject: String, set: &Sample, nu_max: f64) -> Figures {
    figures(subject, false, set, &Spectrum::of(set, nu_max), RING_WIDTH)
}

#[test]
fn warped_sets_are_isotropic_and_keep_their_noise() {
    // The last of a million points.
    for (seed, side, nu_max) in [
        (1, 362.0, 4.0),
        (2, 362.0, 4.0),
        (77, 362.0, 4.0),
        (3, 1000.0, 2.0),
    ] {
        let set = window(seed, ON, side);
        let figures = measured(format!("seed {seed}"), &set, nu_max);
        let value = |name| figures.value(name).expect("measured");
        assert!(value("anisotropy_db") <= 0.2, "{figures:?}");
        assert!(side > 400.0 || value("tallest_peak") <= 35.0, "{figures:?}");
        assert!(value("low_power") <= 1e-5, "{figures:?}");
        assert!(value("delta_min") >= 0.60, "{figures:?}");
    }
    // Without the warp they are not.
    let plain = measured("plain".into(), &window(1, OFF, 362.0), 4.0);
    let anisotropy = plain.value("anisotropy_db").expect("measured");
    assert!(anisotropy > 2.0, "{plain:?}");
}

#[test]
fn seeds_are_unrelated_sets() {
    let set = |seed, warp| window(seed, warp, 362.0);
    let shared = |warp| Shared::of(&set(1, warp), &set(2, warp), 2.5);
    let warped = shared(ON).power_correlation;
    assert!(warped.abs() < 0.03, "{warped}");
    let plain = shared(OFF).power_correlation;
    assert!(
        plain > 0.3,
        "without the warp all sets have the same peaks: {plain}"
    );
}
