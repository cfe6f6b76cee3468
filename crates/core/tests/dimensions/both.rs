//! Properties of sets. This file is a module of the plane and one of space.

#![allow(clippy::useless_conversion, reason = "points of space are their own")]

use proptest::prelude::*;
use strew_core::ErrorKind;

use super::*;

/// A partition of a region into boxes by cuts across an axis, some of them on top of each other.
fn cut(region: Region, cuts: &[(usize, f64)]) -> Vec<Region> {
    let mut parts = vec![region];
    for (i, &(axis, at)) in cuts.iter().enumerate() {
        let part = parts.swap_remove((i * 7919) % parts.len());
        let (min, max) = (part.min(), part.max());
        let middle = (min[axis] + at * (max[axis] - min[axis])).clamp(min[axis], max[axis]);
        let (mut upper_min, mut lower_max) = (min, max);
        upper_min[axis] = middle;
        lower_max[axis] = middle;
        parts.extend([between(min, lower_max), between(upper_min, max)]);
    }
    parts
}

fn any_cuts() -> impl Strategy<Value = Vec<(usize, f64)>> {
    let at = prop_oneof![0.0..1.0f64, Just(0.0), Just(1.0)];
    prop::collection::vec((0..D, at), 1..8)
}

/// Checks that boxes have every point of a region once, in the order of the whole.
fn agree_in_boxes(set: &Set, points: &[Point], boxes: Vec<Region>) {
    let mut from_parts = Vec::new();
    for part in boxes {
        let plan = set.within(part).expect("near");
        let points = all::<strew_core::Points>(&plan, 100);
        assert_eq!(plan.count(), points.len() as u128);
        assert!(points.iter().all(|point| part.contains(point.at())));
        assert_eq!(in_order(points.clone()), points);
        from_parts.extend(points);
    }
    assert_eq!(in_order(from_parts), points);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(1500)))]

    #[test]
    fn a_box_holds_what_brute_force_finds((set, region) in any_box(), parts in any_parts()) {
        let expected = brute_force(&set, &region.into(), reach(&set), definition(&set));
        agree(&set, region, &expected, parts);
    }

    #[test]
    fn the_nearest_are_what_brute_force_finds(
        (set, at) in any_place(), k in prop_oneof![1usize..12, 1usize..200],
        part in prop_oneof![Just(1.0), 0.1..3.0f64],
    ) {
        agree_near(&set, at, k, part);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(10_000)))]

    #[test]
    fn a_partition_has_every_point_exactly_once((set, region) in any_box(), cuts in any_cuts()) {
        agree_in_boxes(&set, &within(&set, region), cut(region, &cuts));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(300)))]

    #[test]
    fn an_area_holds_the_points_of_its_box_that_lie_in_it(
        (set, area) in any_area(), is_box: bool, parts in any_parts(),
    ) {
        let bounds = area.bounds().expect("bounded");
        let area = if is_box { bounds.into() } else { area };
        let mut expected = within(&set, bounds);
        expected.retain(|point| area.contains(point.at()));
        agree(&set, area, &expected, parts);
    }

    #[test]
    fn a_count_is_met_exactly((set, area) in any_area(), count in 1u128..2000, is_box: bool) {
        let area = if is_box { area.bounds().expect("bounded").into() } else { area };
        // Areas without extent hold nothing at any spacing.
        let fine = set.clone().spacing(0.2).expect("valid");
        prop_assume!(fine.count(area.clone()).expect("near") > 200);
        prop_assert!(exactly(&set, count, &area, 0.0).is_ok_and(|plan| plan.count() == count));
        agree_in_number(&set, &area, count);
    }

    #[test]
    fn a_share_keeps_the_points_of_lesser_rank(
        (set, area) in any_area(), share in prop_oneof![0.0001..1.0f64, Just(1.0)], parts in any_parts(),
    ) {
        let whole = within(&set, area.clone());
        let mut expected = whole.clone();
        expected.retain(|point| set.rank(point.id) < share);
        let kept = thinned(&set, share);
        agree(&kept, area, &expected, parts);
        for point in whole.iter().take(50) {
            let found = kept.point(point.id);
            prop_assert_eq!(found.is_some(), expected.contains(point));
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(100)))]

    #[test]
    fn chunks_lose_nothing_and_share_nothing(
        (whole, other, distance, _) in any_layers(), is_clear: bool,
        at in prop::array::uniform::<_, D>(prop_oneof![3 => -40i64..40, 1 => -(1i64 << 30)..1 << 30]),
        (size, number) in prop_oneof![(8.0..20.0f64, Just(2i64)), (2i64..5).prop_map(|n| (24.0 / n as f64, n))],
        parts in any_parts(),
    ) {
        let set = if is_clear { whole.clear_of(&other, distance).expect("near") } else { whole };
        let chunk = |size: f64, at| Region::chunk(size, at).expect("near");
        let region = chunk(size * number as f64, at);
        let points = within(&set, region);
        let part = |i: i64| {
            let mut rest = i;
            chunk(size, at.map(|v| {
                let place = rest % number;
                rest /= number;
                v * number + place
            }))
        };
        let boxes = (0..number.pow(D as u32)).map(part);
        let made = boxes.flat_map(|region| within(&set, region)).collect();
        prop_assert_eq!(&in_order(made), &points);
        agree(&set, region, &points, parts);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(40)))]

    #[test]
    fn sets_keep_clear_of_each_other_wherever_regions_end(
        (whole, other, distance, region) in any_layers(), cuts in any_cuts(), parts in any_parts(),
    ) {
        let clear = whole.clone().clear_of(&other, distance).expect("near");
        let expected = clear_by_hand(&whole, &other, distance, region);
        agree(&clear, region, &expected, parts);
        for point in within(&whole, region) {
            let stays = expected.contains(&point).then_some(point);
            prop_assert_eq!(clear.point(point.id).map(Point::from), stays);
        }
        agree_in_boxes(&clear, &expected, cut(region, &cuts));
        if let Some(first) = expected.first() {
            let nearest = clear.nearest(first.at(), 1).expect("near");
            prop_assert_eq!(nearest[0].member.point(), *first);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(60)))]

    #[test]
    fn points_of_some_ids_are_left_out_and_no_others(
        (set, area) in any_area(), share in prop_oneof![Just(1.0), 0.05..1.0f64], steps in 0u32..2,
        is_box: bool, is_in_field: bool, every in 1usize..20, parts in any_parts(),
    ) {
        let bounds = area.bounds().expect("bounded");
        let area = if is_box { bounds.into() } else { area };
        let set = set.keep(share).expect("a share").settle(steps).expect("few");
        let noise = crate::subject::noise(3, 30.0, 2, [0.0, 1.0]).expect("valid");
        let set = if is_in_field { set.in_field(noise) } else { set };
        let all = within(&set, area.clone());
        let around = within(&set, around(bounds, 3.0));
        let felled: Vec<PointId> = all.iter().chain(&around).map(|point| point.id).step_by(every).collect();
        let (some, others) = felled.split_at(felled.len() / 3);
        let left = set.clone().without(some).without(others).without([id([0; D]), id([1; D])]);
        let stays = |point: &Point| ![id([0; D]), id([1; D])].contains(&point.id) && !felled.contains(&point.id);
        let expected: Vec<Point> = all.iter().copied().filter(stays).collect();
        agree(&left, area.clone(), &expected, parts);
        for point in all.iter().take(20) {
            prop_assert_eq!(left.point(point.id).map(Point::from), stays(point).then_some(*point));
        }
        // Whatever keeps clear of a set keeps clear of what is left of it.
        if let Some(last) = expected.last() {
            let near = left.nearest(last.at(), 1).expect("near");
            prop_assert_eq!(near[0].member.point(), *last);
            let others = set.settle(0).expect("few").seed(9).clear_of(&left, 1.0).expect("near");
            let region = cube(last.at().map(|v| v - 3.0), 6.0);
            let all = within(&others.clone(), region);
            let is_near = |point: &Point| left.nearest(point.at(), 1).expect("near")[0].distance < 1.0;
            prop_assert!(!all.iter().any(is_near));
        }
    }
}

