//! Sets in fields: every way to their points agrees with the definition, point by point and bit for bit.

use crate::subject;

use std::sync::{Arc, OnceLock};

use proptest::prelude::*;
use strew_core::{
    Area, Circle, ErrorKind, F32, Field, Offsets, Point, PointSet, Points, Raster, Region, Table,
    field::{Edges, FieldSpec, Filter, Marks, Pixels},
    server::{self, Stop},
};
use subject::{
    all, any_area, any_box, any_placement, definition,
    plane::{
        Parts, agree, agree_around, agree_in_number, any_parts, between, brute_force, cube, within,
    },
    set, shipped,
};

/// Blue with ranks, and a table without.
fn tables() -> &'static [Table; 2] {
    static ONCE: OnceLock<[Table; 2]> = OnceLock::new();
    ONCE.get_or_init(|| {
        [
            shipped("blue-5-sqrt3-over-2-m"),
            subject::table("sqrt(3)", 20),
        ]
    })
}

/// Square pixels over a square of 128 around the origin.
fn square(
    width: usize,
    pixel: impl Fn(usize) -> f64,
    is_missing: impl Fn(usize) -> bool,
) -> Raster {
    let pixels = (0..width * width).map(|i| pixel(i) as f32).collect();
    let pixels = Pixels::from_floats(width, pixels).expect("numbers");
    Raster::of(cube([-64.0; 2], 128.0), pixels.without(is_missing)).expect("shares")
}

/// Pixels of four spacings, about as steep as a field may be that counts as constant: less so in some places.
fn dunes() -> Raster {
    let wave = |x: f64, y: f64| 0.7 + 0.05 * (x * 0.2).sin() + 0.03 * (y * 0.3).cos();
    square(32, |i| wave((i % 32) as f64, (i / 32) as f64), |_| false)
}

/// Pixels of four units of which every third is missing, and all of a corner.
fn holes() -> Raster {
    let is_missing = |i: usize| i.is_multiple_of(3) || i % 32 < 12 && i < 12 * 32;
    square(32, |i| 0.2 + (i % 7) as f64 * 0.1, is_missing)
}

/// Pixels over a box of 128 by 96 around the origin, 1 a unit.
fn raster(pixel: impl Fn(f64, f64) -> f64) -> Raster {
    let region = Region::new([-64.0, -48.0], [64.0, 48.0]).expect("ordered");
    let value = |i: usize| {
        let [x, y] = [i % 128, i / 128].map(|v| v as f64);
        (pixel(x - 63.5, y - 47.5).clamp(0.0, 1.0) * 255.0) as u8
    };
    let pixels = Pixels::from_bytes(128, (0..128 * 96).map(value).collect());
    Raster::of(region, pixels.expect("rows")).expect("shares")
}

/// Fields with plains of 0, of 1 and of other shares, with slopes and with steps.
fn fields() -> &'static [Arc<dyn Field>] {
    static ONCE: OnceLock<Vec<Arc<dyn Field>>> = OnceLock::new();
    ONCE.get_or_init(|| {
        let hills = |x: f64, y: f64| 1.4 * (x * 0.11).sin() * (y * 0.07).cos() + 0.3;
        let mask = |x: f64, y: f64| if x.hypot(y - 9.0) < 25.0 { 1.0 } else { 0.0 };
        let of = FieldSpec::raster;
        let spec = || -> Result<Vec<FieldSpec>, strew_core::Error> {
            let road = Marks::Lines(vec![vec![[-90.0, -5.0], [0.0, 4.0], [80.0, 60.0]]]);
            let road = FieldSpec::distance(road, [2.0, 9.0], [0.0, 1.0])?;
            let noise = subject::noise(4, 17.0, 3, [0.0, 1.0])?;
            Ok(vec![
                of(raster(hills))?,
                of(raster(mask).edges(Edges::Zero).filter(Filter::Nearest))?,
                of(raster(mask).edges(Edges::Mirror).tone(0.3, 0.8, 1.0)?)?,
                FieldSpec::constant(0.37)?,
                FieldSpec::constant(0.0)?,
                FieldSpec::constant(1.0)?,
                FieldSpec::ramp([-40.0, 0.0], [40.0, 9.0], [1.0, 0.01])?,
                FieldSpec::radial([0.0, 0.0], [5.0, 30.0], [0.25, 0.75])?,
                FieldSpec::multiply(vec![road, noise])?,
                of(dunes())?,
                of(holes())?,
                of(holes())?.invert()?,
                FieldSpec::multiply(vec![
                    of(dunes())?,
                    FieldSpec::ramp([0.0; 2], [500.0, 90.0], [0.9, 1.0])?,
                ])?,
            ])
        };
        let closure = Arc::new(move |[x, y]: [f64; 2]| hills(x, y));
        let specs = spec().expect("valid").into_iter();
        let specs = specs.map(|spec| Arc::new(spec) as Arc<dyn Field>);
        specs.chain([closure as Arc<dyn Field>]).collect()
    })
}

