//! Points in space: every path has the points that ids have, and partitions have every point once.

use std::collections::BTreeSet;

use proptest::prelude::*;
use strew_core::{
    Backend, F32, F64, Map, Offsets, Points, Polygon,
    space::{Ball, Plan, Point, PointId, Prism, Region, SpaceSet, Table, Volume},
    table::{Provenance, Ranks},
};

/// A set of a small map with vectors of up to 4 grid units along each axis.
fn set(spacing: f64, seed: u64) -> SpaceSet {
    let map = Map::new("(5-sqrt(3))/2".parse().expect("valid"), 5).expect("small");
    let blocks = map.intervals().pow(3);
    let vector = |i: usize| [7919, 104_729, 1_299_709].map(|f| ((i * f) % 32_768) as i16 - 16_384);
    let vectors = (0..blocks).map(vector).collect();
    let order = (0..blocks as u32).map(|i| i * 11 % blocks as u32).collect();
    let ranks = Ranks::new(order).expect("an order");
    let table = Table::new(map, "test", vectors, Provenance::default(), Some(ranks));
    let set = SpaceSet::new(table.expect("valid")).seed(seed);
    set.spacing(spacing).expect("in range")
}

/// The points of a volume, looked for at every address around it.
fn by_ids(set: &SpaceSet, volume: &Volume) -> BTreeSet<PointId> {
    let bounds = volume.bounds().expect("bounded");
    let unit = set.placement().spacing.get() * set.table().map().alpha().set_side_f64();
    let range = |axis: usize| {
        let [from, to] = [bounds.min()[axis], bounds.max()[axis]].map(|v| v / unit);
        from as i64 - 24..to as i64 + 24
    };
    let mut found = BTreeSet::new();
    for z in range(2) {
        for y in range(1) {
            for x in range(0) {
                let point = set.point(PointId { x, y, z });
                let inside = point.filter(|point| volume.contains(point.at()));
                found.extend(inside.map(|point| point.id));
            }
        }
    }
    found
}

/// The points of a plan in their order, the same in all formats.
fn points(plan: &Plan) -> Vec<Point> {
    let points = plan.to_vec();
    assert_eq!(points.len() as u128, plan.count());
    assert!(plan.iter().eq(points.iter().copied()));
    let mut doubles = vec![[0.0; 3]; points.len() + 1];
    let mut singles = vec![[0.0; 3]; points.len() + 1];
    assert_eq!(plan.blocks::<F64>().fill(&mut doubles), points.len());
    assert_eq!(plan.blocks::<F32>().fill(&mut singles), points.len());
    let origin = plan.origin();
    for ((point, double), single) in points.iter().zip(&doubles).zip(&singles) {
        assert_eq!(point.at(), *double);
        for axis in 0..3 {
            let offset = double[axis] - origin[axis];
            assert!((f64::from(single[axis]) - offset).abs() <= 1e-6 * (1.0 + offset.abs()));
        }
    }
    let column = |v: i64| v >> 10;
    let key = |p: &Point| {
        let PointId { x, y, z } = p.id;
        (column(x), column(y), z, y, x)
    };
    assert!(points.is_sorted_by(|a, b| key(a) < key(b)), "in order");
    points
}

fn check(set: &SpaceSet, volume: Volume) -> Result<(), TestCaseError> {
    let expected = by_ids(set, &volume);
    let plan = set.within(volume).expect("near");
    let found = points(&plan);
    for point in &found {
        prop_assert_eq!(set.point(point.id), Some(*point));
    }
    prop_assert_eq!(
        found.iter().map(|p| p.id).collect::<BTreeSet<_>>(),
        expected
    );
    Ok(())
}

