//! Chunks far from the origin, compared with exact rationals.

use alloc::vec::Vec;

use super::Plan;
use crate::{
    kernel::{F32, Format, Offsets},
    lattice::PointId,
    map::Map,
    set::PointSet,
    shape::{Area, Region},
    table::{Provenance, Table},
};

fn set(spacing: f64, seed: u64) -> PointSet {
    let map = Map::new("(5-sqrt(3))/2".parse().expect("valid"), 20).expect("small");
    let blocks = map.intervals() * map.intervals();
    let vector = |i: usize| [7919, 104_729].map(|f| (i * f % 10_000_000) as i32 - 5_000_000);
    let vectors = (0..blocks).map(vector).collect();
    let table = Table::new(map, "test", vectors, Provenance::default()).expect("valid");
    let set = PointSet::new(table).seed(seed);
    set.spacing(spacing).expect("in range")
}

fn items<F: Format>(plan: &Plan) -> Vec<F::Item> {
    let mut items = alloc::vec![F::Item::default(); plan.count() as usize + 1];
    let filled = plan.blocks::<F>().fill(&mut items);
    items.truncate(filled);
    items
}

/// A number as an integer times 2^`power`.
fn exact(value: f64, power: i32) -> i128 {
    let mut integer = value;
    let mut at = 0;
    while integer.fract() != 0.0 {
        integer *= 2.0;
        at -= 1;
    }
    let mut exact = integer as i128;
    while at < power {
        assert_eq!(exact % 2, 0, "{value} is no multiple of 2^{power}");
        exact /= 2;
        at += 1;
    }
    exact << (at - power)
}

/// The offset of a point from the corner of a chunk along an axis, times 2^`POWER`.
fn offset(plan: &Plan, id: PointId, axis: usize, size: f64, at: i64) -> i128 {
    let lattice = &plan.scope.lattice;
    let fixed = lattice.place(id).expect("a point")[axis];
    fixed * exact(lattice.step, POWER) - i128::from(at) * exact(size, POWER)
}

/// Steps and sizes of the tests are multiples of 2⁻⁷⁶.
const POWER: i32 = -76;

const FAR: [[i64; 2]; 5] = [
    [1_000_000_000_000, -77],
    [-999_999_999_999, 123_456_789_012],
    [-3, 2],
    [0, 0],
    [68_719_476_735, -68_719_476_736],
];

fn check(set: &PointSet, plan: &Plan, size: f64, at: [i64; 2], lost: &mut u32) {
    let ids: Vec<PointId> = plan.iter().map(|member| member.id()).collect();
    let unit = libm::ldexp(1.0, POWER);
    let (doubles, singles) = (items::<Offsets>(plan), items::<F32>(plan));
    assert_eq!((ids.len(), ids.len()), (doubles.len(), singles.len()));
    for ((id, double), single) in ids.into_iter().zip(doubles).zip(singles) {
        for axis in 0..2 {
            let offset = offset(plan, id, axis, size, at[axis]);
            assert!((0..exact(size, POWER)).contains(&offset), "{id} {at:?}");
            let nearest = (offset as f64 * unit).min(size.next_down());
            assert_eq!(double[axis], nearest, "{id} {at:?}");
            let nearest = ((offset as f64 * unit) as f32).min((size as f32).next_down());
            // Rounded to `f64` before, so rarely the other neighbor.
            let bits = nearest.to_bits().abs_diff(single[axis].to_bits());
            assert!(bits <= 1, "{id} {at:?} {nearest} {}", single[axis]);
            *lost += bits;
        }
        assert_eq!(set.point(id).map(|member| member.id()), Some(id));
    }
}

#[test]
fn offsets_are_exact_at_any_distance() {
    let (mut lost, mut points) = (0, 0);
    for (spacing, seed) in [(1.0, 0), (1.0, 7), (0.37, 3), (2.5, 0)] {
        let set = set(spacing, seed);
        for size in [16.0, 10.0, 7.3] {
            for at in FAR {
                let plan = set.chunk(size, at).expect("near enough");
                check(&set, &plan, size, at, &mut lost);
                points += plan.count();
            }
        }
    }
    assert!(
        points > 10_000 && lost < 3,
        "{lost} of {points} rounded twice"
    );
}

#[test]
fn far_chunks_partition_their_parent() {
    for seed in [0, 7] {
        let set = set(0.05, seed);
        // Coordinates are multiples of 2⁻¹⁰ here, a fiftieth of a spacing.
        for at in [[1 << 41, -(1 << 41)], [5, -3]] {
            let size = 1.0;
            let parent = set.chunk(2.0 * size, at).expect("near enough");
            let mut ids: Vec<PointId> = Vec::new();
            for [x, y] in [[0, 0], [1, 0], [0, 1], [1, 1]] {
                let plan = set.chunk(size, [2 * at[0] + x, 2 * at[1] + y]);
                ids.extend(plan.expect("near enough").iter().map(|member| member.id()));
            }
            let mut all: Vec<PointId> = parent.iter().map(|member| member.id()).collect();
            ids.sort_unstable_by_key(|id| (id.x, id.y));
            all.sort_unstable_by_key(|id| (id.x, id.y));
            assert_eq!(ids, all);
        }
    }
}

/// A sieve decides the rest of an area, integers the chunk.
#[test]
fn chunks_with_further_limits_have_the_points_of_the_chunk_that_satisfy_them() {
    for seed in [0, 7] {
        let (set, other) = (set(0.3, seed), set(4.0, 9));
        // Coordinates are multiples of 2⁻⁸ here.
        let at = [1 << 40, -(1 << 40)];
        let chunk = Region::chunk(16.0, at).expect("valid");
        let whole = set.within(chunk).expect("near enough");
        let clear = set.clone().clear_of(&other, 1.0).expect("in range");
        let kept = clear.within(chunk).expect("near enough");
        let mut clearance = other.clearance(1.0).expect("in range");
        let mut expected: Vec<_> = whole.iter().collect();
        expected.retain(|member| !clearance.is_any_near(member.at(), |_| true));
        assert!(kept.iter().eq(expected.iter().copied()));
        assert_eq!(kept.count(), expected.len() as u128);
        check(&set, &kept, 16.0, at, &mut 0);
        assert!(expected.len() > 100);

        let [x, y] = chunk.min();
        let half = Region::new([x - 1.0, y - 1.0], [x + 7.0, y + 25.0]).expect("ordered");
        let cut = set.within(Area::from(half).and(chunk.into()));
        let cut = cut.expect("near enough");
        let mut expected: Vec<_> = whole.iter().collect();
        expected.retain(|member| half.contains(member.at()));
        assert!(cut.iter().eq(expected.iter().copied()));
        assert_eq!(cut.count(), expected.len() as u128);
        assert_eq!(cut.origin(), chunk.min());
        check(&set, &cut, 16.0, at, &mut 0);
    }
}
