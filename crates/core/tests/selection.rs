//! Areas, windows, cursors and clearances against the points of a box, one by one.

mod subject;

use std::sync::Arc;

use proptest::prelude::*;
use strew_core::{
    Area, Circle, Placement, Plan, Point, Polygon, Region, Sampler, Seed, Spacing,
    sample::{
        Attribute, Attributes, Backend, ClearOf, F32, F64, Keep, Layer, PlanError, Points,
        Selection,
    },
};
use subject::{all, all_by, any_sampler, any_seed, in_order_of_ids, samplers, unit};

/// Where areas lie, in spacings.
fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![(-4i8..=4).prop_map(|v| f64::from(v) * 10.0), -40.0..40.0f64]
}

fn place() -> impl Strategy<Value = [f64; 2]> {
    [coordinate(), coordinate()]
}

fn any_area() -> impl Strategy<Value = Area> {
    let region = (place(), place()).prop_map(|(a, b)| {
        let pick = |f: fn(f64, f64) -> f64| [f(a[0], b[0]), f(a[1], b[1])];
        Area::from(Region::new(pick(f64::min), pick(f64::max)).expect("ordered"))
    });
    let circle = (place(), 0.1..40.0f64)
        .prop_map(|(center, radius)| Area::from(Circle::new(center, radius).expect("valid")));
    let polygon = prop::collection::vec(
        prop::collection::vec(place(), 3..9)
            .prop_filter("different", |ring| Polygon::new(&[ring]).is_ok()),
        1..3,
    )
    .prop_map(|rings| Area::from(Polygon::new(&rings).expect("valid")));
    prop_oneof![region, circle, polygon].prop_recursive(2, 6, 3, |inner| {
        prop_oneof![
            prop::collection::vec(inner.clone(), 1..3).prop_map(Area::any_of),
            (inner.clone(), inner.clone()).prop_map(|(a, b)| a.and(b)),
            (inner.clone(), inner).prop_map(|(a, b)| a.without([b])),
        ]
    })
}

/// The points of an area's box that lie in the area.
fn sifted(sampler: &Arc<Sampler>, placement: Placement, area: &Area) -> Vec<Point> {
    let bounds = area.bounds().expect("bounded");
    let plan = sampler.plan(placement, bounds).expect("in range");
    let mut points = all::<Points>(&plan, 1000);
    points.retain(|p| area.contains([p.x, p.y]));
    points
}