const fn is_shared<T: Clone + Send + Sync>() {}

const _: () = is_shared::<Set>();
const _: () = is_shared::<Plan>();

#[test]
fn a_chosen_warp_stays() {
    let set = Set::new(unit_set().table().clone());
    let strength = |set: Set| set.placement().warp.strength();
    assert_eq!(strength(set.clone()), 0.0);
    assert_eq!(strength(set.clone().seed(3)), 1.0);
    assert_eq!(strength(set.clone().seed(3).seed(0)), 0.0);
    assert_eq!(strength(set.warp(0.5).expect("in range").seed(3)), 0.5);
}

#[test]
fn ids_read_back_and_have_one_text() {
    let ends = [i64::MIN, i64::MAX, -31, 0];
    for first in 0..ends.len() {
        let id = id(std::array::from_fn(|i| ends[(first + i) % 4]));
        assert_eq!(id.to_string().parse(), Ok(id));
    }
    let rest = ":2".repeat(D - 1);
    let few = ["1"; D - 1].join(":");
    let starts = [
        "",
        ":",
        "1:",
        "1:2",
        "+1",
        "01",
        "-0",
        " 1",
        "99999999999999999999",
    ];
    for bad in starts
        .map(|start| format!("{start}{rest}"))
        .into_iter()
        .chain([few])
    {
        let error = bad.parse::<PointId>().expect_err(&bad);
        assert_eq!(error.kind(), ErrorKind::PointId);
    }
}

