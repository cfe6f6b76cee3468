//! Thinning by rank leaves more even sets than random thinning.

use std::{path::PathBuf, sync::Arc};

use strew_core::{
    Placement, Point, Region, Sampler, Seed, Spacing, Warp,
    sample::{Attributes, Column, Keep},
};
use strew_forge::{
    file_name,
    measure::{Spectrum, Window},
    read_table,
};

fn sampler() -> Arc<Sampler> {
    let alpha = "(5-sqrt(3))/2".parse().expect("valid");
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("../../tables")
        .join(file_name("blue", alpha, 49));
    let table = read_table(&path).unwrap_or_else(|e| panic!("{e}"));
    Arc::new(Sampler::new(table))
}

fn points(sampler: &Arc<Sampler>, placement: Placement, side: f64) -> Vec<Point> {
    let region = Region::new([0.0, 0.0], [side, side]).expect("ordered");
    let plan = sampler.plan(placement, region).expect("near");
    let mut points = vec![Point::default(); plan.count() as usize];
    plan.blocks_points().fill(&mut points);
    points
}

/// Mean power below ν = 0.5, in the units of the density after thinning.
fn low_power(points: impl Iterator<Item = Point>, keep: f64, side: f64) -> f64 {
    let set = Window::new(side, keep, points.map(|p| [p.x, p.y]).collect());
    Spectrum::of_window(&set, 0.6).summary(0.05).low_power
}

#[test]
fn ranks_thin_more_evenly_than_chance() {
    let sampler = sampler();
    let spacing = Spacing::new(1.0).expect("valid");
    let attributes = Attributes::new(vec!["u1".parse().expect("plain")]).expect("one");
    for warp in [Warp::OFF, Warp::ON] {
        let placement = Placement::new(spacing, Seed(3)).with_warp(warp);
        // Share kept, side, and the largest power allowed, relative to random thinning.
        for (keep, side, most) in [(0.5, 360.0, 0.8), (0.25, 500.0, 0.5), (0.0625, 800.0, 0.35)] {
            let share = Keep::new(keep).expect("a share");
            let ranked = points(&sampler, placement.with_keep(share), side);
            let fraction = ranked.len() as f64 / (side * side);
            assert!((fraction - keep).abs() < 0.02 * keep, "{keep}: {fraction}");
            let ranked = low_power(ranked.into_iter(), keep, side);

            let all = points(&sampler, placement, side);
            let bound = attributes.bind(&sampler, placement);
            let columns = bound.columns(all.iter().map(|p| p.id));
            let Column::Numbers(chances) = &columns[0] else {
                panic!("a number")
            };
            let chosen = all
                .iter()
                .zip(chances)
                .filter(|(_, chance)| **chance < keep);
            let random = low_power(chosen.map(|(p, _)| *p), keep, side);
            assert!(
                (random / (1.0 - keep) - 1.0).abs() < 0.15,
                "{keep}: {random}"
            );
            assert!(ranked < most * random, "{keep}: {ranked} {random}");
        }
    }
}
