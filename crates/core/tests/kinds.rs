//! Sets of one kind: every way to their points agrees with the definition, point by point and bit for bit.

use crate::subject;

use proptest::prelude::*;
use strew_core::{
    Attribute, Attributes, Circle, ErrorKind, Kinds, Point, PointId, PointSet, Points, Region,
    ScaleRange, Variants, Warp, server::Stop,
};
use subject::{
    all, any_area, any_box, any_placement, definition,
    mixed::{mixed, tables},
    plane::{agree, agree_around, agree_in_number, any_parts, brute_force, within},
    set, waves,
};

fn kinds(set: &PointSet) -> u8 {
    let mix = set.table().mix().expect("a mix");
    mix.shares().kinds() as u8
}

fn only(set: &PointSet, kind: u8) -> PointSet {
    set.clone().only(kind).expect("a kind of the table")
}

fn any_set() -> impl Strategy<Value = PointSet> {
    let parts = (0..tables().len(), any_placement());
    parts.prop_map(|(table, placement)| set(&tables()[table], placement))
}

/// Every point of a box that `place` has, in order, with its kind.
fn defined(
    set: &PointSet,
    region: &Region,
    place: impl Fn(PointId) -> Option<[f64; 2]>,
) -> Vec<(Point, u8)> {
    let points = brute_force(set, &(*region).into(), 160, place);
    let kind = |id| definition::kind(set, id).expect("a table with kinds");
    points.into_iter().map(|p| (p, kind(p.id))).collect()
}

/// Those points that are of a kind.
fn of_kind(all: &[(Point, u8)], kind: u8) -> Vec<Point> {
    let all = all.iter().filter(|(_, own)| *own == kind);
    all.map(|(point, _)| *point).collect()
}

/// Compares the points of each kind in a box with those expected.
fn agree_by_kind(set: &PointSet, region: Region, expected: &[(Point, u8)]) {
    let counts = set.kind_counts(region).expect("near");
    assert_eq!(counts.len(), usize::from(kinds(set)));
    for (kind, count) in (0..).zip(counts) {
        let (own, points) = (only(set, kind), of_kind(expected, kind));
        let plan = own.within(region).expect("near");
        assert_eq!(plan.to_vec(), points);
        assert_eq!((plan.count(), count), (count, points.len() as u128));
        assert_eq!(own.kind(), Some(kind));
        for (point, of) in expected {
            let found = own.point(point.id).map(Point::from);
            assert_eq!(found, (*of == kind).then_some(*point));
        }
    }
    for (point, kind) in expected {
        assert_eq!(set.kind_of(point.id), Some(*kind));
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, ..ProptestConfig::default() })]

    #[test]
    fn a_box_holds_what_the_definition_has(set in any_set(), region in any_box(), in_field: bool) {
        let plain = set.settle(0).expect("0");
        if !in_field {
            let expected = defined(&plain, &region, |id| definition::place(&plain, id));
            agree_by_kind(&plain, region, &expected);
            return Ok(());
        }
        let expected = defined(&plain, &region, |id| definition::place_in(&plain, &waves, id));
        agree_by_kind(&plain.in_field(waves), region, &expected);
        // The kind may also be chosen first.
        let own = only(&plain, 0).in_field(waves);
        prop_assert_eq!(within(&own, region), of_kind(&expected, 0));
    }
}

