//! Sets in space that keep clear of others: every path leaves out the same points, those that brute force does.

use crate::subject;

use proptest::prelude::*;
use strew_core::space::{Ball, Point, Region, SpaceSet};
use subject::space::{around, clear_by_hand, cube, is_near};

fn set(spacing: f64, seed: u64) -> SpaceSet {
    let set = SpaceSet::blue().seed(seed);
    set.spacing(spacing).expect("in range")
}

/// The points of layer number `i` of a chain in a box by the definition, recursively: layers are those of `plain`, and
/// each keeps its distances from some before it.
fn by_definition(
    plain: &[SpaceSet],
    clear: &[Vec<(usize, f64)>],
    i: usize,
    region: Region,
) -> Vec<Point> {
    let mut points = plain[i].within(region).expect("near").to_vec();
    for &(other, distance) in &clear[i] {
        let wide = distance + 1e-6;
        let others = by_definition(plain, clear, other, around(region, wide));
        points.retain(|point| !is_near(point, &others, distance));
    }
    points
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn chains_and_all_pairs_leave_what_the_definition_leaves(
        layers in prop::collection::vec((0.8f64..2.0, 0u64..9, prop_oneof![Just(1.0), 0.2..1.0f64]), 2..6),
        parts in prop::collection::vec(0.1f64..0.5, 15), is_chain: bool, limited: Option<bool>,
        corner in prop::array::uniform3(prop_oneof![-40.0f64..40.0, -2e6..2e6]), side in 1.0f64..3.0, radius in 1.0f64..5.0,
    ) {
        let ball = Ball::new(corner, radius).expect("a ball");
        let chunk = Region::chunk(7.5, corner.map(|v| (v / 7.5).floor() as i64)).expect("a chunk");
        let mut plain = vec![];
        for &(spacing, seed, share) in &layers {
            let layer = set(spacing, seed).keep(share).expect("in range");
            plain.push(match limited {
                Some(true) if plain.len() == 1 => layer.limited_to(ball),
                Some(false) if plain.len() == 1 => layer.limited_to(chunk),
                _ => layer,
            });
        }
        let mut parts = parts.into_iter();
        let distances = |i: usize| -> Vec<(usize, f64)> {
            let before = if is_chain { i.saturating_sub(1)..i } else { 0..i };
            before.filter_map(|j| Some((j, parts.next()? * layers[j].0))).collect()
        };
        let clear: Vec<_> = (0..layers.len()).map(distances).collect();
        let mut sets: Vec<SpaceSet> = vec![];
        for (layer, clear) in plain.iter().zip(&clear) {
            let others = clear.iter();
            let layer = others.fold(layer.clone(), |layer, &(other, distance)| {
                layer.clear_of(&sets[other], distance).expect("in range")
            });
            sets.push(layer);
        }
        let last = layers.len() - 1;
        let region = cube(corner, side);
        let expected = by_definition(&plain, &clear, last, region);
        let plan = sets[last].within(region).expect("near");
        prop_assert_eq!(plan.count(), expected.len() as u128);
        prop_assert_eq!(plan.to_vec(), expected);
    }
}

#[test]
fn a_chain_makes_each_layer_once() {
    use std::sync::{
        Arc,
        atomic::{AtomicU32, Ordering},
    };
    use strew_core::server::Stop;
    // The looks at the flag tell how many tiles are made.
    let looks = |depth: u64, all: bool| {
        let mut sets: Vec<SpaceSet> = vec![];
        for seed in 1..=depth {
            let first = if all { 0 } else { sets.len().saturating_sub(1) };
            let others = sets[first..].iter();
            let layer = others.fold(set(1.0, seed), |layer, other| {
                layer.clear_of(other, 0.5).expect("in range")
            });
            sets.push(layer);
        }
        let seen = Arc::new(AtomicU32::new(0));
        let seeing = seen.clone();
        let stop = Stop::with_look(move || {
            seeing.fetch_add(1, Ordering::Relaxed);
        });
        let ball = Ball::new([0.0; 3], 2.0).expect("a ball");
        let last = sets.last().expect("some");
        last.within_until(ball, stop).expect("near");
        seen.load(Ordering::Relaxed)
    };
    for all in [false, true] {
        let [four, eight] = [4, 8].map(|depth| looks(depth, all));
        assert!(eight < 6 * four, "{four} {eight}");
    }
}

#[test]
fn large_requests_and_dense_others_leave_out_the_same_points() {
    // Several patches, and another set that is too dense for tiles to be worth it.
    let region = cube([-11.0, 3.0, 700.0], 40.0);
    for (spacing, distance) in [(2.0, 1.4), (0.15, 0.1)] {
        let (own, other) = (set(1.0, 3), set(spacing, 4));
        let clear = own.clone().clear_of(&other, distance).expect("in range");
        let plan = clear.within(region).expect("near");
        let chunk = cube([0.0, 8.0, 710.0], 5.0);
        let all = plan.to_vec();
        assert_eq!(all.len() as u128, plan.count());
        let inside = all.iter().filter(|point| chunk.contains(point.at()));
        let inside: Vec<Point> = inside.copied().collect();
        let mut expected = clear_by_hand(&own, &other, distance, chunk);
        expected.sort_by_key(|point| all.iter().position(|other| other == point));
        assert!(!expected.is_empty() && expected.len() < 125);
        assert_eq!(inside, expected);
    }
}
