//! Nearest points and discs against brute force over boxes.

mod subject;

use std::{path::Path, sync::Arc};

use proptest::prelude::*;
use strew_core::{
    Placement, Point, Region, Sampler, Seed, Spacing, Table, Warp,
    pattern::Pattern,
    sample::{FindError, Finder, Keep, Neighbor, rank},
};
use subject::table;

fn samplers() -> &'static [Arc<Sampler>] {
    static ONCE: std::sync::OnceLock<Vec<Arc<Sampler>>> = std::sync::OnceLock::new();
    ONCE.get_or_init(|| {
        let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tables");
        let mut tables = vec![table("sqrt(3)", 20), table("(1+sqrt(5))/2", 20)];
        for name in ["blue-5-sqrt3-over-2-s", "pink-5-sqrt3-over-2-s"] {
            let bytes = std::fs::read(shipped.join(name).with_extension("strew")).expect("there");
            tables.push(Table::from_bytes(&bytes).expect("valid"));
        }
        tables
            .into_iter()
            .map(|table| Arc::new(Sampler::new(table)))
            .collect()
    })
}

/// All points of the box around a disc, and their squared distances, in order.
fn in_box(sampler: &Arc<Sampler>, placement: Placement, at: [f64; 2], r: f64) -> Vec<(f64, Point)> {
    let r = r * 1.001 + (at[0].abs() + at[1].abs()) * 1e-15;
    let region = Region::new(at.map(|v| v - r), at.map(|v| v + r)).expect("ordered");
    let plan = sampler.plan(placement, region).expect("near");
    let mut points = vec![Point::default(); plan.count() as usize];
    plan.blocks_points().fill(&mut points);
    let mut all: Vec<(f64, Point)> = points
        .into_iter()
        .map(|p| {
            let (dx, dy) = (p.x - at[0], p.y - at[1]);
            (dx * dx + dy * dy, p)
        })
        .collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.id.cmp(&b.1.id)));
    all
}

fn neighbors(all: &[(f64, Point)]) -> Vec<Neighbor> {
    let neighbor = |&(d, point): &(f64, Point)| Neighbor {
        point,
        distance: d.sqrt(),
    };
    all.iter().map(neighbor).collect()
}