#[test]
fn others_keep_clear_of_the_points_of_all_levels() {
    let set = Set::new(unit_set().table().clone());
    let trees = set.clone().seed(1).keep(0.3).expect("a share");
    let left = |trees: &Set| {
        let flowers = set.clone().seed(2).clear_of(trees, 1.0);
        within(&flowers.expect("near"), cube([0.0; D], 20.0))
    };
    let level = trees.clone().lod(0.1).expect("a part");
    assert_eq!(left(&level), left(&trees));
}

#[test]
fn far_windows_and_many_parts_are_found_without_walking_all() {
    let set = Set::new(unit_set().table().clone());
    let plan = set.within(cube([-0.5 * WIDE; D], WIDE)).expect("near");
    assert!(plan.count() > 50_000_000_000_000_000);
    for offset in [1, 999, plan.count() / 2, plan.count() - 100] {
        let points = plan.window(offset, Some(100)).to_vec();
        let earlier = plan.window(offset - 1, Some(50)).to_vec();
        assert_eq!(points.len(), 100);
        assert_eq!(&points[..49], &earlier[1..], "{offset}");
    }
    let numbers: Vec<u128> = (1..40).map(|i| plan.count() / 40 * i).collect();
    for (cursor, &k) in plan.cursors(&numbers).into_iter().zip(&numbers) {
        assert_eq!(plan.window(k, None).cursor(), cursor);
        let up_to = plan.from_cursor(cursor.expect("inside"));
        assert_eq!((up_to.offset(), up_to.cursor()), (k, cursor));
    }
    let parts: Vec<Plan> = plan.split(100).collect();
    assert_eq!(parts.iter().map(Plan::count).sum::<u128>(), plan.count());
    for pair in parts.windows(2) {
        assert_eq!(pair[0].next_cursor(), pair[1].cursor());
    }
    let ball = Round::new([5.0; D], 70.0).expect("valid");
    let ball = set.seed(7).within(ball).expect("near");
    let parts = ball.split(97).flat_map(|part| part.to_vec());
    assert!(parts.eq(ball.to_vec()));
}

