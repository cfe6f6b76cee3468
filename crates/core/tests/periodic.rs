//! Periodic sets, parts of them (shares, kinds, fields) and their windows, against brute force: over the seam, and
//! against the plane.

use crate::subject;

use std::collections::{BTreeMap, BTreeSet};

use strew_core::{
    Alpha, Attribute, Attributes, Cursor, ErrorKind, Kinds, Map, Member, PeriodicPlan, PeriodicSet,
    Point, PointId, PointSet, Region, Table, table::from_grid_units,
};
use subject::{mixed::mixed, shipped};

/// A table with arbitrary vectors of up to `most` grid units, to make wrong blocks show.
fn table_of(alpha: &str, most: f64) -> Table {
    let map = Map::new(alpha.parse().expect("valid"), 20).expect("small");
    let n = map.intervals();
    let vector = |i: usize| {
        let part = |k: usize| (((i * k) % 601) as f64 / 100.0 - 3.0) * (most / 3.0);
        [part(7919), part(104_729)].map(|v| from_grid_units(v).expect("small"))
    };
    Table::new(
        map,
        "test",
        (0..n * n).map(vector).collect(),
        Default::default(),
    )
    .expect("valid")
}

fn table(alpha: &str) -> Table {
    table_of(alpha, 3.0)
}

/// A table with small vectors and kinds.
fn with_kinds(shares: &str) -> Table {
    mixed(&table_of("(5-sqrt(3))/2", 1.0), shares)
}

/// From one place to another on a torus of side `side`.
fn apart(a: [f64; 2], b: [f64; 2], side: f64) -> f64 {
    let d = [0, 1]
        .map(|i| a[i] - b[i])
        .map(|v| v - side * (v / side).round());
    d[0].hypot(d[1])
}

/// Each of some places with each other one.
fn pairs(all: &[[f64; 2]], step: usize) -> impl Iterator<Item = [[f64; 2]; 2]> {
    let others = |i: usize| all[..i].iter().chain(&all[i + 1..]);
    let some = all.iter().enumerate().step_by(step);
    some.flat_map(move |(i, &a)| others(i).map(move |&b| [a, b]))
}

/// The vectors from one place to all others within `radius` along both axes, on a torus of side `side`, or in
/// the plane for an infinite side. In 1024ths, sorted.
fn surroundings(at: [f64; 2], all: &[[f64; 2]], radius: f64, side: f64) -> Vec<[i64; 2]> {
    let wrapped = |v: f64| {
        if side.is_finite() {
            v - side * (v / side).round()
        } else {
            v
        }
    };
    let mut found: Vec<[i64; 2]> = all
        .iter()
        .map(|p| [wrapped(p[0] - at[0]), wrapped(p[1] - at[1])])
        .filter(|d| d.iter().all(|v| v.abs() < radius))
        .map(|d| d.map(|v| (v * 1024.0).round() as i64))
        .collect();
    found.sort_unstable();
    found
}

/// The set with one grid unit to a world unit.
fn on_grid(table: &Table, points: u64) -> PeriodicSet {
    let set = PeriodicSet::new(table.clone(), points).expect("a period");
    let side = set.twin().period() as f64;
    set.side(side).expect("in range")
}

fn places(members: impl Iterator<Item = Member>) -> Vec<[f64; 2]> {
    members.map(|p| p.at()).collect()
}