fn corner() -> impl Strategy<Value = [f64; 3]> {
    prop::array::uniform3(prop_oneof![-1200.0..1200.0f64, Just(0.0)])
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    #[test]
    fn boxes_have_the_points_of_their_ids(
        seed in 0u64..3, at in corner(), sides in prop::array::uniform3(0.0..14.0f64), share in prop_oneof![Just(1.0), 0.01..1.0f64],
    ) {
        let set = set(1.0, seed).keep(share).expect("in range");
        let to = [0, 1, 2].map(|i| at[i] + sides[i]);
        check(&set, Region::new(at, to).expect("ordered").into())?;
    }

    #[test]
    fn volumes_have_the_points_of_their_ids(
        seed in 0u64..3, at in corner(), radius in 1.0..7.0f64, kind in 0..4, share in prop_oneof![Just(1.0), 0.1..1.0f64],
    ) {
        let set = set(1.0, seed).keep(share).expect("in range");
        let ball = Volume::from(Ball::new(at, radius).expect("valid"));
        let [x, y, z] = at;
        let triangle = [[x, y], [x + 9.0, y + 1.0], [x + 2.0, y + 11.0]];
        let prism = Prism::new(Polygon::new(&[triangle]).expect("valid"), [z - 2.0, z + radius]);
        let prism = Volume::from(prism.expect("ordered"));
        check(&set, match kind {
            0 => ball,
            1 => prism,
            2 => Volume::any_of([ball, prism]),
            _ => prism.without([ball]),
        })?;
    }

    #[test]
    fn chunks_halves_and_cursors_have_every_point_once(
        seed in 0u64..3, at in prop::array::uniform3(-40i64..40), size in 8.0..20.0f64, pages in 1u32..9,
    ) {
        let set = set(1.0, seed);
        let whole = points(&set.chunk(2.0 * size, at).expect("near"));
        let mut parts = Vec::new();
        for i in 0..8 {
            let part = [0, 1, 2].map(|axis| 2 * at[axis] + (i >> axis & 1));
            parts.extend(set.chunk(size, part).expect("near").iter().map(|p| p.id));
        }
        parts.sort_unstable();
        let mut all: Vec<PointId> = whole.iter().map(|p| p.id).collect();
        all.sort_unstable();
        prop_assert_eq!(&parts, &all);
        let plan = set.chunk(2.0 * size, at).expect("near");
        let split: Vec<Point> = plan.split(pages).flatten().collect();
        prop_assert_eq!(&split, &whole);
        let numbers: Vec<u128> = (0..u128::from(pages)).map(|i| i * i * 37).collect();
        let cursors = plan.window(3, None).cursors(&numbers);
        let ids = cursors.iter().map(|cursor| cursor.map(|cursor| cursor.at));
        let expected = numbers.iter().map(|&k| whole.get(k as usize + 3).map(|point| point.id));
        prop_assert!(ids.eq(expected));
        let region = Region::chunk(2.0 * size, at).expect("valid");
        let limit = plan.count() / u128::from(pages) + 1;
        let mut page = plan.window(0, Some(limit));
        let mut paged = page.to_vec();
        while let Some(cursor) = page.next_cursor() {
            page = set.resume(region, cursor).expect("near").window(0, Some(limit));
            paged.extend(page.to_vec());
        }
        prop_assert_eq!(&paged, &whole);
    }

    #[test]
    fn nearest_points_are_those_of_brute_force(
        seed in 0u64..3, at in corner(), k in 1usize..60, share in prop_oneof![Just(1.0), 0.05..1.0f64],
    ) {
        let set = set(1.0, seed).keep(share).expect("in range");
        let near = set.nearest(at, k).expect("near");
        prop_assert_eq!(near.len(), k);
        let reach = near[k - 1].distance + 0.5;
        let around = Region::new(at.map(|v| v - reach), at.map(|v| v + reach)).expect("ordered");
        let mut all: Vec<(f64, PointId)> = set.within(around).expect("near").iter().map(|p| {
            let [dx, dy, dz] = [p.x - at[0], p.y - at[1], p.z - at[2]];
            (dx * dx + dy * dy + dz * dz, p.id)
        }).collect();
        all.sort_by(|a, b| a.0.total_cmp(&b.0).then_with(|| a.1.cmp(&b.1)));
        let expected: Vec<PointId> = all.into_iter().take(k).map(|(_, id)| id).collect();
        prop_assert_eq!(near.iter().map(|n| n.point.id).collect::<Vec<_>>(), expected);
        // A reported distance as the radius finds its point.
        for neighbor in &near {
            let within = set.nearest_within(at, 100, neighbor.distance).expect("near");
            prop_assert!(within.contains(neighbor));
            prop_assert!(within.iter().all(|found| found.distance <= neighbor.distance));
        }
    }

    #[test]
    fn offsets_in_chunks_are_exact_and_rounded_once(
        seed in 0u64..3, spacing in 0.3f64..3.0, size in prop_oneof![0.5..20.0f64, 0.5..20.0f64],
        at in prop::array::uniform3(prop_oneof![-40i64..40, -10_000_000_000i64..10_000_000_000]),
    ) {
        let set = set(spacing, seed);
        // Beyond the reach of a spacing chunks are refused.
        let at = at.map(|column| column.clamp(-(9e10 * spacing / size) as i64, (9e10 * spacing / size) as i64));
        let plan = set.chunk(size, at).expect("near");
        let mut offsets = vec![[0.0; 3]; plan.count() as usize];
        plan.blocks::<Offsets>().fill(&mut offsets);
        let step = spacing * set.table().map().alpha().set_side_f64() / f64::from(1 << 20);
        for (point, offset) in plan.iter().zip(offsets) {
            for axis in 0..3 {
                // Reported coordinates tell the position: they are its rounded multiples of the step.
                let about = (point.at()[axis] / step).round() as i64;
                let mut positions = about - (about.abs() >> 50) - 2..about + (about.abs() >> 50) + 3;
                let is_it = |p: i64| {
                    let exact = exactly(step, p, size, at[axis]);
                    offset[axis] == exact.clamp(0.0, size.next_down())
                };
                prop_assert!(positions.any(is_it), "{} {:?}", offset[axis], point);
                prop_assert!((0.0..size).contains(&offset[axis]));
            }
        }
    }
}

