//! Parts of periods (shares, kinds, fields) and their windows, against brute force.

mod subject;

use std::collections::BTreeSet;

use strew_core::{
    Attribute, Attributes, Cursor, Kinds, Map, PeriodicPlan, PeriodicSet, Point, PointId, Table,
    table::{Mix, Ranks, from_grid_units},
};
use subject::shipped;

const ALPHA: &str = "(5-sqrt(3))/2";

/// A table with small arbitrary vectors and kinds.
fn table(shares: &str) -> Table {
    let map = Map::new(ALPHA.parse().expect("valid"), 20).expect("small");
    let n = map.intervals();
    let vector = |i: usize| {
        let part = |k: usize| ((i * k) % 401) as f64 / 200.0 - 1.0;
        [part(7919), part(104_729)].map(|v| from_grid_units(v).expect("small"))
    };
    let mix = Mix::scattered(&map, shares.parse().expect("valid")).expect("near");
    let ranks = Ranks::new((0..(n * n) as u32).rev().collect()).expect("a permutation");
    let vectors = (0..n * n).map(vector).collect();
    let table = Table::new(map, "test", vectors, Default::default()).expect("valid");
    table.with_mix(mix, ranks).expect("of the map")
}

fn tile() -> PeriodicSet {
    PeriodicSet::new(table("1:3:10"), 500)
        .expect("a period")
        .seed(9)
}

fn listed(plan: &PeriodicPlan, most: usize) -> Vec<Point> {
    let (mut blocks, mut block, mut all) =
        (plan.blocks(), vec![Point::default(); most], Vec::new());
    loop {
        let filled = blocks.fill(&mut block);
        all.extend_from_slice(&block[..filled]);
        if filled == 0 {
            return all;
        }
    }
}

/// The sets whose points are a part of a tile's.
fn parts(tile: &PeriodicSet) -> Vec<PeriodicSet> {
    let side = tile.length();
    let waves = move |[x, y]: [f64; 2]| {
        let turn = std::f64::consts::TAU / side;
        0.5 + 0.3 * (turn * x).sin() + 0.2 * (turn * y).cos()
    };
    let kept = tile.clone().keep(0.3).expect("a share");
    let only = tile.clone().only(1).expect("a kind");
    vec![
        tile.clone(),
        kept.clone(),
        only.clone(),
        kept.only(2).expect("a kind"),
        tile.in_field(waves),
        only.in_field(waves).keep(0.5).expect("a share"),
    ]
}

#[test]
fn parts_are_those_points_that_their_definition_leaves() {
    let tile = tile();
    let all: Vec<_> = tile.iter().collect();
    let kept = tile.clone().keep(0.3).expect("a share");
    let expected = all.iter().filter(|p| tile.rank(p.id()) < Some(0.3));
    assert!(kept.iter().eq(expected.copied()));
    let mut counts = [0; 3];
    for kind in 0..3u8 {
        let only = tile.clone().only(kind).expect("a kind");
        let expected = all.iter().filter(|p| tile.kind_of(p.id()) == Some(kind));
        assert!(only.iter().eq(expected.copied()));
        counts[usize::from(kind)] = only.count();
    }
    assert_eq!(counts.iter().sum::<u64>(), tile.len());
    for (count, share) in counts.into_iter().zip([1.0, 3.0, 10.0]) {
        // A period has few points, whose indices are as coarse.
        let error = count as f64 / tile.len() as f64 - share / 14.0;
        assert!(error.abs() < 0.03, "{share}: {error}");
    }
    // Points in a field stay where they are.
    let side = tile.length();
    let ramp = move |[x, _]: [f64; 2]| x / side;
    let graded = tile.in_field(ramp);
    let expected = all
        .iter()
        .filter(|p| tile.rank(p.id()) < Some(ramp(p.at())));
    assert!(graded.iter().eq(expected.copied()));
}

