//! Space.

use proptest::prelude::*;
use strew_core::{
    ErrorKind, Offsets, Polygon,
    field::FieldSpec,
    server::{Stop, Visits},
    space::Prism,
};

use crate::subject::noise;
pub use crate::subject::space::*;

#[path = "both.rs"]
mod both;

/// Vectors reach 4 units, a warp less than 20.
const fn reach(_: &Set) -> i64 {
    24
}

/// The side of a cube that holds more than 5·10¹⁶ points.
const WIDE: f64 = 4e5;

/// Brute force takes long.
fn cases(number: u32) -> u32 {
    (number / 100).max(12)
}

/// A set of a small map with vectors of up to 4 grid units along each axis.
fn set(spacing: f64, seed: u64) -> Set {
    let set = Set::new(table(16_384)).seed(seed);
    set.spacing(spacing).expect("in range")
}

fn unit_set() -> Set {
    set(1.0, 7)
}

/// Lookups, which `space_definition.rs` compares with the definition.
fn definition(set: &Set) -> impl Fn(PointId) -> Option<[f64; 3]> {
    |id| set.point(id).map(|point| point.at())
}

fn thinned(set: &Set, share: f64) -> Set {
    let kept = set.clone().keep(share).expect("in range");
    kept.settle(0).expect("0")
}

fn any_set() -> impl Strategy<Value = Set> {
    let share = prop_oneof![Just(1.0), 0.01..1.0f64, 0.1..1.0f64];
    (0u64..3, share).prop_map(|(seed, share)| thinned(&set(1.0, seed), share))
}

fn corner() -> impl Strategy<Value = [f64; 3]> {
    prop::array::uniform3(prop_oneof![-1200.0..1200.0f64, Just(0.0)])
}

fn any_place() -> impl Strategy<Value = (Set, [f64; 3])> {
    (any_set(), corner())
}

fn any_box() -> impl Strategy<Value = (Set, Region)> {
    let sides = prop::array::uniform3(0.0..14.0f64);
    (any_place(), sides).prop_map(|((set, at), sides)| {
        let to = [0, 1, 2].map(|i| at[i] + sides[i]);
        (set, between(at, to))
    })
}

/// Boxes, balls, prisms, and their combinations.
fn any_area() -> impl Strategy<Value = (Set, Area)> {
    let parts = (any_box(), 1.0..7.0f64, 0..5);
    let seeds = (0u64..3).prop_map(|seed| set(1.0, seed));
    (seeds, parts).prop_map(|(set, ((_, region), radius, kind))| {
        let at = region.min();
        let ball = Area::from(Round::new(at, radius).expect("valid"));
        let [x, y, z] = at;
        let triangle = [[x, y], [x + 9.0, y + 1.0], [x + 2.0, y + 11.0]];
        let triangle = Polygon::new(&[triangle]).expect("valid");
        let prism = Prism::new(triangle, [z - 2.0, z + radius]);
        let prism = Area::from(prism.expect("ordered"));
        let area = match kind {
            0 => ball,
            1 => prism,
            2 => Area::any_of([ball, prism]),
            3 => prism.without([ball]),
            _ => region.into(),
        };
        (set, area)
    })
}

/// Two sets, a distance, and a box.
fn any_layers() -> impl Strategy<Value = (Set, Set, f64, Region)> {
    let blue = |spacing: f64, seed: u64| {
        let set = Set::blue().seed(seed);
        set.spacing(spacing).expect("in range")
    };
    let own = (0.5f64..2.0, 0u64..5).prop_map(move |(spacing, seed)| blue(spacing, seed));
    let other = (0.3f64..3.0, 10u64..15).prop_map(move |(spacing, seed)| blue(spacing, seed));
    let corner = prop::array::uniform3(-50.0f64..50.0);
    let limit = prop_oneof![Just(None), (1.0f64..5.0).prop_map(Some)];
    let sizes = (0.05f64..1.2, 4.0f64..9.0);
    (own, other, sizes, corner, limit).prop_map(|(own, other, (part, side), corner, limit)| {
        let distance = part * other.placement().spacing.get();
        let other = match limit {
            Some(radius) => other.limited_to(Round::new(corner, radius).expect("a ball")),
            None => other,
        };
        (own, other, distance, cube(corner, side))
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

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
                    let exact = rounded_once(step, p, size, at[axis]);
                    offset[axis] == exact.clamp(0.0, size.next_down())
                };
                prop_assert!(positions.any(is_it), "{} {:?}", offset[axis], point);
                prop_assert!((0.0..size).contains(&offset[axis]));
            }
        }
    }
}

