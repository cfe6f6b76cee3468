//! Tables of points in space: their ranks spread what is left, and the shipped ones keep what their history says.

use strew_core::space::{SpaceSet, Table};
use strew_forge::{
    forge,
    measure::Distances,
    space::{LocalPower, SpaceJob, SpacePower, SpaceProfile, window_set},
};

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
