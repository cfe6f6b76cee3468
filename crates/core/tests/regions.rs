//! The points of regions against brute force, and the laws: partitions, order, blocks, threads.

mod subject;

use proptest::prelude::*;
use rayon::prelude::*;
use strew_core::{
    Backend, Exact, F32, F64, LATTICE_LIMIT, Offsets, Pattern, Placement, Point, PointId, PointSet,
    Points, Region, Spacing, Warp, table::FRACTION_BITS,
};
use subject::{all, all_by, any_seed, any_table, definition, in_order_of_ids, set, tables, unit};

/// Every point of a region from first principles: for each lattice address near it the index is computed
/// anew, the block searched, the position converted.
fn brute_force(set: &PointSet, region: Region) -> Vec<Point> {
    let Placement { spacing, seed, .. } = set.placement();
    let table = set.table();
    let (map, alpha) = (table.map(), table.alpha());
    let pattern = Pattern::with_origin(alpha, seed.origin());
    let step = spacing.get() * alpha.set_side_f64() / f64::from(1u32 << FRACTION_BITS);
    let lattice = |v: f64| (v / step / f64::from(1u32 << FRACTION_BITS)).floor() as i64;
    // f64 errs by a few units here; vectors reach 13 units, a warp of strength 2 with long waves at most 111.
    let reach = 13 + 8 + 111;
    let mut points = Vec::new();
    let (min, max) = (region.min().map(lattice), region.max().map(lattice));
    for y in min[1] - reach..=max[1] + reach {
        for x in min[0] - reach..=max[0] + reach {
            if !pattern.contains(x, y) {
                continue;
            }
            let (dx, dy) = pattern.index(x, y);
            let find = |d| {
                (0..map.intervals())
                    .find(|&i| map.interval(i).contains(&d))
                    .expect("in")
            };
            let [column, row] = [find(dx), find(dy)];
            let block = set.block(PointId { x, y });
            assert_eq!(block, Some([column, row]));
            let p = definition::place(set, PointId { x, y }).expect("a member");
            if region.contains(p) {
                points.push(Point {
                    id: PointId { x, y },
                    x: p[0],
                    y: p[1],
                });
            }
        }
    }
    points
}

/// Regions by kind: near, far, negative, tiny, thin, empty; sides in mean spacings.
fn any_region() -> impl Strategy<Value = (Spacing, Region)> {
    let place = prop_oneof![
        4 => -40.0..40.0f64,
        2 => -1e6..1e6f64,
        1 => -1e12..1e12f64,
        1 => Just(0.0),
    ];
    let side = prop_oneof![
        5 => 0.0..25.0f64,
        2 => 0.0..1.0f64,
        1 => 0.0..1e-6f64,
        1 => Just(0.0),
        1 => 20.0..80.0f64,
    ];
    let spacing = prop_oneof![3 => 0.01..100.0f64, 1 => Just(1.0), 1 => 1e-9..1e9f64];
    (spacing, place.clone(), place, side.clone(), side).prop_map(|(spacing, x, y, w, h)| {
        let min = [x * spacing, y * spacing];
        let max = [min[0] + w * spacing, min[1] + h * spacing];
        (
            Spacing::new(spacing).expect("valid"),
            Region::new(min, max).expect("ordered"),
        )
    })
}

