//! Kinds whose shares vary: every way to their points agrees with the definition, point by point and bit for bit.

use crate::{kinds::agree_as_attributes, subject};

use std::sync::Arc;

use proptest::prelude::*;
use strew_core::{
    ErrorKind, Field, Point, PointId, PointSet, Table, VaryingKinds,
    server::{self, Stop},
    table::Ranks,
};
use subject::{
    any_area, any_placement, definition,
    plane::{agree, agree_around, any_parts, within},
    set, waves as hills,
};

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
    fn varying(&self) -> VaryingKinds {
        let (shares, fields) = self.weights.clone();
        VaryingKinds::new(&self.order, shares.parse().expect("valid"), fields).expect("fields")
    }

    fn varied(&self) -> PointSet {
        let set = self.plain.clone().with_varying_kinds(self.varying());
        set.expect("the same map")
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
    let tables = subject::mixed::tables();
    let parts = (0..tables.len(), any_placement(), 0..4usize);
    parts.prop_map(|(table, placement, number)| {
        // They have kinds of their own, which do not count.
        let table = &subject::mixed::tables()[table];
        Subject {
            plain: set(table, placement),
            order: order(table),
            weights: weights(number),
        }
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 100, ..ProptestConfig::default() })]

    #[test]
    fn each_kind_has_the_points_that_the_definition_says(
        mut subject in any_subject(), area in any_area(), parts in any_parts(), in_field: bool, clear: bool,
    ) {
        let unthinned = subject.plain.clone();
        let mut varied = subject.varied();
        if in_field {
            subject.plain = subject.plain.in_field(hills);
            varied = varied.in_field(hills);
        }
        if clear {
            let other = Subject { plain: unthinned.clone().seed(3), ..subject.clone() };
            let other = other.varied().only(1).expect("two kinds");
            subject.plain = subject.plain.clear_of(&other, 0.7).expect("near");
            varied = varied.clear_of(&other, 0.7).expect("near");
        }
        let points = within(&subject.plain, area.clone());
        prop_assert_eq!(&within(&varied, area.clone()), &points);
        let defined = Subject { plain: unthinned, ..subject };
        let counts = server::kind_counts(&varied, area.clone(), &Stop::default()).expect("near");
        for kind in 0..defined.kinds() {
            let expected = defined.expected(&points, kind);
            let own = varied.clone().only(kind).expect("a kind");
            prop_assert_eq!(own.kind(), Some(kind));
            prop_assert_eq!(counts[usize::from(kind)], expected.len() as u128);
            agree(&own, area.clone(), &expected, parts);
            let of_others = own.kind_counts(area.clone()).expect("near");
            prop_assert_eq!(of_others.iter().sum::<u128>(), expected.len() as u128);
        }
        for point in &points {
            let kind = varied.kind_of(point.id);
            prop_assert_eq!(kind, defined.kind(point.id));
            let own = varied.clone().only(kind.expect("a point")).expect("a kind");
            prop_assert_eq!(own.point(point.id).map(|member| member.point()), Some(*point));
        }
    }

    #[test]
    fn searches_find_what_boxes_hold(
        subject in any_subject(), at in prop::array::uniform2(-40.0..40.0f64), radius in 0.1..9.0f64, kind: u8,
    ) {
        agree_around(&subject.varied().only(kind % subject.kinds()).expect("a kind"), at, radius);
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
    agree_as_attributes(&set);
    assert_eq!(
        set.clone().only(3).expect_err("three kinds").kind(),
        ErrorKind::Kinds
    );
    assert_eq!(set.least_distance_of(0, 2), Some(set.least_distance()));
    assert_eq!(set.least_distance_of(0, 3), None);
    let other = PointSet::new(subject::tables()[1].clone());
    assert!(other.with_varying_kinds(subject.varying()).is_err());
}
