//! Attributes: ranges, uniformity, independence, and the same value in every query.

use proptest::prelude::*;
use strew_core::{
    Attribute, Attributes, Column, ErrorKind, Point, PointId, PointSet, Region, Table, Variants,
};

fn set(seed: u64) -> PointSet {
    let alpha = "(5-sqrt(3))/2".parse().expect("valid");
    let table = Table::undisplaced(alpha, 20, "pattern").expect("valid");
    PointSet::new(table).seed(seed)
}

fn points(seed: u64, min: [f64; 2], max: [f64; 2]) -> Vec<Point> {
    let region = Region::new(min, max).expect("ordered");
    set(seed).within(region).expect("near").to_vec()
}

fn list(names: &[&str]) -> Attributes {
    let parse = |name: &&str| name.parse().expect("plain");
    Attributes::new(names.iter().map(parse).collect()).expect("different")
}

fn numbers(attributes: &Attributes, seed: u64, points: &[Point]) -> Vec<Vec<f64>> {
    let bound = set(seed).attributes(attributes).expect("of any table");
    let columns = bound.columns(points.iter().map(|p| p.id));
    let numbers = |column| match column {
        Column::Numbers(values) => values,
        Column::Variants(values) => values.into_iter().map(f64::from).collect(),
    };
    columns.into_iter().map(numbers).collect()
}

/// χ² of values in [0, 1) over equal bins, less its mean, in standard deviations.
fn unevenness(values: impl Iterator<Item = f64>, bins: usize) -> f64 {
    let mut counts = vec![0.0; bins];
    values.for_each(|v| counts[(v * bins as f64) as usize] += 1.0);
    let expected = counts.iter().sum::<f64>() / bins as f64;
    let square = |count: &f64| (count - expected) * (count - expected) / expected;
    let chi: f64 = counts.iter().map(square).sum();
    let freedom = bins as f64 - 1.0;
    (chi - freedom) / (2.0 * freedom).sqrt()
}

fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let mean = |v: &[f64]| v.iter().sum::<f64>() / v.len() as f64;
    let (ma, mb) = (mean(a), mean(b));
    let sum =
        |f: fn(f64, f64) -> f64| -> f64 { a.iter().zip(b).map(|(x, y)| f(x - ma, y - mb)).sum() };
    sum(|x, y| x * y) / (sum(|x, _| x * x) * sum(|_, y| y * y)).sqrt()
}

#[test]
fn hashed_numbers_are_uniform_and_independent() {
    let attributes = list(&["u1", "u2", "u16", "angle", "rank"]);
    let near = points(1, [-100.0, -100.0], [100.0, 100.0]);
    let far = points(1, [1e12, -3e9], [1e12 + 200.0, -3e9 + 200.0]);
    for points in [&near, &far] {
        let mut values = numbers(&attributes, 1, points);
        values[3]
            .iter_mut()
            .for_each(|v| *v /= std::f64::consts::TAU);
        // And another seed, and the numbers of the next points in the row.
        let other = numbers(&list(&["u1"]), 2, points);
        let mut next = values[0].clone();
        next.rotate_left(1);
        values.extend(other);
        values.push(next);
        for (i, a) in values.iter().enumerate() {
            assert!(a.iter().all(|v| (0.0..1.0).contains(v)));
            if i != 4 {
                let score = unevenness(a.iter().copied(), 100);
                assert!(score.abs() < 4.5, "{i}: {score}");
            }
            for b in &values[..i] {
                let limit = 4.5 / (a.len() as f64).sqrt();
                assert!(correlation(a, b).abs() < limit, "{i}");
                // Pairs also fill the square evenly. Ranks are more even.
                let pairs = a
                    .iter()
                    .zip(b)
                    .map(|(x, y)| ((x * 16.0).floor() + y) / 16.0);
                let score = unevenness(pairs, 256);
                assert!(score < 4.5, "{i}: {score}");
            }
        }
    }
}

#[test]
fn neighbors_along_both_axes_are_independent() {
    // All ids in a square, whether points or not.
    let bound = set(0).attributes(&list(&["u3"])).expect("of any table");
    let value = |x: i64, y: i64| bound.value(0, PointId { x, y }).expect("there");
    let grid = |dx: i64, dy: i64| -> Vec<f64> {
        (0..200 * 200)
            .map(|i| value(i % 200 - 100 + dx, i / 200 - 100 + dy))
            .collect()
    };
    let own = grid(0, 0);
    for (dx, dy) in [(1, 0), (0, 1), (1, 1), (1, -1), (2, 0), (0, 1 << 20)] {
        let c = correlation(&own, &grid(dx, dy));
        assert!(c.abs() < 4.5 / 200.0, "({dx}, {dy}): {c}");
    }
    assert_eq!(bound.value(1, PointId { x: 0, y: 0 }), None);
}

#[test]
fn variants_come_by_weight_and_scales_in_their_range() {
    let variants: Variants = "oak:3,birch:1,rare:0.001".parse().expect("valid");
    let scale = Attribute::scale(0.5, 2.0).expect("valid");
    let error = Attributes::new(vec![scale.clone(), scale.clone()]).expect_err("twice");
    assert_eq!(error.kind(), ErrorKind::Attribute);
    assert_eq!(error.value(), "scale");
    let attributes = Attributes::new(vec![Attribute::Variant(variants), scale]);
    let attributes = attributes.expect("different");
    let points = points(9, [0.0, 0.0], [300.0, 300.0]);
    let values = numbers(&attributes, 9, &points);
    let count = |index: f64| values[0].iter().filter(|&&v| v == index).count() as f64;
    let total = points.len() as f64;
    for (index, weight) in [(0.0, 3.0), (1.0, 1.0), (2.0, 0.001)] {
        let expected = total * weight / 4.001;
        let off = (count(index) - expected) / expected.sqrt();
        assert!(off.abs() < 4.5, "{index}: {off}");
    }
    assert!(values[1].iter().all(|v| (0.5..=2.0).contains(v)));
    let mean = values[1].iter().sum::<f64>() / total;
    assert!((mean - 1.25).abs() < 0.01, "{mean}");
}

