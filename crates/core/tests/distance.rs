//! The promised least distance: never undercut, and attained without warp.

use std::{collections::HashMap, path::Path, sync::Arc};

use proptest::prelude::*;
use strew_core::{
    Alpha, Map, Placement, Region, Sampler, Seed, Spacing, Table, Warp,
    sample::{DistanceError, LeastDistance},
    table::{FRACTION_BITS, Provenance},
};

fn shipped(name: &str) -> Arc<Sampler> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../tables")
        .join(name);
    let bytes = std::fs::read(path.with_extension("strew")).expect("there");
    Arc::new(Sampler::new(Table::from_bytes(&bytes).expect("valid")))
}

/// Vectors of up to ± `most` grid units.
fn wild(alpha: &str, radius: u32, most: i32) -> Arc<Sampler> {
    let map = Map::new(alpha.parse::<Alpha>().expect("valid"), radius).expect("small");
    let mut state = 99u64;
    let mut next = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        ((state >> 33) % (2 * most as u64 + 1)) as i32 - most
    };
    let blocks = map.intervals() * map.intervals();
    let vectors = (0..blocks).map(|_| [next(), next()]).collect();
    let table = Table::new(map, "wild", vectors, Provenance::default()).expect("valid");
    Arc::new(Sampler::new(table))
}

fn points(
    sampler: &Arc<Sampler>,
    placement: Placement,
    corner: [f64; 2],
    side: f64,
) -> Vec<[f64; 2]> {
    let region = Region::new(corner, corner.map(|v| v + side)).expect("ordered");
    let plan = sampler.plan(placement, region).expect("near");
    let mut points = vec![[0.0; 2]; plan.count() as usize];
    plan.blocks_f64().fill(&mut points);
    points
}

/// The least distance between any two points: those of neighboring cells of a grid are compared.
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
fn without_warp_the_promise_is_attained() {
    let mut samplers = vec![
        wild("sqrt(3)", 9, 1 << (FRACTION_BITS - 2)),
        wild("(1+sqrt(5))/2", 6, 5 << FRACTION_BITS),
    ];
    samplers.extend(
        [
            "blue-5-sqrt3-over-2-s",
            "blue-sqrt3-s",
            "spaced-5-sqrt3-over-2-s",
            "spaced-1-plus-sqrt5-over-2-s",
            "pattern-5-sqrt3-over-2-s",
            "step-5-sqrt3-over-2-s",
        ]
        .map(shipped),
    );
    for sampler in samplers {
        let promise = sampler.least_distance().with_warp(Warp::OFF);
        let found = least_of(&points(&sampler, unit(0, 0.0), [0.0, 0.0], 500.0));
        let name = sampler.table().profile();
        assert!(found >= promise - 1e-12, "{name}: {found} < {promise}");
        assert!(found <= promise + 1e-3, "{name}: {found} > {promise}");
    }
}

#[test]
fn large_maps_are_quick() {
    for name in ["blue-5-sqrt3-over-2-l", "spaced-5-sqrt3-over-2-l"] {
        let sampler = shipped(name);
        let start = std::time::Instant::now();
        let promise = sampler.least_distance();
        assert!(start.elapsed().as_secs_f64() < 2.0, "{:?}", start.elapsed());
        assert!(promise.is_promised(), "{promise:?}");
        let found = least_of(&points(&sampler, unit(3, 0.0), [0.0, 0.0], 300.0));
        let promise = promise.with_warp(Warp::OFF);
        assert!(
            found >= promise - 1e-12 && found < promise + 0.03,
            "{found} {promise}"
        );
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]

    #[test]
    fn no_window_undercuts_the_promise(
        which in 0usize..4, seed: u64, strength in prop_oneof![0.0..2.0f64, Just(1.0), Just(2.0)],
        x in -1e6..1e6f64, y in -1e6..1e6f64,
    ) {
        static ONCE: std::sync::OnceLock<[(Arc<Sampler>, LeastDistance); 4]> =
            std::sync::OnceLock::new();
        let samplers = ONCE.get_or_init(|| {
            [
                shipped("blue-5-sqrt3-over-2-s"),
                shipped("spaced-sqrt3-s"),
                shipped("lloyd-5-sqrt3-over-2-s"),
                wild("sqrt(3)", 20, 1 << (FRACTION_BITS - 1)),
            ]
            .map(|sampler| (sampler.clone(), sampler.least_distance()))
        });
        let (sampler, least) = &samplers[which];
        let placement = unit(seed, strength);
        let found = least_of(&points(sampler, placement, [x, y], 60.0));
        prop_assert!(found >= least.with_warp(placement.warp) - 1e-9);
        if least.is_promised() {
            let distance = 0.7;
            let spacing = least.spacing_for(distance, placement.warp).expect("promised");
            let placement = Placement { spacing, ..placement };
            let corner = [x * spacing.get(), y * spacing.get()];
            let found = least_of(&points(sampler, placement, corner, 40.0));
            prop_assert!(found >= distance, "{}", found);
        }
    }
}

#[test]
fn profiles_without_distance_promise_none() {
    for name in [
        "pink-5-sqrt3-over-2-s",
        "green-5-sqrt3-over-2-s",
        "step-5-sqrt3-over-2-s",
    ] {
        let least = shipped(name).least_distance();
        let error = least.spacing_for(1.0, Warp::OFF).expect_err(name);
        assert!(matches!(error, DistanceError::NoPromise { relative } if relative < 0.3));
        assert!(
            error.to_string().contains("promises no least distance"),
            "{error}"
        );
    }
    let least = shipped("blue-5-sqrt3-over-2-s").least_distance();
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(
            least.spacing_for(bad, Warp::ON),
            Err(DistanceError::Distance(_))
        ));
    }
    assert!(matches!(
        least.spacing_for(1e101, Warp::ON),
        Err(DistanceError::Spacing { .. })
    ));
    // δ_min 0.6664 and 0.928 are what windows of a million points show.
    let relative = least.relative();
    assert!((0.6..0.7).contains(&relative), "{relative}");
    assert!(least.with_warp(Warp::ON) > 0.5, "{least:?}");
}

#[test]
fn the_sparsest_patterns_are_answered_at_once() {
    for alpha in ["1.000000000000001", "1.00001", "1.03", "1.999999999"] {
        let table = Table::undisplaced(alpha.parse().expect("valid"), 3, "pattern").expect("valid");
        let sampler = Arc::new(Sampler::new(table));
        let least = sampler.least_distance();
        assert!(
            (0.0..=1.0).contains(&least.relative()),
            "{alpha}: {least:?}"
        );
        for warp in [0.0, 2.0] {
            let finder = sampler.finder(unit(1, warp));
            let _ = finder.nearest([0.5, 0.5], 3);
            let _ = finder
                .clearance(1.0)
                .map(|mut c| c.is_any_near([0.5, 0.5], |_| true));
        }
    }
}
