//! Points as they are served: the seeded warp makes sets isotropic, and sets of different seeds unrelated; thinning by rank
//! leaves evenly spread sets, in space as well; the shipped table of points in space keeps what its history says.

mod shipped;

use strew_core::{
    PointSet,
    space::{SpaceSet, Table},
    table::Figures,
};
use strew_forge::{
    forge,
    judge::{RING_WIDTH, figures},
    measure::{Distances, Sample, Shared, Spectrum, square_set},
    space::{LocalPower, SpaceJob, SpacePower, SpaceProfile, window_set},
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

#[test]
fn ranks_are_an_order_that_spreads_what_is_left() {
    let job = SpaceJob {
        radius: 4,
        steps: Some(40),
        ..SpaceJob::new(SpaceProfile::Blue)
    };
    let ranked = forge(&job, &()).expect("allowed").table;
    let (map, vectors) = (ranked.map().clone(), ranked.vectors().to_vec());
    let history = ranked.provenance().clone();
    let without = Table::new(map, "blue", vectors, history, None).expect("valid");
    let low = |table: &Table| {
        let set = SpaceSet::new(table.clone())
            .seed(1)
            .keep(0.5)
            .expect("in range");
        let points = window_set(&set, [0.0; 3], 24.0).expect("near");
        SpacePower::of(&points).summary.low_power
    };
    // Without ranks a hashed order decides.
    let (even, hashed) = (low(&ranked), low(&without));
    assert!(even < 0.7 * hashed, "{even} {hashed}");
}

#[test]
fn the_shipped_table_has_the_figures_that_it_was_accepted_with() {
    for seed in [0, 5] {
        let set = SpaceSet::blue().seed(seed);
        let points = window_set(&set, [7.0; 3], 40.0).expect("near");
        let power = SpacePower::of(&points).summary;
        assert!(
            power.low_power < 8e-5 && power.peak_power < 2.5,
            "{seed} {power:?}"
        );
        let distances = Distances::of(&points);
        assert!(
            distances.delta_min > 0.57 && distances.delta_avg > 0.82,
            "{seed} {distances:?}"
        );
        let local = LocalPower::of(&set, [0.0; 3], 20, 12).expect("near");
        assert!(
            local.deviation < 0.4 && local.largest < 6.0,
            "{seed} {local:?}"
        );
    }
}