#[test]
fn windows_cursors_and_ids_agree_with_the_whole() {
    for set in parts(&tile()) {
        let whole: Vec<Point> = set.iter().map(|p| p.point()).collect();
        let plan = set.plan();
        assert_eq!(
            (plan.count(), plan.total()),
            (whole.len() as u128, whole.len() as u128)
        );
        assert_eq!(set.count(), whole.len() as u64);
        for most in [1, 7, 10_000] {
            assert_eq!(listed(&plan, most), whole);
        }
        let ids: BTreeSet<PointId> = whole.iter().map(|p| p.id).collect();
        let period = set.twin().period() as i64;
        for y in -1..=period {
            for x in -1..=period {
                let id = PointId { x, y };
                assert_eq!(set.point(id).is_some(), ids.contains(&id), "{id}");
            }
        }
        for offset in [0, 1, 17, whole.len() - 1, whole.len()] {
            for limit in [0, 1, 40, whole.len()] {
                let window = plan.window(offset as u128, Some(limit as u128));
                let expected = &whole[offset..(offset + limit).min(whole.len())];
                assert_eq!(listed(&window, 13), expected);
                let end = offset + expected.len();
                assert_eq!(window.next_cursor().is_some(), end < whole.len());
                for cursor in window.cursor().into_iter().chain(window.next_cursor()) {
                    let rest = set.resume(cursor);
                    assert_eq!(listed(&rest, 100), whole[cursor.offset as usize..]);
                    let part = rest.window(3, Some(5));
                    let from = (cursor.offset as usize + 3).min(whole.len());
                    assert_eq!(listed(&part, 100), whole[from..(from + 5).min(whole.len())]);
                }
            }
        }
        // Blocks know where they are.
        let (mut blocks, mut block) = (plan.blocks(), vec![Point::default(); 50]);
        let mut given = 0;
        loop {
            given += blocks.fill(&mut block);
            let Some(cursor) = blocks.cursor() else { break };
            assert_eq!(cursor.offset as usize, given);
            assert_eq!(listed(&set.resume(cursor), 100), whole[given..]);
        }
        assert_eq!(given, whole.len());
        // A cursor from nowhere makes no more than there is.
        let at = PointId {
            x: i64::MAX,
            y: i64::MIN,
        };
        let odd = Cursor {
            offset: 3,
            total: u128::MAX,
            at,
        };
        assert!(listed(&set.resume(odd), 100).len() <= whole.len());
    }
}

#[test]
fn a_field_with_the_period_is_followed_without_a_seam() {
    // The same points, whatever part of the plane the period is: the field is looked at modulo L.
    let table = shipped("blue-5-sqrt3-over-2-m");
    let tile = PeriodicSet::new(table, 5000).expect("a period");
    let side = tile.length();
    let wave = move |shift: f64| {
        move |[x, y]: [f64; 2]| {
            assert!(
                (0.0..side).contains(&x) && (0.0..side).contains(&y),
                "{x} {y}"
            );
            let turn = std::f64::consts::TAU / side;
            0.4 + 0.35 * (turn * (x + shift)).cos() * (turn * (y + 2.0 * shift)).cos()
        }
    };
    // Where the field is least and where it is greatest, points are as far apart at the seam as inside.
    for shift in [0.0, side / 2.0, side / 3.0] {
        let graded = tile.in_field(wave(shift));
        let all: Vec<[f64; 2]> = graded.iter().map(|p| p.at()).collect();
        let near = |a: [f64; 2], b: [f64; 2]| {
            let d = [0, 1].map(|i| (a[i] - b[i]) - side * ((a[i] - b[i]) / side).round());
            d[0].hypot(d[1])
        };
        let mut least = [f64::INFINITY; 2];
        for (i, &a) in all.iter().enumerate().step_by(7) {
            for &b in all[..i].iter().chain(&all[i + 1..]) {
                let is_across = (0..2).any(|i| (a[i] - b[i]).abs() > side / 2.0);
                let distance = near(a, b);
                least[usize::from(is_across)] = least[usize::from(is_across)].min(distance);
            }
        }
        assert!(least[0] > 0.2 && least[1] > 0.2, "{shift}: {least:?}");
        let share = all.len() as f64 / tile.len() as f64;
        assert!((share - 0.4).abs() < 0.01, "{shift}: {share}");
    }
}

#[test]
fn attributes_are_those_of_the_points() {
    let tile = tile();
    let even = Kinds::even("oak:10,birch:3,fir:1").expect("kinds");
    let list = vec![
        Attribute::Rank,
        Attribute::Angle,
        Attribute::Kind(even.clone()),
    ];
    let list = Attributes::new(list).expect("different");
    let bound = tile.attributes(&list).expect("its shares");
    for p in tile.iter() {
        assert_eq!(bound.value(0, p.id()), tile.rank(p.id()));
        assert_eq!(bound.value(1, p.id()), Some(p.angle()));
        let kind = tile.kind_of(p.id()).expect("kinds");
        assert_eq!(bound.value(2, p.id()), even.index(kind).map(f64::from));
    }
    let other = PeriodicSet::new(table("1:1"), 500).expect("a period");
    assert!(other.attributes(&list).is_err());
}

#[test]
fn guaranteed_distances_hold_across_the_seam() {
    let table = shipped("blue-5-sqrt3-over-2-m");
    for seed in [0, 4] {
        let tile = PeriodicSet::new(table.clone(), 5000).expect("a period");
        let tile = tile.side(3.0).expect("in range").seed(seed);
        let guaranteed = tile.least_distance();
        let all: Vec<[f64; 2]> = tile.iter().map(|p| p.at()).collect();
        let mut least = f64::INFINITY;
        for (i, a) in all.iter().enumerate().step_by(5) {
            for b in all[..i].iter().chain(&all[i + 1..]) {
                let d = [0, 1].map(|i| (a[i] - b[i]) - 3.0 * ((a[i] - b[i]) / 3.0).round());
                least = least.min(d[0].hypot(d[1]));
            }
        }
        assert!(
            guaranteed > 0.0 && least >= guaranteed,
            "{seed}: {least} {guaranteed}"
        );
        assert!(seed > 0 || least < 1.5 * guaranteed);
    }
}