#[test]
fn bad_input_is_refused() {
    let set = unit_set();
    let corners = |axis: usize, low: f64, high: f64| {
        let (mut min, mut max) = ([0.0; D], [1.0; D]);
        (min[axis], max[axis]) = (low, high);
        let error = Region::new(min, max).expect_err("refused");
        assert_eq!(error.kind(), ErrorKind::Region);
        error.field().to_owned()
    };
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate().take(D) {
        let [min, max] = ["min", "max"].map(|end| format!("{end}_{name}"));
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert_eq!(corners(axis, bad, 1.0), min);
            assert_eq!(corners(axis, 0.0, bad), max);
            let mut at = [0.0; D];
            at[axis] = bad;
            let error = Round::new(at, 1.0).expect_err("not finite");
            assert_eq!(error.kind(), ErrorKind::Area);
            let error = set.nearest(at, 1).expect_err("not finite");
            assert_eq!(error.kind(), ErrorKind::Place);
        }
        assert_eq!(corners(axis, 2.0, 1.0), max);
        // A flat box has no points.
        let mut max = [9.0; D];
        max[axis] = 0.0;
        let flat = between([0.0; D], max);
        assert!(flat.is_empty());
        assert_eq!(set.count(flat), Ok(0));
        let (mut min, mut max) = ([0.0; D], [1.0; D]);
        (min[axis], max[axis]) = (1e16, 1e16 + 5.0);
        let error = set.within(between(min, max)).expect_err("far");
        assert_eq!(error.kind(), ErrorKind::TooFar);
    }
    let everywhere = Area::Outside(Box::new(cube([0.0; D], 1.0).into()));
    let error = set.within(everywhere.clone()).expect_err("unbounded");
    assert_eq!(error.kind(), ErrorKind::Unbounded);
    // A limit bounds it.
    let limited = set.clone().limited_to(cube([-1.0; D], 2.0));
    assert!(limited.within(everywhere).is_ok());
    let round = Area::from(Round::new([0.0; D], 50.0).expect("valid"));
    let (unit, mut flat) = (cube([0.0; D], 1.0), [1.0; D]);
    flat[D - 1] = 0.0;
    for (count, area, least, kind) in [
        (0, unit.into(), 0.0, ErrorKind::Count),
        (1, between([0.0; D], flat).into(), 0.0, ErrorKind::Count),
        (1_000_000, round.clone(), 1.0, ErrorKind::TooDense),
        (1, Area::Outside(Box::new(round)), 0.0, ErrorKind::Unbounded),
    ] {
        let error = exactly(&set, count, &area, least).expect_err("refused");
        assert_eq!(error.kind(), kind);
    }
    for (size, at, problem) in [
        (0.0, 0, "size"),
        (-1.0, 0, "size"),
        (f64::NAN, 0, "size"),
        (1.0, (1 << 52) + 1, "too far"),
        (1.0, i64::MAX, "too far"),
        (1e300, 1 << 40, "finite"),
    ] {
        let mut column = [0; D];
        column[0] = at;
        let error = set.chunk(size, column).expect_err(problem);
        assert_eq!(error.kind(), ErrorKind::Chunk);
        assert!(error.to_string().contains(problem), "{error}");
    }
    for k in [0, 10_001] {
        let error = set.nearest([0.0; D], k).expect_err("none or too many");
        assert_eq!(error.kind(), ErrorKind::Neighbors);
        assert_eq!(error.value(), k.to_string());
        assert!(set.nearest_within([0.0; D], k, 1.0).is_err());
    }
    for radius in [-1.0, f64::NAN] {
        let error = set.nearest_within([0.0; D], 9, radius);
        assert_eq!(error.expect_err("refused").kind(), ErrorKind::Radius);
    }
    // 16 spacings of the other set.
    let other = set.clone().spacing(2.0).expect("in range");
    for distance in [0.0, -1.0, f64::NAN, f64::INFINITY, 32.1] {
        let error = set.clone().clear_of(&other, distance).expect_err("refused");
        assert_eq!(
            (error.kind(), error.field()),
            (ErrorKind::Clearance, "distance")
        );
        assert!(error.allowed().contains("at most 32"), "{error}");
    }
    let error = set.clone().clear_of(&other, 32.1).expect_err("far");
    assert_eq!(error.limit(), Some(32.0));
    assert!(set.clone().clear_of(&other, 32.0).is_ok());
    for bad in [
        f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
        0.0,
        -1.0,
        1e300,
        1e-300,
    ] {
        let kind = |result: Result<Set, strew_core::Error>| result.expect_err("refused").kind();
        assert_eq!(kind(set.clone().spacing(bad)), ErrorKind::Spacing);
        assert_eq!(kind(set.clone().density(bad)), ErrorKind::Density);
        assert_eq!(kind(set.clone().keep(bad)), ErrorKind::Keep);
    }
}