/// p · step − size · column, rounded once.
fn exactly(step: f64, p: i64, size: f64, column: i64) -> f64 {
    let parts = |v: f64| {
        let bits = v.to_bits();
        (
            ((bits & ((1 << 52) - 1)) | 1 << 52) as i128,
            (bits >> 52) as i32 - 1075,
        )
    };
    let ((a, e), (b, f)) = (parts(step), parts(size));
    let power = e.min(f);
    let value = ((a * i128::from(p)) << (e - power)) - ((b * i128::from(column)) << (f - power));
    value as f64 * 2f64.powi(power)
}

#[test]
fn far_windows_and_many_parts_are_found_without_walking_all() {
    let wide = Region::new([-2e5; 3], [2e5; 3]).expect("ordered");
    let plan = set(1.0, 0).within(wide).expect("near");
    let numbers: Vec<u128> = (1..40).map(|i| plan.count() / 40 * i).collect();
    for (cursor, &k) in plan.cursors(&numbers).iter().zip(&numbers) {
        let cursor = cursor.expect("inside");
        let up_to = plan.from_cursor(cursor);
        assert_eq!((up_to.offset(), up_to.cursor()), (k, Some(cursor)));
    }
    // One alone is the same.
    assert_eq!(
        plan.window(numbers[7], None).cursor(),
        plan.cursors(&numbers)[7]
    );
    let ball = set(1.0, 7)
        .within(Ball::new([5.0; 3], 70.0).expect("a ball"))
        .expect("near");
    let parts: Vec<Plan> = ball.split(97).collect();
    let ids = parts.iter().flat_map(Plan::iter).map(|point| point.id);
    assert!(ids.eq(ball.iter().map(|point| point.id)));
}

#[test]
fn a_raised_flag_ends_a_search_for_neighbors() {
    use strew_core::{
        ErrorKind,
        server::{Stop, Visits},
    };
    let stop = Stop::new();
    stop.raise();
    let error = set(1.0, 7).nearest_visiting([0.0; 3], 9, None, &Visits::new(usize::MAX, stop));
    assert_eq!(error.expect_err("stopped").kind(), ErrorKind::Stopped);
}

