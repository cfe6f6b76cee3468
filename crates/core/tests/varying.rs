//! Kinds whose shares vary: every way to their points agrees with the definition, point by point and bit for bit.

mod subject;

use std::sync::Arc;

use proptest::prelude::*;
use strew_core::{
    Area, Attribute, Attributes, Backend, Circle, ErrorKind, F64, Field, Keep, Kinds, Placement,
    Point, PointId, PointSet, Points, Polygon, Region, Seed, Spacing, Table, VariantScales,
    VaryingKinds, Warp,
    server::{self, Stop},
    table::Ranks,
};
use subject::{all_by, definition};

/// Shares, and the fields of some of their kinds.
type Weights = (&'static str, Vec<Option<Arc<dyn Field>>>);

fn waves(x: f64, y: f64, phase: f64) -> Option<Arc<dyn Field>> {
    Some(Arc::new(move |at: [f64; 2]| {
        0.5 + 0.7 * (at[0] * x + at[1] * y + phase).sin()
    }))
}

/// Some of them are zero, or not numbers, in places.
fn weights(number: usize) -> Weights {
    let hole = |[x, y]: [f64; 2]| if x * x + y * y < 100.0 { 0.0 } else { f64::NAN };
    match number {
        0 => ("1:1", vec![waves(0.1, 0.0, 0.0), None]),
        1 => (
            "1:3:10",
            vec![None, waves(0.05, 0.2, 1.0), waves(0.0, 0.3, 2.0)],
        ),
        2 => ("1:1", vec![waves(0.2, 0.1, 0.0), Some(Arc::new(hole))]),
        _ => (
            "1:2:3:4:5",
            vec![waves(0.1, 0.1, 0.5), None, waves(0.2, 0.0, 0.0), None, None],
        ),
    }
}

fn parts(weights: &Weights) -> Vec<(f64, Option<&dyn Field>)> {
    let shares: strew_core::table::Shares = weights.0.parse().expect("valid");
    let own = shares.parts().iter().map(|part| f64::from(*part));
    own.zip(weights.1.iter().map(Option::as_deref)).collect()
}

/// Any order of the blocks of a table, as a table.
fn order(table: &Table) -> Table {
    let blocks = table.displacements().len() as u32;
    let mut order: Vec<u32> = (0..blocks).collect();
    order.sort_by_key(|&block| block.wrapping_mul(0x85eb_ca6b).swap_bytes());
    let plain = Table::undisplaced(table.alpha(), table.map().radius(), "order").expect("small");
    plain
        .with_ranks(Ranks::new(order).expect("an order"))
        .expect("fits")
}

/// A set without kinds, and what they vary with.
#[derive(Clone)]
struct Subject {
    plain: PointSet,
    order: Table,
    weights: Weights,
}

impl std::fmt::Debug for Subject {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:?} {}", self.plain.placement(), self.weights.0)
    }
}

impl Subject {
    fn varied(&self) -> PointSet {
        let (shares, fields) = self.weights.clone();
        let kinds = VaryingKinds::new(&self.order, shares.parse().expect("valid"), fields);
        let kinds = kinds.expect("fields");
        self.plain
            .clone()
            .with_varying_kinds(kinds)
            .expect("the same map")
    }

    fn kinds(&self) -> u8 {
        self.weights.1.len() as u8
    }

    fn kind(&self, id: PointId) -> Option<u8> {
        definition::varying_kind(&self.plain, &self.order, &parts(&self.weights), id)
    }

    /// The points of a kind among those of the plain set.
    fn expected(&self, points: &[Point], kind: u8) -> Vec<Point> {
        let is_own = |point: &&Point| self.kind(point.id) == Some(kind);
        points.iter().filter(is_own).copied().collect()
    }
}

fn any_subject() -> impl Strategy<Value = Subject> {
    let seed = prop_oneof![Just(0u64), any::<u64>()];
    let warp = prop_oneof![Just(0.0), Just(1.0), 0.0..2.0f64];
    let keep = prop_oneof![Just(1.0), 0.02..1.0f64];
    let tables = subject::mixed::tables();
    let parts = (0..tables.len(), seed, warp, 0.6..3.0f64, keep, 0..4usize);
    parts.prop_map(|(table, seed, warp, spacing, keep, number)| {
        let keep = Keep::new(keep).expect("a share");
        let placement = Placement::new(Spacing::new(spacing).expect("in range"), Seed(seed))
            .with_warp(Warp::new(warp).expect("in range"))
            .with_keep(keep);
        // They have kinds of their own, which do not count.
        let table = &subject::mixed::tables()[table];
        Subject {
            plain: PointSet::new(table.clone()).placed(placement),
            order: order(table),
            weights: weights(number),
        }
    })
}

