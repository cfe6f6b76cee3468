//! Areas, windows, cursors, shares and sets that keep clear, against the points of a box one by one.

mod subject;

use proptest::prelude::*;
use strew_core::{
    Area, Attribute, Attributes, Backend, Circle, ErrorKind, F32, F64, Placement, Plan, Point,
    PointSet, Points, Polygon, Region, Seed, Spacing,
    server::{self, Stop},
};
use subject::{all, all_by, any_seed, any_table, in_order_of_ids, set, tables, unit};

/// Coordinates of areas, in spacings.
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
fn sifted(set: &PointSet, area: &Area) -> Vec<Point> {
    let bounds = area.bounds().expect("bounded");
    let mut points = set.within(bounds).expect("in range").to_vec();
    points.retain(|p| area.contains(p.at()));
    points
}

fn within(set: &PointSet, area: &Area) -> Plan {
    set.within(area.clone()).expect("in range")
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn an_area_holds_the_points_of_its_box_that_lie_in_it(
        table in any_table(), (seed, warp) in any_seed(), area in any_area(), block in 1usize..500,
    ) {
        let set = set(&table, Placement { seed, ..unit(0).with_warp(warp) });
        let expected = sifted(&set, &area);
        let plan = within(&set, &area);
        prop_assert_eq!(plan.count(), expected.len() as u128);
        prop_assert_eq!(&all::<Points>(&plan, block), &expected);
        let pairs: Vec<[f64; 2]> = expected.iter().map(Point::at).collect();
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
        table in any_table(), (seed, warp) in any_seed(), center in place(),
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
        let set = set(&table, Placement { seed, ..unit(0).with_warp(warp) });
        let of = |ring: &[[f64; 2]]| {
            let plan = within(&set, &Polygon::new(&[ring]).expect("valid").into());
            (plan.count(), all::<Points>(&plan, 300))
        };
        let (mut count, mut points) = (0, vec![]);
        for (i, &a) in ring.iter().enumerate() {
            let (more, some) = of(&[a, ring[(i + 1) % ring.len()], center]);
            count += more;
            points.extend(some);
        }
        // A gap of more than half a turn between arms turns its triangle inside out, so only whole stars
        // are compared.
        prop_assume!(arms.iter().all(|arm| arm.0 < whole / 2.0));
        let (expected_count, expected) = of(&ring);
        prop_assert_eq!(count, expected_count);
        prop_assert_eq!(in_order_of_ids(points), expected);
    }

    #[test]
    fn windows_cursors_and_splits_are_parts_of_the_whole(
        table in any_table(), (seed, warp) in any_seed(), area in any_area(),
        cut in 0.0..=1.0f64, length in 0u128..500, parts in 1u32..9, is_box: bool,
    ) {
        let set = set(&table, Placement { seed, ..unit(0).with_warp(warp) });
        let area = if is_box { area.bounds().expect("bounded").into() } else { area };
        let plan = within(&set, &area);
        let points = plan.to_vec();
        let offset = (cut * points.len() as f64) as usize;
        let window = plan.window(offset as u128, Some(length));
        let end = points.len().min(offset + length as usize);
        prop_assert_eq!(window.count(), (end - offset) as u128);
        prop_assert_eq!(&all::<Points>(&window, 7), &points[offset..end]);
        prop_assert_eq!(all::<F32>(&window, 7), &all::<F32>(&plan, 100)[offset..end]);

        // The rest is found again from its cursor, without counting.
        let place = window.cursor();
        prop_assert_eq!(place.map(|c| c.at), points[offset..end].first().map(|p| p.id));
        let next = window.next_cursor();
        prop_assert_eq!(next.map(|c| c.at), points.get(end).map(|p| p.id));
        if let Some(cursor) = next {
            let rest = set.resume(area.clone(), cursor).expect("in range");
            prop_assert_eq!(rest.count(), (points.len() - end) as u128);
            prop_assert_eq!(&all::<Points>(&rest, 100), &points[end..]);
            prop_assert_eq!(rest.window(1, Some(5)).offset(), end as u128 + 1);
        }

        // And from the end of any block.
        let mut blocks = window.blocks::<F32>();
        let mut block = vec![[0.0; 2]; 1 + parts as usize * 9];
        let mut written = offset;
        while let Some(cursor) = blocks.cursor() {
            prop_assert_eq!(cursor.offset, written as u128);
            let rest = set.resume(area.clone(), cursor).expect("in range");
            let near = &points[written..points.len().min(written + 70)];
            prop_assert_eq!(&all::<Points>(&rest.window(0, Some(70)), 33), near);
            let filled = blocks.fill(&mut block);
            written += filled;
            if filled == 0 {
                break;
            }
        }
        prop_assert_eq!(written, end);

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
    fn sets_keep_clear_of_each_other_wherever_regions_end(
        (table, other) in (any_table(), any_table()), (seed, warp) in any_seed(),
        area in any_area(), distance in 0.1..3.0f64, spacing in 0.5..3.0f64, at in 0.0..1.0f64,
    ) {
        let rocks = Placement::new(Spacing::new(spacing).expect("valid"), Seed(7));
        let rocks = set(&other, rocks).limited_to(area.clone());
        let bounds = Region::new([-20.0, -20.0], [20.0, 20.0]).expect("ordered");
        let near: Vec<[f64; 2]> = match rocks.within(area) {
            Ok(plan) => plan.iter().map(|rock| rock.at()).collect(),
            Err(error) => panic!("{error}"),
        };
        let whole = set(&table, Placement { seed, ..unit(0).with_warp(warp) });
        let clear = whole.clone().clear_of(&rocks, distance).expect("valid");
        let plan = clear.within(bounds).expect("in range");
        let points = all::<Points>(&plan, 50);
        prop_assert_eq!(plan.count(), points.len() as u128);
        let mut expected = whole.within(bounds).expect("in range").to_vec();
        expected.retain(|p| {
            near.iter().all(|q| {
                let [dx, dy] = [q[0] - p.x, q[1] - p.y];
                dx * dx + dy * dy >= distance * distance
            })
        });
        prop_assert_eq!(&points, &expected);
        // Cut in two, the halves agree with the whole.
        let middle = -20.0 + at * 40.0;
        let halves = [([-20.0; 2], [middle, 20.0]), ([middle, -20.0], [20.0; 2])];
        let parts = halves.map(|(min, max)| {
            let area = Region::new(min, max).expect("ordered");
            clear.within(area).expect("in range").to_vec()
        });
        prop_assert_eq!(in_order_of_ids(parts.concat()), points);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn a_count_is_met_exactly(
        table in any_table(), (seed, warp) in any_seed(), area in any_area(), count in 1u128..2000,
        is_box: bool,
    ) {
        let set = set(&table, Placement { seed, ..unit(0).with_warp(warp) });
        let area = if is_box { area.bounds().expect("bounded").into() } else { area };
        // Areas without extent hold nothing at any spacing.
        let fine = set.clone().spacing(0.2).expect("valid");
        prop_assume!(within(&fine, &area).count() > 200);
        let plan = set.exactly(count, area.clone()).expect("found");
        prop_assert_eq!(plan.count(), count);
        prop_assert_eq!(plan.to_vec().len() as u128, count);
        let again = set.placed(plan.placement()).within(area).expect("in range");
        prop_assert_eq!(&again.to_vec()[..plan.to_vec().len()], plan.to_vec());
    }

    #[test]
    fn a_share_keeps_the_points_of_lesser_rank(
        table in any_table(), (seed, warp) in any_seed(), area in any_area(),
        share in prop_oneof![0.0001..1.0f64, Just(1.0)],
    ) {
        let set = set(&table, Placement { seed, ..unit(0).with_warp(warp) });
        let ranks = Attributes::new(vec![Attribute::Rank]).expect("one");
        let ranks = set.attributes(&ranks).expect("of any table");
        let mut expected = within(&set, &area).to_vec();
        expected.retain(|p| ranks.value(0, p.id).expect("a member") < share);
        let kept = set.clone().keep(share).expect("in range").settle(0).expect("0");
        let plan = within(&kept, &area);
        prop_assert_eq!(plan.count(), expected.len() as u128);
        prop_assert_eq!(&all::<Points>(&plan, 100), &expected);
        for point in sifted(&set, &area).iter().take(50) {
            let found = kept.point(point.id);
            prop_assert_eq!(found.is_some(), expected.contains(point));
        }
    }
}

#[test]
fn a_place_among_ten_to_the_seventeen_points_is_found() {
    let region = Region::new([-3e8, -2e8], [3e8, 2e8]).expect("ordered");
    let plan = set(&tables()[0], unit(0)).within(region).expect("in range");
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
fn what_cannot_be_planned_is_refused() {
    let region = Region::new([0.0; 2], [1.0; 2]).expect("ordered");
    let set = set(&tables()[0], unit(0));
    let outside = Area::Outside(Box::new(region.into()));
    let error = set.within(outside.clone()).expect_err("unbounded");
    assert_eq!(error.kind(), ErrorKind::Unbounded);
    // A limit bounds it.
    let limited = set
        .clone()
        .limited_to(Region::new([-1.0; 2], [1.0; 2]).expect("ordered"));
    assert!(limited.within(outside).is_ok());
    for distance in [0.0, -1.0, f64::NAN, 17.0] {
        let error = set.clone().clear_of(&set, distance).expect_err("refused");
        assert_eq!(
            (error.kind(), error.limit()),
            (ErrorKind::Clearance, Some(16.0))
        );
    }
    assert_eq!(
        set.exactly(0, region).expect_err("none").kind(),
        ErrorKind::Count
    );
    let stop = Stop::new();
    stop.raise();
    let error = server::within(&set, region, &stop).expect_err("stopped");
    assert_eq!(error.kind(), ErrorKind::Stopped);
    let circle = Circle::new([0.0; 2], 50.0).expect("valid").into();
    let error = server::exactly(&set, 1_000_000, &circle, 1.0, &Stop::default());
    assert_eq!(error.expect_err("dense").kind(), ErrorKind::TooDense);
}
