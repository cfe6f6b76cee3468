//! Disks and searches against brute force over boxes.

use crate::subject::{any_place, plane::in_box, set, tables_of_searches};
use proptest::prelude::*;
use strew_core::{Circle, ErrorKind, Keep, Neighbor, Placement, Point, Seed, Spacing};

/// Points with distances.
fn pairs(all: &[(f64, Point)]) -> Vec<(Point, f64)> {
    all.iter().map(|&(d, point)| (point, d.sqrt())).collect()
}

fn found(neighbors: Vec<Neighbor>) -> Vec<(Point, f64)> {
    let pair = |neighbor: Neighbor| (neighbor.member.point(), neighbor.distance);
    neighbors.into_iter().map(pair).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn disks_hold_what_brute_force_finds(
        (set, at) in any_place(), spacings in prop_oneof![0.0..3.0f64, 0.0..12.0f64],
    ) {
        let radius = spacings * set.placement().spacing.get();
        let all = in_box(&set, at, radius);
        let mut clearance = set.clearance(radius).expect("small");
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
            let mut clearance = set.clearance(d.sqrt()).expect("small");
            prop_assert!(!clearance.is_any_near(at, |q| q.id == p.id));
        }
    }

    #[test]
    fn thinned_searches_see_what_is_kept(
        (set, at) in any_place(), keep in 0.01..1.0f64, k in 1usize..20,
    ) {
        let thinned = set.clone().keep(keep).expect("a share").settle(0).expect("0");
        let nearest = found(thinned.nearest(at, k).expect("near"));
        prop_assert_eq!(nearest.len(), k);
        let mut all = in_box(&set, at, nearest[k - 1].1);
        all.retain(|(_, p)| set.rank(p.id) < keep);
        prop_assert_eq!(nearest, pairs(&all[..k]));
    }

    #[test]
    fn searches_see_the_points_of_a_limited_set_that_keeps_clear(
        (set, at) in any_place(), (other, _) in any_place(), k in 1usize..6, r in 4.0..8.0f64,
    ) {
        let spacing = set.placement().spacing.get();
        let other = other.spacing(spacing * 2.0).expect("valid");
        let disk = Circle::new(at, r * spacing).expect("valid");
        let limited = set.clone().limited_to(disk);
        let limited = limited.clear_of(&other, spacing * 0.7).expect("small");
        let mut clearance = other.clearance(spacing * 0.7).expect("small");
        let mut all = in_box(&set, at, r * spacing);
        all.retain(|(_, p)| disk.contains(p.at()) && !clearance.is_any_near(p.at(), |_| true));
        prop_assert_eq!(limited.count(disk), Ok(all.len() as u128));
        prop_assume!(all.len() >= k);
        prop_assert_eq!(found(limited.nearest(at, k).expect("near")), pairs(&all[..k]));
        for (_, p) in in_box(&set, at, r * spacing) {
            let is_there = all.iter().any(|(_, q)| *q == p);
            prop_assert_eq!(limited.point(p.id).map(Point::from), is_there.then_some(p));
        }
    }
}

#[test]
fn a_thousand_neighbors_and_the_limits() {
    let placement = Placement::new(Spacing::new(3.0).expect("valid"), Seed(4));
    let set = set(&tables_of_searches()[2], placement);
    let at = [1e9, -7.5];
    let nearest = found(set.nearest(at, 10_000).expect("near"));
    let all = in_box(&set, at, nearest[9_999].1);
    assert_eq!(nearest, pairs(&all[..10_000]));

    let kind = |error: strew_core::Error| error.kind();
    // Nothing beyond the radius is searched, so there is an answer where there are too few points.
    let rare = set.clone().keep(1e-6).expect("a share");
    assert!(rare.nearest(at, 5).is_err());
    assert_eq!(rare.nearest_within(at, 5, 30.0), Ok(vec![]));
    let error = set.around(at, 1e6, 1_000_000).expect_err("many");
    assert!(error.to_string().contains("at most"), "{error}");
    assert!(set.around(at, 1e300, 1_000_000).is_err());
    for radius in [-1.0, f64::NAN, f64::INFINITY] {
        let around = set.around(at, radius, 10).map(|_| ());
        let clearance = set.clearance(radius).map(|_| ());
        for refused in [around, clearance] {
            assert_eq!(refused.map_err(kind), Err(ErrorKind::Radius));
        }
    }
    assert!(set.clearance(1e4).is_err());
    let limit = set.search_limit();
    let nothing_near = |at| !set.clearance(9.0).expect("small").is_any_near(at, |_| true);
    for at in [[f64::NAN, 0.0], [0.0, f64::INFINITY]] {
        assert_eq!(set.nearest(at, 1).map_err(kind), Err(ErrorKind::Place));
        assert!(nothing_near(at));
    }
    for at in [[limit, 0.0], [0.0, -limit], [1e300, 0.0]] {
        assert_eq!(set.nearest(at, 1).map_err(kind), Err(ErrorKind::TooFar));
        assert!(nothing_near(at));
    }
    let edge = [limit - 100.0, 100.0 - limit];
    assert_eq!(set.nearest(edge, 5).expect("inside").len(), 5);
    // Almost nothing is kept.
    let few = set.clone().keep(Keep::MIN).expect("a share");
    assert_eq!(few.nearest(at, 1000).map_err(kind), Err(ErrorKind::TooMany));
    // Nothing of the set is near the place.
    let far = set.limited_to(Circle::new([0.0, 0.0], 1.0).expect("valid"));
    assert_eq!(far.nearest(at, 1).map_err(kind), Err(ErrorKind::TooMany));
}