#[test]
fn large_requests_are_those_of_their_parts() {
    for (seed, share) in [(0, 1.0), (0, 0.3), (7, 1.0), (7, 0.3)] {
        let set = set(1.0, seed).keep(share).expect("in range");
        let ball = Ball::new([310.0, 5.0, -40.0], 30.0).expect("valid");
        let volumes = [
            Volume::from(
                Region::new([290.0, -20.0, -70.0], [350.0, 40.0, -10.5]).expect("ordered"),
            ),
            Volume::from(ball),
            Volume::from(
                Region::new([290.0, -20.0, -70.0], [350.0, 40.0, -10.5]).expect("ordered"),
            )
            .without([ball.into()]),
        ];
        for volume in volumes {
            let plan = set.within(volume.clone()).expect("near");
            let all = points(&plan);
            assert!(plan.count() > 10_000);
            let mut parts = BTreeSet::new();
            for i in 0..64 {
                let at = [
                    f64::from(290 + i % 4 * 15),
                    f64::from(-25 + i / 4 % 4 * 15),
                    f64::from(-70 + i / 16 * 15),
                ];
                let cube = Region::new(at, at.map(|v| v + 15.0)).expect("ordered");
                let part = set.within(volume.clone().and(cube.into())).expect("near");
                for point in points(&part) {
                    assert!(parts.insert(point.id), "twice");
                }
            }
            let all: BTreeSet<PointId> = all
                .iter()
                .map(|p| p.id)
                .filter(|id| {
                    let point = set.point(*id).expect("a point");
                    (280.0..350.0).contains(&point.x) && point.y < 35.0 && point.z < -10.0
                })
                .collect();
            let parts: BTreeSet<PointId> = parts
                .into_iter()
                .filter(|id| {
                    let point = set.point(*id).expect("a point");
                    (290.0..350.0).contains(&point.x) && point.y < 35.0 && point.z < -10.0
                })
                .collect();
            assert_eq!(
                parts,
                all.into_iter()
                    .filter(|id| {
                        let point = set.point(*id).expect("a point");
                        point.x >= 290.0
                    })
                    .collect()
            );
        }
    }
}

#[test]
fn counts_do_not_depend_on_the_size() {
    let set = set(1.0, 0);
    for share in [1.0, 0.2] {
        let set = set.clone().keep(share).expect("in range");
        let [low, high] = [[-3000.0, -20.0, -5.0], [4000.0, 3.0, 30.5]];
        let plan = set
            .within(Region::new(low, high).expect("ordered"))
            .expect("near");
        let mut block = vec![[0.0; 3]; 4096];
        let (mut blocks, mut made) = (plan.blocks_f64(), 0);
        loop {
            let filled = blocks.fill(&mut block);
            assert!(block[..filled].iter().all(|p| plan.region().contains(*p)));
            made += filled as u128;
            if filled == 0 {
                break;
            }
        }
        assert_eq!(made, plan.count());
        // Windows begin where counting finds them.
        for k in [1, 77, 5000, plan.count() / 2, plan.count() - 1] {
            let window = plan.window(k, Some(3));
            let expected: Vec<Point> = plan.iter().skip(k as usize).take(3).collect();
            assert_eq!(window.to_vec(), expected, "{k}");
        }
    }
}

#[test]
fn backends_have_the_same_bits() {
    for seed in [0, 7] {
        let plan = set(0.7, seed).within(Region::new([-30.0; 3], [25.0; 3]).expect("ordered"));
        let plan = plan.expect("near");
        let count = plan.count() as usize;
        let filled = |backend| {
            let (mut a, mut b, mut c) = (
                vec![[0f32; 3]; count],
                vec![[0f64; 3]; count],
                vec![Point::default(); count],
            );
            plan.blocks::<F32>().with_backend(backend).fill(&mut a);
            plan.blocks::<F64>().with_backend(backend).fill(&mut b);
            plan.blocks::<Points>().with_backend(backend).fill(&mut c);
            (a, b, c)
        };
        let expected = filled(Backend::Scalar);
        assert!(Backend::available().all(|backend| filled(backend) == expected));
    }
}

#[test]
fn wide_boxes_outlast_the_templates_that_are_kept() {
    let set = SpaceSet::blue();
    let wide = Region::new([1.0; 3], [321.0, 25.0, 321.0]).expect("ordered");
    let plan = set.within(wide).expect("near");
    let mut points = 0;
    for point in plan.iter() {
        assert_eq!(set.point(point.id), Some(point));
        points += 1;
    }
    assert_eq!(points, plan.count());
}

