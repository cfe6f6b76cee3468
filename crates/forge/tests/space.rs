//! Tables of points in space: equal jobs make equal tables, and the shipped ones keep what their history says.

use strew_core::space::{SpaceSet, Table};
use strew_forge::space::{
    LocalPower, SpaceDistances, SpaceJob, SpacePower, SpaceProfile, forge, with_ranks,
};

fn job(profile: SpaceProfile) -> SpaceJob {
    SpaceJob {
        radius: 6,
        steps: Some(40),
        ..SpaceJob::new(profile)
    }
}

#[test]
fn equal_jobs_make_equal_tables() {
    for profile in SpaceProfile::ALL {
        let make = |seed| {
            let job = SpaceJob {
                seed,
                ..job(profile)
            };
            forge(&job, &()).expect("allowed").expect("not stopped")
        };
        let table = make(1);
        assert_eq!(table, make(1));
        assert_ne!(table, make(2));
        let pattern = Table::undisplaced(table.map().alpha(), 6, "pattern").expect("small");
        let least = table.least_distance().relative();
        assert!(
            least > 0.1 && pattern.least_distance().relative() > 0.4,
            "{least}"
        );
        assert_eq!(Table::from_bytes(&table.to_bytes()), Ok(table));
    }
}

#[test]
fn ranks_are_an_order_that_spreads_what_is_left() {
    let table = forge(&job(SpaceProfile::Blue), &())
        .expect("allowed")
        .expect("not stopped");
    let ranked = with_ranks(&table).expect("an order");
    assert!(ranked.ranks().is_some());
    let low = |table: &Table| {
        let set = SpaceSet::new(table.clone())
            .seed(1)
            .keep(0.5)
            .expect("in range");
        let power = SpacePower::of_window(&set, [0.0; 3], 24.0).expect("near");
        power.low
    };
    // Without ranks a hashed order decides.
    let (even, hashed) = (low(&ranked), low(&table));
    assert!(even < 0.6 * hashed, "{even} {hashed}");
}

#[test]
fn the_shipped_table_has_the_figures_that_it_was_accepted_with() {
    for seed in [0, 5] {
        let set = SpaceSet::blue().seed(seed);
        let power = SpacePower::of_window(&set, [7.0; 3], 40.0).expect("near");
        assert!(power.low < 8e-5 && power.peak < 2.5, "{seed} {power:?}");
        let distances = SpaceDistances::of_window(&set, [7.0; 3], 40.0).expect("near");
        assert!(
            distances.least > 0.57 && distances.mean > 0.82,
            "{seed} {distances:?}"
        );
        let local = LocalPower::of(&set, 20).expect("near");
        assert!(
            local.deviation < 0.4 && local.largest < 6.0,
            "{seed} {local:?}"
        );
    }
}
