//! The warp of space: three warps of the plane, one after another.
//!
//! The shears of the plane (x, y) move points along x and y, those of (y, z) and of (z, x) along these: four in each
//! plane, twelve in all. Six displace along an axis by a function of another coordinate, six along the diagonal of a
//! face. Each keeps volumes, has an exact inverse in integers, and is bounded. Distances shrink by a factor of at
//! most the product of the three planes' factors.

use crate::{
    kernel::{Backend, PLANES, PlainLoop, SpaceShears, compiled_loop},
    lattice::seed::Seed,
    warp::{PatchShears, Shears, Stretch, Warp},
};

/// The warp of one seed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shears3([Shears; 3]);

impl Shears3 {
    /// The warp of a seed, or `None` if it is off.
    pub(super) fn new(warp: Warp, seed: Seed) -> Option<Self> {
        let plane = |number| Shears::in_space(warp, seed, number);
        Some(Self([plane(0)?, plane(1)?, plane(2)?]))
    }

    /// The place to which the warp moves a fixed-point position.
    pub(super) fn apply(&self, position: [i64; 3]) -> [i64; 3] {
        let planes = &self.0;
        let mut moving = Moving { planes, position };
        compiled_loop(Backend::best(), &mut moving);
        moving.position
    }

    /// The ranges of places that the warp takes positions to from some ranges. Both ends belong to a range.
    pub(super) fn spread(&self, mut ranges: [[i64; 2]; 3]) -> [[i64; 2]; 3] {
        for (shears, [a, b]) in self.0.iter().zip(PLANES) {
            let drift = shears.drift_from([a, b].map(|axis| ranges[axis].map(i128::from)));
            for (axis, [least, most]) in [a, b].into_iter().zip(drift) {
                ranges[axis][0] += i64::from(least);
                ranges[axis][1] += i64::from(most);
            }
        }
        ranges
    }

    /// The ranges of positions from which the warp takes points into some ranges, which are not empty. Both ends
    /// belong to a range.
    pub(super) fn gather(&self, mut ranges: [[i64; 2]; 3]) -> [[i64; 2]; 3] {
        for (shears, [a, b]) in self.0.iter().zip(PLANES).rev() {
            let bounds =
                [a, b].map(|axis| i128::from(ranges[axis][0])..i128::from(ranges[axis][1]) + 1);
            let drift = shears.drift_into([&bounds[0], &bounds[1]]);
            for (axis, [least, most]) in [a, b].into_iter().zip(drift) {
                ranges[axis][0] -= i64::from(most);
                ranges[axis][1] -= i64::from(least);
            }
        }
        ranges
    }

    /// The shears of the points of a patch, whose displaced positions lie in some ranges relative to its origin, and from
    /// their lattice coordinates within the reach. The origin is a multiple of the distance of the knots along all axes.
    pub(super) fn patch(
        &self,
        origin: [i64; 3],
        mut ranges: [[i32; 2]; 3],
        reach: [[i32; 2]; 3],
    ) -> SpaceShears {
        let planes = [0, 1, 2].map(|number| {
            let [a, b] = PLANES[number];
            let origin = [origin[a], origin[b]];
            let patch = PatchShears::new(&self.0[number], origin, [ranges[a], ranges[b]]);
            let [first, second, rising, falling] = patch.bounds;
            let [along_y, along_x] = [first, second];
            let across = [rising[0] + falling[0], rising[1] + falling[1]];
            let up = [rising[0] - falling[1], rising[1] - falling[0]];
            for (axis, along, both) in [(a, along_x, across), (b, along_y, up)] {
                ranges[axis][0] += along[0] + both[0];
                ranges[axis][1] += along[1] + both[1];
            }
            patch
        });
        SpaceShears::new(planes, reach)
    }
}

/// A position that the warp moves.
struct Moving<'a> {
    planes: &'a [Shears; 3],
    position: [i64; 3],
}

impl PlainLoop for Moving<'_> {
    #[inline(always)]
    fn run(&mut self) {
        self.position = Shears::apply_in_space(self.planes, PLANES, self.position);
    }
}

/// The bound of the effect of a warp on distances, the same for all seeds.
pub(crate) fn stretch(warp: Warp) -> Stretch {
    let planes = [0, 1, 2].map(|plane| Shears::in_space(warp, Seed(0), plane));
    let [first, second, third] = planes.map(|shears| Stretch::of(shears.as_ref()));
    Stretch {
        factor: first.factor * second.factor * third.factor,
        // Later planes stretch the errors of earlier ones.
        slack: (first.slack * second.factor + second.slack) * third.factor + third.slack,
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn ranges_hold_what_they_bound(
            seed: u64, corner in prop::array::uniform3(-1i64 << 58..1 << 58),
            sides in prop::array::uniform3(1i64 << 20..1 << 30),
            inside in prop::collection::vec(prop::array::uniform3(0.0..1.0f64), 1..20),
        ) {
            let shears = Shears3::new(Warp::ON, Seed(seed)).expect("on");
            let ranges = [0, 1, 2].map(|axis| [corner[axis], corner[axis] + sides[axis]]);
            let spread = shears.spread(ranges);
            let back = shears.gather(spread);
            for part in inside {
                let at = [0, 1, 2].map(|axis| corner[axis] + (part[axis] * sides[axis] as f64) as i64);
                let to = shears.apply(at);
                for axis in 0..3 {
                    prop_assert!(spread[axis][0] <= to[axis] && to[axis] <= spread[axis][1]);
                    prop_assert!(back[axis][0] <= at[axis] && at[axis] <= back[axis][1]);
                }
            }
        }

        #[test]
        fn points_move_as_in_one_plane_after_another(
            seed: u64, at in prop::array::uniform3(-1i64 << 60..1 << 60),
        ) {
            let shears = Shears3::new(Warp::ON, Seed(seed)).expect("on");
            let mut position = at;
            for (shears, [a, b]) in shears.0.iter().zip(PLANES) {
                let moved = shears.apply([position[a], position[b]].map(i128::from));
                [position[a], position[b]] = moved.map(|v| v as i64);
            }
            prop_assert_eq!(shears.apply(at), position);
        }

        #[test]
        fn distances_stay_within_the_bound(
            seed: u64, strength in 0.01..2.0f64, from in prop::array::uniform3(-1i64 << 40..1 << 40),
            by in prop::array::uniform3(-1i64 << 26..1 << 26), near in 0u32..20,
        ) {
            let warp = Warp::new(strength).expect("in range");
            let Some(shears) = Shears3::new(warp, Seed(seed)) else { return Ok(()) };
            let Stretch { factor, slack } = stretch(warp);
            let by = by.map(|v| v >> near);
            let [p, q] = [from, [0, 1, 2].map(|i| from[i] + by[i])].map(|at| shears.apply(at));
            let length = |v: [i64; 3]| v.iter().map(|&v| (v as f64) * (v as f64)).sum::<f64>().sqrt();
            let (before, after) = (length(by), length([0, 1, 2].map(|i| q[i] - p[i])));
            prop_assert!(after <= factor * before + 2.0 * slack);
            prop_assert!(before <= factor * (after + 2.0 * slack));
        }
    }
}