#[test]
fn bad_input_is_refused() {
    use strew_core::ErrorKind;
    let set = set(1.0, 7);
    for bad in [f64::NAN, f64::INFINITY] {
        let error = Region::new([0.0, bad, 0.0], [1.0; 3]).expect_err("not finite");
        assert_eq!((error.kind(), error.field()), (ErrorKind::Region, "min_y"));
        assert_eq!(
            Ball::new([0.0, 0.0, bad], 1.0)
                .expect_err("not finite")
                .kind(),
            ErrorKind::Area
        );
        assert_eq!(
            set.nearest([bad, 0.0, 0.0], 1)
                .expect_err("not finite")
                .kind(),
            ErrorKind::Place
        );
        assert_eq!(
            set.clone().spacing(bad).expect_err("not finite").kind(),
            ErrorKind::Spacing
        );
    }
    let error = Region::new([0.0; 3], [1.0, 1.0, -1.0]).expect_err("turned");
    assert_eq!((error.kind(), error.field()), (ErrorKind::Region, "max_z"));
    // A flat box has no points.
    let flat = Region::new([0.0; 3], [9.0, 9.0, 0.0]).expect("ordered");
    assert_eq!(set.within(flat).expect("near").count(), 0);
    let far = Region::new([1e13, 0.0, 0.0], [1e13 + 5.0, 1.0, 1.0]).expect("ordered");
    assert_eq!(set.within(far).expect_err("far").kind(), ErrorKind::TooFar);
    let all = Volume::Outside(Box::new(flat.into()));
    assert_eq!(
        set.within(all).expect_err("unbounded").kind(),
        ErrorKind::Unbounded
    );
    assert_eq!(
        set.chunk(-1.0, [0; 3]).expect_err("negative").kind(),
        ErrorKind::Chunk
    );
    assert_eq!(
        set.chunk(1.0, [i64::MAX, 0, 0]).expect_err("far").kind(),
        ErrorKind::Chunk
    );
    for k in [0, 10_001] {
        let error = set.nearest([0.0; 3], k).expect_err("none or too many");
        assert_eq!(error.kind(), ErrorKind::Neighbors);
        assert!(set.nearest_within([0.0; 3], k, 1.0).is_err());
    }
    let error = set.nearest_within([0.0; 3], 9, -1.0).expect_err("negative");
    assert_eq!(error.kind(), ErrorKind::Radius);
    assert_eq!(
        set.clone().density(-1.0).expect_err("negative").kind(),
        ErrorKind::Density
    );
    assert_eq!(set.keep(0.0).expect_err("nothing").kind(), ErrorKind::Keep);
}

#[test]
fn the_promised_distance_is_kept() {
    let set = SpaceSet::blue();
    let least = set.least_distance();
    for (seed, promised) in [(0, least), (3, set.clone().seed(3).least_distance())] {
        let set = set.clone().seed(seed);
        let plan = set
            .within(Region::new([50.0; 3], [62.0; 3]).expect("ordered"))
            .expect("near");
        let nearest = plan
            .iter()
            .map(|point| set.nearest(point.at(), 2).expect("near")[1].distance);
        let nearest = nearest.fold(f64::INFINITY, f64::min);
        assert!(
            nearest >= promised * (1.0 - 1e-9),
            "{seed}: {nearest} {promised}"
        );
    }
}

#[test]
fn golden_vectors() {
    // Printed once; a change of any bit needs another version of the algorithm.
    let digest = |seed: u64, share: f64| {
        let set = SpaceSet::blue().spacing(1.5).expect("in range").seed(seed);
        let set = set.keep(share).expect("in range");
        let plan = set.chunk(40.0, [3, -2, 1]).expect("near");
        let mut sum = plan.count() as u64;
        for point in &plan {
            for word in [point.id.x as u64, point.id.y as u64, point.id.z as u64] {
                sum = sum.rotate_left(9).wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ word;
            }
            for v in point.at() {
                sum = sum.rotate_left(9).wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ v.to_bits();
            }
        }
        sum
    };
    let found =
        [(0, 1.0), (7, 1.0), (u64::MAX, 1.0), (7, 0.3)].map(|(seed, share)| digest(seed, share));
    assert_eq!(found, GOLDEN, "{found:#x?}");
}

/// The digests of [`golden_vectors`].
const GOLDEN: [u64; 4] = [
    0x9838_22b9_93a7_ec94,
    0x1415_331e_4c41_fc4a,
    0x1293_8e91_14ba_38f5,
    0xfd35_86c4_beea_f74b,
];