fn any_area() -> impl Strategy<Value = Area> {
    let point = || prop::array::uniform2(-30.0..30.0f64);
    let ring = prop::collection::vec(point(), 3..7);
    prop_oneof![
        (point(), prop::array::uniform2(0.0..45.0f64)).prop_map(|([x, y], [w, h])| {
            Region::new([x, y], [x + w, y + h]).expect("ordered").into()
        }),
        (1.0..40.0f64, prop::array::uniform2(-3..3i64)).prop_map(|(size, at)| Region::chunk(
            size, at
        )
        .expect("near")
        .into()),
        (point(), 1.0..25.0f64).prop_map(|(at, r)| Circle::new(at, r).expect("round").into()),
        ring.prop_filter_map("a polygon", |ring| Polygon::new(&[ring])
            .ok()
            .map(Area::from)),
    ]
}

fn all(set: &PointSet, area: &Area) -> Vec<Point> {
    set.within(area.clone()).expect("near").to_vec()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 100, ..ProptestConfig::default() })]

    #[test]
    fn each_kind_has_the_points_that_the_definition_says(
        mut subject in any_subject(), area in any_area(), block in 1usize..300, in_field: bool, clear: bool,
    ) {
        let unthinned = subject.plain.clone();
        let mut varied = subject.varied();
        if in_field {
            let field = |[x, y]: [f64; 2]| 0.7 + 0.5 * (x * 0.2).sin() * (y * 0.1).cos();
            subject.plain = subject.plain.in_field(field);
            varied = varied.in_field(field);
        }
        if clear {
            let other = Subject { plain: unthinned.clone().seed(3), ..subject.clone() };
            let other = other.varied().only(1).expect("two kinds");
            subject.plain = subject.plain.clear_of(&other, 0.7).expect("near");
            varied = varied.clear_of(&other, 0.7).expect("near");
        }
        let points = all(&subject.plain, &area);
        prop_assert_eq!(&all(&varied, &area), &points);
        let defined = Subject { plain: unthinned, ..subject };
        let counts = server::kind_counts(&varied, area.clone(), &Stop::default()).expect("near");
        for kind in 0..defined.kinds() {
            let expected = defined.expected(&points, kind);
            let own = varied.clone().only(kind).expect("a kind");
            let plan = own.within(area.clone()).expect("near");
            prop_assert_eq!(own.kind(), Some(kind));
            prop_assert_eq!(plan.count(), expected.len() as u128);
            prop_assert_eq!(counts[usize::from(kind)], plan.count());
            let pairs: Vec<[f64; 2]> = expected.iter().map(Point::at).collect();
            for backend in Backend::available() {
                prop_assert_eq!(&all_by::<Points>(&plan, block, backend), &expected);
                prop_assert_eq!(&all_by::<F64>(&plan, block, backend), &pairs);
            }
            let of_others = own.kind_counts(area.clone()).expect("near");
            prop_assert_eq!(of_others.iter().sum::<u128>(), plan.count());
        }
        for point in &points {
            let kind = varied.kind_of(point.id);
            prop_assert_eq!(kind, defined.kind(point.id));
            let own = varied.clone().only(kind.expect("a point")).expect("a kind");
            prop_assert_eq!(own.point(point.id).map(|member| member.point()), Some(*point));
        }
    }

    #[test]
    fn windows_cursors_and_tiles_are_parts(
        subject in any_subject(), area in any_area(), parts in 1u32..7, offset in 0.0..1.2f64,
        block in 1usize..300, kind: u8, in_field: bool,
    ) {
        let mut own = subject.varied().only(kind % subject.kinds()).expect("a kind");
        if in_field {
            own = own.in_field(|[x, y]: [f64; 2]| 0.7 + 0.5 * (x * 0.2).sin() * (y * 0.1).cos());
        }
        let plan = own.within(area.clone()).expect("near");
        let all = plan.to_vec();
        let split: Vec<Point> = plan.split(parts).flat_map(|part| part.to_vec()).collect();
        prop_assert_eq!(&split, &all);
        let offset = ((offset * all.len() as f64) as usize).min(all.len());
        let window = plan.window(offset as u128, Some(30));
        prop_assert_eq!(window.to_vec(), &all[offset..(offset + 30).min(all.len())]);
        if let Some(next) = window.next_cursor() {
            let rest = own.resume(area, next).expect("near");
            prop_assert_eq!(rest.to_vec(), &all[next.offset as usize..]);
        }
        let from_tiles = plan.tiles(block).flat_map(|tile| {
            let mut points = vec![Point::default(); all.len() + 1];
            let filled = plan.tile_blocks::<Points>(&tile).fill(&mut points);
            points.truncate(filled);
            points
        });
        prop_assert!(from_tiles.eq(all.iter().copied()));
    }

    #[test]
    fn searches_find_what_boxes_hold(
        subject in any_subject(), at in prop::array::uniform2(-40.0..40.0f64), radius in 0.1..9.0f64, kind: u8,
    ) {
        let own = subject.varied().only(kind % subject.kinds()).expect("a kind");
        let region = Region::new(at.map(|v| v - 10.0), at.map(|v| v + 10.0)).expect("ordered");
        let squared = |p: &Point| (p.x - at[0]).powi(2) + (p.y - at[1]).powi(2);
        let mut expected = all(&own, &region.into());
        expected.retain(|p| squared(p) <= radius * radius);
        expected.sort_by(|a, b| squared(a).total_cmp(&squared(b)).then(a.id.cmp(&b.id)));
        let found = own.around(at, radius, 10_000).expect("few");
        prop_assert!(found.iter().map(|near| near.member.point()).eq(expected.iter().copied()));
        let mut clearance = own.clearance(radius).expect("few");
        let is_near = expected.iter().any(|p| squared(p) < radius * radius);
        prop_assert_eq!(clearance.is_any_near(at, |_| true), is_near);
    }
}