#[test]
fn across_the_seam_points_have_the_neighbors_that_they_have_in_the_plane() {
    for alpha in ["(5-sqrt(3))/2", "sqrt(3)", "(1+sqrt(5))/2"] {
        let table = table(alpha);
        // Points of one block of a wider map have neighbors of equal blocks, with equal vectors.
        let wide = Table::undisplaced(table.alpha(), 40, "pattern").expect("small");
        let mut twins = PeriodicSet::periods(wide.map()).map(|twin| twin.points());
        let points = twins.find(|&n| on_grid(&table, n).twin() == on_grid(&wide, n).twin());
        let [tile, wide_tile] = [&table, &wide].map(|table| on_grid(table, points.expect("one")));
        let side = tile.length();
        let all = places(tile.iter());
        // The plane in grid units, and a point of each block.
        let scale = 1.0 / table.alpha().set_side_f64();
        let (plane, wide_plane) = (PointSet::new(table.clone()), PointSet::new(wide));
        let region = Region::new([-180.0 / scale; 2], [180.0 / scale; 2]).expect("in order");
        let listed: Vec<Member> = plane.within(region).expect("near").iter().collect();
        let in_grid = |p: &Member| p.at().map(|v| v * scale);
        let world: Vec<[f64; 2]> = listed.iter().map(in_grid).collect();
        let mut of_block = BTreeMap::new();
        for p in listed
            .iter()
            .filter(|p| in_grid(p).iter().all(|v| v.abs() < 150.0))
        {
            of_block.insert(wide_plane.block(p.id()), p);
        }
        // Displacements take up to 6 of the 20 grid units whose neighbors are known with their blocks.
        let radius = 13.0;
        let mut across = 0;
        for p in tile.iter() {
            let Some(other) = of_block.get(&wide_tile.block(p.id())) else {
                continue;
            };
            let near_seam = p.at().iter().any(|v| *v < radius || *v > side - radius);
            across += u32::from(near_seam);
            let here = surroundings(p.at(), &all, radius, side);
            let there = surroundings(in_grid(other), &world, radius, f64::INFINITY);
            // Rounding to 1024ths may differ by one.
            let close = |a: &[i64; 2], b: &[i64; 2]| (0..2).all(|i| (a[i] - b[i]).abs() <= 1);
            let found = |from: &[[i64; 2]], to: &[[i64; 2]]| {
                from.iter().all(|a| {
                    let edge = a.iter().any(|v| v.abs() as f64 > (radius - 0.01) * 1024.0);
                    edge || to.iter().any(|b| close(a, b))
                })
            };
            assert!(
                found(&here, &there) && found(&there, &here),
                "{alpha} {}",
                p.id()
            );
        }
        assert!(across > 200, "{alpha}: {across}");
    }
}

#[test]
fn a_period_has_each_point_once_and_stays_inside() {
    let table = table("(5-sqrt(3))/2");
    for seed in [0, 1, 2, 3, 0xdead_beef] {
        let tile = PeriodicSet::new(table.clone(), 500)
            .expect("a period")
            .seed(seed);
        let tile = tile.side(3.0).expect("in range");
        let members: Vec<Member> = tile.iter().collect();
        assert_eq!(members.len() as u64, tile.len());
        let ids: BTreeSet<_> = members.iter().map(Member::id).collect();
        assert_eq!(ids.len(), members.len());
        let period = tile.twin().period() as i64;
        for p in &members {
            assert!(p.at().iter().all(|v| (0.0..3.0).contains(v)), "{p:?}");
            assert!((0..period).contains(&p.id().x) && (0..period).contains(&p.id().y));
            assert_eq!(tile.point(p.id()), Some(*p));
        }
        if seed == 0 {
            // Ranks follow the order of blocks, which is that of the plane.
            for p in &members {
                let [x, y] = tile.block(p.id()).expect("a point");
                let ranks = table.block_ranks(y * table.map().intervals() + x);
                assert!(ranks.contains(&tile.rank(p.id()).expect("a point")));
            }
        }
        let rows = [0..30, 30..2 * period as u64].map(|rows| tile.rows(rows));
        assert!(rows.into_iter().flatten().eq(members.iter().copied()));
        let blocks: BTreeSet<_> = members.iter().map(|p| tile.block(p.id())).collect();
        assert_eq!(
            blocks.len(),
            table.displacements().len(),
            "every block occurs"
        );
    }
}

#[test]
fn periods_that_do_not_exist_are_refused_with_the_reason() {
    let alpha: Alpha = "3/2".parse().expect("valid");
    let table = Table::undisplaced(alpha, 49, "pattern").expect("small");
    let error = PeriodicSet::new(table, 100).expect_err("thresholds coincide");
    assert_eq!(error.kind(), ErrorKind::Period);
    assert!(
        error
            .to_string()
            .contains("α = 3/2 and R = 49 has no such period"),
        "{error}"
    );
    let table =
        Table::undisplaced("sqrt(3)".parse().expect("valid"), 20, "pattern").expect("small");
    let error = PeriodicSet::new(table.clone(), u64::MAX).expect_err("too large");
    assert_eq!(error.limit(), Some(PeriodicSet::MAX_POINTS as f64));
    for side in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e101] {
        let tile = PeriodicSet::new(table.clone(), 100).expect("a period");
        assert_eq!(tile.side(side).expect_err("refused").field(), "side");
    }
}

