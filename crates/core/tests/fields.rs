//! Sets in fields, and thinned sets, against their definition point by point.

use crate::subject;

use proptest::prelude::*;
use strew_core::{
    Area, Circle, Map, Placement, PointSet, Raster, Region, Seed, Settle, Spacing, Table, Warp,
    field::{FieldSpec, Pixels},
    table::{Provenance, Ranks},
};
use subject::{
    definition,
    plane::{agree, any_parts, between, brute_force, cube, in_order, within},
};

/// A number that looks random.
fn mixed(i: u32) -> u32 {
    let z = (i ^ (i >> 16)).wrapping_mul(0x7feb_352d);
    let z = (z ^ (z >> 15)).wrapping_mul(0x846c_a68b);
    z ^ (z >> 16)
}

/// A table with vectors of up to ±6 grid units, and ranks.
fn table() -> Table {
    let map = Map::new("(5-sqrt(3))/2".parse().expect("valid"), 12).expect("small");
    let blocks = (map.intervals() * map.intervals()) as u32;
    let vector = |i: u32| [i, !i].map(|i| (mixed(i) % (12 << 20)) as i32 - (6 << 20));
    let vectors = (0..blocks).map(vector).collect();
    let table = Table::new(map, "test", vectors, Provenance::default()).expect("valid");
    let mut order: Vec<u32> = (0..blocks).collect();
    order.sort_by_key(|&block| mixed(block + 77));
    let mut positions = vec![0; blocks as usize];
    for (position, &block) in (0..).zip(&order) {
        positions[block as usize] = position;
    }
    table
        .with_ranks(Ranks::new(positions).expect("all"))
        .expect("valid")
}

fn set(seed: u64, warp: f64, spacing: f64) -> PointSet {
    let placement = Placement::new(Spacing::new(spacing).expect("in range"), Seed(seed));
    // Where their ranks have them: `settle.rs` tests the rest.
    let placement = placement.with_settle(Settle::OFF);
    PointSet::new(table()).placed(placement.with_warp(Warp::new(warp).expect("in range")))
}

/// Smooth, with places of share 0 and of share 1.
fn hills([x, y]: [f64; 2]) -> f64 {
    let (u, v) = ((x * 0.11).sin(), (y * 0.07).cos());
    1.4 * u * v + 0.3
}

/// The square around the origin that pixels cover.
fn square() -> Region {
    cube([-64.0; 2], 128.0)
}

/// Pixels over the square by their columns and rows.
fn raster_of(width: usize, pixel: impl Fn([f64; 2]) -> f64) -> Raster {
    let pixel = |i: usize| pixel([i % width, i / width].map(|v| v as f64)) as f32;
    Raster::new(square(), width, (0..width * width).map(pixel).collect()).expect("shares")
}

/// Hills in pixels, so with bounds.
fn raster() -> Raster {
    raster_of(128, |at| hills(at.map(|v| v - 63.5)).clamp(0.0, 1.0))
}

/// Pixels of four spacings, about as steep as a field may be that counts as constant: less so in some places.
fn dunes() -> Raster {
    raster_of(32, |[x, y]| {
        0.7 + 0.05 * (x * 0.2).sin() + 0.03 * (y * 0.3).cos()
    })
}

/// Pixels of four units of which every third is missing, and all of a corner.
fn holes() -> FieldSpec {
    let pixels = (0..32 * 32).map(|i| 0.2 + (i % 7) as f32 * 0.1).collect();
    let pixels = Pixels::from_floats(32, pixels).expect("numbers");
    let is_missing = |i: usize| i.is_multiple_of(3) || i % 32 < 12 && i < 12 * 32;
    let raster = Raster::of(square(), pixels.without(is_missing));
    FieldSpec::raster(raster.expect("shares")).expect("a field")
}