#[test]
fn thinning_changes_no_kind() {
    let plain = PointSet::new(subject::mixed::tables()[3].clone()).seed(5);
    let order = order(plain.table());
    let subject = Subject {
        plain,
        order,
        weights: weights(1),
    };
    let whole = subject.varied();
    let half = whole.clone().keep(0.5).expect("a share");
    let points = half.chunk(60.0, [0, 0]).expect("near").to_vec();
    assert!(points.len() > 1000);
    for point in points {
        assert_eq!(half.kind_of(point.id), whole.kind_of(point.id));
    }
}

#[test]
fn variants_and_their_scales_are_the_kinds() {
    let plain = PointSet::new(subject::tables()[0].clone()).seed(11);
    let order = order(plain.table());
    let subject = Subject {
        plain,
        order,
        weights: weights(1),
    };
    let set = subject.varied();
    let even = Kinds::even("oak:10,birch:1,elm:3").expect("shares");
    let range =
        |kind: u32| strew_core::ScaleRange::new(f64::from(kind), f64::from(kind)).expect("ordered");
    let scales: VariantScales = even
        .scales((0..3).map(range).collect())
        .expect("one for each");
    let list = vec![
        Attribute::Kind(even.clone()),
        Attribute::VariantScale(scales),
        Attribute::Rank,
    ];
    let plan = set.chunk(40.0, [0, 0]).expect("near");
    let bound = plan
        .attributes(&Attributes::new(list).expect("different"))
        .expect("the same shares");
    let points = plan.to_vec();
    let columns = bound.columns(points.iter().map(|point| point.id));
    let indices = columns[0].variants().expect("variants");
    let scales = columns[1].numbers().expect("numbers");
    for ((point, &index), &scale) in points.iter().zip(indices).zip(scales) {
        assert_eq!(
            even.index(set.kind_of(point.id).expect("a kind")),
            Some(index)
        );
        assert_eq!(
            (f64::from(index), bound.value(2, point.id)),
            (scale, Some(set.rank(point.id)))
        );
    }
    // Other shares are other kinds.
    let other = Kinds::even("a:1,b:2").expect("shares");
    let list = Attributes::new(vec![Attribute::Kind(other)]).expect("different");
    assert_eq!(
        set.attributes(&list).expect_err("other shares").kind(),
        ErrorKind::Kinds
    );
    assert_eq!(
        set.clone().only(3).expect_err("three kinds").kind(),
        ErrorKind::Kinds
    );
    assert_eq!(set.least_distance_of(0, 2), Some(set.least_distance()));
    assert_eq!(set.least_distance_of(0, 3), None);
}
