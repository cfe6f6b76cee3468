//! Thinning by rank leaves more even sets than random thinning.

mod shipped;

use strew_core::{Attributes, Point, PointSet, Region};
use strew_forge::measure::{Spectrum, Window};

fn points(set: &PointSet, side: f64) -> Vec<Point> {
    let region = Region::new([0.0, 0.0], [side, side]).expect("ordered");
    set.within(region).expect("near").to_vec()
}

/// Mean power below ν = 0.5, in the units of the density after thinning.
fn low_power(points: impl Iterator<Item = Point>, keep: f64, side: f64) -> f64 {
    let set = Window::new(side, keep, points.map(|p| [p.x, p.y]).collect());
    Spectrum::of_window(&set, 0.6).summary(0.05).low_power
}

#[test]
fn ranks_thin_more_evenly_than_chance() {
    let table = shipped::table("blue", "(5-sqrt(3))/2", 49);
    let attributes = Attributes::new(vec!["u1".parse().expect("plain")]).expect("one");
    for warp in [0.0, 1.0] {
        let set = PointSet::new(table.clone()).seed(3).warp(warp);
        let set = set.expect("in range");
        // Share kept, side, and the largest power allowed, relative to random thinning.
        for (keep, side, most) in [(0.5, 360.0, 0.8), (0.25, 500.0, 0.5), (0.0625, 800.0, 0.35)] {
            let ranked = points(&set.clone().keep(keep).expect("a share"), side);
            let fraction = ranked.len() as f64 / (side * side);
            assert!((fraction - keep).abs() < 0.02 * keep, "{keep}: {fraction}");
            let ranked = low_power(ranked.into_iter(), keep, side);

            let all = points(&set, side);
            let columns = set.attributes(&attributes);
            let columns = columns.columns(all.iter().map(|p| p.id));
            let chances = columns[0].numbers().expect("a number");
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
