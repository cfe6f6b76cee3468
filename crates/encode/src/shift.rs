//! Coordinates relative to a point.

use strew_core::Point;

use crate::source::Source;

/// Moves the points of a plan. Rounding never takes one out of the moved region: what would reach
/// its upper bound takes the number before.
pub(super) struct Shift {
    origin: [f64; 2],
    bound: [f64; 2],
}

impl Shift {
    pub(super) fn new(plan: &dyn Source, origin: [f64; 2]) -> Self {
        let max = plan.region().max();
        Self {
            origin,
            bound: [max[0] - origin[0], max[1] - origin[1]],
        }
    }

    pub(super) fn apply(&self, point: &Point) -> [f64; 2] {
        let moved = |value: f64, axis: usize| {
            let moved = value - self.origin[axis];
            if moved < self.bound[axis] {
                moved
            } else {
                self.bound[axis].next_down()
            }
        };
        [moved(point.x, 0), moved(point.y, 1)]
    }

    pub(super) fn near(&self, point: &Point) -> [f32; 2] {
        let [x, y] = self.apply(point);
        let near = |value: f64, axis: usize| {
            let near = value as f32;
            if f64::from(near) < self.bound[axis] {
                near
            } else {
                near.next_down()
            }
        };
        [near(x, 0), near(y, 1)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample_rows::parts;

    #[test]
    fn what_rounds_up_to_the_bound_takes_the_number_before() {
        let plan = &parts()[0].plan;
        let shift = Shift::new(&**plan, plan.origin());
        let last = Point {
            x: 30f64.next_down(),
            y: 40.5f64.next_down(),
            ..Point::default()
        };
        assert_eq!(shift.near(&last), [40f32.next_down(), 35.5f32.next_down()]);
    }
}