/// p · step − size · column, rounded once.
fn rounded_once(step: f64, p: i64, size: f64, column: i64) -> f64 {
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
fn a_raised_flag_ends_searches_and_counting() {
    let set = set(1.0, 7);
    let visits = Visits::new(usize::MAX, Stop::new());
    let near = set.nearest_visiting([0.0; 3], 9, None, &visits);
    assert!(near.expect("near").len() == 9 && visits.made() >= 9);
    let stop = Stop::new();
    stop.raise();
    let stopped = set.within_until(cube([0.0; 3], 9.0), stop.clone());
    assert_eq!(stopped.expect_err("stopped").kind(), ErrorKind::Stopped);
    let near = set.nearest_visiting([0.0; 3], 9, None, &Visits::new(usize::MAX, stop));
    assert_eq!(near.expect_err("stopped").kind(), ErrorKind::Stopped);
}

#[test]
fn large_requests_are_those_of_their_parts() {
    let glow = FieldSpec::radial([320.0, 10.0, -40.0], [20.0, 50.0], [1.0, 0.3]).expect("valid");
    let parts = vec![glow, noise(3, 20.0, 2, [0.1, 1.0]).expect("valid")];
    let field = FieldSpec::multiply(parts).expect("valid");
    let sets = [(0, 1.0), (0, 0.3), (7, 1.0), (7, 0.3)];
    let sets = sets.map(|(seed, share)| thinned(&set(1.0, seed), share));
    let graded = [0, 5].map(|seed| thinned(&set(0.8, seed), 1.0).in_field(field.clone()));
    let whole = within(&sets[2], cube([300.0, -10.0, -60.0], 30.0));
    let felled: Vec<PointId> = whole.iter().map(|point| point.id).step_by(7).collect();
    let left = sets[2].clone().without(felled);
    for set in sets.into_iter().chain(graded).chain([left]) {
        let ball = Round::new([310.0, 5.0, -40.0], 30.0).expect("valid");
        let region = between([290.0, -20.0, -70.0], [350.0, 40.0, -10.5]);
        let without = Area::from(region).without([ball.into()]);
        for volume in [region.into(), ball.into(), without] {
            let all = within(&set, volume.clone());
            assert!(all.len() > 10_000);
            assert_eq!(set.count(volume.clone()), Ok(all.len() as u128));
            let part = |i: i32| {
                let at = [280 + i % 5 * 15, -25 + i / 5 % 5 * 15, -70 + i / 25 * 15];
                let cube = cube(at.map(f64::from), 15.0);
                within(&set, volume.clone().and(cube.into()))
            };
            assert_eq!(in_order((0..100).flat_map(part).collect()), all);
        }
    }
}

#[test]
fn long_and_large_boxes_agree() {
    let parts = Parts {
        block: 4096,
        tile: 1,
        offset: 0.5,
        limit: 3,
        number: 7,
    };
    let long = between([-3000.0, -20.0, -5.0], [4000.0, 3.0, 30.5]);
    let large = between([-30.0; 3], [25.0; 3]);
    for (spacing, seed, share, region) in [
        (1.0, 0, 1.0, long),
        (1.0, 0, 0.2, long),
        (0.7, 0, 1.0, large),
        (0.7, 7, 1.0, large),
    ] {
        let set = thinned(&set(spacing, seed), share);
        let points = within(&set, region);
        assert!(points.iter().all(|point| region.contains(point.at())));
        agree(&set, region, &points, parts);
    }
}

#[test]
fn wide_boxes_outlast_the_templates_that_are_kept() {
    let set = Set::blue();
    let wide = between([1.0; 3], [321.0, 25.0, 321.0]);
    let plan = set.within(wide).expect("near");
    let mut points = 0;
    for point in plan.iter() {
        assert_eq!(set.point(point.id()), Some(point));
        points += 1;
    }
    assert_eq!(points, plan.count());
}

#[test]
fn the_promised_distance_is_kept() {
    let set = Set::blue();
    let least = set.least_distance();
    for (seed, promised) in [(0, least), (3, set.clone().seed(3).least_distance())] {
        let set = set.clone().seed(seed);
        let plan = set.within(cube([50.0; 3], 12.0)).expect("near");
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
        let set = Set::blue().spacing(1.5).expect("in range").seed(seed);
        let set = set.keep(share).expect("in range");
        let plan = set.chunk(40.0, [3, -2, 1]).expect("near");
        let mut sum = plan.count() as u64;
        for point in plan.to_vec() {
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
    0x074d_3b1b_15f1_79c6,
];