/// A partition of a region into boxes by random cuts, some of them on top of each other.
fn cut(region: Region, cuts: &[(bool, f64)]) -> Vec<Region> {
    let mut parts = vec![region];
    for (i, &(vertical, at)) in cuts.iter().enumerate() {
        let part = parts.swap_remove((i * 7919) % parts.len());
        let axis = usize::from(vertical);
        let (min, max) = (part.min(), part.max());
        let middle = (min[axis] + at * (max[axis] - min[axis])).clamp(min[axis], max[axis]);
        let (mut upper_min, mut lower_max) = (min, max);
        upper_min[axis] = middle;
        lower_max[axis] = middle;
        parts.push(Region::new(min, lower_max).expect("ordered"));
        parts.push(Region::new(upper_min, max).expect("ordered"));
    }
    parts
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1500))]

    #[test]
    fn a_region_holds_what_brute_force_finds(
        table in any_table(), (seed, warp) in any_seed(), (spacing, region) in any_region(),
    ) {
        let set = set(&table, Placement::new(spacing, seed).with_warp(warp));
        let plan = set.within(region).expect("in range");
        let points = all::<Points>(&plan, 777);
        let expected = in_order_of_ids(brute_force(&set, region));
        prop_assert_eq!(plan.count(), expected.len() as u128);
        prop_assert_eq!(&points, &expected);
        prop_assert_eq!(&plan.to_vec(), &points);
        prop_assert_eq!(set.count(region), Ok(plan.count()));
        for point in points.iter().take(20) {
            prop_assert_eq!(set.point(point.id).map(|member| member.point()), Some(*point));
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(10_000))]

    #[test]
    fn a_partition_gives_every_point_exactly_once(
        table in any_table(),
        (seed, warp) in any_seed(),
        (spacing, region) in any_region(),
        cuts in proptest::collection::vec((any::<bool>(), prop_oneof![0.0..1.0f64, Just(0.0), Just(1.0)]), 1..8),
    ) {
        let set = set(&table, Placement::new(spacing, seed).with_warp(warp));
        let whole = set.within(region).expect("in range");
        let mut from_parts = Vec::new();
        let mut counted = 0;
        for part in cut(region, &cuts) {
            let plan = set.within(part).expect("in range");
            counted += plan.count();
            let points = all::<Points>(&plan, 100);
            prop_assert_eq!(points.len() as u128, plan.count());
            prop_assert!(points.iter().all(|p| part.contains([p.x, p.y])));
            // The order of a part is its order in the whole.
            prop_assert_eq!(&in_order_of_ids(points.clone()), &points);
            from_parts.extend(points);
        }
        prop_assert_eq!(counted, whole.count());
        prop_assert_eq!(in_order_of_ids(from_parts), all::<Points>(&whole, 100));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn formats_blocks_and_tiles_agree(
        table in any_table(), (seed, warp) in any_seed(), (spacing, region) in any_region(),
        block in 1usize..300, tile in 1usize..3000,
    ) {
        let set = set(&table, Placement::new(spacing, seed).with_warp(warp));
        let plan = set.within(region).expect("in range");
        let points = all::<Points>(&plan, 64);
        let members: Vec<Point> = plan.iter().map(Point::from).collect();
        prop_assert_eq!(&members, &points);
        prop_assert_eq!(plan.iter().fold(0, |n, _| n + 1), points.len());
        let pairs: Vec<[f64; 2]> = points.iter().map(|p| [p.x, p.y]).collect();
        prop_assert_eq!(&all::<F64>(&plan, block), &pairs);
        for backend in Backend::available() {
            prop_assert_eq!(&all_by::<F64>(&plan, block, backend), &pairs);
            prop_assert_eq!(all_by::<F32>(&plan, block, backend), all_by::<F32>(&plan, 99, Backend::Scalar));
        }

        let tiles: Vec<_> = plan.tiles(tile).collect();
        let filled: Vec<Vec<[f64; 2]>> = tiles
            .par_iter()
            .map(|tile| {
                let mut items = vec![[0.0; 2]; plan.count() as usize];
                let filled = plan.tile_blocks::<F64>(tile).fill(&mut items);
                items.truncate(filled);
                items
            })
            .collect();
        prop_assert_eq!(&filled.concat(), &pairs);

        let (min, max) = (region.min(), region.max());
        let offsets = all::<Offsets>(&plan, block);
        let places = all::<Exact>(&plan, block);
        prop_assert!(plan.converted::<Offsets>(&places).eq(offsets.iter().copied()));
        prop_assert!(plan.converted::<F32>(&places).eq(all::<F32>(&plan, block)));
        prop_assert!(plan.converted::<Points>(&places).eq(plan.to_vec()));
        prop_assert!(places.iter().map(|place| place.id()).eq(plan.iter().map(|member| member.id())));
        for ((relative, p), exact) in all::<F32>(&plan, block).iter().zip(&pairs).zip(offsets) {
            for axis in 0..2 {
                let extent = max[axis] - min[axis];
                // One rounding to f32 of the offset from the corner, and that of the corner's own place far out.
                let rounding = exact[axis] * 6e-8 + f64::from(f32::MIN_POSITIVE);
                let beside = min[axis].abs() * 2.3e-16;
                let off = (f64::from(relative[axis]) - exact[axis]).abs();
                let is_last = extent - exact[axis] <= extent * 1.2e-7;
                prop_assert!(off <= rounding + beside || is_last, "{} {}", relative[axis], exact[axis]);
                prop_assert!(relative[axis] >= 0.0 && f64::from(relative[axis]) < extent);
                // The rounding of f32, that of the f64 it is compared with, and one unit.
                let allowed = extent * 1.2e-7 + p[axis].abs() * 4.5e-16 + spacing.get() * 4e-7;
                let offset = p[axis] - min[axis];
                prop_assert!((f64::from(relative[axis]) - offset).abs() <= allowed);
            }
        }
    }
}

/// Large enough for kept templates, several bands, tiles and many blocks.
#[test]
fn a_large_region_is_the_same_in_any_block_size_and_with_any_threads() {
    for warp in [Warp::OFF, Warp::ON] {
        let region = Region::new([-700.0, -333.3], [900.1, 1200.7]).expect("ordered");
        let set = set(&tables()[0], unit(5).with_warp(warp));
        let plan = set.within(region).expect("in range");
        let reference = all::<F64>(&plan, 1 << 16);
        assert_eq!(reference.len() as u128, plan.count());
        assert!((reference.len() as f64 / (1600.1 * 1534.0) - 1.0).abs() < 0.01);
        assert_eq!(all::<F64>(&plan, 1_000_003), reference);
        assert_eq!(all::<F64>(&plan, 17), reference);
        for threads in [1, 2, 3] {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .expect("threads");
            let tiles: Vec<_> = plan.tiles(50_000).collect();
            let fill = |tile| {
                let mut items = vec![[0.0; 2]; 50_000];
                let filled = plan.tile_blocks::<F64>(tile).fill(&mut items);
                items.truncate(filled);
                items
            };
            let filled: Vec<Vec<[f64; 2]>> = pool.install(|| tiles.par_iter().map(fill).collect());
            assert_eq!(filled.concat(), reference, "{threads} threads");
        }
    }
}