#[test]
fn points_have_these_bits() {
    let tile = PeriodicSet::new(table("(5-sqrt(3))/2"), 1000).expect("a period");
    let sum = |tile: &PeriodicSet| {
        let mix = |sum: u64, v: f64| sum.rotate_left(5) ^ v.to_bits();
        tile.iter().flat_map(|p| p.at()).fold(0, mix)
    };
    let seeded = tile.clone().seed(7).side(3.0).expect("in range");
    let expected = [12_348_697_484_901_543_038, 8_288_891_734_264_237_938];
    assert_eq!([sum(&tile), sum(&seeded)], expected);
}

fn tile() -> PeriodicSet {
    PeriodicSet::new(with_kinds("1:3:10"), 500)
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
        // The field is looked at modulo L.
        assert!([x, y].iter().all(|v| (0.0..side).contains(v)), "{x} {y}");
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
    let still = tile.clone().settle(0).expect("0");
    let kept = still.clone().keep(0.3).expect("a share");
    let expected = all.iter().filter(|p| tile.rank(p.id()) < Some(0.3));
    assert!(kept.iter().eq(expected.copied()));
    // A part of the points that settle goes where they all go.
    let whole = tile.clone().keep(0.3).expect("a share");
    let level = whole.clone().lod(0.5).expect("a share");
    let expected = whole.iter().filter(|p| tile.rank(p.id()) < Some(0.15));
    assert!(level.iter().eq(expected));
    let mut counts = [0; 3];
    for kind in 0..3u8 {
        let only = tile.clone().only(kind).expect("a kind");
        let of_whole = whole.iter().filter(|p| tile.kind_of(p.id()) == Some(kind));
        assert!(
            whole
                .clone()
                .only(kind)
                .expect("a kind")
                .iter()
                .eq(of_whole)
        );
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
    // Points in a field stay where they are, if they do not settle.
    let side = tile.length();
    let ramp = move |[x, _]: [f64; 2]| x / side;
    let graded = still.in_field(ramp);
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
    assert!(tile.plan().attributes(&list).is_ok());
    assert_eq!(tile.least_distance_of(0, 3), None);
    assert!(tile.least_distance_of(0, 0) >= Some(tile.least_distance()));
    let other = PeriodicSet::new(with_kinds("1:1"), 500).expect("a period");
    assert!(other.attributes(&list).is_err());
    let plain = PeriodicSet::new(table("sqrt(3)"), 500).expect("a period");
    let first = plain.iter().next().expect("points").id();
    assert_eq!(
        (plain.kind_of(first), plain.least_distance_of(0, 0)),
        (None, None)
    );
}

#[test]
fn guaranteed_distances_hold_across_the_seam() {
    let table = shipped("blue-5-sqrt3-over-2-s");
    let tile = PeriodicSet::new(table, 5000).expect("a period");
    let tile = tile.side(3.0).expect("in range");
    let least = |tile: &PeriodicSet, step| {
        let all = places(tile.iter());
        let apart = pairs(&all, step).map(|[a, b]| apart(a, b, 3.0));
        apart.fold(f64::INFINITY, f64::min)
    };
    let plain = least(&tile, 1);
    assert!(plain < 1.5 * tile.least_distance());
    for seed in [0, 1, 4] {
        let seeded = tile.clone().seed(seed);
        let guaranteed = seeded.least_distance();
        assert!(
            guaranteed > 0.0 && least(&seeded, 5) >= guaranteed,
            "{seed}"
        );
        // A seed alone shows other places of the same pattern, turned.
        let unwarped = seeded.warp(0.0).expect("in range");
        assert!((least(&unwarped, 1) - plain).abs() < 1e-9, "{seed}");
    }
}
