//! The guaranteed least distance: never undercut, and attained without warp.

use crate::subject;

use std::collections::HashMap;

use proptest::prelude::*;
use strew_core::{
    ErrorKind, LeastDistance, Placement, PointSet, Seed, Spacing, Table, Warp, table::FRACTION_BITS,
};
use subject::{plane::cube, set, shipped, table_of};

fn points(table: &Table, placement: Placement, corner: [f64; 2], side: f64) -> Vec<[f64; 2]> {
    let plan = set(table, placement).within(cube(corner, side));
    plan.expect("near")
        .iter()
        .map(|member| member.at())
        .collect()
}

/// The least distance between any two points, by comparing those of neighboring cells of a grid.
fn least_of(points: &[[f64; 2]]) -> f64 {
    const CELL: f64 = 1.1;
    let cell = |p: &[f64; 2]| p.map(|v| (v / CELL).floor() as i64);
    let mut cells: HashMap<[i64; 2], Vec<[f64; 2]>> = HashMap::new();
    let mut least = f64::INFINITY;
    for p in points {
        let [x, y] = cell(p);
        for key in (-1..=1).flat_map(|i| (-1..=1).map(move |j| [x + i, y + j])) {
            for q in cells.get(&key).into_iter().flatten() {
                least = least.min((q[0] - p[0]).hypot(q[1] - p[1]));
            }
        }
        cells.entry([x, y]).or_default().push(*p);
    }
    least
}

fn unit(seed: u64, warp: f64) -> Placement {
    let warp = Warp::new(warp).expect("in range");
    Placement::new(Spacing::new(1.0).expect("valid"), Seed(seed)).with_warp(warp)
}

#[test]
fn without_warp_the_guarantee_is_attained() {
    let names = [
        "blue-5-sqrt3-over-2-s",
        "blue-sqrt3-s",
        "spaced-5-sqrt3-over-2-s",
        "spaced-1-plus-sqrt5-over-2-s",
        "pattern-5-sqrt3-over-2-s",
        "step-5-sqrt3-over-2-s",
    ];
    let wild = [
        table_of("sqrt(3)", 9, 1 << (FRACTION_BITS - 2)),
        table_of("(1+sqrt(5))/2", 6, 5 << FRACTION_BITS),
    ];
    let tables = wild.into_iter().chain(names.map(shipped));
    for table in tables {
        let least = table.least_distance().with_warp(Warp::OFF);
        let found = least_of(&points(&table, unit(0, 0.0), [0.0, 0.0], 500.0));
        let name = table.profile();
        assert!(found >= least - 1e-12, "{name}: {found} < {least}");
        assert!(found <= least + 1e-3, "{name}: {found} > {least}");
        let set = set(&table, unit(0, 0.0)).spacing(4.0).expect("valid");
        assert!((set.least_distance() / (4.0 * least) - 1.0).abs() < 1e-6);
    }
}