#[test]
fn counts_of_regions_too_large_to_list_add_up() {
    let set = set(&tables()[0], unit(3).with_warp(Warp::OFF));
    let count = |min, max| {
        let region = Region::new(min, max).expect("ordered");
        set.count(region).expect("in range")
    };
    let whole = count([-1e9, -5e8], [1e9, 5e8]);
    assert!((whole as f64 / 2e18 - 1.0).abs() < 1e-8, "{whole}");
    let quarters = count([-1e9, -5e8], [12_345.6, 0.1])
        + count([12_345.6, -5e8], [1e9, 0.1])
        + count([-1e9, 0.1], [12_345.6, 5e8])
        + count([12_345.6, 0.1], [1e9, 5e8]);
    assert_eq!(whole, quarters);
}

#[test]
fn regions_beyond_the_lattice_are_refused() {
    let set = set(&tables()[0], unit(0));
    let plan = |min, max| set.within(Region::new(min, max).expect("ordered"));
    let error = plan([0.0, 0.0], [1.0, 1e300]).expect_err("too far");
    assert!(error.to_string().starts_with("max_y is 1e300"), "{error}");
    assert!(plan([-1e16, 0.0], [1.0, 1.0]).is_err());
    let limit = 1.42e15;
    assert!(plan([-limit, -limit], [limit, limit]).is_ok());
    // Everything still works at the very edge.
    let edge = plan([limit, limit], [limit + 40.0, limit + 40.0]).expect("in range");
    assert_eq!(all::<Points>(&edge, 64).len() as u128, edge.count());
    assert!(edge.count() > 1000);
    for x in [i64::MIN, LATTICE_LIMIT + 1] {
        assert_eq!(set.point(PointId { x, y: 3 }), None);
    }
}

#[test]
fn reversed_and_non_finite_boxes_are_refused() {
    for (min, max, name) in [
        ([f64::NAN, 0.0], [1.0, 1.0], "min_x"),
        ([0.0, f64::NEG_INFINITY], [1.0, 1.0], "min_y"),
        ([0.0, 0.0], [f64::INFINITY, 1.0], "max_x"),
        ([0.0, 0.0], [1.0, f64::NAN], "max_y"),
        ([2.0, 0.0], [1.0, 1.0], "max_x"),
        ([0.0, 2.0], [1.0, 1.0], "max_y"),
    ] {
        let error = Region::new(min, max).expect_err("refused").to_string();
        assert!(error.starts_with(name), "{error}");
    }
    assert!(
        Region::new([1.0, 1.0], [1.0, 1.0])
            .expect("empty")
            .is_empty()
    );
}

#[test]
fn chunks_partition_the_plane() {
    let set = set(&tables()[1], unit(9));
    for (size, x, y) in [
        (16.0, -3i64, 7i64),
        (0.1, 1 << 40, -5),
        (7.3, 123_456_789, 0),
    ] {
        let whole = set.within(
            Region::new(
                [x as f64 * size, y as f64 * size],
                [(x + 3) as f64 * size, (y + 2) as f64 * size],
            )
            .expect("ordered"),
        );
        let whole = whole.expect("in range").to_vec();
        let mut parts = Vec::new();
        for at in (0..6).map(|i| [x + i % 3, y + i / 3]) {
            parts.extend(
                set.chunk(size, at)
                    .expect("in range")
                    .iter()
                    .map(Point::from),
            );
        }
        assert_eq!(in_order_of_ids(parts), whole);
    }
    for (size, at, problem) in [
        (0.0, [0, 0], "size"),
        (f64::NAN, [0, 0], "size"),
        (1.0, [(1 << 52) + 1, 0], "too far"),
        (1e300, [1 << 40, 0], "finite"),
    ] {
        let error = set.chunk(size, at).expect_err(problem);
        assert!(error.to_string().contains(problem), "{error}");
    }
}

#[test]
fn iterators_know_how_many_are_left() {
    let set = set(&tables()[2], unit(1));
    let plan = set.within(Region::new([0.0, 0.0], [70.0, 70.0]).expect("ordered"));
    let plan = plan.expect("in range");
    let mut members = plan.iter();
    let mut left = plan.len().expect("few");
    assert!(left > 4000);
    while let Some(member) = members.next() {
        left -= 1;
        assert_eq!(members.len(), left);
        assert_eq!(set.point(member.id()), Some(member));
    }
    assert_eq!((left, members.next()), (0, None));
}