#[test]
fn names_are_checked() {
    for name in ["angle", "rank", "u1", "u16"] {
        let attribute: Attribute = name.parse().expect("plain");
        assert_eq!(attribute.name(), name);
    }
    assert_eq!(
        Attribute::scale(0.8, 1.2).expect("valid").to_string(),
        "scale"
    );
    for (name, part) in [
        ("", "attribute is \"\""),
        ("u0", "attribute is"),
        ("u17", "u1 to u16"),
        ("u01", "attribute is"),
        ("Angle", "attribute is"),
        ("scale", "with a range"),
        ("variant", "with a list"),
    ] {
        let error = name.parse::<Attribute>().expect_err(name).to_string();
        assert!(error.contains(part), "{error}");
    }
    let (nan, infinity) = (f64::NAN, f64::INFINITY);
    for (min, max) in [(-1.0, 1.0), (2.0, 1.0), (nan, 1.0), (0.0, infinity)] {
        assert!(Attribute::scale(min, max).is_err());
    }
    assert!(Attribute::uniform(0).is_err() && Attribute::uniform(17).is_err());
}

proptest! {
    #[test]
    fn a_value_depends_on_id_and_seed_alone(
        seed: u64, x: i64, y: i64, spacing in 1e-6..1e6f64, strength in 0.0..2.0f64,
    ) {
        let attributes = list(&["angle", "u7", "rank"]);
        let id = PointId { x, y };
        let other = set(seed).spacing(spacing).expect("valid").warp(strength).expect("in range");
        let a = set(seed).attributes(&attributes).expect("of any table");
        let b = other.attributes(&attributes).expect("of any table");
        let mut columns = vec![Column::Variants(vec![3]); 5];
        b.write([PointId { x: 1, y: 2 }, id].into_iter(), &mut columns);
        prop_assert_eq!(columns.len(), 3);
        for (i, column) in columns.iter().enumerate() {
            let Column::Numbers(values) = column else { panic!("numbers") };
            prop_assert_eq!(a.value(i, id), Some(values[1]));
        }
    }
}

#[test]
fn members_have_the_values_of_columns() {
    let kinds: Variants = "oak:3,birch:1,rare:0.5".parse().expect("valid");
    let attributes = Attributes::new(vec![
        Attribute::Angle,
        Attribute::scale(0.8, 1.2).expect("valid"),
        Attribute::Variant(kinds.clone()),
        Attribute::uniform(7).expect("valid"),
        Attribute::Rank,
    ]);
    let set = set(77);
    let bound = set
        .attributes(&attributes.expect("different"))
        .expect("of any table");
    let plan = set.chunk(20.0, [-4, 2]).expect("near");
    let mut columns = Vec::new();
    bound.write_points(&plan.to_vec(), &mut columns);
    assert_eq!(
        columns,
        bound.columns(plan.iter().map(|member| member.id()))
    );
    for member in &plan {
        let value = |i| bound.value(i, member.id()).expect("there");
        assert_eq!(member.angle(), value(0));
        assert_eq!(member.scale(0.8..=1.2), value(1));
        assert_eq!(Some(member.variant(&kinds)), kinds.name(value(2) as u32));
        assert_eq!(member.uniform(7), value(3));
        assert_eq!(set.rank(member.id()), value(4));
    }
}

/// Values are part of the algorithm version.
#[test]
fn values_are_pinned() {
    let attributes = Attributes::new(vec![
        Attribute::Angle,
        Attribute::scale(0.5, 1.5).expect("valid"),
        Attribute::Variant("a:1,b:2,c:3".parse().expect("valid")),
        Attribute::Rank,
        Attribute::uniform(1).expect("valid"),
        Attribute::uniform(16).expect("valid"),
    ])
    .expect("different");
    let bound = set(42).attributes(&attributes).expect("of any table");
    // From an independent program.
    let none = 1.0 - f64::EPSILON / 2.0;
    let pinned = |[x, y]: [i64; 2], values: [f64; 6]| {
        let found = [0, 1, 2, 3, 4, 5].map(|i| bound.value(i, PointId { x, y }));
        assert_eq!(found, values.map(Some));
    };
    pinned(
        [0, 0],
        [
            4.195754032065334,
            0.5067606996105573,
            0.0,
            none,
            0.11873508124973142,
            0.5815156750741645,
        ],
    );
    pinned(
        [-31, 1 << 50],
        [
            5.247145616794338,
            1.1458591356331613,
            2.0,
            none,
            0.20459077190172592,
            0.483999484139356,
        ],
    );
    pinned(
        [4, -9],
        [
            4.306217298483824,
            0.5647858354433963,
            1.0,
            none,
            0.5650814719622604,
            0.42303441569219746,
        ],
    );
    let rank = bound.value(3, PointId { x: 0, y: 1 });
    assert_eq!(rank, Some(0.6101640903442529));
}