fn select(sampler: &Arc<Sampler>, placement: Placement, area: &Area) -> Plan {
    let selection = Selection::new(placement, area.clone());
    sampler.select(selection).expect("in range")
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn an_area_holds_the_points_of_its_box_that_lie_in_it(
        sampler in any_sampler(), (seed, warp) in any_seed(), area in any_area(), block in 1usize..500,
    ) {
        let placement = unit(0).with_warp(warp);
        let placement = Placement { seed, ..placement };
        let expected = sifted(&sampler, placement, &area);
        let plan = select(&sampler, placement, &area);
        prop_assert_eq!(plan.count(), expected.len() as u128);
        prop_assert_eq!(&all::<Points>(&plan, block), &expected);
        let pairs: Vec<[f64; 2]> = expected.iter().map(|p| [p.x, p.y]).collect();
        for backend in Backend::available() {
            prop_assert_eq!(&all_by::<F64>(&plan, block, backend), &pairs);
            prop_assert_eq!(all_by::<F32>(&plan, block, backend), all_by::<F32>(&plan, 99, Backend::Scalar));
        }
        let from_tiles: Vec<[f64; 2]> = plan
            .tiles(500)
            .flat_map(|tile| {
                let mut items = vec![[0.0; 2]; expected.len() + 1];
                let filled = plan.tile_blocks::<F64>(&tile).fill(&mut items);
                items.truncate(filled);
                items
            })
            .collect();
        prop_assert_eq!(&from_tiles, &pairs);
    }

    #[test]
    fn triangles_that_share_edges_share_no_point_and_lose_none(
        sampler in any_sampler(), (seed, warp) in any_seed(), center in place(),
        arms in prop::collection::vec((0.05..1.0f64, 5.0..40.0f64), 3..8),
    ) {
        // A star around the center: its triangles meet along the arms.
        let whole: f64 = arms.iter().map(|arm| arm.0).sum();
        let mut angle = 0.0;
        let ring: Vec<[f64; 2]> = arms
            .iter()
            .map(|(share, length)| {
                angle += share / whole * std::f64::consts::TAU;
                [center[0] + length * angle.cos(), center[1] + length * angle.sin()]
            })
            .collect();
        let placement = Placement { seed, ..unit(0).with_warp(warp) };
        let of = |ring: &[[f64; 2]]| {
            let plan = select(&sampler, placement, &Polygon::new(&[ring]).expect("valid").into());
            (plan.count(), all::<Points>(&plan, 300))
        };
        let (mut count, mut points) = (0, vec![]);
        for (i, &a) in ring.iter().enumerate() {
            let (more, some) = of(&[a, ring[(i + 1) % ring.len()], center]);
            count += more;
            points.extend(some);
        }
        // A gap of more than half a turn between arms turns its triangle inside out; by parity the
        // others then cover what it lacks twice or not at all, so only whole stars are compared.
        prop_assume!(arms.iter().all(|arm| arm.0 < whole / 2.0));
        let (expected_count, expected) = of(&ring);
        prop_assert_eq!(count, expected_count);
        prop_assert_eq!(in_order_of_ids(points), expected);
    }

    #[test]
    fn windows_cursors_and_splits_are_parts_of_the_whole(
        sampler in any_sampler(), (seed, warp) in any_seed(), area in any_area(),
        cut in 0.0..=1.0f64, length in 0u128..500, parts in 1u32..9, is_box: bool,
    ) {
        let placement = Placement { seed, ..unit(0).with_warp(warp) };
        let area = if is_box { area.bounds().expect("bounded").into() } else { area };
        let plan = select(&sampler, placement, &area);
        let points = all::<Points>(&plan, 1000);
        let offset = (cut * points.len() as f64) as usize;
        let window = plan.window(offset as u128, Some(length));
        let end = points.len().min(offset + length as usize);
        prop_assert_eq!(window.count(), (end - offset) as u128);
        prop_assert_eq!(&all::<Points>(&window, 7), &points[offset..end]);
        prop_assert_eq!(all::<F32>(&window, 7), &all::<F32>(&plan, 100)[offset..end]);

        // From its cursor the rest is found again, without counting.
        let selection = Selection::new(placement, area.clone());
        let place = window.cursor();
        prop_assert_eq!(place.map(|c| c.at), points[offset..end].first().map(|p| p.id));
        let next = window.next_cursor();
        prop_assert_eq!(next.map(|c| c.at), points.get(end).map(|p| p.id));
        if let Some(cursor) = next {
            let rest = sampler.resume(selection, cursor).expect("in range");
            prop_assert_eq!(rest.count(), (points.len() - end) as u128);
            prop_assert_eq!(&all::<Points>(&rest, 100), &points[end..]);
            prop_assert_eq!(rest.window(1, Some(5)).offset(), end as u128 + 1);
        }

        // So it is from where any block ended.
        let mut blocks = window.blocks::<F32>();
        let mut block = vec![[0.0; 2]; 1 + parts as usize * 9];
        let mut given = offset;
        while let Some(cursor) = blocks.cursor() {
            prop_assert_eq!(cursor.offset, given as u128);
            let selection = Selection::new(placement, area.clone());
            let rest = sampler.resume(selection, cursor).expect("in range");
            let near = &points[given..points.len().min(given + 70)];
            prop_assert_eq!(&all::<Points>(&rest.window(0, Some(70)), 33), near);
            let filled = blocks.fill(&mut block);
            given += filled;
            if filled == 0 {
                break;
            }
        }
        prop_assert_eq!(given, end);

        let split: Vec<Plan> = plan.split(parts).collect();
        prop_assert_eq!(split.len(), parts as usize);
        let sizes: Vec<u128> = split.iter().map(Plan::count).collect();
        prop_assert!(sizes.iter().max().expect("some") - sizes.iter().min().expect("some") <= 1);
        let union: Vec<Point> = split.iter().flat_map(|part| all::<Points>(part, 64)).collect();
        prop_assert_eq!(&union, &points);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn layers_keep_clear_of_each_other_wherever_regions_end(
        (sampler, other) in (any_sampler(), any_sampler()), (seed, warp) in any_seed(),
        area in any_area(), distance in 0.1..3.0f64, spacing in 0.5..3.0f64, at in 0.0..1.0f64,
    ) {
        let rocks = Layer {
            sampler: other.clone(),
            placement: Placement::new(Spacing::new(spacing).expect("valid"), Seed(7)),
            area: Some(area.clone()),
            clear: Arc::new([]),
        };
        let bounds = Region::new([-20.0, -20.0], [20.0, 20.0]).expect("ordered");
        let reach = distance + 1.0;
        let around = Region::new([-20.0 - reach; 2], [20.0 + reach; 2]).expect("ordered");
        let mut near = all::<Points>(&other.plan(rocks.placement, around).expect("in range"), 100);
        near.retain(|p| area.contains([p.x, p.y]));
        let placement = Placement { seed, ..unit(0).with_warp(warp) };
        let clear: Arc<[ClearOf]> =
            Arc::new([ClearOf::new(Arc::new(rocks), distance).expect("valid")]);
        let selection = |area: Area| Selection { placement, area, clear: clear.clone(), stop: strew_core::sample::Stop::default() };
        let plan = sampler.select(selection(bounds.into())).expect("in range");
        let points = all::<Points>(&plan, 50);
        prop_assert_eq!(plan.count(), points.len() as u128);
        let mut expected = all::<Points>(&sampler.plan(placement, bounds).expect("in range"), 100);
        expected.retain(|p| {
            near.iter().all(|q| {
                let [dx, dy] = [q.x - p.x, q.y - p.y];
                dx * dx + dy * dy >= distance * distance
            })
        });
        prop_assert_eq!(&points, &expected);
        // Cut in two, the halves agree with the whole.
        let middle = -20.0 + at * 40.0;
        let halves = [([-20.0; 2], [middle, 20.0]), ([middle, -20.0], [20.0; 2])];
        let parts = halves.map(|(min, max)| {
            let area = Region::new(min, max).expect("ordered").into();
            all::<Points>(&sampler.select(selection(area)).expect("in range"), 64)
        });
        prop_assert_eq!(in_order_of_ids(parts.concat()), points);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn a_count_is_met_exactly(
        sampler in any_sampler(), (seed, warp) in any_seed(), area in any_area(), count in 1u128..2000,
        is_box: bool,
    ) {
        let placement = Placement { seed, ..unit(0).with_warp(warp) };
        let area = if is_box { area.bounds().expect("bounded").into() } else { area };
        let selection = Selection::new(placement, area.clone());
        // Areas without extent hold nothing at any spacing.
        let fine = Placement { spacing: Spacing::new(0.2).expect("valid"), ..placement };
        prop_assume!(select(&sampler, fine, &area).count() > 200);
        let plan = sampler.select_count(&selection, count).expect("found");
        prop_assert_eq!(plan.count(), count);
        prop_assert_eq!(all::<Points>(&plan, 500).len() as u128, count);
    }

    #[test]
    fn a_share_keeps_the_points_of_lesser_rank(
        sampler in any_sampler(), (seed, warp) in any_seed(), area in any_area(),
        share in prop_oneof![0.0001..1.0f64, Just(1.0)],
    ) {
        let placement = Placement { seed, ..unit(0).with_warp(warp) };
        let ranks = Attributes::new(vec![Attribute::Rank]).expect("one").bind(&sampler, placement);
        let mut expected = all::<Points>(&select(&sampler, placement, &area), 500);
        expected.retain(|p| ranks.value(0, p.id).expect("a member") < share);
        let kept = placement.with_keep(Keep::new(share).expect("in range"));
        let plan = select(&sampler, kept, &area);
        prop_assert_eq!(plan.count(), expected.len() as u128);
        prop_assert_eq!(&all::<Points>(&plan, 100), &expected);
        let other = sifted(&sampler, placement, &area);
        for point in other.iter().take(50) {
            let found = sampler.point(kept, point.id);
            prop_assert_eq!(found.is_some(), expected.contains(point));
        }
    }
}

#[test]
fn a_place_among_ten_to_the_seventeen_points_is_found() {
    let sampler = &samplers()[0];
    let region = Region::new([-3e8, -2e8], [3e8, 2e8]).expect("ordered");
    let plan = sampler.plan(unit(0), region).expect("in range");
    assert!(plan.count() > 200_000_000_000_000_000);
    for offset in [1, 999, 100_000_000_000_000_000, plan.count() - 100] {
        let points = all::<Points>(&plan.window(offset, Some(100)), 32);
        let earlier = all::<Points>(&plan.window(offset - 1, Some(50)), 32);
        assert_eq!(points.len(), 100);
        assert_eq!(&points[..49], &earlier[1..], "{offset}");
    }
    let parts: Vec<Plan> = plan.split(1000).collect();
    assert_eq!(parts.iter().map(Plan::count).sum::<u128>(), plan.count());
    for pair in parts.windows(2) {
        assert_eq!(pair[0].next_cursor(), pair[1].cursor());
    }
}

#[test]
fn areas_without_end_are_refused() {
    let region = Region::new([0.0; 2], [1.0; 2]).expect("ordered");
    let area = Area::Outside(Box::new(region.into()));
    let error = samplers()[0]
        .select(Selection::new(unit(0), area))
        .expect_err("unbounded");
    assert_eq!(error, PlanError::Unbounded);
    let layer = Layer {
        sampler: samplers()[0].clone(),
        placement: unit(0),
        area: None,
        clear: Arc::new([]),
    };
    for distance in [0.0, -1.0, f64::NAN, 17.0] {
        assert!(ClearOf::new(Arc::new(layer.clone()), distance).is_err());
    }
}