fn any_region() -> impl Strategy<Value = Region> {
    let corner = prop::array::uniform2(-60.0..40.0f64);
    (corner, prop::array::uniform2(0.0..30.0f64))
        .prop_map(|([x, y], [w, h])| between([x, y], [x + w, y + h]))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

    #[test]
    fn a_walk_finds_what_the_definition_has(
        seed in 0u64..40, warp in prop_oneof![Just(0.0), Just(1.0)],
        spacing in 0.5..3.0f64, region in any_region(), keep in prop_oneof![Just(1.0), 0.2..1.0f64],
        parts in any_parts(),
    ) {
        let set = set(seed, warp, spacing).keep(keep).expect("a share");
        let ramp = FieldSpec::ramp([0.0; 2], [500.0, 90.0], [0.9, 1.0]).expect("valid");
        let both = FieldSpec::multiply(vec![FieldSpec::raster(dunes()).expect("valid"), ramp]);
        for graded in [
            set.in_field(hills),
            set.in_field(raster()),
            set.in_field(dunes()),
            set.in_field(holes()),
            set.in_field(holes().invert().expect("a field")),
            set.in_field(both.expect("valid")),
        ] {
            let place = |id| graded.point(id).map(|member| member.at());
            let expected = brute_force(&graded, &region.into(), 91, place);
            agree(&graded, region, &expected, parts);
        }
    }

    #[test]
    fn what_is_kept_turns_with_the_seed(
        seed in 0u64..40, warp in prop_oneof![Just(0.0), Just(1.0)],
        region in any_region(), share in prop_oneof![0.01..1.0f64, Just(1.0), Just(0.7)],
        parts in any_parts(),
    ) {
        let all = set(seed, warp, 1.0);
        let kept = all.clone().keep(share).expect("a share");
        let expected = brute_force(&kept, &region.into(), 91, |id| definition::place(&kept, id));
        agree(&kept, region, &expected, parts);
        for id in expected.iter().map(|point| point.id) {
            prop_assert_eq!(Some(all.rank(id)), definition::rank(&all, id));
            prop_assert_eq!(kept.rank(id), all.rank(id));
        }
    }

    #[test]
    fn parts_of_thinned_sets_count_what_they_hold(
        seed in 0u64..40, warp in prop_oneof![Just(0.0), Just(1.0)],
        corner in prop::array::uniform2(-2000.0..2000.0f64), side in 1.0..900.0f64, narrow in 0.02..1.0f64,
        share in 0.01..1.0f64, radius in 0.1..0.8f64,
    ) {
        let kept = set(seed, warp, 1.0).keep(share).expect("a share");
        let max = [corner[0] + side, corner[1] + side * narrow];
        let region = between(corner, max);
        let circle = Circle::new(corner, radius * side).expect("round");
        for area in [Area::from(region), Area::from(circle), Area::from(region).and(circle.into())] {
            let plan = kept.within(area).expect("near");
            prop_assert_eq!(plan.count(), plan.iter().count() as u128);
        }
    }

    #[test]
    fn boxes_share_no_point_and_lose_none(cut in 0.0..1.0f64, region in any_region(), seed in 0u64..3) {
        let graded = set(seed, 1.0, 1.0).in_field(hills);
        let (min, max) = (region.min(), region.max());
        let middle = min[0] + (max[0] - min[0]) * cut;
        let halves = [between(min, [middle, max[1]]), between([middle, min[1]], max)];
        let parts = halves.map(|half| within(&graded, half)).concat();
        prop_assert_eq!(in_order(parts), within(&graded, region));
    }
}

#[test]
fn shares_outside_the_range_and_nan_are_none_or_all() {
    let set = set(1, 1.0, 1.0);
    let region = cube([0.0; 2], 20.0);
    let count = |share: f64| {
        let graded = set.in_field(move |_: [f64; 2]| share);
        graded.count(region).expect("near")
    };
    let all = set.count(region).expect("near");
    assert_eq!([count(1.0), count(7.0), count(f64::INFINITY)], [all; 3]);
    assert_eq!([count(0.0), count(-1.0), count(f64::NAN)], [0; 3]);
}

#[test]
fn bad_rasters_are_refused() {
    let region = cube([0.0; 2], 20.0);
    for (width, pixels) in [
        (0, vec![0.5]),
        (3, vec![0.5; 4]),
        (1, vec![-0.1]),
        (1, vec![f32::NAN]),
    ] {
        assert!(Raster::new(region, width, pixels).is_err());
    }
}