#[test]
fn large_maps_are_exact_too() {
    for name in ["blue-5-sqrt3-over-2-l", "spaced-5-sqrt3-over-2-l"] {
        let table = shipped(name);
        let least = table.least_distance();
        assert!(least.is_useful(), "{least:?}");
        let found = least_of(&points(&table, unit(3, 0.0), [0.0, 0.0], 300.0));
        let least = least.with_warp(Warp::OFF);
        let is_near = found >= least - 1e-12 && found < least + 0.03;
        assert!(is_near, "{found} {least}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]

    #[test]
    fn no_window_undercuts_the_guarantee(
        which in 0usize..4, seed: u64, strength in prop_oneof![0.0..2.0f64, Just(1.0), Just(2.0)],
        x in -1e6..1e6f64, y in -1e6..1e6f64,
    ) {
        static ONCE: std::sync::OnceLock<[Table; 4]> = std::sync::OnceLock::new();
        let tables = ONCE.get_or_init(|| {
            [
                shipped("blue-5-sqrt3-over-2-s"),
                shipped("spaced-sqrt3-s"),
                shipped("lloyd-5-sqrt3-over-2-s"),
                table_of("sqrt(3)", 20, 1 << (FRACTION_BITS - 1)),
            ]
        });
        let table = &tables[which];
        let least = table.least_distance();
        let placement = unit(seed, strength);
        let found = least_of(&points(table, placement, [x, y], 60.0));
        prop_assert!(found >= least.with_warp(placement.warp) - 1e-9);
        if least.is_useful() {
            let distance = 0.7;
            let spacing = least.spacing_for(distance, placement.warp).expect("useful");
            let placement = Placement { spacing, ..placement };
            let corner = [x * spacing.get(), y * spacing.get()];
            let found = least_of(&points(table, placement, corner, 40.0));
            prop_assert!(found >= distance, "{}", found);
        }
    }
}

/// The least distance between points near the corner of a square `reach` from the origin, in all
/// directions from it, by reported coordinates.
fn least_far_out(set: &PointSet, reach: f64) -> f64 {
    let side = 40.0 * set.placement().spacing.get();
    let corners = [
        [reach - side, -reach],
        [-reach, reach - side],
        [reach - side, 0.37 * reach],
        [-0.71 * reach, reach - side],
    ];
    let least = corners.map(|corner| {
        let plan = set.within(cube(corner, side)).expect("near enough");
        let scale = 1.0 / set.placement().spacing.get();
        // Differences of such numbers are exact.
        let relative = plan
            .iter()
            .map(|m| [0, 1].map(|i| (m.at()[i] - corner[i]) * scale));
        least_of(&relative.collect::<Vec<_>>()) / scale
    });
    least.into_iter().fold(f64::INFINITY, f64::min)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn reported_coordinates_keep_the_distance_out_to_the_limit(
        which in 0usize..4, seed: u64, strength in prop_oneof![Just(0.0), 0.0..2.0f64, Just(1.0)],
        distance in prop_oneof![Just(1.0), 1e-6..1e6f64], share in prop_oneof![Just(1.0), 0.0..1.0f64],
        beyond in 1.0..1e5f64,
    ) {
        let names = ["blue-5-sqrt3-over-2-s", "spaced-sqrt3-s", "spaced-5-sqrt3-over-2-s",
            "pattern-5-sqrt3-over-2-s"];
        let warp = Warp::new(strength).expect("in range");
        let table = shipped(names[which]);
        let spacing = table.least_distance().spacing_for(distance, warp).expect("useful");
        let placement = Placement::new(spacing, Seed(seed)).with_warp(warp);
        let set = set(&table, placement);
        let limit = LeastDistance::RANGE * distance;
        prop_assert!(set.least_distance_within(limit) >= distance);
        let found = least_far_out(&set, share * limit);
        prop_assert!(found >= distance, "{found} at {}", share * limit);
        // Beyond the limit less is promised, and kept.
        let promised = set.least_distance_within(beyond * limit);
        let found = least_far_out(&set, beyond * limit);
        prop_assert!(found >= promised, "{found} < {promised} at {}", beyond * limit);
    }
}

#[test]
fn far_beyond_the_limit_distances_are_not_kept() {
    let table = shipped("spaced-5-sqrt3-over-2-s");
    let distance = table.least_distance().with_warp(Warp::OFF);
    let near = set(&table, unit(0, 0.0));
    assert_eq!(near.least_distance_within(1e6), near.least_distance());
    // Coordinates are multiples of 1/64 there.
    assert!(near.least_distance_within(1e14) < near.least_distance() - 0.01);
    let least = (0..3).map(|seed| least_far_out(&set(&table, unit(seed, 0.0)), 1e14));
    let least = least.fold(f64::INFINITY, f64::min);
    assert!(least < 0.99 * distance, "{least}: the limit has no reason");
}

#[test]
fn profiles_without_distance_guarantee_none() {
    for profile in ["pink", "green", "step"] {
        let name = format!("{profile}-5-sqrt3-over-2-s");
        let least = shipped(&name).least_distance();
        let error = least.spacing_for(1.0, Warp::OFF).expect_err(profile);
        assert_eq!(error.kind(), ErrorKind::NoLeastDistance);
        assert!(least.relative() < 0.3);
        let text = error.to_string();
        assert!(text.contains("guarantees no least distance"), "{text}");
    }
    let least = shipped("blue-5-sqrt3-over-2-s").least_distance();
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let error = least.spacing_for(bad, Warp::ON).expect_err("refused");
        assert_eq!(error.kind(), ErrorKind::Distance);
    }
    let error = least.spacing_for(1e101, Warp::ON).expect_err("refused");
    assert_eq!(error.kind(), ErrorKind::Spacing);
    // Windows of a million points show 0.6664.
    let relative = least.relative();
    assert!((0.6..0.7).contains(&relative), "{relative}");
    assert!(least.with_warp(Warp::ON) > 0.5, "{least:?}");
}

#[test]
fn the_sparsest_patterns_are_answered_at_once() {
    for alpha in ["1.000000000000001", "1.00001", "1.03", "1.999999999"] {
        let table = Table::undisplaced(alpha.parse().expect("valid"), 3, "pattern").expect("valid");
        let least = table.least_distance();
        let is_part = (0.0..=1.0).contains(&least.relative());
        assert!(is_part, "{alpha}: {least:?}");
        for warp in [0.0, 2.0] {
            let set = set(&table, unit(1, warp));
            let _ = set.nearest([0.5, 0.5], 3);
            let clearance = set.clearance(1.0);
            let _ = clearance.map(|mut c| c.is_any_near([0.5, 0.5], |_| true));
        }
    }
}
