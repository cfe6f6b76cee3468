//! The library's own points for one query, to compare answers with.

use std::sync::Arc;

use strew_core::{Placement, Plan, Point, Region, Sampler, Seed, Spacing};

use super::daemon::{PROFILE, table};

/// A region that is not a square, off the origin, partly negative.
pub const QUERY: &str = "/v1/points?bbox=-3.5,1,40,33.25&density=7&profile=test&seed=5";

/// The plan of [`QUERY`].
pub fn plan() -> Plan {
    let sampler = Arc::new(Sampler::new(table("(5-sqrt(3))/2", PROFILE)));
    let region = Region::new([-3.5, 1.0], [40.0, 33.25]).expect("a box");
    let spacing = Spacing::from_density(7.0).expect("positive");
    sampler
        .plan(Placement::new(spacing, Seed(5)), region)
        .expect("near")
}

/// All points of a plan.
pub fn points(plan: &Plan) -> Vec<Point> {
    let mut points = vec![Point::default(); usize::try_from(plan.count()).expect("few")];
    plan.blocks_points().fill(&mut points);
    points
}

/// Fails at the first difference.
pub fn assert_same(got: &[Point], expected: &[Point]) {
    for (i, (got, expected)) in got.iter().zip(expected).enumerate() {
        assert_eq!(got, expected, "point {i}");
    }
    assert_eq!(got.len(), expected.len());
}
