//! Point sets to measure, also windows of the unbounded pattern of a table and of served sets.

use std::ops::Range;

use strew_core::{
    Error, Map, Pattern, PointSet, Region, Table,
    pattern::{Axis, Class, IndexOrigin},
    server::Stop,
    table::to_grid_units,
};

use crate::numeric::SplitMix;

/// The points of a square, or of a cube, at unit density: one period of a set that repeats, or a window of an unbounded one.
#[derive(Clone, Debug)]
pub struct Sample<const D: usize = 2> {
    side: f64,
    points: Vec<[f64; D]>,
    is_periodic: bool,
    pub(super) stop: Stop,
}

/// The side of a square, or of a cube, of some volume.
pub(crate) fn root<const D: usize>(volume: f64) -> f64 {
    match D {
        2 => volume.sqrt(),
        _ => libm::cbrt(volume),
    }
}

impl<const D: usize> Sample<D> {
    /// Rescales the points of one period, a torus of side `side`, to unit density: to a side of √N mean spacings, in space
    /// of the cube root. Coordinates may lie outside [0, side); they are taken modulo the side.
    pub fn torus(side: f64, points: Vec<[f64; D]>) -> Self {
        let unit_side = root::<D>(points.len() as f64);
        Self::scaled(unit_side, unit_side / side, points, true)
    }

    /// Rescales the points in the box [0, `side`)² or [0, `side`)³ of a set with `density` points per unit area or volume
    /// to unit density. Points outside the box are dropped; none inside may be missing.
    pub fn window(side: f64, density: f64, mut points: Vec<[f64; D]>) -> Self {
        points.retain(|p| p.iter().all(|v| (0.0..side).contains(v)));
        let scale = root::<D>(density);
        Self::scaled(side * scale, scale, points, false)
    }

    fn scaled(side: f64, scale: f64, mut points: Vec<[f64; D]>, is_periodic: bool) -> Self {
        for p in &mut points {
            *p = p.map(|v| v * scale);
        }
        Self {
            side,
            points,
            is_periodic,
            stop: Stop::NEVER,
        }
    }

    /// This set, measured until a flag is raised: the results are meaningless then.
    pub fn until(self, stop: Stop) -> Self {
        Self { stop, ..self }
    }

    /// The side of the square or cube, in mean spacings.
    pub const fn side(&self) -> f64 {
        self.side
    }

    /// Whether the set repeats outside.
    pub const fn is_periodic(&self) -> bool {
        self.is_periodic
    }

    /// Whether a point is measured, of which all is there within `margin`: on a torus always, in a window away from its edge.
    pub(super) fn is_inner(&self, margin: f64, p: &[f64; D]) -> bool {
        let inner = margin..self.side - margin;
        !self.stop.is_raised() && (self.is_periodic || p.iter().all(|v| inner.contains(v)))
    }

    /// The points, in mean spacings.
    pub fn points(&self) -> &[[f64; D]] {
        &self.points
    }

    /// The points for moving them, in mean spacings.
    pub fn points_mut(&mut self) -> &mut [[f64; D]] {
        &mut self.points
    }

    /// The points in units of the side, within [0, 1).
    pub(crate) fn turns(&self) -> Vec<[f64; D]> {
        let turns = self.points.iter().map(|p| p.map(|v| v / self.side));
        let most = 1.0 - f64::EPSILON;
        match self.is_periodic {
            true => turns.map(|p| p.map(|v| wrap(v, 1.0))).collect(),
            false => turns.map(|p| p.map(|v| v.min(most))).collect(),
        }
    }
}

/// Returns `v` modulo `side`, in [0, side).
pub(crate) fn wrap(v: f64, side: f64) -> f64 {
    let wrapped = v - (v / side).floor() * side;
    if wrapped < side {
        wrapped.max(0.0)
    } else {
        0.0
    }
}

