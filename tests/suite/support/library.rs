//! The library's own points for one query, to compare answers with.

use strew_core::{Plan, Point, PointSet, Region};

use super::daemon::{PROFILE, table};

/// A region that is not a square, off the origin, partly negative.
pub const QUERY: &str = "/v1/points?bbox=-3.5,1,40,33.25&density=7&profile=test&seed=5";

/// The plan of [`QUERY`].
pub fn plan() -> Plan {
    let set = PointSet::new(table("(5-sqrt(3))/2", PROFILE)).seed(5);
    let set = set.density(7.0).expect("positive");
    let region = Region::new([-3.5, 1.0], [40.0, 33.25]).expect("a box");
    set.within(region).expect("near")
}

/// All points of a plan.
pub fn points(plan: &Plan) -> Vec<Point> {
    plan.to_vec()
}

/// Fails at the first difference.
pub fn assert_same(got: &[Point], expected: &[Point]) {
    for (i, (got, expected)) in got.iter().zip(expected).enumerate() {
        assert_eq!(got, expected, "point {i}");
    }
    assert_eq!(got.len(), expected.len());
}
