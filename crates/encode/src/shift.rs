//! Coordinates relative to a point.

use strew_core::Point;

use crate::{place::Place, source::Source};

/// Moves the points of a plan. Rounding never takes one out of the moved region: what would reach
/// its upper bound takes the number before.
pub(super) struct Shift {
    origin: [f64; 3],
    bound: [f64; 3],
}

impl Shift {
    pub(super) fn new(plan: &dyn Source, origin: Place) -> Self {
        let [max_x, max_y] = plan.region().max();
        let max = [max_x, max_y, plan.heights().map_or(0.0, |[_, top]| top)];
        let [x, y] = origin.flat();
        let origin = [x, y, origin.z()];
        Self {
            origin,
            bound: [0, 1, 2].map(|axis| max[axis] - origin[axis]),
        }
    }

    pub(super) fn apply(&self, point: &Point) -> [f64; 2] {
        [self.moved(point.x, 0), self.moved(point.y, 1)]
    }

    /// The coordinate along z.
    pub(super) fn height(&self, z: f64) -> f64 {
        self.moved(z, 2)
    }

    fn moved(&self, value: f64, axis: usize) -> f64 {
        let moved = value - self.origin[axis];
        if moved < self.bound[axis] {
            moved
        } else {
            self.bound[axis].next_down()
        }
    }

    pub(super) fn near(&self, point: &Point) -> [f32; 2] {
        let [x, y] = self.apply(point);
        [self.narrowed(x, 0), self.narrowed(y, 1)]
    }

    /// The coordinate along z as `f32`.
    pub(super) fn near_height(&self, z: f64) -> f32 {
        self.narrowed(self.height(z), 2)
    }

    fn narrowed(&self, value: f64, axis: usize) -> f32 {
        let near = value as f32;
        if f64::from(near) < self.bound[axis] {
            near
        } else {
            near.next_down()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample_rows::parts;

    #[test]
    fn what_rounds_up_to_the_bound_takes_the_number_before() {
        let plan = &parts()[0].plan;
        let shift = Shift::new(&**plan, Place::Plane(plan.origin()));
        let last = Point {
            x: 30f64.next_down(),
            y: 40.5f64.next_down(),
            ..Point::default()
        };
        assert_eq!(shift.near(&last), [40f32.next_down(), 35.5f32.next_down()]);
    }
}
