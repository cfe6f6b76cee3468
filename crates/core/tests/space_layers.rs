//! Sets in space that keep clear of others: every path leaves out the same points, those that brute force does.

use proptest::prelude::*;
use strew_core::{
    Backend, ErrorKind, Points,
    space::{Ball, Point, Region, SpaceSet, Volume},
};

fn set(spacing: f64, seed: u64) -> SpaceSet {
    let set = SpaceSet::blue().seed(seed);
    set.spacing(spacing).expect("in range")
}

/// Whether a point is nearer to another than a distance.
fn is_near(point: &Point, others: &[Point], distance: f64) -> bool {
    others.iter().any(|other| {
        let [dx, dy, dz] = [0, 1, 2].map(|axis| point.at()[axis] - other.at()[axis]);
        dx * dx + dy * dy + dz * dz < distance * distance
    })
}

fn cube(corner: [f64; 3], side: f64) -> Region {
    Region::new(corner, corner.map(|v| v + side)).expect("a box")
}

/// The points of a box that are clear of others, one by one.
fn by_hand(set: &SpaceSet, other: &SpaceSet, distance: f64, region: Region) -> Vec<Point> {
    let wide = Region::new(
        region.min().map(|v| v - distance - 1.0),
        region.max().map(|v| v + distance + 1.0),
    );
    let others = other.within(wide.expect("a box")).expect("near").to_vec();
    let all = set.within(region).expect("near").to_vec();
    let stays = |point: &Point| !is_near(point, &others, distance);
    all.into_iter().filter(stays).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn points_near_others_are_left_out_on_every_path(
        seeds in (0u64..5, 0u64..5),
        spacings in (0.5f64..2.0, 0.3f64..3.0),
        corner in prop::array::uniform3(-50.0f64..50.0),
        part in 0.05f64..1.2,
        side in 4.0f64..9.0,
    ) {
        let (own, other) = (set(spacings.0, seeds.0), set(spacings.1, seeds.1 + 10));
        let distance = part * spacings.1;
        let region = cube(corner, side);
        let clear = own.clone().clear_of(&other, distance).expect("in range");
        let expected = by_hand(&own, &other, distance, region);
        let plan = clear.within(region).expect("near");
        prop_assert_eq!(plan.count(), expected.len() as u128);
        prop_assert_eq!(&plan.to_vec(), &expected);
        let mut scalar = vec![Point::default(); expected.len()];
        plan.blocks::<Points>().with_backend(Backend::Scalar).fill(&mut scalar);
        prop_assert_eq!(&scalar, &expected);
        // By ids, before and after.
        for point in own.within(region).expect("near") {
            let stays = expected.contains(&point);
            prop_assert_eq!(clear.point(point.id), stays.then_some(point));
        }
        // In halves and from cursors.
        let middle = corner[0] + side * 0.37;
        let mut parts = vec![];
        for [from, to] in [[corner[0], middle], [middle, corner[0] + side]] {
            let [mut min, mut max] = [region.min(), region.max()];
            (min[0], max[0]) = (from, to);
            let half = Region::new(min, max).expect("a box");
            parts.extend(clear.within(half).expect("near").to_vec());
        }
        let id = |point: &Point| point.id;
        let mut sorted = expected.clone();
        parts.sort_by_key(id);
        sorted.sort_by_key(id);
        prop_assert_eq!(&parts, &sorted);
        let mut page = plan.window(0, Some(37));
        let mut pages = page.to_vec();
        while let Some(cursor) = page.next_cursor() {
            page = clear.resume(region, cursor).expect("near").window(0, Some(37));
            pages.extend(page.to_vec());
        }
        prop_assert_eq!(&pages, &expected);
        if let Some(first) = expected.first() {
            prop_assert_eq!(clear.nearest(first.at(), 1).expect("near")[0].point, *first);
        }
    }

    #[test]
    fn others_that_are_limited_or_clear_themselves_decide_by_what_they_leave(
        seed in 0u64..4, corner in prop::array::uniform3(-9.0f64..9.0), radius in 1.0f64..5.0,
    ) {
        let region = cube(corner, 6.0);
        let center = corner.map(|v| v + 3.0);
        let ball = Ball::new(center, radius).expect("a ball");
        let first = set(1.5, seed + 20);
        let second = set(1.0, seed + 30).limited_to(ball).clear_of(&first, 0.9).expect("in range");
        let own = set(0.8, seed);
        let clear = own.clone().clear_of(&second, 0.7).expect("in range");
        let expected = by_hand(&own, &second, 0.7, region);
        prop_assert_eq!(clear.within(region).expect("near").to_vec(), expected);
        let inside = second.within(Volume::from(cube(corner, 6.0))).expect("near");
        prop_assert!(inside.iter().all(|point| ball.contains(point.at())));
    }
}

#[test]
fn large_requests_and_dense_others_leave_out_the_same_points() {
    // More than are kept at once, several patches, and another set too dense for a grid around a patch.
    let region = cube([-11.0, 3.0, 700.0], 40.0);
    for (spacing, distance) in [(2.0, 1.4), (0.25, 0.16)] {
        let (own, other) = (set(1.0, 3), set(spacing, 4));
        let clear = own.clone().clear_of(&other, distance).expect("in range");
        let plan = clear.within(region).expect("near");
        let chunk = cube([0.0, 8.0, 710.0], 5.0);
        let all = plan.to_vec();
        assert_eq!(all.len() as u128, plan.count());
        let inside = all.iter().filter(|point| chunk.contains(point.at()));
        let inside: Vec<Point> = inside.copied().collect();
        let mut expected = by_hand(&own, &other, distance, chunk);
        expected.sort_by_key(|point| all.iter().position(|other| other == point));
        assert!(!expected.is_empty() && expected.len() < 125);
        assert_eq!(inside, expected);
    }
}

#[test]
fn distances_out_of_range_are_refused() {
    let (own, other) = (set(1.0, 1), set(2.0, 2));
    for distance in [0.0, -1.0, 32.1, f64::NAN, f64::INFINITY] {
        let error = own
            .clone()
            .clear_of(&other, distance)
            .expect_err("out of range");
        assert_eq!(
            (error.kind(), error.field()),
            (ErrorKind::Clearance, "distance")
        );
        assert!(error.allowed().contains("at most 32"), "{error}");
    }
    assert!(own.clear_of(&other, 32.0).is_ok());
}