#[test]
fn every_symmetry_agrees_with_the_definition() {
    // All eight symmetries occur among these seeds.
    let region = Region::new([-9.0, 3.0], [8.0, 21.0]).expect("ordered");
    for seed in 0..24 {
        for table in tables() {
            let set = PointSet::new(table.clone()).seed(seed);
            let expected = defined(&set, &region, |id| definition::place(&set, id));
            assert!(expected.len() > 200);
            agree_by_kind(&set, region, &expected);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 150, ..ProptestConfig::default() })]

    #[test]
    fn an_area_holds_the_points_of_the_whole_set_that_are_of_the_kind(
        set in any_set(), area in any_area(), parts in any_parts(), clear: bool, in_field: bool, kind: u8,
    ) {
        let kind = kind % kinds(&set);
        let mut set = set;
        if in_field {
            set = set.in_field(waves);
        }
        if clear {
            let other = PointSet::new(tables()[1].clone()).spacing(3.0).expect("in range");
            set = set.clear_of(&only(&other.seed(3), 1), 1.5).expect("near");
        }
        let whole = within(&set, area.clone());
        let is_own = |point: &&Point| set.kind_of(point.id) == Some(kind);
        let expected: Vec<Point> = whole.iter().filter(is_own).copied().collect();
        agree(&only(&set, kind), area.clone(), &expected, parts);
        let counts = set.kind_counts_until(&area, &Stop::default()).expect("near");
        prop_assert_eq!(counts[usize::from(kind)], expected.len() as u128);
        prop_assert_eq!(counts.iter().sum::<u128>(), whole.len() as u128);
    }

    #[test]
    fn searches_find_what_boxes_hold(
        set in any_set(), at in prop::array::uniform2(-40.0..40.0f64), radius in 0.0..9.0f64, kind: u8,
        in_field: bool,
    ) {
        let set = if in_field { set.in_field(waves) } else { set };
        agree_around(&only(&set, kind % kinds(&set)), at, radius);
    }

    #[test]
    fn large_boxes_are_the_sums_of_their_parts(
        set in any_set(), corner in prop::array::uniform2(-1e12..1e12f64),
        size in prop::array::uniform2(1.0..1e9f64), cut in 0.0..1.0f64, kind: u8,
    ) {
        // Counts of warped boxes and of points that settle take time in proportion to the circumference.
        let set = set.warp(0.0).expect("in range").settle(0).expect("0");
        let own = only(&set, kind % kinds(&set));
        let [x, y] = corner;
        let [right, top] = [x + size[0], y + size[1]];
        let middle = x + size[0] * cut;
        let region = |from, to| Region::new([from, y], [to, top]).expect("ordered");
        let count = |region: Region| own.count(region).expect("near");
        let whole = count(region(x, right));
        prop_assert_eq!(whole, count(region(x, middle)) + count(region(middle, right)));
        let counts = set.kind_counts(region(x, right)).expect("near");
        prop_assert_eq!(counts.iter().sum::<u128>(), set.count(region(x, right)).expect("near"));
        prop_assert_eq!(counts[usize::from(own.kind().expect("a kind"))], whole);
        // The k-th point is found without counting them all.
        if let Some(before) = whole.checked_sub(3) {
            let plan = own.within(region(x, right)).expect("near");
            let last = plan.window(before, None).to_vec();
            prop_assert_eq!(last.len(), 3);
            prop_assert!(last.iter().all(|point| own.kind_of(point.id) == own.kind()));
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, ..ProptestConfig::default() })]

    #[test]
    fn a_number_of_points_is_found(set in any_set(), area in any_area(), count in 1u128..1000, kind: u8) {
        agree_in_number(&only(&set, kind % kinds(&set)), &area, count);
    }
}

#[test]
fn previews_and_chunks_are_of_the_kind() {
    let set = PointSet::new(tables()[1].clone()).seed(3);
    let own = only(&set, 1);
    let plan = own.chunk(60.0, [-2, 1]).expect("near");
    let preview = plan.preview(2.0).expect("in range");
    let points = all::<Points>(&preview, 64);
    let other = set.spacing(2.0).expect("in range");
    assert!(points.len() > 50);
    let is_own = |id| other.kind_of(id) == Some(1) && other.point(id).is_some();
    assert!(points.iter().all(|point| is_own(point.id)));
    // A chosen kind stays, whatever is changed later.
    let changed = own.seed(9).keep(0.5).expect("a share");
    let changed = changed.warp(0.0).expect("in range");
    assert_eq!(changed.kind(), Some(1));
    let is_own = |id| changed.kind_of(id) == Some(1) && changed.rank(id) < 0.5;
    let points = changed.chunk(60.0, [0, 0]).expect("near").to_vec();
    assert!(points.iter().all(|point| is_own(point.id)));
}

#[test]
fn kinds_that_are_not_there_are_refused() {
    let set = PointSet::new(tables()[0].clone());
    let error = set.clone().only(2).expect_err("two kinds");
    assert_eq!(error.kind(), ErrorKind::Kinds);
    assert_eq!(error.to_string(), "only is 2; it must be from 0 to 1");
    assert_eq!(set.least_distance_of(0, 2), None);
    let plain = PointSet::new(subject::tables()[0].clone());
    let error = plain.clone().only(0).expect_err("no kinds").to_string();
    assert!(error.contains("the table has no kinds"), "{error}");
    assert_eq!(plain.kind_of(PointId { x: 0, y: 0 }), None);
    assert_eq!(plain.least_distance_of(0, 0), None);
    let area = Circle::new([0.0; 2], 5.0).expect("round");
    assert!(plain.kind_counts(area).expect("near").is_empty());
}

