//! Points of space that settle, against the slow reference of docs/algorithm.md, and by all ways of asking.

use std::collections::HashMap;

use crate::{
    definition::{By, reference_of},
    subject::{
        noise,
        space::{agree, any_parts, around, between, order, within},
    },
};
use proptest::prelude::*;
use strew_core::{
    Field,
    field::FieldSpec,
    space::{Ball, Point, PointId, Region, SpaceSet, Table},
};

fn set(table: &str, seed: u64, steps: u32) -> SpaceSet {
    let set = match table {
        "blue" => SpaceSet::blue(),
        alpha => SpaceSet::new(
            Table::undisplaced(alpha.parse().expect("valid"), 5, "pattern").expect("small"),
        ),
    };
    set.seed(seed).settle(steps).expect("0 to 4")
}

fn cloud() -> FieldSpec {
    noise(5, 12.0, 2, [0.15, 1.0]).expect("valid")
}

/// Compares the points of a box with those of the reference in a wider one.
fn check(set: &SpaceSet, share: &dyn Fn([f64; 3]) -> f64, inner: Region, room: f64) {
    let still = set.clone().settle(0).expect("0");
    let points = within(&still, around(inner, room));
    let side = set.table().map().alpha().set_side_f64();
    let by = By {
        mix: None,
        least: set.table().least_distance(),
        placement: set.placement(),
        is_near: false,
        side,
        side_of_table: side,
        step: set.placement().spacing.get() * side / f64::from(1u32 << 20),
    };
    let kinds = vec![None; points.len()];
    let settled = reference_of(by, (points.iter().map(Point::at).collect(), kinds), share);
    let expected: HashMap<PointId, [f64; 3]> = points
        .iter()
        .map(|point| point.id)
        .zip(settled)
        .filter(|(_, at)| inner.contains(*at))
        .collect();
    let found = set.within(inner).expect("near");
    assert_eq!(found.count(), expected.len() as u128);
    let mut moved = found
        .iter()
        .map(|point| still.point(point.id()) != Some(point));
    assert!(expected.len() > 20 && moved.any(|moved| moved));
    for point in found.iter() {
        assert_eq!(
            Some(&point.at()),
            expected.get(&point.id()),
            "{}",
            point.id()
        );
    }
}

#[test]
fn thinned_points_are_those_of_the_definition() {
    for (table, seed, steps, keep, size) in [
        ("blue", 7, 1, 0.5, 5.0),
        ("blue", 8, 2, 0.3, 4.0),
        ("blue", 9, 3, 0.02, 3.0),
        ("blue", 0, 4, 0.1, 3.0),
        ("(5-sqrt(3))/2", 7, 2, 0.97, 4.0),
    ] {
        let local = f64::cbrt(1.0 / keep);
        let inner = Region::new(
            [-31.0, 11.0, 4.0],
            [-31.0, 11.0, 4.0].map(|v| v + size * local),
        );
        let room = (2.9 * f64::from(steps) + 0.5) * local;
        check(
            &set(table, seed, steps).keep(keep).expect("a share"),
            &|_| 1.0,
            inner.expect("a box"),
            room,
        );
    }
}

#[test]
fn points_of_fields_are_those_of_the_definition() {
    let step = FieldSpec::ramp([0.0, 0.0, 8.0], [0.0, 1.0, 9.0], [0.9, 0.2]).expect("valid");
    for (field, size) in [(cloud(), 5.0), (step, 4.0)] {
        let set = set("blue", 7, 2).in_field(field.clone());
        let share = |at: [f64; 3]| field.share(at);
        let inner = Region::new([3.0, -2.0, 6.0], [3.0 + size, size - 2.0, 6.0 + size]);
        check(&set, &share, inner.expect("a box"), 10.5);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(3))]

    #[test]
    fn parts_agree_with_the_whole(
        seed in 0u64..3, keep in 0.02..1.0f64, steps in 1u32..=4, in_field: bool, is_ball: bool, parts in any_parts(),
        lod in prop_oneof![Just(1.0), 0.2..1.0f64], felled in 1i64..9,
    ) {
        let set = set("sqrt(3)", seed, steps).keep(keep).expect("a share");
        let set = if in_field { set.in_field(cloud()) } else { set };
        let whole = between([-3.0, 2.0, -9.0], [9.0, 14.0, 3.0]);
        let all = within(&set, whole);
        let ids: Vec<PointId> = all.iter().map(|point| point.id).filter(|id| (id.x ^ id.z) % (felled + 1) == 0).collect();
        let part = set.clone().without(ids.clone()).lod(lod).expect("a part");
        // What is left stays where it is.
        let shown = |point: &&Point| !ids.contains(&point.id) && part.point(point.id).is_some();
        let left: Vec<Point> = all.iter().filter(shown).copied().collect();
        prop_assert!(lod < 1.0 || left.len() + ids.len() == all.len());
        let ball = Ball::new([3.0, 8.0, -3.0], 5.0).expect("a ball");
        let in_ball = left.iter().filter(|point| ball.contains(point.at())).copied();
        match is_ball {
            true => agree(&part, ball, &in_ball.collect::<Vec<_>>(), parts),
            false => agree(&part, whole, &left, parts),
        }
        for point in left.iter().step_by(29) {
            prop_assert_eq!(part.point(point.id).map(Point::from), Some(*point));
        }
        let chunks = (0..8i64).flat_map(|i| {
            let at = [-3 + i % 2 * 6, 2 + i / 2 % 2 * 6, -9 + i / 4 * 6].map(|v| v as f64);
            within(&part, between(at, at.map(|v| v + 6.0)))
        });
        let mut chunks: Vec<Point> = chunks.collect();
        chunks.sort_by_key(|point| order(point.id));
        prop_assert_eq!(chunks, left);
    }
}

/// Pieces of a thin tower are as high as they get.
#[test]
fn towers_agree_with_their_floors() {
    let set = set("blue", 7, 1).keep(0.01).expect("a share");
    let tower = between([900.0, -40.0, -300.0], [960.0, 20.0, 900.0]);
    let points = within(&set, tower);
    let floors = (0..12).flat_map(|i| {
        let z = 100.0 * f64::from(i) - 300.0;
        within(&set, between([900.0, -40.0, z], [960.0, 20.0, z + 100.0]))
    });
    let mut floors: Vec<Point> = floors.collect();
    floors.sort_by_key(|point| order(point.id));
    assert!(points.len() > 40_000);
    assert_eq!(points, floors);
}

#[test]
fn thinned_sets_keep_their_distances() {
    for (seed, keep) in [(7, 0.9), (8, 0.4), (0, 0.05)] {
        let set = set("blue", seed, 4).keep(keep).expect("a share");
        let points = set.chunk(24.0, [1, -1, 2]).expect("near");
        for point in points.iter().step_by(97) {
            let [own, next] = set.nearest(point.at(), 2).expect("near")[..] else {
                panic!("two points");
            };
            assert_eq!(own.member, point);
            assert!(next.distance >= set.least_distance());
        }
    }
}
