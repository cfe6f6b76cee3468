//! How far the warp moves the points of a box, at most.
//!
//! g varies slowly, so within a small box all points move nearly alike: its columns and rows can be told from
//! those around it far better than by the largest movement anywhere.

use core::ops::Range;

use super::{Shears, shears::CELL_BITS};

/// The least and the greatest movement along x and y, in fixed-point units.
type Drift = [[i32; 2]; 2];

/// Over more cells than these a bound of all control values serves.
const MOST_CELLS: i128 = 12;
/// Room for rounding in `f32`, in fixed-point units.
const ROOM: i32 = 64;

impl Shears {
    /// The least and the greatest value of a direction's g from one coordinate to another.
    fn range(&self, direction: usize, [from, to]: [i128; 2]) -> [i32; 2] {
        let [first, last] = [from, to].map(|s| s >> CELL_BITS);
        if last - first >= MOST_CELLS {
            let amplitude = self.amplitudes()[direction];
            return [-amplitude, amplitude];
        }
        let mut controls = [0; MOST_CELLS as usize + 2];
        let controls = &mut controls[..(last - first) as usize + 3];
        self.controls(direction, first as i64 - 1, controls);
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        for (cell, knots) in (first..).zip(controls.windows(3)) {
            let [a, b, c] = [knots[0], knots[1], knots[2]].map(f64::from);
            // The part of the cell within the range, in [0, 1].
            let part = |s: i128| {
                let offset = (s - (cell << CELL_BITS)).clamp(0, 1 << CELL_BITS);
                offset as f64 / f64::from(1 << CELL_BITS)
            };
            let [start, end] = [part(from), part(to)];
            let (slope, curve) = (b - a, (a - 2.0 * b + c) / 2.0);
            let vertex = (-slope / (2.0 * curve)).clamp(start, end);
            // NaN where the curve is straight, whose ends suffice.
            let vertex = if vertex.is_nan() { start } else { vertex };
            for u in [start, vertex, end] {
                let value = (a + b) / 2.0 + (slope + curve * u) * u;
                least = least.min(value);
                most = most.max(value);
            }
        }
        [least as i32 - ROOM, most as i32 + ROOM]
    }

    /// The movement of the points that the warp takes from anywhere into a box, which is not empty.
    pub(crate) fn drift_into(&self, bounds: [&Range<i128>; 2]) -> Drift {
        let [x, y] = bounds.map(|bounds| [bounds.start, bounds.end - 1]);
        let falling = self.range(3, [x[0] + y[0], x[1] + y[1]]);
        let (x, y) = (less(x, falling), more(y, falling));
        let rising = self.range(2, [x[0] - y[1], x[1] - y[0]]);
        let (x, y) = (less(x, rising), less(y, rising));
        let along_x = self.range(1, y);
        let along_y = self.range(0, less(x, along_x));
        moved([along_x, along_y], rising, falling)
    }

    /// The movement of points from a box to wherever the warp takes them. Both ends belong to it.
    pub(crate) fn drift_from(&self, [x, y]: [[i128; 2]; 2]) -> Drift {
        let along_y = self.range(0, x);
        let y = more(y, along_y);
        let along_x = self.range(1, y);
        let x = more(x, along_x);
        let rising = self.range(2, [x[0] - y[1], x[1] - y[0]]);
        let (x, y) = (more(x, rising), more(y, rising));
        let falling = self.range(3, [x[0] + y[0], x[1] + y[1]]);
        moved([along_x, along_y], rising, falling)
    }
}

fn more([low, high]: [i128; 2], [least, most]: [i32; 2]) -> [i128; 2] {
    [low + i128::from(least), high + i128::from(most)]
}

fn less(range: [i128; 2], [least, most]: [i32; 2]) -> [i128; 2] {
    more(range, [-most, -least])
}

fn moved([x, y]: [[i32; 2]; 2], rising: [i32; 2], falling: [i32; 2]) -> Drift {
    [
        [x[0] + rising[0] + falling[0], x[1] + rising[1] + falling[1]],
        [y[0] + rising[0] - falling[1], y[1] + rising[1] - falling[0]],
    ]
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::sample::{Seed, Warp};

    proptest! {
        #[test]
        fn no_point_of_a_box_moves_farther(
            seed: u64, strength in 0.01..=2.0f64, x in -1i128 << 60..1 << 60, y in -1i128 << 60..1 << 60,
            sides in [1i128 << 20..1 << 32, 1i128 << 20..1 << 32],
            inside in proptest::collection::vec([0.0..1.0f64, 0.0..1.0f64], 1..30),
        ) {
            let warp = Warp::new(strength).expect("in range");
            let Some(shears) = Shears::new(warp, Seed(seed)) else { return Ok(()) };
            let [width, height] = sides;
            let into = shears.drift_into([&(x..x + width), &(y..y + height)]);
            let from = shears.drift_from([[x, x + width - 1], [y, y + height - 1]]);
            let reach = shears.reach() + 8 * ROOM;
            for [u, v] in inside {
                let at = [x + (u * width as f64) as i128, y + (v * height as f64) as i128];
                for (drift, start, end) in
                    [(from, at, shears.apply(at)), (into, shears.invert(at), at)]
                {
                    for axis in 0..2 {
                        let [least, most] = drift[axis].map(i128::from);
                        let moved = end[axis] - start[axis];
                        prop_assert!(least <= moved && moved <= most, "{} {:?}", moved, drift);
                        prop_assert!(-reach <= drift[axis][0] && drift[axis][1] <= reach);
                    }
                }
            }
        }
    }
}