#[test]
fn kinds_keep_their_distances() {
    let blue = subject::shipped("blue-5-sqrt3-over-2-s");
    let region = Region::new([0.0, 0.0], [160.0, 160.0]).expect("ordered");
    for shares in ["1:1", "1:3:10"] {
        let table = mixed(&blue, shares);
        let kinds_of = table.mix().expect("a mix").shares().kinds() as u8;
        let of = |a, b| Some(table.least_distance_of(a, b)?.with_warp(Warp::OFF));
        let pairs = (0..kinds_of).flat_map(|a| (0..kinds_of).map(move |b| (a, b)));
        // The nearest of all pairs are of some kinds.
        let least = pairs
            .map(|(a, b)| of(a, b).expect("kinds"))
            .fold(f64::MAX, f64::min);
        assert_eq!(
            (least, of(0, kinds_of)),
            (table.least_distance().with_warp(Warp::OFF), None)
        );
        for (seed, warp) in [(0, 0.0), (7, 1.0)] {
            let set = PointSet::new(table.clone()).seed(seed);
            let set = set.warp(warp).expect("in range");
            let count = usize::from(kinds(&set));
            let points: Vec<_> = set.within(region).expect("near").iter().collect();
            let mut seen = vec![f64::INFINITY; count * count];
            for a in &points {
                let own = usize::from(set.kind_of(a.id()).expect("a kind"));
                for near in set.around(a.at(), 5.0, 1000).expect("few") {
                    let id = near.member.id();
                    if id != a.id() {
                        let other = usize::from(set.kind_of(id).expect("a kind"));
                        let least = &mut seen[own * count + other];
                        *least = near.distance.min(*least);
                    }
                }
            }
            for (i, seen) in seen.iter().enumerate() {
                let (a, b) = ((i / count) as u8, (i % count) as u8);
                let least = set.least_distance_of(a, b).expect("kinds");
                assert!(*seen >= least, "{shares} {a} {b}: {seen} < {least}");
                // Split blocks and the warp alone make the guarantee smaller.
                let part = if warp == 0.0 { 0.98 } else { 0.85 };
                assert!(part * seen <= least, "{shares} {a} {b}: {seen} > {least}");
            }
            let least = Some(only(&set, 0).least_distance());
            assert_eq!(set.least_distance_of(0, 0), least);
            let own = only(&set, 0).min_distance(2.0).expect("useful");
            assert!(own.least_distance() >= 2.0);
        }
    }
}

/// The kinds of a set whose shares are 1:3:10, as attributes.
pub fn agree_as_attributes(set: &PointSet) {
    let plan = set.chunk(50.0, [0, 0]).expect("near");
    let ids = || plan.iter().map(|point| point.id());
    let list = |attributes| Attributes::new(attributes).expect("different");
    for text in ["oak:10,birch:1,elm:3", "elm:0.3,oak:1,birch:0.1"] {
        let chance: Variants = text.parse().expect("valid");
        let even = Kinds::even(&chance).expect("shares");
        // Scales that depend on the kind.
        let range = |i: i32| ScaleRange::new(f64::from(i), f64::from(i) + 0.5).expect("ordered");
        let scales = even.scales((0..3).map(range).collect());
        let scales = scales.expect("one for each");
        assert_eq!(scales.variants(), even.variants());
        let error = even.scales(vec![range(1)]).expect_err("one for three");
        assert_eq!(error.allowed(), "3 ranges, one for each variant");
        let kind = Attribute::Kind(even.clone());
        assert_eq!(
            (kind.variants(), Attribute::Angle.variants()),
            (Some(even.variants()), None)
        );
        let attributes = list(vec![kind, Attribute::VariantScale(scales), Attribute::Rank]);
        let bound = plan.attributes(&attributes).expect("the same shares");
        let columns = bound.columns(ids());
        let indices = columns[0].variants().expect("variants");
        let scales = columns[1].numbers().expect("numbers");
        for ((id, &index), &scale) in ids().zip(indices).zip(scales) {
            assert_eq!(bound.value(0, id), Some(index.into()));
            assert_eq!(bound.value(2, id), Some(set.rank(id)));
            assert_eq!(scale.floor(), f64::from(index));
            let kind = set.kind_of(id).expect("a kind");
            assert_eq!(even.index(kind), Some(index));
            let name = even.variants().name(index).expect("a name");
            assert_eq!(
                (even.name(kind), even.number(name)),
                (Some(name), Some(kind))
            );
            assert_eq!(name, ["birch", "elm", "oak"][usize::from(kind)]);
        }
    }
    // Other shares are other kinds.
    let other = list(vec![Attribute::Kind(
        Kinds::even("a:1,b:2").expect("shares"),
    )]);
    let error = set.attributes(&other).expect_err("other shares");
    assert_eq!(error.kind(), ErrorKind::Kinds);
    let says = "the ratio of the table's kinds is 1:3:10; it must be 1:2, that of the named kinds";
    assert_eq!(error.to_string(), says);
    let plain = PointSet::new(subject::tables()[0].clone());
    assert!(plain.attributes(&other).is_err());
}

#[test]
fn named_kinds_are_the_kinds() {
    agree_as_attributes(&PointSet::new(tables()[1].clone()).seed(11));
}