/// A field that is shared.
#[derive(Clone)]
struct Shared(Arc<dyn Field>, usize);

impl std::fmt::Debug for Shared {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "field {}", self.1)
    }
}

impl Field for Shared {
    fn share(&self, at: [f64; 2]) -> f64 {
        self.0.share(at)
    }

    fn shares(&self, places: &[[f64; 2]], shares: &mut [f64]) {
        self.0.shares(places, shares);
    }

    fn bounds(&self, within: &Region) -> [f64; 2] {
        self.0.bounds(within)
    }
}

fn any_set() -> impl Strategy<Value = (PointSet, Shared)> {
    let parts = (0..2usize, any_placement(), 0..fields().len());
    parts.prop_map(|(table, placement, field)| {
        let set = set(&tables()[table], placement);
        (set, Shared(fields()[field].clone(), field))
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

    #[test]
    fn a_box_holds_what_the_definition_has(
        (set, field) in any_set(), region in any_box(), parts in any_parts(),
    ) {
        let place = |id| definition::place_in(&set, &field, id);
        let expected = brute_force(&set, &region.into(), 160, place);
        let ranks: Vec<_> = expected.iter().map(|point| definition::rank(&set, point.id)).collect();
        let set = set.in_field(field).settle(0).expect("0");
        agree(&set, region, &expected, parts);
        for (point, rank) in expected.iter().zip(ranks) {
            prop_assert_eq!(Some(set.rank(point.id)), rank);
            prop_assert_eq!(set.point(point.id).map(Point::from), Some(*point));
            prop_assert!(set.share(point.id).is_some_and(|share| set.rank(point.id) < share));
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 150, ..ProptestConfig::default() })]

    #[test]
    fn an_area_holds_the_points_of_its_box_that_lie_in_it(
        (set, field) in any_set(), area in any_area(), parts in any_parts(), clear: bool,
    ) {
        let mut set = set.in_field(field.clone());
        if clear {
            let other = PointSet::new(tables()[0].clone()).spacing(4.0).expect("in range");
            set = set.clear_of(&other.seed(3).in_field(field), 1.5).expect("near");
        }
        let mut expected = within(&set, area.bounds().expect("bounded"));
        expected.retain(|p| area.contains(p.at()));
        agree(&set, area, &expected, parts);
    }

    #[test]
    fn searches_find_what_boxes_hold(
        (set, field) in any_set(), at in prop::array::uniform2(-40.0..40.0f64), radius in 0.0..9.0f64,
    ) {
        agree_around(&set.in_field(field), at, radius);
    }

    #[test]
    fn a_constant_field_is_a_share(
        (set, _) in any_set(), area in any_area(), share in prop_oneof![Just(1.0), Just(0.7), 0.0..1.0f64],
    ) {
        let keep = set.placement().keep.get();
        let field = FieldSpec::constant(share).expect("a share");
        let described = set.in_field(field).within(area.clone()).expect("near");
        let closure = set.in_field(move |_: [f64; 2]| share).within(area.clone()).expect("near");
        prop_assert_eq!(described.to_vec(), closure.to_vec());
        prop_assert_eq!(described.placement(), set.placement());
        if share * keep >= 1e-6 {
            let kept = set.keep(share * keep).expect("a share");
            let points = within(&kept, area);
            prop_assert_eq!(described.to_vec(), &points[..]);
            prop_assert_eq!(described.count(), points.len() as u128);
            for member in described.iter().step_by(points.len() / 50 + 1) {
                prop_assert_eq!(kept.point(member.id()), Some(member));
                let near = kept.nearest(member.at(), 1).expect("near");
                prop_assert_eq!(near[0].distance, 0.0);
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, ..ProptestConfig::default() })]

    #[test]
    fn a_number_of_points_is_found(
        (set, field) in any_set(), area in any_area(), count in 1u128..3000,
    ) {
        agree_in_number(&set.in_field(field), &area, count);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

    #[test]
    fn parts_of_thinned_sets_count_what_they_hold(
        (set, _) in any_set(), corner in prop::array::uniform2(-2000.0..2000.0f64), side in 1.0..900.0f64,
        narrow in 0.02..1.0f64, radius in 0.1..0.8f64,
    ) {
        let kept = set.settle(0).expect("0");
        let region = between(corner, [corner[0] + side, corner[1] + side * narrow]);
        let circle = Circle::new(corner, radius * side).expect("round");
        for area in [Area::from(region), Area::from(circle), Area::from(region).and(circle.into())] {
            let plan = kept.within(area).expect("near");
            prop_assert_eq!(plan.count(), plan.iter().count() as u128);
        }
    }
}

#[test]
fn shares_outside_the_range_and_nan_are_none_or_all() {
    let set = PointSet::new(tables()[0].clone()).seed(1);
    let count = |share: f64| {
        let graded = set.in_field(move |_: [f64; 2]| share);
        graded.count(cube([0.0; 2], 20.0)).expect("near")
    };
    let all = set.count(cube([0.0; 2], 20.0)).expect("near");
    assert_eq!([1.0, 7.0, f64::INFINITY].map(count), [all; 3]);
    assert_eq!([0.0, -1.0, f64::NAN].map(count), [0; 3]);
}

#[test]
fn no_number_is_sought_where_a_field_leaves_nothing() {
    let set = PointSet::new(tables()[0].clone());
    let thin = Region::new([0.0, 0.0], [0.2, 274.0]).expect("ordered");
    let beyond = FieldSpec::radial([16.0, 20.0], [2.0, 10.0], [1.0, 0.0]).expect("valid");
    let refused = |set: &PointSet, least: f64| {
        let error = server::exactly(set, 800, &thin.into(), least, &Stop::default());
        let error = error.expect_err("nothing");
        (error.kind(), error.problem().to_owned())
    };
    // Bounds say so, so nothing is counted: without a least spacing that would not end.
    let (kind, problem) = refused(&set.in_field(beyond), 0.0);
    assert_eq!(kind, ErrorKind::Count);
    assert_eq!(problem, "the field is 0 in all of the region");
    let (kind, problem) = refused(&set.in_field(|_: [f64; 2]| 0.0), 0.05);
    assert_eq!(kind, ErrorKind::TooDense);
    assert_eq!(problem, "no point is left here, down to a spacing of 0.05");
}

#[test]
fn numbers_are_found_in_every_field() {
    let region = Region::new([-60.0, -40.0], [60.0, 40.0]).expect("ordered");
    for (i, field) in fields().iter().enumerate() {
        let set = PointSet::new(tables()[0].clone()).seed(5);
        let set = set.in_field(Shared(field.clone(), i));
        let plan = server::exactly(&set, 5000, &region.into(), 0.05, &Stop::default());
        // Field 4 is 0 everywhere.
        assert_eq!(
            plan.ok().map(|plan| plan.to_vec().len()),
            (i != 4).then_some(5000),
            "{i}"
        );
    }
}

#[test]
fn far_chunks_have_exact_offsets() {
    let field = |_: [f64; 2]| 0.6;
    let set = PointSet::new(tables()[0].clone());
    let beside = |[x, y]: [i64; 2]| [[x, y], [x + 1, y], [x, y + 1]];
    for (seed, at) in [(0, [1_000_000_000_000, -77]), (7, [-3, 99_999_999_999])] {
        let set = set.clone().seed(seed);
        let graded = set.in_field(field);
        let kept = set.keep(0.6).expect("a share");
        for at in beside(at) {
            let chunk = Region::chunk(10.0, at).expect("near enough");
            let [plan, kept] = [&graded, &kept].map(|set| set.within(chunk).expect("near"));
            assert_eq!(all::<Offsets>(&plan, 17), all::<Offsets>(&kept, 99));
            assert_eq!(all::<F32>(&plan, 17), all::<F32>(&kept, 99));
            assert_eq!(all::<Points>(&plan, 17), all::<Points>(&kept, 99));
            assert_eq!(plan.origin(), kept.origin());
        }
    }
}

#[test]
fn where_a_field_is_constant_its_bounds_change_nothing() {
    let spec = || -> Result<FieldSpec, strew_core::Error> {
        let low = FieldSpec::ramp([700.0, 0.0], [760.0, 0.0], [0.4, 0.0])?;
        let island = FieldSpec::radial([250.0, 900.0], [180.0, 190.0], [1.0, 0.0])?;
        FieldSpec::max(vec![low, island])
    };
    let field = spec().expect("valid");
    for (seed, keep) in [(0, 1.0), (9, 1.0), (9, 0.8)] {
        let set = PointSet::new(tables()[0].clone())
            .seed(seed)
            .keep(keep)
            .expect("a share");
        let shares = field.clone();
        let looked_up = set.in_field(move |at: [f64; 2]| shares.share(at));
        let set = set.in_field(field.clone());
        let region = Region::new([-30.0, 10.0], [900.0, 1500.0]).expect("ordered");
        let circle = Circle::new([300.0, 700.0], 420.0).expect("round");
        for area in [Area::from(region), circle.into()] {
            let expected = within(&looked_up, area.clone());
            for offset in [0.0, 0.01, 0.3, 0.31, 0.9] {
                let parts = Parts {
                    block: 1234,
                    tile: 40_000,
                    offset,
                    limit: 5000,
                    number: 2,
                };
                agree(&set, area.clone(), &expected, parts);
            }
            let [plan, other] =
                [&set, &looked_up].map(|set| set.within(area.clone()).expect("near"));
            assert_eq!(all::<F32>(&plan, 777), all::<F32>(&other, 4000));
        }
    }
}