/// Returns a window of about `points` points of the unbounded displaced pattern of the table's own
/// α, at a place chosen by `seed`.
pub fn window_set(table: &Table, points: u64, seed: u64) -> Sample {
    let map = table.map();
    let density = map.alpha().set_side_f64() * map.alpha().set_side_f64();
    let side = (points as f64 / density).sqrt();
    let mut random = SplitMix::new(seed);
    let origin = IndexOrigin {
        x: random.next_u64(),
        y: random.next_u64(),
    };
    let pattern = Pattern::with_origin(map.alpha(), origin);
    let lengths = table.displacements().iter().flatten().map(|v| v.abs());
    let margin = to_grid_units(lengths.max().unwrap_or(0)).ceil() as i64 + 1;
    let range = -margin..side.ceil() as i64 + margin;

    let mut found = Vec::with_capacity(points as usize + points as usize / 8);
    for class in Class::ALL {
        let columns: Vec<(i64, usize)> = members(&pattern, map, Axis::X, class, range.clone());
        for (y, by) in members(&pattern, map, Axis::Y, class, range.clone()) {
            for &(x, bx) in &columns {
                let [dx, dy] = table.displacements()[by * map.intervals() + bx];
                found.push([x as f64 + to_grid_units(dx), y as f64 + to_grid_units(dy)]);
            }
        }
    }
    Sample::window(side, density, found)
}

/// Returns a square of a served set with a number of points per unit area.
pub fn square_set(
    set: &PointSet,
    corner: [f64; 2],
    side: f64,
    density: f64,
) -> Result<Sample, Error> {
    let region = Region::new(corner, corner.map(|v| v + side))?;
    let points = set.within(region)?.to_vec();
    let points = points.iter().map(|p| [p.x - corner[0], p.y - corner[1]]);
    Ok(Sample::window(side, density, points.collect()))
}

/// The columns (or rows, along [`Axis::Y`]) of a class in a range, each with its interval.
fn members(
    pattern: &Pattern,
    map: &Map,
    axis: Axis,
    class: Class,
    range: Range<i64>,
) -> Vec<(i64, usize)> {
    let other = match axis {
        Axis::X => class.y,
        Axis::Y => class.x,
    };
    pattern
        .axis_set(axis, class)
        .iter(range)
        .filter_map(|v| Some((v, map.interval_of(pattern.axis_index(axis, v, other))?)))
        .collect()
}

#[cfg(test)]
mod tests {
    use strew_core::table::Provenance;

    use super::*;

    /// A table of random vectors of up to ±2 grid units.
    fn table() -> Table {
        let map = Map::new("(5-sqrt(3))/2".parse().expect("valid"), 20).expect("small");
        let blocks = map.intervals() * map.intervals();
        let mut random = SplitMix::new(9);
        let mut next = || (random.next_u64() % (1 << 22)) as i32 - (1 << 21);
        let vectors = (0..blocks).map(|_| [next(), next()]).collect();
        Table::new(map, "blue", vectors, Provenance::default()).expect("valid")
    }

    #[test]
    fn a_window_is_complete() {
        // The oracle: every lattice point of a wider box, tested one by one.
        let table = table();
        let (map, n) = (table.map(), table.map().intervals());
        let window = window_set(&table, 900, 5);
        let mut random = SplitMix::new(5);
        let (x, y) = (random.next_u64(), random.next_u64());
        let pattern = Pattern::with_origin(map.alpha(), IndexOrigin { x, y });
        let side = window.side() / map.alpha().set_side_f64();
        let mut expected = Vec::new();
        for y in -140..300 {
            for x in -140..300 {
                let (dx, dy) = pattern.index(x, y);
                if let (Some(bx), Some(by)) = (map.interval_of(dx), map.interval_of(dy)) {
                    let [dx, dy] = table.displacements()[by * n + bx].map(to_grid_units);
                    let p = [x as f64 + dx, y as f64 + dy];
                    expected.extend(p.iter().all(|v| (0.0..side).contains(v)).then_some(p));
                }
            }
        }
        let sorted = |points: &[[f64; 2]], scale: f64| {
            let mut all: Vec<_> = points
                .iter()
                .map(|p| p.map(|v| (v * scale * 1e6).round() as i64))
                .collect();
            all.sort_unstable();
            all
        };
        assert!((850..950).contains(&expected.len()));
        let found = sorted(window.points(), 1.0);
        assert_eq!(found, sorted(&expected, map.alpha().set_side_f64()));
    }
}
