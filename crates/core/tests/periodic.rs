//! Periodic sets against brute force: over the seam, and against the plane.

use std::collections::{BTreeMap, BTreeSet};

use strew_core::{
    Alpha, ErrorKind, Map, Member, PeriodicSet, PointSet, Region, Table, table::from_grid_units,
};

/// A table with arbitrary vectors of up to 3 grid units, so that wrong blocks show.
fn table(alpha: &str) -> Table {
    let map = Map::new(alpha.parse().expect("valid"), 20).expect("small");
    let n = map.intervals();
    let vector = |i: usize| {
        let part = |k: usize| ((i * k) % 601) as f64 / 100.0 - 3.0;
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
        let blocks: BTreeSet<_> = members.iter().map(|p| tile.block(p.id())).collect();
        assert_eq!(
            blocks.len(),
            table.displacements().len(),
            "every block occurs"
        );
    }
}

/// The least distance between two points on a torus with a side of 1, times √N.
fn least_distance(tile: &PeriodicSet) -> f64 {
    let all = places(tile.clone().side(1.0).expect("in range").iter());
    let apart = |a: [f64; 2], b: [f64; 2]| {
        let d = [0, 1].map(|i| a[i] - b[i]).map(|v| v - v.round());
        (d[0] * d[0] + d[1] * d[1]).sqrt()
    };
    let pairs = all
        .iter()
        .enumerate()
        .flat_map(|(i, &a)| all[..i].iter().map(move |&b| (a, b)));
    let least = pairs
        .map(|(a, b)| apart(a, b))
        .fold(f64::INFINITY, f64::min);
    least * (all.len() as f64).sqrt()
}

#[test]
fn seeds_and_warps_keep_distances_across_the_seam() {
    let table = Table::undisplaced("(5-sqrt(3))/2".parse().expect("valid"), 49, "pattern");
    let tile = PeriodicSet::new(table.expect("small"), 3000).expect("a period");
    let plain = least_distance(&tile);
    for seed in [1, 2, 3] {
        let seeded = tile.clone().seed(seed);
        assert!(least_distance(&seeded) > plain / 1.143, "seed {seed}");
        let unwarped = seeded.warp(0.0).expect("in range");
        assert!(
            (least_distance(&unwarped) - plain).abs() < 1e-9,
            "seed {seed}"
        );
    }
}

#[test]
fn thinned_periods_are_those_of_their_ranks() {
    let table = table("(1+sqrt(5))/2");
    let tile = PeriodicSet::new(table.clone(), 20_000)
        .expect("a period")
        .seed(5);
    let plane = PointSet::new(table);
    // Ranks follow the order of blocks, which is that of the plane.
    let ranks = |block: [usize; 2]| {
        plane
            .table()
            .block_ranks(block[1] * plane.table().map().intervals() + block[0])
    };
    for p in tile.iter() {
        assert!((0.0..1.0).contains(&tile.rank(p.id()).expect("a point")));
    }
    let unturned = tile.clone().seed(0);
    for p in unturned.iter() {
        let rank = unturned.rank(p.id()).expect("a point");
        assert!(ranks(unturned.block(p.id()).expect("a point")).contains(&rank));
    }
    for share in [0.1, 0.5, 0.9] {
        let kept = tile
            .iter()
            .filter(|p| tile.rank(p.id()) < Some(share))
            .count();
        assert!((kept as f64 / tile.len() as f64 - share).abs() < 0.02);
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
