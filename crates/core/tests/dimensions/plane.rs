//! The plane.

use proptest::prelude::*;
use rayon::prelude::*;
use strew_core::{
    ErrorKind, Exact, F32, F64, LATTICE_LIMIT, Offsets, Pattern, Placement, Points, Polygon,
    Spacing, Warp,
    server::{self, Stop},
};

pub use crate::subject::plane::*;
use crate::subject::{self, any_place, any_seed, any_table, set, tables, unit};

#[path = "both.rs"]
mod both;

/// Vectors reach 13 units, a warp of strength 2 with long waves at most 111; f64 errs by a few far out.
fn reach(set: &Set) -> i64 {
    13 + 8 + (set.placement().warp.strength() * 55.5).ceil() as i64
}

/// The side of a square that holds more than 10¹⁷ points.
const WIDE: f64 = 4e8;

fn cases(number: u32) -> u32 {
    number
}

fn unit_set() -> Set {
    set(&tables()[0], unit(0))
}

/// The place of a lattice address from first principles: its index is computed anew, the block searched, the position
/// converted.
fn definition(set: &Set) -> impl Fn(PointId) -> Option<[f64; 2]> {
    let (map, seed) = (set.table().map(), set.placement().seed);
    let pattern = Pattern::with_origin(set.table().alpha(), seed.origin());
    move |id| {
        let (dx, dy) = pattern
            .contains(id.x, id.y)
            .then(|| pattern.index(id.x, id.y))?;
        let block = [dx, dy].map(|d| {
            let mut intervals = 0..map.intervals();
            intervals.find(|&i| map.interval(i).contains(&d))
        });
        assert_eq!(set.block(id).map(|block| block.map(Some)), Some(block));
        Some(subject::definition::place(set, id).expect("a member"))
    }
}

fn thinned(set: &Set, share: f64) -> Set {
    let kept = set.clone().keep(share).expect("in range");
    kept.settle(0).expect("0")
}

/// Regions by kind: near, far, negative, tiny, thin, empty; sides in mean spacings.
fn any_box() -> impl Strategy<Value = (Set, Region)> {
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
    let numbers = (spacing, [place.clone(), place], [side.clone(), side]);
    (any_table(), any_seed(), numbers).prop_map(|(table, (seed, warp), (spacing, at, sides))| {
        let min = at.map(|v| v * spacing);
        let max = [0, 1].map(|i| min[i] + sides[i] * spacing);
        let placement = Placement::new(Spacing::new(spacing).expect("valid"), seed);
        (set(&table, placement.with_warp(warp)), between(min, max))
    })
}

/// Coordinates of areas, in spacings.
fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![(-4i8..=4).prop_map(|v| f64::from(v) * 10.0), -40.0..40.0f64]
}

fn any_corner() -> impl Strategy<Value = [f64; 2]> {
    [coordinate(), coordinate()]
}

fn area() -> impl Strategy<Value = Area> {
    let region = (any_corner(), any_corner()).prop_map(|(a, b)| {
        let pick = |f: fn(f64, f64) -> f64| [f(a[0], b[0]), f(a[1], b[1])];
        Area::from(Region::new(pick(f64::min), pick(f64::max)).expect("ordered"))
    });
    let circle = (any_corner(), 0.1..40.0f64)
        .prop_map(|(center, radius)| Area::from(Round::new(center, radius).expect("valid")));
    let polygon = prop::collection::vec(
        prop::collection::vec(any_corner(), 3..9)
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

fn any_area() -> impl Strategy<Value = (Set, Area)> {
    (any_table(), any_seed(), area()).prop_map(|(table, (seed, warp), area)| {
        let placement = unit(0).with_warp(warp);
        (set(&table, Placement { seed, ..placement }), area)
    })
}

/// Two sets, a distance, and a box.
fn any_layers() -> impl Strategy<Value = (Set, Set, f64, Region)> {
    let limit = prop_oneof![area().prop_map(Some), Just(None)];
    let spacing = prop_oneof![0.5..3.0f64, 0.3..6.0f64];
    let distance = prop_oneof![0.1..3.0f64, 0.05..4.0f64];
    let corner = prop_oneof![Just([-20.0; 2]), Just([-7000.0, 1300.0])];
    let side = prop_oneof![Just(40.0), Just(60.0)];
    let sets = (any_area(), any_table(), any_seed(), spacing, limit);
    (sets, distance, corner, side).prop_map(|(sets, distance, corner, side)| {
        let ((own, _), table, (seed, warp), spacing, limit) = sets;
        let placement = Placement::new(Spacing::new(spacing).expect("valid"), seed);
        let other = set(&table, placement.with_warp(warp));
        let other = match limit {
            Some(area) => other.limited_to(area),
            None => other,
        };
        (own, other, distance, cube(corner, side))
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn formats_agree((set, region) in any_box(), block in 1usize..300) {
        let plan = set.within(region).expect("in range");
        let pairs = all::<F64>(&plan, block);
        let spacing = set.placement().spacing;

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
        let region = between([-700.0, -333.3], [900.1, 1200.7]);
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
            let fill = |tile| read(plan.tile_blocks::<F64>(tile), 50_000);
            let filled: Vec<Vec<[f64; 2]>> = pool.install(|| tiles.par_iter().map(fill).collect());
            assert_eq!(filled.concat(), reference, "{threads} threads");
        }
    }
}

#[test]
fn regions_beyond_the_lattice_are_refused() {
    let set = set(&tables()[0], unit(0));
    let plan = |min, max| set.within(between(min, max));
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
fn counting_stops() {
    let set = set(&tables()[0], unit(3));
    let graded = set.in_field(|[x, _]: [f64; 2]| 0.5 + x * 1e-5);
    let clear = set.clone().clear_of(&set.clone().seed(4), 0.4);
    let (go, stop) = (Stop::new(), Stop::new());
    stop.raise();
    for set in [set, graded, clear.expect("near")] {
        for side in [1.0, 20.0, 900.0] {
            let region = cube([0.0; 2], side);
            assert!(server::within(&set, region, &go).is_ok());
            let error = server::within(&set, region, &stop).expect_err("stopped");
            assert_eq!(error.kind(), ErrorKind::Stopped);
        }
    }
}