fn any_query() -> impl Strategy<Value = (Arc<Sampler>, Placement, [f64; 2])> {
    let place = prop_oneof![
        4 => -50.0..50.0f64,
        2 => -1e6..1e6f64,
        1 => -1e15..1e15f64,
        1 => Just(0.0),
    ];
    let seed = prop_oneof![1 => Just(0u64), 3 => any::<u64>()];
    let strength = prop_oneof![Just(0.0), Just(1.0), Just(2.0), 0.0..2.0f64];
    let spacing = prop_oneof![Just(1.0), 0.01..100.0f64, 1e-9..1e9f64];
    (0..4usize, seed, strength, spacing, place.clone(), place).prop_map(
        |(sampler, seed, strength, spacing, x, y)| {
            let warp = Warp::new(strength).expect("in range");
            let placement =
                Placement::new(Spacing::new(spacing).expect("valid"), Seed(seed)).with_warp(warp);
            (
                samplers()[sampler].clone(),
                placement,
                [x * spacing, y * spacing],
            )
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn the_nearest_are_what_brute_force_finds(
        (sampler, placement, at) in any_query(), k in prop_oneof![0usize..12, 0usize..200],
    ) {
        let finder = sampler.finder(placement);
        let found = finder.nearest(at, k).expect("near");
        prop_assert_eq!(found.len(), k);
        let farthest = found.last().map_or(0.0, |n| n.distance);
        let all = in_box(&sampler, placement, at, farthest);
        prop_assert!(all.len() >= k);
        prop_assert_eq!(found, neighbors(&all[..k]));
    }

    #[test]
    fn discs_hold_what_brute_force_finds(
        (sampler, placement, at) in any_query(), spacings in prop_oneof![0.0..3.0f64, 0.0..12.0f64],
    ) {
        let finder = sampler.finder(placement);
        let radius = spacings * placement.spacing.get();
        let all = in_box(&sampler, placement, at, radius);
        let inside: Vec<_> = all.iter().filter(|(d, _)| *d <= radius * radius).copied().collect();
        prop_assert_eq!(finder.within(at, radius, 1000), Ok(neighbors(&inside)));
        if !inside.is_empty() {
            let limit = inside.len() - 1;
            let refused = matches!(finder.within(at, radius, limit), Err(FindError::TooMany { .. }));
            prop_assert!(refused);
        }

        let mut clearance = finder.clearance(radius).expect("small");
        let strictly = all.iter().filter(|(d, _)| *d < radius * radius);
        let strictly: Vec<Point> = strictly.map(|(_, p)| *p).collect();
        prop_assert_eq!(clearance.is_any_near(at, |_| true), !strictly.is_empty());
        let mut seen = Vec::new();
        let any = clearance.is_any_near(at, |p| { seen.push(*p); false });
        prop_assert!(!any);
        seen.sort_by_key(|p| p.id);
        let mut expected = strictly.clone();
        expected.sort_by_key(|p| p.id);
        prop_assert_eq!(seen, expected);
        // Strict: a point is not nearer than its own distance.
        if let Some((d, p)) = all.iter().find(|(d, _)| d.sqrt() * d.sqrt() == *d) {
            let mut clearance = finder.clearance(d.sqrt()).expect("small");
            prop_assert!(!clearance.is_any_near(at, |q| q.id == p.id));
        }
    }

    #[test]
    fn thinned_searches_see_what_is_kept(
        (sampler, placement, at) in any_query(), keep in 0.01..1.0f64, k in 1usize..20,
    ) {
        let finder = sampler.finder(placement.with_keep(Keep::new(keep).expect("a share")));
        let found = finder.nearest(at, k).expect("near");
        prop_assert_eq!(found.len(), k);
        let alpha = sampler.table().alpha();
        let pattern = Pattern::with_origin(alpha, placement.seed.origin());
        let mut all = in_box(&sampler, placement, at, found[k - 1].distance);
        all.retain(|(_, p)| {
            rank(pattern.depth(p.id.x, p.id.y), alpha.set_side()) < keep
        });
        prop_assert_eq!(found, neighbors(&all[..k]));
    }
}

#[test]
fn a_thousand_neighbors_and_the_limits() {
    let sampler = &samplers()[2];
    let placement = Placement::new(Spacing::new(3.0).expect("valid"), Seed(4));
    let finder = sampler.finder(placement);
    let at = [1e9, -7.5];
    let found = finder.nearest(at, 10_000).expect("near");
    let all = in_box(sampler, placement, at, found[9_999].distance);
    assert_eq!(found, neighbors(&all[..10_000]));

    assert_eq!(
        finder.nearest(at, Finder::MAX_NEAREST + 1),
        Err(FindError::TooManyNearest(10_001))
    );
    let error = finder.within(at, 1e6, 1_000_000).expect_err("many");
    assert!(error.to_string().contains("at most"), "{error}");
    assert!(finder.within(at, 1e300, 1_000_000).is_err());
    for radius in [-1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(
            finder.within(at, radius, 10),
            Err(FindError::Radius(_))
        ));
        assert!(matches!(
            finder.clearance(radius),
            Err(FindError::Radius(_))
        ));
    }
    assert!(finder.clearance(1e4).is_err());
    let limit = finder.limit();
    for at in [[f64::NAN, 0.0], [0.0, f64::INFINITY]] {
        assert!(matches!(
            finder.nearest(at, 1),
            Err(FindError::NotFinite { .. })
        ));
        assert!(
            !finder
                .clearance(9.0)
                .expect("small")
                .is_any_near(at, |_| true)
        );
    }
    for at in [[limit, 0.0], [0.0, -limit], [1e300, 0.0]] {
        assert!(matches!(
            finder.nearest(at, 1),
            Err(FindError::TooFar { .. })
        ));
        assert!(
            !finder
                .clearance(9.0)
                .expect("small")
                .is_any_near(at, |_| true)
        );
    }
    let edge = [limit - 100.0, 100.0 - limit];
    assert_eq!(finder.nearest(edge, 5).expect("inside").len(), 5);
    // Next to nothing is kept.
    let few = Keep::new(Keep::MIN).expect("a share");
    assert!(matches!(
        sampler.finder(placement.with_keep(few)).nearest(at, 1000),
        Err(FindError::TooMany { .. })
    ));
}
