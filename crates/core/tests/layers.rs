//! Sets that keep clear of others: bulk tests of many places agree with single searches and with all pairs.

use crate::subject;

use proptest::prelude::*;
use strew_core::{
    Area, Circle, Keep, Placement, Point, PointSet, Points, Region, Spacing, Table, server::Stop,
};
use subject::{
    all, any_seed, any_table, mixed,
    plane::{agree, any_parts, one_by_one},
    set, unit,
};

/// The form of another set, whatever its table, seed and spacing.
#[derive(Clone, Copy, Debug)]
enum Sort {
    All,
    /// It has a share of its points, which settle by some steps.
    Kept(f64, u32),
    InField,
    /// It has the points of a kind alone.
    OfKind,
    /// It lies in a circle.
    Limited,
}

fn any_sort() -> impl Strategy<Value = Sort> {
    prop_oneof![
        3 => Just(Sort::All),
        1 => (0.05..0.9f64, 0u32..3).prop_map(|(share, steps)| Sort::Kept(share, steps)),
        1 => Just(Sort::InField),
        1 => Just(Sort::OfKind),
        1 => Just(Sort::Limited),
    ]
}

/// Another set, near a place.
fn any_other() -> impl Strategy<Value = (PointSet, Sort)> {
    let spacing = prop_oneof![0.25..1.0f64, 1.0..8.0f64];
    (any_table(), any_seed(), spacing, any_sort(), 0usize..5).prop_map(
        |(table, (seed, warp), spacing, sort, kinds)| {
            let table = match sort {
                Sort::OfKind => mixed::tables()[kinds].clone(),
                _ => table,
            };
            let spacing = Spacing::new(spacing).expect("in range");
            let placement = Placement::new(spacing, seed).with_warp(warp);
            (set(&table, placement), sort)
        },
    )
}

/// The set as it is, around a place.
fn made((other, sort): (PointSet, Sort), at: [f64; 2]) -> PointSet {
    match sort {
        Sort::All => other,
        Sort::Kept(share, steps) => {
            let keep = Keep::new(share).expect("in range");
            let other = other.settle(steps).expect("few");
            let placement = other.placement().with_keep(keep);
            other.placed(placement)
        }
        Sort::InField => {
            other.in_field(move |[x, y]: [f64; 2]| 0.5 + 0.1 * (x - at[0]) - 0.05 * (y - at[1]))
        }
        Sort::OfKind => other.only(0).expect("a kind"),
        Sort::Limited => other.limited_to(Circle::new(at, 9.0).expect("valid")),
    }
}

/// Somewhere: around the origin, far away and very far away.
fn anywhere() -> impl Strategy<Value = [f64; 2]> {
    let within = |most: f64| [-most..most, -most..most];
    prop_oneof![within(30.0), within(1e5), within(1e12)]
}

/// An area around a place.
fn any_area() -> impl Strategy<Value = ([f64; 2], Area)> {
    let sides = [0.5..40.0f64, 0.5..40.0f64];
    (anywhere(), sides, 0u8..4).prop_map(|(at, sides, sort)| {
        let max = [0, 1].map(|i| at[i] + sides[i]);
        let center = [0, 1].map(|i| at[i] + 0.5 * sides[i]);
        let region = Region::new(at, max).expect("ordered");
        let circle = || Circle::new(center, 0.5 * sides[0]).expect("valid");
        let area = match sort {
            0 => {
                let number = at.map(|v| (v / sides[0]).floor() as i64);
                Region::chunk(sides[0], number).expect("in range").into()
            }
            1 => Area::from(circle()),
            2 => Area::from(region).without([circle().into()]),
            _ => region.into(),
        };
        (center, area)
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    #[test]
    fn bulk_and_single_tests_agree(
        table in any_table(), (seed, warp) in any_seed(), (at, area) in any_area(),
        (first, second) in (any_other(), any_other()),
        distances in [0.02..4.0f64, 0.02..4.0f64, 0.02..4.0f64],
        nested: bool, sort in any_sort(), parts in any_parts(),
    ) {
        let (first, second) = (made(first, at), made(second, at));
        let [of_first, of_second, between] = distances;
        let most_of = |set: &PointSet, distance: f64| distance.min(15.0 * set.placement().spacing.get());
        let second = match nested {
            true => second.clear_of(&first, most_of(&first, between)).expect("near"),
            false => second,
        };
        let own = set(&table, Placement { seed, ..unit(0).with_warp(warp) });
        // Kinds take a table with kinds.
        let whole = match sort {
            Sort::OfKind => own,
            sort => made((own, sort), at),
        };
        let clear = whole.clone().clear_of(&first, most_of(&first, of_first)).expect("near");
        let clear = clear.clear_of(&second, most_of(&second, of_second)).expect("near");
        let expected = one_by_one(&whole, &clear, area.clone());
        agree(&clear, area, &expected, parts);
    }
}

/// Several bands and patches, and other sets from much sparser to much denser.
#[test]
fn large_plans_are_made_piece_by_piece() {
    let [a, b, c] = subject::tables();
    let region = Region::new([-430.0, -70.0], [70.0, 60.0]).expect("ordered");
    let of = |table: &Table, spacing: f64, seed: u64| {
        let set = PointSet::new(table.clone()).seed(seed);
        set.spacing(spacing).expect("valid")
    };
    let rocks = of(b, 30.0, 3);
    let stones = of(c, 0.7, 4).clear_of(&rocks, 10.0).expect("near");
    for seed in [0, 8] {
        let whole = of(a, 1.0, seed);
        for (first, second) in [(8.0, 0.3), (0.5, 1.2)] {
            let clear = whole.clone().clear_of(&rocks, first).expect("near");
            let clear = clear.clear_of(&stones, second * 0.5).expect("near");
            let plan = clear.within(region).expect("in range");
            let points = all::<Points>(&plan, 5000);
            assert_eq!(points.len() as u128, plan.count());
            assert_eq!(points, one_by_one(&whole, &clear, region));
        }
    }
}

/// Once a flag is raised there may be fewer points, but no others.
#[test]
fn a_raised_flag_leaves_no_point_too_near() {
    let [a, b, _] = subject::tables();
    let rocks = PointSet::new(b.clone())
        .seed(3)
        .spacing(9.0)
        .expect("valid");
    let region = Region::new([-90.0, -70.0], [1500.0, 1110.0]).expect("ordered");
    for share in [1.0, 0.5] {
        let set = PointSet::new(a.clone())
            .seed(8)
            .keep(share)
            .expect("a share");
        let (set, stop) = (set.clear_of(&rocks, 3.0).expect("near"), Stop::new());
        let plan = set.within_until(region, stop.clone()).expect("in range");
        let points = all::<Points>(&plan, 5000);
        let mut blocks = plan.blocks::<Points>();
        let mut early = vec![Point::default(); points.len()];
        let (first, rest) = early.split_at_mut(5000);
        assert_eq!(blocks.fill(first), 5000);
        stop.raise();
        let more = blocks.fill(rest);
        assert!(more < rest.len());
        assert_eq!(early[..5000 + more], points[..5000 + more]);
    }
}
